//! Identities that hold, formulas that do not, and what is refused.

use super::*;
use crate::expr::random::{Kind, build, recipes};
use crate::expr::text::{parse, print};
use crate::expr::{Dag, ExprId, Residues, SymbolClass, derivative, evaluate};
use proptest::prelude::*;
use rustc_hash::FxHashMap;

fn read(dag: &mut Dag, text: &str) -> ExprId {
    let resolve = &mut |dag: &mut Dag, name: &str| {
        let class = match name.trim_end_matches(|c: char| c.is_ascii_digit()) {
            "q" | "th" => SymbolClass::Configuration,
            "qd" | "thd" => SymbolClass::Rate,
            "qdd" | "thdd" => SymbolClass::Acceleration,
            "m" | "I" => SymbolClass::Inertia,
            _ => SymbolClass::Geometry,
        };
        Some(dag.symbol(name, class))
    };
    parse(dag, text, resolve).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn is_equal(left: &str, right: &str) -> bool {
    let mut dag = Dag::new();
    let (a, b) = (read(&mut dag, left), read(&mut dag, right));
    equal(&mut dag, a, b).unwrap_or_else(|error| panic!("{left} = {right}: {error}"))
}

fn refusal(text: &str) -> CanonicalError {
    let mut dag = Dag::new();
    let expr = read(&mut dag, text);
    canonical(&mut dag, expr).expect_err(text)
}

#[test]
fn identities_are_seen() {
    for (left, right) in [
        ("(a + b)^2", "a^2 + 2*a*b + b^2"),
        ("(a + b)*(a - b)", "a^2 - b^2"),
        ("(a + b)^5 - (a - b)^5", "2*b*(5*a^4 + 10*a^2*b^2 + b^4)"),
        ("a/b*b", "a"),
        ("(a^2 + b)/(a*b)", "a/b + 1/a"),
        ("sin(q1)^2 + cos(q1)^2", "1"),
        ("sin(q1)^4 - cos(q1)^4", "1 - 2*cos(q1)^2"),
        ("sin(2*q1)", "2*sin(q1)*cos(q1)"),
        ("cos(3*q1)", "4*cos(q1)^3 - 3*cos(q1)"),
        ("sin(q1 + q2)", "sin(q1)*cos(q2) + cos(q1)*sin(q2)"),
        ("cos(q1 - q2)*cos(q1 + q2)", "cos(q1)^2 - sin(q2)^2"),
        ("cos(q1 + q2 + q3) + cos(q1 - (q2 + q3))", "2*cos(q1)*cos(q2 + q3)"),
        ("sin(q1 + pi/2)*tan(q1)", "sin(q1)"),
        ("sin(q1 - 7*pi/2)", "cos(q1)"),
        ("cos(r*(q1 + q2))", "cos(r*q1)*cos(r*q2) - sin(r*q1)*sin(r*q2)"),
        ("sin((a + b)^2 - a^2 - b^2)", "2*sin(a*b)*cos(a*b)"),
        ("tanh((a + b)*(a - b))", "tanh(a^2 - b^2)"),
        ("tanh(a - b - c)", "-tanh(b + c - a)"),
        (
            "select((a + b)^2 < a^2, q1*q2 + q1, 0)",
            "select(2*a*b + a^2 + b^2 < a^2, q1*(q2 + 1), 0)",
        ),
        ("min(a*(b + c), a*b + a*c)", "a*b + a*c"),
        ("pi*(a + 1)", "a*pi + pi"),
    ] {
        assert!(is_equal(left, right), "{left} = {right}");
    }
}

#[test]
fn what_differs_is_told_apart() {
    for (left, right) in [
        ("(a + b)^2", "a^2 + a*b + b^2"),
        ("sin(q1 + q2)", "sin(q1)*cos(q2) - cos(q1)*sin(q2)"),
        ("cos(2*q1)", "2*cos(q1)"),
        ("a/b", "b/a"),
        ("sin(q1)", "cos(q1)"),
        ("tanh(a)", "tanh(b)"),
        ("0.1 + 0.2", "0.3000000000000000000000001"),
    ] {
        assert!(!is_equal(left, right), "{left} is not {right}");
    }
}

#[test]
fn what_has_no_canonical_form_is_refused() {
    assert_eq!(refusal("1/(a + b)"), CanonicalError::DivisionBySum);
    assert_eq!(refusal("1/sin(q1)"), CanonicalError::DivisionBySum);
    assert_eq!(refusal("a/((a + b)^2 - a^2 - 2*a*b - b^2)"), CanonicalError::DivisionByZero);
    assert_eq!(refusal("sin(q1/2)"), CanonicalError::Angle);
    assert_eq!(refusal("sin(q1 + pi/4)"), CanonicalError::Angle);
    assert_eq!(refusal("cos(q1 + 1)"), CanonicalError::Angle);
    assert_eq!(refusal("cos(1000*q1)"), CanonicalError::Angle);
    assert_eq!(refusal("(a + b + c + d + e + f)^64"), CanonicalError::TooManyTerms);
    assert_eq!(refusal("((a + b)^64)^64"), CanonicalError::TooManyTerms);
    assert_eq!(refusal("(((((a^64)^64)^64)^64)^64)^64"), CanonicalError::TooManyTerms);
}

#[test]
fn the_normal_form_has_each_sine_at_most_once() {
    let mut dag = Dag::new();
    let expr = read(&mut dag, "(a*sin(q1) + cos(q2)*sin(q2 + q1))^3/a");
    let polynomial = canonical(&mut dag, expr).unwrap();
    let sines = ["sin(q1)", "sin(q2)"].map(|text| read(&mut dag, text));
    for (monomial, _) in polynomial.terms() {
        assert!(sines.iter().all(|&sine| (0..=1).contains(&monomial.exponent(sine))));
    }
    let back = polynomial.to_expr(&mut dag);
    let values = evaluate(&dag, &[expr, back], &mut Residues::new(4)).unwrap();
    assert_eq!(values[0], values[1]);
}

/// The double pendulum of the thesis's appendix A, from its energies, by differentiation.
struct Pendulum {
    dag: Dag,
    kinetic: ExprId,
    potential: ExprId,
}

impl Pendulum {
    /// Positions by A.20-A.23 (y upwards), velocities as their derivatives along time.
    fn new() -> Self {
        let mut dag = Dag::new();
        let rates = [("th1", "thd1"), ("th2", "thd2")];
        let seeds = FxHashMap::from_iter(
            rates.map(|(angle, rate)| (read(&mut dag, angle), read(&mut dag, rate))),
        );
        let (mut kinetic, mut potential) = (dag.zero(), dag.zero());
        for (mass, inertia, x, y, angle) in [
            ("m1", "I1", "c1*cos(th1)", "c1*sin(th1)", "th1"),
            (
                "m2",
                "I2",
                "l1*cos(th1) + c2*cos(th1 + th2)",
                "l1*sin(th1) + c2*sin(th1 + th2)",
                "th1 + th2",
            ),
        ] {
            let [mass, inertia, x, y, angle] =
                [mass, inertia, x, y, angle].map(|text| read(&mut dag, text));
            let speeds = derivative(&mut dag, &[x, y, angle], &seeds);
            for (weight, speed) in [mass, mass, inertia].into_iter().zip(speeds) {
                let square = dag.mul(speed, speed);
                let twice = dag.mul(weight, square);
                let half = dag.constant(crate::number::ratio(1, 2));
                let energy = dag.mul(half, twice);
                kinetic = dag.add(kinetic, energy);
            }
            let gravity = read(&mut dag, "g");
            let weight = dag.mul(mass, gravity);
            let energy = dag.mul(weight, y);
            potential = dag.add(potential, energy);
        }
        Self { dag, kinetic, potential }
    }

    fn along(&mut self, expr: ExprId, name: &str) -> ExprId {
        let symbol = read(&mut self.dag, name);
        let seeds = FxHashMap::from_iter([(symbol, self.dag.one())]);
        derivative(&mut self.dag, &[expr], &seeds)[0]
    }

    fn assert_is(&mut self, expr: ExprId, text: &str) {
        let expected = read(&mut self.dag, text);
        let message = print(&self.dag, expr);
        assert_eq!(equal(&mut self.dag, expr, expected), Ok(true), "{message} is not {text}");
    }
}

#[test]
fn a17_is_the_hessian_of_the_kinetic_energy() {
    let mut pendulum = Pendulum::new();
    let d12 = "m2*(c2^2 + l1*c2*cos(th2)) + I2";
    for (i, j, text) in [
        (1, 1, "m1*c1^2 + m2*(l1^2 + c2^2 + 2*l1*c2*cos(th2)) + I1 + I2"),
        (1, 2, d12),
        (2, 1, d12),
        (2, 2, "m2*c2^2 + I2"),
    ] {
        let momentum = pendulum.along(pendulum.kinetic, &format!("thd{i}"));
        let entry = pendulum.along(momentum, &format!("thd{j}"));
        pendulum.assert_is(entry, text);
    }
}

#[test]
fn a18_corrected_is_made_of_christoffel_symbols() {
    let mut pendulum = Pendulum::new();
    let mut entry = |i: usize, j: usize| {
        let momentum = pendulum.along(pendulum.kinetic, &format!("thd{i}"));
        pendulum.along(momentum, &format!("thd{j}"))
    };
    let d = [[entry(1, 1), entry(1, 2)], [entry(2, 1), entry(2, 2)]];
    let correct = [
        ["-m2*l1*c2*sin(th2)*thd2", "-m2*l1*c2*sin(th2)*(thd1 + thd2)"],
        ["m2*l1*c2*sin(th2)*thd1", "0"],
    ];
    // A.18 as printed has a rate too many.
    let printed = read(&mut pendulum.dag, "-m2*l1*c2*thd2*sin(th2)*(thd1 + thd2)");
    for i in 0..2 {
        for j in 0..2 {
            let mut sum = pendulum.dag.zero();
            for k in 0..2 {
                let rate = read(&mut pendulum.dag, &format!("thd{}", k + 1));
                let [a, b, c] = [(i, j, k), (i, k, j), (j, k, i)]
                    .map(|(r, s, t)| pendulum.along(d[r][s], &format!("th{}", t + 1)));
                let dag = &mut pendulum.dag;
                let ab = dag.add(a, b);
                let abc = dag.sub(ab, c);
                let half = dag.constant(crate::number::ratio(1, 2));
                let symbol = dag.mul(half, abc);
                let term = dag.mul(symbol, rate);
                sum = dag.add(sum, term);
            }
            pendulum.assert_is(sum, correct[i][j]);
            assert_eq!(equal(&mut pendulum.dag, sum, printed), Ok(false));
        }
    }
}

#[test]
fn a19_is_the_gradient_of_the_potential_energy() {
    let mut pendulum = Pendulum::new();
    for (name, text) in [
        ("th1", "(m1*c1 + m2*l1)*g*cos(th1) + m2*c2*g*cos(th1 + th2)"),
        ("th2", "m2*c2*g*cos(th1 + th2)"),
    ] {
        let slope = pendulum.along(pendulum.potential, name);
        pendulum.assert_is(slope, text);
    }
}

proptest! {
    /// The polynomial has the values of the expression, and two expressions have one polynomial
    /// exactly if they have the same values at a random point modulo p.
    #[test]
    fn equality_agrees_with_random_points(recipe in recipes(Kind::Trigonometric, 20)) {
        let mut dag = Dag::new();
        let exprs = build(&mut dag, Kind::Trigonometric, &recipe, Dag::make);
        let mut polynomials = Vec::new();
        for &expr in &exprs {
            let Ok(polynomial) = canonical(&mut dag, expr) else { return Ok(()) };
            if polynomial.len() > 200 {
                return Ok(());
            }
            polynomials.push(polynomial);
        }
        // Modulo p the sine of a product or of a sine is not that of the product written out.
        let is_simple = |polynomial: &Polynomial| {
            let atoms = polynomial.terms().flat_map(|(monomial, _)| monomial.powers());
            atoms.into_iter().all(|&(atom, _)| dag.topological(&[atom]).len() <= 2)
        };
        if !polynomials.iter().all(is_simple) {
            return Ok(());
        }
        let values = evaluate(&dag, &exprs, &mut Residues::new(11)).unwrap();
        for (index, (polynomial, value)) in polynomials.iter().zip(&values).enumerate() {
            let mut scratch = dag.clone();
            let back = polynomial.to_expr(&mut scratch);
            let again = evaluate(&scratch, &[back], &mut Residues::new(11)).unwrap();
            prop_assert_eq!(&again[0], value);
            for (other, other_value) in polynomials.iter().zip(&values).take(index) {
                prop_assert_eq!(polynomial == other, value == other_value);
            }
        }
    }
}
