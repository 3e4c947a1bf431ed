//! Sine and cosine as steps: those of the runtime, in its order, so that bits are the same.

use super::lower::Lowering;
use super::steps::{Comparison, Operation, Step, Value};
use crate::lanes::Lanes;
use denavit_runtime::FUSES;
use denavit_runtime::numbers::{COSINE, HALF_PI, ORDINARY_RANGE, ROUNDER, SINE};
use std::f64::consts::FRAC_2_PI;

/// The sign of a number.
pub(super) const SIGN: f64 = -0.0;
/// All other bits of a number.
pub(super) const MAGNITUDE: f64 = f64::from_bits(!(1 << 63));
/// The lowest bit of a number.
const LOWEST: f64 = f64::from_bits(1);

/// Writes the steps of one angle. Steps of several angles are put between each other, so they are
/// kept apart.
pub(super) struct Turn<'a> {
    pub(super) lowering: &'a mut Lowering,
    pub(super) steps: Vec<Step>,
    /// A mask that no other angle has, which is written in between.
    pub(super) mask: u8,
}

/// An angle as a number of quarter turns and a rest, head - excess.
struct Reduced {
    biased: Value,
    head: Value,
    excess: Value,
}

impl Turn<'_> {
    /// The sine and the cosine.
    pub(super) fn run(&mut self, angle: Value) -> [Value; 2] {
        let reduced = self.reduced(angle);
        self.watch(angle);
        self.of_reduced(reduced)
    }

    fn step(&mut self, operation: Operation, operands: &[Value]) -> Value {
        let result = self.lowering.new_value();
        self.steps.push(Step::new(operation, operands, [Some(result), None]));
        result
    }

    fn effect(&mut self, operation: Operation, operands: &[Value]) {
        self.steps.push(Step::new(operation, operands, [None; 2]));
    }

    fn number(&mut self, number: f64) -> Value {
        self.lowering.number(number)
    }

    fn add(&mut self, a: Value, b: Value) -> Value {
        self.step(Operation::Add, &[a, b])
    }

    fn sub(&mut self, a: Value, b: Value) -> Value {
        self.step(Operation::Sub, &[a, b])
    }

    fn mul(&mut self, a: Value, b: Value) -> Value {
        self.step(Operation::Mul, &[a, b])
    }

    /// `Scalar::product_plus`
    fn product_plus(&mut self, a: Value, b: Value, c: Value) -> Value {
        if FUSES {
            return self.step(Operation::MulAdd, &[a, b, c]);
        }
        let product = self.mul(a, b);
        self.add(product, c)
    }

    /// `Scalar::product_minus`
    fn product_minus(&mut self, a: Value, b: Value, c: Value) -> Value {
        if FUSES {
            return self.step(Operation::MulSub, &[a, b, c]);
        }
        let product = self.mul(a, b);
        self.sub(product, c)
    }

    /// `Scalar::minus_product` where the product is exact: then it is the same whether it is
    /// rounded or not, and one step is enough.
    fn minus_exact_product(&mut self, c: Value, a: Value, b: Value) -> Value {
        self.step(Operation::NegMulAdd, &[a, b, c])
    }

    /// `reduce_ordinary` of the runtime.
    fn reduced(&mut self, angle: Value) -> Reduced {
        let [inverse, rounder] = [FRAC_2_PI, ROUNDER].map(|number| self.number(number));
        let [first_part, second_part, third_part] = HALF_PI.map(|number| self.number(number));
        let biased = self.product_plus(angle, inverse, rounder);
        let turns = self.sub(biased, rounder);
        // Products of the first two parts and a number of ordinary turns are exact.
        let first = self.minus_exact_product(angle, turns, first_part);
        let second = self.minus_exact_product(first, turns, second_part);
        let difference = self.sub(first, second);
        let lost = self.minus_exact_product(difference, turns, second_part);
        let correction = self.product_minus(turns, third_part, lost);
        let head = self.sub(second, correction);
        let difference = self.sub(second, head);
        let excess = self.sub(correction, difference);
        Reduced { biased, head, excess }
    }

    /// Remembers an angle that `reduced` is wrong of. Infinities are among them; NaN is not, whose
    /// sine and cosine are NaN either way.
    fn watch(&mut self, angle: Value) {
        let [magnitude, limit] = [MAGNITUDE, ORDINARY_RANGE].map(|number| self.number(number));
        let size = self.step(Operation::And, &[angle, magnitude]);
        if self.lowering.lanes == Lanes::Eight {
            self.effect(Operation::Watch, &[size, limit]);
        } else {
            let is_large = self.step(Operation::Compare(Comparison::Greater), &[size, limit]);
            self.effect(Operation::Watch, &[is_large]);
        }
        self.lowering.straight.watches = true;
    }

    /// `of_reduced` of the runtime.
    fn of_reduced(&mut self, Reduced { biased, head, excess }: Reduced) -> [Value; 2] {
        let square = self.mul(head, head);
        let fourth = self.mul(square, square);
        let [half, one] = [0.5, 1.0].map(|number| self.number(number));
        // Half a number is exact, or so small that one loses nothing by it.
        let leading = self.minus_exact_product(one, half, square);

        let cube = self.mul(square, head);
        let sines = self.polynomial(SINE, square, fourth);
        let product = self.mul(excess, leading);
        let bracket = self.product_plus(cube, sines, product);
        let sine = self.sub(head, bracket);

        let difference = self.sub(one, leading);
        let lost = self.minus_exact_product(difference, half, square);
        let cosines = self.polynomial(COSINE, square, fourth);
        let product = self.mul(head, excess);
        let bracket = self.product_plus(fourth, cosines, product);
        let small = self.add(lost, bracket);
        let cosine = self.add(leading, small);
        self.turned(sine, cosine, biased)
    }

    fn polynomial(&mut self, coefficients: [f64; 6], z: Value, z_squared: Value) -> Value {
        let a = coefficients.map(|number| self.number(number));
        let [low, middle, high] = [0, 2, 4].map(|at| self.product_plus(a[at + 1], z, a[at]));
        let high = self.product_plus(z_squared, high, middle);
        self.product_plus(z_squared, high, low)
    }

    /// `turned` of the runtime: an odd number of quarter turns swaps the two, and their signs are
    /// bit 1 of the number, and of the next one.
    fn turned(&mut self, sine: Value, cosine: Value, quarters: Value) -> [Value; 2] {
        let lowest = self.number(LOWEST);
        let [first, second] = if self.lowering.lanes == Lanes::Eight {
            self.effect(Operation::Test(self.mask), &[quarters, lowest]);
            let choose = Operation::ChooseBy(self.mask);
            [self.step(choose, &[cosine, sine]), self.step(choose, &[sine, cosine])]
        } else {
            let is_odd = self.step(Operation::ShiftLeft(63), &[quarters]);
            let choose = Operation::Choose;
            [self.step(choose, &[is_odd, cosine, sine]), self.step(choose, &[is_odd, sine, cosine])]
        };
        let next = self.step(Operation::AddBits, &[quarters, lowest]);
        [(first, quarters), (second, next)].map(|(number, bits)| {
            let bits = self.step(Operation::ShiftLeft(62), &[bits]);
            let sign = self.number(SIGN);
            if self.lowering.lanes == Lanes::Eight {
                return self.step(Operation::XorAnd, &[number, bits, sign]);
            }
            let bits = self.step(Operation::And, &[bits, sign]);
            self.step(Operation::Xor, &[number, bits])
        })
    }
}
