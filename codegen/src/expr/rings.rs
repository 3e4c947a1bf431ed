//! The rings that expressions are evaluated over.

use super::angle::{angle_atoms, is_pi};
use super::circle;
use super::dag::{BinaryFunction, Dag, ExprId, Relation, SymbolId, UnaryFunction};
use super::evaluate::{EvaluateError, Ring};
use super::symbol::ClassSet;
use crate::arena::Handle;
use crate::number::{Rational, Residue, to_f64};
use num_traits::{Signed, ToPrimitive, Zero};
use rustc_hash::FxHashMap;

/// Floating point, with the standard library's functions: for looking at values, never for
/// deciding anything.
pub struct Floats<F: Fn(&str) -> Option<f64>> {
    value_of: F,
}

impl<F: Fn(&str) -> Option<f64>> Floats<F> {
    /// `value_of` gives a symbol's value by its name.
    pub fn new(value_of: F) -> Self {
        Self { value_of }
    }
}

impl<F: Fn(&str) -> Option<f64>> Ring for Floats<F> {
    type Value = f64;

    fn constant(&mut self, value: &Rational) -> Result<f64, EvaluateError> {
        Ok(to_f64(value))
    }
    fn pi(&mut self) -> Result<f64, EvaluateError> {
        Ok(std::f64::consts::PI)
    }
    fn symbol(&mut self, dag: &Dag, id: SymbolId) -> Result<f64, EvaluateError> {
        let name = &dag.symbols()[id].name;
        (self.value_of)(name).ok_or_else(|| EvaluateError::MissingSymbol(name.clone()))
    }
    fn neg(&mut self, a: &f64) -> f64 {
        -a
    }
    fn add(&mut self, a: &f64, b: &f64) -> f64 {
        a + b
    }
    fn sub(&mut self, a: &f64, b: &f64) -> f64 {
        a - b
    }
    fn mul(&mut self, a: &f64, b: &f64) -> f64 {
        a * b
    }
    fn div(&mut self, a: &f64, b: &f64) -> Result<f64, EvaluateError> {
        if *b == 0.0 { Err(EvaluateError::DivisionByZero) } else { Ok(a / b) }
    }
    fn unary(
        &mut self,
        function: UnaryFunction,
        _: &Dag,
        argument: ExprId,
        values: &[Option<f64>],
    ) -> Result<f64, EvaluateError> {
        let x = values[argument.index()].expect("operands come first");
        Ok(match function {
            UnaryFunction::Sin => x.sin(),
            UnaryFunction::Cos => x.cos(),
            UnaryFunction::Tan => x.tan(),
            UnaryFunction::Sqrt => x.sqrt(),
            UnaryFunction::Exp => x.exp(),
            UnaryFunction::Log => x.ln(),
            UnaryFunction::Tanh => x.tanh(),
            UnaryFunction::Abs => x.abs(),
            UnaryFunction::Sign if x == 0.0 => 0.0,
            UnaryFunction::Sign => x.signum(),
        })
    }
    fn binary(
        &mut self,
        function: BinaryFunction,
        _: &Dag,
        _: [ExprId; 2],
        [a, b]: [&f64; 2],
    ) -> Result<f64, EvaluateError> {
        Ok(match function {
            BinaryFunction::Atan2 => a.atan2(*b),
            BinaryFunction::Min => a.min(*b),
            BinaryFunction::Max => a.max(*b),
        })
    }
    fn select(
        &mut self,
        relation: Relation,
        _: &Dag,
        _: [ExprId; 2],
        [left, right]: [&f64; 2],
        then: &f64,
        otherwise: &f64,
    ) -> f64 {
        if holds(relation, left, right) { *then } else { *otherwise }
    }
}

/// The rational numbers. What leaves them is an error, never an approximation.
pub struct Rationals<F: Fn(&str) -> Option<Rational>> {
    value_of: F,
}

