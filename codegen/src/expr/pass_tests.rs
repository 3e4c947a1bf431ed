//! The passes over the graph: derivatives against differences and known ones, and all passes on
//! graphs that are a million nodes deep.

use super::random::{Kind, build, recipes};
use super::text::{parse, print, print_with_intermediates};
use super::*;
use crate::number::Residue;
use proptest::prelude::*;
use rustc_hash::FxHashMap;

fn read(dag: &mut Dag, text: &str) -> ExprId {
    let resolve = &mut |dag: &mut Dag, name: &str| {
        let class = match name.trim_end_matches(|c: char| c.is_ascii_digit()) {
            "q" | "x" | "y" => SymbolClass::Configuration,
            "qd" => SymbolClass::Rate,
            "qdd" => SymbolClass::Acceleration,
            _ => SymbolClass::Geometry,
        };
        Some(dag.symbol(name, class))
    };
    parse(dag, text, resolve).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// The degree of a polynomial in all symbols together.
fn degree(dag: &Dag, expr: ExprId) -> u64 {
    let mut degrees: FxHashMap<ExprId, u64> = FxHashMap::default();
    for expr in dag.topological(&[expr]) {
        let of = |operand: ExprId| degrees[&operand];
        let degree = match dag.node(expr) {
            Node::Symbol(_) => 1,
            Node::Neg(a) => of(a),
            Node::Add(a, b) | Node::Sub(a, b) => of(a).max(of(b)),
            Node::Mul(a, b) => of(a).saturating_add(of(b)),
            Node::Pow(a, n) => of(a).saturating_mul(u64::from(n)),
            _ => 0,
        };
        degrees.insert(expr, degree);
    }
    degrees[&expr]
}

proptest! {
    /// For a polynomial g of degree d, g'(0) = sum over k = 1..d of (-1)^(k+1)/k times the k-th
    /// forward difference of g at 0, exactly.
    #[test]
    fn derivatives_of_polynomials_are_those_of_their_differences(
        recipe in recipes(Kind::Polynomial, 16)
    ) {
        let mut dag = Dag::new();
        let Some(&expr) = build(&mut dag, Kind::Polynomial, &recipe, Dag::make).last() else {
            return Ok(());
        };
        let degree = degree(&dag, expr);
        prop_assume!(degree <= 64);
        let directions = [("q1", 3), ("qd1", 1), ("l1", 5)];
        let mut seeds = FxHashMap::default();
        for (name, speed) in directions {
            let symbol = dag.find_symbol(name).unwrap();
            let (symbol, rate) = (dag.symbol_expr(symbol), dag.integer(speed));
            seeds.insert(symbol, rate);
        }
        let rate = derivative(&mut dag, &[expr], &seeds)[0];
        let derived = evaluate(&dag, &[rate], &mut Residues::new(5)).unwrap()[0];

        let at = |h: u64| {
            let ring = Residues::new(5);
            let ring = directions.iter().fold(ring, |ring, (name, speed)| {
                let id = dag.find_symbol(name).unwrap();
                let start = Residues::new(5).symbol(&dag, id).unwrap();
                ring.with(name, start + Residue::new(h) * Residue::new(*speed as u64))
            });
            let mut ring = ring;
            evaluate(&dag, &[expr], &mut ring).unwrap()[0]
        };
        let mut differences: Vec<Residue> = (0..=degree).map(at).collect();
        let mut expected = Residue::ZERO;
        for k in 1..=degree {
            differences = differences.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let term = differences[0] * Residue::new(k).inverse().unwrap();
            expected = if k % 2 == 1 { expected + term } else { expected - term };
        }
        prop_assert_eq!(derived, expected);
    }
}

#[test]
fn derivatives_of_functions_are_the_known_ones() {
    for (text, expected) in [
        ("sin(x)", "cos(x)"),
        ("cos(x)", "-sin(x)"),
        ("tan(x)", "1 + tan(x)^2"),
        ("sqrt(x)", "1/(2*sqrt(x))"),
        ("exp(x)", "exp(x)"),
        ("log(x)", "1/x"),
        ("tanh(x)", "1 - tanh(x)^2"),
        ("abs(x)", "sign(x)"),
        ("sign(x)", "0"),
        ("min(x, y)", "select(x < y, 1, 0)"),
        ("max(x, y)", "select(x < y, 0, 1)"),
        ("atan2(x, y)", "y/(x^2 + y^2)"),
        ("atan2(y, x)", "-y/(x^2 + y^2)"),
        ("select(x < y, x^2, y)", "select(x < y, 2*x, 0)"),
        ("x^5", "5*x^4"),
        ("1/x", "-1/x^2"),
        ("y/x^3", "-3*y/x^4"),
        ("sin(3*x + y)*x", "3*x*cos(3*x + y) + sin(3*x + y)"),
        ("exp(sin(x)^2)", "2*sin(x)*cos(x)*exp(sin(x)^2)"),
        ("y + pi", "0"),
    ] {
        let mut dag = Dag::new();
        let (x, expr, expected) =
            (read(&mut dag, "x"), read(&mut dag, text), read(&mut dag, expected));
        let seeds = FxHashMap::from_iter([(x, dag.one())]);
        let rate = derivative(&mut dag, &[expr], &seeds)[0];
        let point = |name: &str| Some(if name == "x" { 0.37 } else { 1.21 });
        let values = evaluate(&dag, &[rate, expected], &mut Floats::new(point)).unwrap();
        assert!((values[0] - values[1]).abs() < 1e-14, "{text}: {}", print(&dag, rate));
        if !text.contains("m") {
            let values = evaluate(&dag, &[rate, expected], &mut Residues::new(1)).unwrap();
            assert_eq!(values[0], values[1], "{text}: {}", print(&dag, rate));
        }
    }
}

#[test]
fn a_direction_may_be_time() {
    let mut dag = Dag::new();
    let expr = read(&mut dag, "l1*q1^2*qd2 + sin(q2)*qd1");
    let seeds = FxHashMap::from_iter(
        [("q1", "qd1"), ("q2", "qd2"), ("qd1", "qdd1"), ("qd2", "qdd2")]
            .map(|(of, rate)| (read(&mut dag, of), read(&mut dag, rate))),
    );
    let rate = derivative(&mut dag, &[expr], &seeds)[0];
    let expected =
        read(&mut dag, "2*l1*q1*qd1*qd2 + l1*q1^2*qdd2 + cos(q2)*qd2*qd1 + sin(q2)*qdd1");
    let values = evaluate(&dag, &[rate, expected], &mut Residues::new(1)).unwrap();
    assert_eq!(values[0], values[1]);
}

#[test]
fn substitution_replaces_all_at_once() {
    let mut dag = Dag::new();
    let expr = read(&mut dag, "x*sin(y) + q1*(x + y)");
    let (x, y, sum) = (read(&mut dag, "x"), read(&mut dag, "y"), read(&mut dag, "x + y"));
    let replacements = FxHashMap::from_iter([(x, y), (y, x), (sum, dag.one())]);
    let replaced = substitute(&mut dag, &[expr], &replacements)[0];
    assert_eq!(replaced, read(&mut dag, "y*sin(x) + q1"));
    let names: Vec<&str> = free_symbols(&dag, &[replaced])
        .into_iter()
        .map(|id| dag.symbols()[id].name.as_str())
        .collect();
    assert_eq!(names, ["x", "y", "q1"]);
}

/// One node on the other, a million of them (fewer in a slow build), by all passes: on the small
/// stack of a test's thread a recursive pass would not survive it.
#[test]
fn passes_do_not_recurse() {
    const DEPTH: usize = if cfg!(debug_assertions) { 40_000 } else { 250_000 };
    let mut dag = Dag::new();
    let (q1, q2) = (read(&mut dag, "q1"), read(&mut dag, "q2"));
    let mut expr = q1;
    for _ in 0..DEPTH {
        let product = dag.mul(expr, q2);
        let sum = dag.add(product, q1);
        let sin = dag.sin(sum);
        expr = dag.sub(q2, sin);
    }
    assert!(dag.topological(&[expr]).len() >= 4 * DEPTH - 10);
    let seeds = FxHashMap::from_iter([(q1, dag.one())]);
    let rate = derivative(&mut dag, &[expr], &seeds)[0];
    let values = evaluate(&dag, &[expr, rate], &mut Residues::new(2)).unwrap();
    assert_ne!(values[0], values[1]);
    let exchanged = FxHashMap::from_iter([(q1, q2), (q2, q1)]);
    let there = substitute(&mut dag, &[expr], &exchanged);
    assert_eq!(substitute(&mut dag, &there, &exchanged), [expr]);
    assert_eq!(free_symbols(&dag, &[expr]).len(), 2);
    let order = Order::of(&dag, &[expr]);
    assert!(order.rank(expr) as usize > DEPTH);
    let text = print(&dag, expr);
    assert_eq!(read(&mut dag, &text), expr);
    // The derivative uses each level twice: written out it would have 2^DEPTH terms.
    let printed = print_with_intermediates(&dag, &[rate], 1000);
    assert!(printed.bindings.len() >= DEPTH - 1, "{}", printed.bindings.len());
}
