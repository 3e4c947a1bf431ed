//! The laws of functions and selections, under the rules of `fold.rs`.

use super::dag::{BinaryFunction, Dag, ExprId, Node, Relation, UnaryFunction};
use crate::number::{Rational, integer};
use num_traits::{One, Signed, ToPrimitive, Zero};
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

impl Dag {
    /// `sin(a)`.
    pub fn sin(&mut self, a: ExprId) -> ExprId {
        self.unary(UnaryFunction::Sin, a)
    }

    /// `cos(a)`.
    pub fn cos(&mut self, a: ExprId) -> ExprId {
        self.unary(UnaryFunction::Cos, a)
    }

    /// A function of one argument, folded.
    pub fn unary(&mut self, function: UnaryFunction, a: ExprId) -> ExprId {
        use UnaryFunction::{Abs, Cos, Exp, Log, Sign, Sin, Sqrt, Tan, Tanh};
        if let Some(value) = self.as_constant(a).and_then(|value| unary_of(function, value)) {
            return self.constant(value);
        }
        if matches!(function, Sin | Cos | Tan) {
            // sin(a + k pi/2) and cos(a + k pi/2) are +-sin a or +-cos a
            // tan(a + k pi) = tan a
            if let Some((rest, turns)) = self.split_quarter_turns(a, function == Tan) {
                return self.shifted(function, rest, turns);
            }
        }
        let negated = match self.node(a) {
            Node::Neg(inner) => Some(inner),
            _ => None,
        };
        match (function, negated) {
            // f(-a) = -f(a) for sin, tan, tanh, sign
            (Sin | Tan | Tanh | Sign, Some(inner)) => {
                let value = self.unary(function, inner);
                self.neg(value)
            }
            // f(-a) = f(a) for cos, abs
            (Cos | Abs, Some(inner)) => self.unary(function, inner),
            (Sin | Cos | Tan | Tanh | Sign | Abs | Sqrt | Exp | Log, _) => {
                self.intern(Node::Unary(function, a))
            }
        }
    }

    /// A function of two arguments, folded.
    pub fn binary(&mut self, function: BinaryFunction, a: ExprId, b: ExprId) -> ExprId {
        match function {
            BinaryFunction::Atan2 => self.atan2(a, b),
            BinaryFunction::Min | BinaryFunction::Max => self.extremum(function, a, b),
        }
    }

    /// `atan2(y, x)`.
    pub fn atan2(&mut self, y: ExprId, x: ExprId) -> ExprId {
        // atan2(0, k) = 0 for k > 0
        if y == self.zero() && self.as_constant(x).is_some_and(Rational::is_positive) {
            return y;
        }
        self.intern(Node::Binary(BinaryFunction::Atan2, y, x))
    }

    /// A function of `a + turns pi/2`; for the tangent `turns` is even.
    fn shifted(&mut self, function: UnaryFunction, a: ExprId, turns: u8) -> ExprId {
        use UnaryFunction::{Cos, Sin, Tan};
        if function == Tan {
            return self.unary(function, a);
        }
        // cos a is sin(a + pi/2)
        let turns = (turns + u8::from(function == Cos)) % 4;
        let value = self.unary(if turns.is_multiple_of(2) { Sin } else { Cos }, a);
        if turns < 2 { value } else { self.neg(value) }
    }

    /// `a = rest + k pi/2` with the whole number k (an even one if `half_turns`) taken modulo 4;
    /// `None` if k is 0. The sums below `a` are made again without their multiples of pi, each as
    /// it was grouped: no addition is new unless the angle is used as a number too.
    fn split_quarter_turns(&mut self, a: ExprId, half_turns: bool) -> Option<(ExprId, u8)> {
        let nodes = self.additive_nodes(a);
        if nodes.iter().all(|&expr| self.half_pis(expr).is_none()) {
            return None;
        }
        let mut stripped: FxHashMap<ExprId, (ExprId, Rational)> = FxHashMap::default();
        for expr in nodes {
            let split = self.without_pi(expr, &stripped);
            stripped.insert(expr, split);
        }
        let (mut rest, half_pis) = stripped.remove(&a)?;
        let step = integer(if half_turns { 2 } else { 1 });
        let whole = (&half_pis / &step).floor() * step;
        if whole.is_zero() {
            return None;
        }
        let turns = quarter_turns(&whole);
        let pi = self.pi();
        let fraction = self.constant((half_pis - whole) / integer(2));
        let angle = self.mul(fraction, pi);
        rest = self.add(rest, angle);
        Some((rest, turns))
    }

    /// The sums below `a` and their terms, operands first.
    fn additive_nodes(&self, a: ExprId) -> Vec<ExprId> {
        let (mut pending, mut nodes) = (BTreeSet::from([a]), Vec::new());
        // Users have larger handles than operands.
        while let Some(expr) = pending.pop_last() {
            nodes.push(expr);
            let node = self.node(expr);
            if matches!(node, Node::Neg(_) | Node::Add(..) | Node::Sub(..)) {
                node.for_each_operand(|operand| {
                    pending.insert(operand);
                });
            }
        }
        nodes.reverse();
        nodes
    }