impl<F: Fn(&str) -> Option<Rational>> Rationals<F> {
    /// `value_of` gives a symbol's value by its name.
    pub fn new(value_of: F) -> Self {
        Self { value_of }
    }
}

impl<F: Fn(&str) -> Option<Rational>> Ring for Rationals<F> {
    type Value = Rational;

    fn constant(&mut self, value: &Rational) -> Result<Rational, EvaluateError> {
        Ok(value.clone())
    }
    fn pi(&mut self) -> Result<Rational, EvaluateError> {
        Err(EvaluateError::PiNotInRing)
    }
    fn symbol(&mut self, dag: &Dag, id: SymbolId) -> Result<Rational, EvaluateError> {
        let name = &dag.symbols()[id].name;
        (self.value_of)(name).ok_or_else(|| EvaluateError::MissingSymbol(name.clone()))
    }
    fn neg(&mut self, a: &Rational) -> Rational {
        -a
    }
    fn add(&mut self, a: &Rational, b: &Rational) -> Rational {
        a + b
    }
    fn sub(&mut self, a: &Rational, b: &Rational) -> Rational {
        a - b
    }
    fn mul(&mut self, a: &Rational, b: &Rational) -> Rational {
        a * b
    }
    fn div(&mut self, a: &Rational, b: &Rational) -> Result<Rational, EvaluateError> {
        if b.is_zero() { Err(EvaluateError::DivisionByZero) } else { Ok(a / b) }
    }
    fn unary(
        &mut self,
        function: UnaryFunction,
        _: &Dag,
        argument: ExprId,
        values: &[Option<Rational>],
    ) -> Result<Rational, EvaluateError> {
        let x = values[argument.index()].clone().expect("operands come first");
        let mut scratch = Dag::new();
        let argument = scratch.constant(x);
        let folded = scratch.unary(function, argument);
        scratch.as_constant(folded).cloned().ok_or(EvaluateError::NotInRing(function))
    }
    fn binary(
        &mut self,
        function: BinaryFunction,
        _: &Dag,
        _: [ExprId; 2],
        [a, b]: [&Rational; 2],
    ) -> Result<Rational, EvaluateError> {
        Ok(match function {
            BinaryFunction::Min => a.min(b).clone(),
            BinaryFunction::Max => a.max(b).clone(),
            BinaryFunction::Atan2 if a.is_zero() && b.is_positive() => Rational::zero(),
            BinaryFunction::Atan2 => return Err(EvaluateError::NotInRingBinary(function)),
        })
    }
    fn select(
        &mut self,
        relation: Relation,
        _: &Dag,
        _: [ExprId; 2],
        [left, right]: [&Rational; 2],
        then: &Rational,
        otherwise: &Rational,
    ) -> Rational {
        if holds(relation, left, right) { then.clone() } else { otherwise.clone() }
    }
}

fn holds<T: PartialOrd>(relation: Relation, left: &T, right: &T) -> bool {
    match relation {
        Relation::Less => left < right,
        Relation::LessEqual => left <= right,
        Relation::Equal => left == right,
    }
}

/// A random point over the field of residues modulo 2^61 - 1, made from a written seed.
///
/// A symbol's value depends on the seed and its name alone, so two graphs can be compared. Sines
/// and cosines are points of the unit circle that obey the addition theorems: an angle is read as
/// a whole-number combination of atoms, each atom has a random point, quarter turns are exact.
/// What is no ring operation is opaque: a random residue for each (function, arguments), odd where
/// the function is odd, even where it is even.
pub struct Residues {
    seed: u64,
    parameter_seed: u64,
    given: FxHashMap<String, Residue>,
    unit_points: FxHashMap<(Residue, u64), [Residue; 2]>,
}

impl Residues {
    /// The point of a seed.
    pub fn new(seed: u64) -> Self {
        Self::with_parameters(seed, seed)
    }

