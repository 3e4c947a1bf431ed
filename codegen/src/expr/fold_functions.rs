//! The laws of functions and selections, under the rules of `fold.rs`.

use super::dag::{BinaryFunction, Dag, ExprId, Node, Relation, UnaryFunction};
use crate::number::{Rational, integer};
use num_traits::{One, Signed, ToPrimitive, Zero};

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
            // sin(a + k pi/2) is +-sin a or +-cos a, and so for cos and tan
            if let Some((rest, turns)) = self.split_quarter_turns(a) {
                return self.shifted(function, rest, turns);
            }
        }
        let negated = match self.node(a) {
            Node::Neg(inner) => Some(inner),
            _ => None,
        };
        match (function, negated) {
            // sin, tan, tanh and sign are odd: f(-a) = -f(a)
            (Sin | Tan | Tanh | Sign, Some(inner)) => {
                let value = self.unary(function, inner);
                self.neg(value)
            }
            // cos and abs are even: f(-a) = f(a)
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

    /// A function of `a + turns pi/2`.
    fn shifted(&mut self, function: UnaryFunction, a: ExprId, turns: u8) -> ExprId {
        use UnaryFunction::{Cos, Sin};
        if function == UnaryFunction::Tan {
            let value = self.unary(function, a);
            if turns.is_multiple_of(2) {
                return value;
            }
            // tan(a + pi/2) = -1/tan a
            let minus_one = self.integer(-1);
            return self.div(minus_one, value);
        }
        // cos a = sin(a + pi/2)
        let turns = (turns + u8::from(function == Cos)) % 4;
        let value = self.unary(if turns.is_multiple_of(2) { Sin } else { Cos }, a);
        if turns < 2 { value } else { self.neg(value) }
    }

    /// `a = rest + k pi/2` with the whole number k taken modulo 4; `None` if k is 0.
    fn split_quarter_turns(&mut self, a: ExprId) -> Option<(ExprId, u8)> {
        let (mut half_pis, mut rest) = (Rational::zero(), Vec::new());
        let mut pending = vec![(a, false)];
        while let Some((expr, minus)) = pending.pop() {
            match self.node(expr) {
                Node::Neg(x) => pending.push((x, !minus)),
                Node::Add(x, y) => pending.extend([(y, minus), (x, minus)]),
                Node::Sub(x, y) => pending.extend([(y, !minus), (x, minus)]),
                _ => match self.half_pis(expr) {
                    Some(count) if minus => half_pis -= count,
                    Some(count) => half_pis += count,
                    None => rest.push((expr, minus)),
                },
            }
        }
        let whole = half_pis.floor();
        if whole.is_zero() {
            return None;
        }
        let turns = num_integer_mod_4(&whole);
        let pi = self.pi();
        let fraction = self.constant((half_pis - whole) / integer(2));
        let mut sum = self.mul(fraction, pi);
        for (expr, minus) in rest {
            sum = if minus { self.sub(sum, expr) } else { self.add(sum, expr) };
        }
        Some((sum, turns))
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
        // min(k, l) and max(k, l) are constants
        if let (Some(x), Some(y)) = (self.as_constant(a), self.as_constant(b)) {
            return if (x < y) == (function == BinaryFunction::Min) { a } else { b };
        }
        self.intern(Node::Binary(function, a.min(b), a.max(b)))
    }

    /// `then` where `left relation right`, `otherwise` elsewhere.
    pub fn select(
        &mut self,
        relation: Relation,
        (left, right): (ExprId, ExprId),
        then: ExprId,
        otherwise: ExprId,
    ) -> ExprId {
        // select(c, a, a) = a
        if then == otherwise {
            return then;
        }
        // select(a < a, x, y) = y; select(a <= a, x, y) = select(a == a, x, y) = x
        if left == right {
            return if relation == Relation::Less { otherwise } else { then };
        }
        // a condition between constants is decided
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
        // sin 0 = tan 0 = tanh 0 = 0, cos 0 = exp 0 = 1
        Sin | Tan | Tanh if value.is_zero() => Some(Rational::zero()),
        Cos | Exp if value.is_zero() => Some(Rational::one()),
        // log 1 = 0
        Log if value.is_one() => Some(Rational::zero()),
        // sqrt(k^2) = |k|
        Sqrt if !value.is_negative() => {
            let root = Rational::new(value.numer().sqrt(), value.denom().sqrt());
            (&root * &root == *value).then_some(root)
        }
        Abs => Some(value.abs()),
        Sign => Some(value.signum()),
        Sin | Cos | Tan | Sqrt | Exp | Log | Tanh => None,
    }
}

fn num_integer_mod_4(whole: &Rational) -> u8 {
    let four = integer(4);
    let rest = whole - (whole / &four).floor() * &four;
    rest.to_u8().expect("a whole number modulo 4 is 0, 1, 2 or 3")
}