    /// `expr = rest + k pi/2`, given the same for the operands of sums.
    fn without_pi(
        &mut self,
        expr: ExprId,
        stripped: &FxHashMap<ExprId, (ExprId, Rational)>,
    ) -> (ExprId, Rational) {
        let split = |operand: ExprId| {
            let (rest, count) = &stripped[&operand];
            (*rest, count.clone())
        };
        let (node, count) = match self.node(expr) {
            Node::Neg(x) => {
                let (rest, count) = split(x);
                (Node::Neg(rest), -count)
            }
            Node::Add(x, y) => {
                let ((left, k), (right, l)) = (split(x), split(y));
                (Node::Add(left, right), k + l)
            }
            Node::Sub(x, y) => {
                let ((left, k), (right, l)) = (split(x), split(y));
                (Node::Sub(left, right), k - l)
            }
            _ => {
                return match self.half_pis(expr) {
                    Some(count) => (self.zero(), count),
                    None => (expr, Rational::zero()),
                };
            }
        };
        (self.make(node), count)
    }

    /// The rational k for which the expression is `k pi/2`.
    fn half_pis(&self, expr: ExprId) -> Option<Rational> {
        match self.node(expr) {
            Node::Pi => Some(integer(2)),
            Node::Mul(x, y) => {
                let (k, pi) = if self.as_constant(x).is_some() { (x, y) } else { (y, x) };
                (self.node(pi) == Node::Pi).then(|| self.as_constant(k).map(|k| k * integer(2)))?
            }
            _ => None,
        }
    }

    /// The smaller of two.
    pub fn min(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.extremum(BinaryFunction::Min, a, b)
    }

    /// The larger of two.
    pub fn max(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.extremum(BinaryFunction::Max, a, b)
    }

    fn extremum(&mut self, function: BinaryFunction, a: ExprId, b: ExprId) -> ExprId {
        // min(a, a) = max(a, a) = a
        if a == b {
            return a;
        }
        // min(k, l) = k or l, max(k, l) = k or l
        if let (Some(x), Some(y)) = (self.as_constant(a), self.as_constant(b)) {
            return if (x < y) == (function == BinaryFunction::Min) { a } else { b };
        }
        self.intern(Node::Binary(function, a.min(b), a.max(b)))
    }

    /// `then` where `left relation right`, `otherwise` elsewhere.
    pub fn select(
        &mut self,
        relation: Relation,
        left: ExprId,
        right: ExprId,
        then: ExprId,
        otherwise: ExprId,
    ) -> ExprId {
        // select(c, a, a) = a
        if then == otherwise {
            return then;
        }
        // select(a < a, x, y) = y
        // select(a <= a, x, y) = select(a == a, x, y) = x
        if left == right {
            return if relation == Relation::Less { otherwise } else { then };
        }
        // select(k < l, x, y) = x or y
        if let (Some(x), Some(y)) = (self.as_constant(left), self.as_constant(right)) {
            let holds = match relation {
                Relation::Less => x < y,
                Relation::LessEqual => x <= y,
                Relation::Equal => x == y,
            };
            return if holds { then } else { otherwise };
        }
        self.intern(Node::Select { relation, left, right, then, otherwise })
    }
}

/// The exact value of a function of a constant, where it is rational.
fn unary_of(function: UnaryFunction, value: &Rational) -> Option<Rational> {
    use UnaryFunction::{Abs, Cos, Exp, Log, Sign, Sin, Sqrt, Tan, Tanh};
    match function {
        // sin 0 = tan 0 = tanh 0 = 0
        Sin | Tan | Tanh if value.is_zero() => Some(Rational::zero()),
        // cos 0 = exp 0 = 1
        Cos | Exp if value.is_zero() => Some(Rational::one()),
        // log 1 = 0
        Log if value.is_one() => Some(Rational::zero()),
        // sqrt(k^2) = |k|
        Sqrt if !value.is_negative() => {
            let root = Rational::new(value.numer().sqrt(), value.denom().sqrt());
            (&root * &root == *value).then_some(root)
        }
        // abs k = |k|
        Abs => Some(value.abs()),
        // sign k = -1, 0 or 1
        Sign => Some(value.signum()),
        Sin | Cos | Tan | Sqrt | Exp | Log | Tanh => None,
    }
}

/// A whole number modulo 4.
pub(crate) fn quarter_turns(whole: &Rational) -> u8 {
    let four = integer(4);
    let rest = whole - (whole / &four).floor() * &four;
    rest.to_u8().expect("a whole number modulo 4 is 0, 1, 2 or 3")
}