    /// The point of a seed, at which parameters (and what depends on them alone) have the values of
    /// the point `parameter_seed`.
    pub fn with_parameters(seed: u64, parameter_seed: u64) -> Self {
        let (given, unit_points) = (FxHashMap::default(), FxHashMap::default());
        Self { seed, parameter_seed, given, unit_points }
    }

    /// The same point, but with this value for the symbol `name`.
    pub fn with(mut self, name: &str, value: Residue) -> Self {
        self.given.insert(name.to_owned(), value);
        self
    }

    /// What depends on parameters alone is the same at all points of the same parameters.
    fn seed_of(&self, dag: &Dag, exprs: &[ExprId]) -> u64 {
        let is_run_time = exprs.iter().any(|&expr| dag.is_run_time(expr));
        if is_run_time { self.seed } else { self.parameter_seed }
    }

    /// (cos, sin) of the angle `argument`, by the addition theorems.
    fn unit_point(
        &mut self,
        dag: &Dag,
        argument: ExprId,
        values: &[Option<Residue>],
    ) -> Result<[Residue; 2], EvaluateError> {
        let mut point = [Residue::ONE, Residue::ZERO];
        for (atom, mut coefficient) in angle_atoms(dag, argument) {
            if is_pi(dag, &atom) {
                let (exact, odd) = circle::fraction_of_pi(&coefficient);
                point = circle::turned(point, exact);
                coefficient = odd;
            }
            let mut value = Residue::ONE;
            for &(expr, exponent) in &atom {
                let factor = values[expr.index()].expect("operands come first");
                value = value * power(factor, exponent).ok_or(EvaluateError::DivisionByZero)?;
            }
            let is_run_time = atom.iter().any(|&(expr, _)| dag.is_run_time(expr));
            let seed = if is_run_time { self.seed } else { self.parameter_seed };
            let denominator = coefficient.denom().to_u64().unwrap_or(u64::MAX);
            let mut factor = self.random_unit_point(seed, value, denominator);
            if coefficient.is_negative() {
                factor[1] = -factor[1];
            }
            let times = coefficient.numer().abs().to_u64().unwrap_or(u64::MAX);
            point = circle::turned(point, circle::multiple(factor, times));
        }
        Ok(point)
    }

    /// A random point for an atom; that of 0 is 1, and opposite atoms have conjugate points.
    fn random_unit_point(&mut self, seed: u64, value: Residue, denominator: u64) -> [Residue; 2] {
        if value == Residue::ZERO {
            return [Residue::ONE, Residue::ZERO];
        }
        let (value, is_opposite) = magnitude(value);
        let [cos, sin] = *self.unit_points.entry((value, denominator)).or_insert_with(|| {
            let key = value.value() ^ denominator.rotate_left(40);
            circle::half_tangent(Residue::scrambled(seed ^ 0x756e_6974, key))
        });
        [cos, if is_opposite { -sin } else { sin }]
    }

    fn opaque(&self, seed: u64, label: &str, arguments: &[Residue]) -> Residue {
        arguments.iter().fold(Residue::scrambled(seed, fnv(label)), |state, argument| {
            Residue::scrambled(state.value(), argument.value())
        })
    }
}

/// a^n; `None` for a negative power of 0.
fn power(a: Residue, exponent: i64) -> Option<Residue> {
    let mut base = if exponent < 0 { a.inverse()? } else { a };
    let mut exponent = exponent.unsigned_abs();
    let mut result = Residue::ONE;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = result * base;
        }
        base = base * base;
        exponent >>= 1;
    }
    Some(result)
}

/// One of a and -a, the same for both, and whether it is -a: what odd and even functions look at.
fn magnitude(a: Residue) -> (Residue, bool) {
    if a > -a { (-a, true) } else { (a, false) }
}

fn fnv(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

impl Ring for Residues {
    type Value = Residue;

    fn constant(&mut self, value: &Rational) -> Result<Residue, EvaluateError> {
        Residue::from_rational(value).ok_or(EvaluateError::DivisionByZero)
    }
    fn pi(&mut self) -> Result<Residue, EvaluateError> {
        Ok(Residue::scrambled(self.parameter_seed, fnv("pi")))
    }
    fn symbol(&mut self, dag: &Dag, id: SymbolId) -> Result<Residue, EvaluateError> {
        let name = &dag.symbols()[id].name;
        let class = ClassSet::of(dag.symbols()[id].class);
        let seed = if class.is_run_time() { self.seed } else { self.parameter_seed };
        let random = || Residue::scrambled(seed ^ 0x7379_6d62, fnv(name));
        Ok(self.given.get(name).copied().unwrap_or_else(random))
    }
    fn neg(&mut self, a: &Residue) -> Residue {
        -*a
    }
    fn add(&mut self, a: &Residue, b: &Residue) -> Residue {
        *a + *b
    }
    fn sub(&mut self, a: &Residue, b: &Residue) -> Residue {
        *a - *b
    }
    fn mul(&mut self, a: &Residue, b: &Residue) -> Residue {
        *a * *b
    }
    fn div(&mut self, a: &Residue, b: &Residue) -> Result<Residue, EvaluateError> {
        b.inverse().map(|inverse| *a * inverse).ok_or(EvaluateError::DivisionByZero)
    }
    fn unary(
        &mut self,
        function: UnaryFunction,
        dag: &Dag,
        argument: ExprId,
        values: &[Option<Residue>],
    ) -> Result<Residue, EvaluateError> {
        match function {
            UnaryFunction::Sin => Ok(self.unit_point(dag, argument, values)?[1]),
            UnaryFunction::Cos => Ok(self.unit_point(dag, argument, values)?[0]),
            UnaryFunction::Tan => {
                let [cos, sin] = self.unit_point(dag, argument, values)?;
                self.div(&sin, &cos)
            }
            _ => {
                let value = values[argument.index()].expect("operands come first");
                let (value, negated) = match function {
                    UnaryFunction::Abs => (magnitude(value).0, false),
                    UnaryFunction::Tanh | UnaryFunction::Sign => magnitude(value),
                    _ => (value, false),
                };
                // f(-0) = -f(0): what is odd is 0 at 0, in whichever order a difference is written.
                let is_odd = matches!(function, UnaryFunction::Tanh | UnaryFunction::Sign);
                if is_odd && value == Residue::ZERO {
                    return Ok(value);
                }
                let seed = self.seed_of(dag, &[argument]);
                let result = self.opaque(seed, &format!("{function:?}"), &[value]);
                Ok(if negated { -result } else { result })
            }
        }
    }
    fn binary(
        &mut self,
        function: BinaryFunction,
        dag: &Dag,
        arguments: [ExprId; 2],
        [a, b]: [&Residue; 2],
    ) -> Result<Residue, EvaluateError> {
        // Min and max do not know the order of their arguments.
        let (a, b) = match function {
            BinaryFunction::Atan2 => (a, b),
            BinaryFunction::Min | BinaryFunction::Max => (a.min(b), a.max(b)),
        };
        let seed = self.seed_of(dag, &arguments);
        Ok(self.opaque(seed, &format!("{function:?}"), &[*a, *b]))
    }
    fn select(
        &mut self,
        relation: Relation,
        dag: &Dag,
        sides: [ExprId; 2],
        values: [&Residue; 2],
        then: &Residue,
        otherwise: &Residue,
    ) -> Residue {
        // The sides decide as a coin would, so that a selection keeps what holds of both branches:
        // it is linear in them, and its square is the selection of the squares.
        let seed = self.seed_of(dag, &sides);
        let coin = self.opaque(seed, &format!("{relation:?}"), &values.map(|value| *value));
        if coin.value().is_multiple_of(2) { *then } else { *otherwise }
    }
}
