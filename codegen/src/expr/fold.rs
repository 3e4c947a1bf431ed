//! The laws of simplification, one arm per law, its equation in the comment before it.
//!
//! What every law here obeys: it is exact (true for all values for which both sides are defined),
//! it terminates (the right side is smaller, or moves a sign outwards, or gathers parameters), and
//! it never adds operations to run-time code, even if the operands are shared with other users
//! (but for powers above the fourth, which are made of squares: `((x^3)^3)^3` has a product less).
//! (Counted are multiplications, additions, divisions and functions; negations are free.) Each law
//! has its cases under its own name in `tests/fixtures/fold`, and `fold_tests.rs` sees to it that
//! none is missing; the laws of functions stand in `fold_functions.rs` under the same rules.

use super::dag::{Dag, ExprId, Node, UnaryFunction};
use num_traits::Signed;

/// Constants are raised to a power only while the result has at most this many bits.
const MAX_POWER_BITS: u64 = 4096;

impl Dag {
    /// The expression of a node whose operands may be anything: applies the laws.
    pub(crate) fn make(&mut self, node: Node) -> ExprId {
        match node {
            Node::Constant(_) | Node::Pi | Node::Symbol(_) => self.intern(node),
            Node::Neg(a) => self.neg(a),
            Node::Add(a, b) => self.add(a, b),
            Node::Sub(a, b) => self.sub(a, b),
            Node::Mul(a, b) => self.mul(a, b),
            Node::Div(a, b) => self.div(a, b),
            Node::Pow(a, n) => self.power(a, n),
            Node::Unary(function, a) => self.unary(function, a),
            Node::Binary(function, a, b) => self.binary(function, a, b),
            Node::Select { relation, left, right, then, otherwise } => {
                self.select(relation, left, right, then, otherwise)
            }
        }
    }

    /// `-a`.
    pub fn neg(&mut self, a: ExprId) -> ExprId {
        match self.node(a) {
            // -(k) = (-k)
            Node::Constant(id) => self.constant(-self.constant_value(id).clone()),
            // -(-a) = a
            Node::Neg(inner) => inner,
            // -(a - b) = b - a
            Node::Sub(x, y) => self.sub(y, x),
            _ => self.intern(Node::Neg(a)),
        }
    }

    /// `a + b`.
    pub fn add(&mut self, a: ExprId, b: ExprId) -> ExprId {
        // 0 + a = a
        if a == self.zero() {
            return b;
        }
        if b == self.zero() {
            return a;
        }
        // k + l = m
        if let (Some(x), Some(y)) = (self.as_constant(a), self.as_constant(b)) {
            return self.constant(x + y);
        }
        // a + (-k) = a - k
        for (x, k) in [(a, b), (b, a)] {
            if let Some(value) = self.as_constant(k).filter(|value| value.is_negative()) {
                let positive = self.constant(-value.clone());
                return self.sub(x, positive);
            }
        }
        match (self.node(a), self.node(b)) {
            // (-a) + (-b) = -(a + b)
            (Node::Neg(x), Node::Neg(y)) => {
                let sum = self.add(x, y);
                self.neg(sum)
            }
            // a + (-b) = a - b
            (_, Node::Neg(y)) => self.sub(a, y),
            (Node::Neg(x), _) => self.sub(b, x),
            // (a - b) + b = a
            (Node::Sub(x, y), _) if y == b => x,
            (_, Node::Sub(x, y)) if y == a => x,
            // (a - b) + (b - c) = a - c
            (Node::Sub(x, y), Node::Sub(u, v)) if y == u => self.sub(x, v),
            (Node::Sub(x, y), Node::Sub(u, v)) if v == x => self.sub(u, y),
            // sin^2 a + cos^2 a = 1
            (Node::Pow(x, 2), Node::Pow(y, 2)) if self.same_angle(x, y) => self.one(),
            _ => self
                .common_parameter_factor(a, b, false)
                .or_else(|| self.gather_terms(a, b, false))
                .unwrap_or_else(|| self.intern(Node::Add(a.min(b), a.max(b)))),
        }
    }

    /// `a - b`.
    pub fn sub(&mut self, a: ExprId, b: ExprId) -> ExprId {
        // a - 0 = a
        if b == self.zero() {
            return a;
        }
        // 0 - a = -a
        if a == self.zero() {
            return self.neg(b);
        }
        // a - a = 0
        if a == b {
            return self.zero();
        }
        // k - l = m
        if let (Some(x), Some(y)) = (self.as_constant(a), self.as_constant(b)) {
            return self.constant(x - y);
        }
        // a - (-k) = a + k
        if let Some(value) = self.as_constant(b).filter(|value| value.is_negative()) {
            let positive = self.constant(-value.clone());
            return self.add(a, positive);
        }
        // (-k) - a = -(k + a)
        if let Some(value) = self.as_constant(a).filter(|value| value.is_negative()) {
            let positive = self.constant(-value.clone());
            let sum = self.add(positive, b);
            return self.neg(sum);
        }
        match (self.node(a), self.node(b)) {
            // a - (-b) = a + b
            (_, Node::Neg(y)) => self.add(a, y),
            // (-a) - b = -(a + b)
            (Node::Neg(x), _) => {
                let sum = self.add(x, b);
                self.neg(sum)
            }
            // (a + b) - a = b
            (Node::Add(x, y), _) if x == b => y,
            (Node::Add(x, y), _) if y == b => x,
            // a - (a + b) = -b
            (_, Node::Add(x, y)) if x == a => self.neg(y),
            (_, Node::Add(x, y)) if y == a => self.neg(x),
            // (a - b) - a = -b
            (Node::Sub(x, y), _) if x == b => self.neg(y),
            // a - (a - b) = b
            (_, Node::Sub(x, y)) if x == a => y,
            _ => self
                .common_summand(a, b)
                .or_else(|| self.common_parameter_factor(a, b, true))
                .or_else(|| self.gather_terms(a, b, true))
                .unwrap_or_else(|| self.ordered_difference(a, b)),
        }
    }

    /// One of two opposite differences is kept, so that both share their operation.
    fn ordered_difference(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if a < b {
            return self.intern(Node::Sub(a, b));
        }
        // a - b = -(b - a)
        let difference = self.intern(Node::Sub(b, a));
        self.intern(Node::Neg(difference))
    }

    /// `a b`.
    pub fn mul(&mut self, a: ExprId, b: ExprId) -> ExprId {
        // 0 a = 0
        if a == self.zero() || b == self.zero() {
            return self.zero();
        }
        // 1 a = a
        if a == self.one() {
            return b;
        }
        if b == self.one() {
            return a;
        }
        // k l = m
        if let (Some(x), Some(y)) = (self.as_constant(a), self.as_constant(b)) {
            return self.constant(x * y);
        }
        // (-k) a = -(k a)
        for (k, x) in [(a, b), (b, a)] {
            if let Some(value) = self.as_constant(k).filter(|value| value.is_negative()) {
                let positive = self.constant(-value.clone());
                let product = self.mul(positive, x);
                return self.neg(product);
            }
        }
        match (self.node(a), self.node(b)) {
            // (-a) (-b) = a b
            (Node::Neg(x), Node::Neg(y)) => self.mul(x, y),
            // (-a) b = -(a b)
            (Node::Neg(x), _) => {
                let product = self.mul(x, b);
                self.neg(product)
            }
            (_, Node::Neg(y)) => {
                let product = self.mul(a, y);
                self.neg(product)
            }
            // a a = a^2
            _ if a == b => self.pow(a, 2),
            // a^m a^n = a^(m+n)
            (Node::Pow(x, n), Node::Pow(y, m)) if x == y => self.pow_sum(x, n, m),
            // a^m a = a^(m+1)
            (Node::Pow(x, n), _) if x == b => self.pow_sum(x, n, 1),
            (_, Node::Pow(y, m)) if y == a => self.pow_sum(y, m, 1),
            _ => self
                .gather_factors(a, b)
                .unwrap_or_else(|| self.intern(Node::Mul(a.min(b), a.max(b)))),
        }
    }

    /// `a / b`. Division by the constant 0 is kept as it stands: evaluation reports it.
    pub fn div(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if b == self.zero() {
            return self.intern(Node::Div(a, b));
        }
        // 0 / b = 0
        if a == self.zero() {
            return a;
        }
        // a / a = 1
        if a == b {
            return self.one();
        }
        // a / k = (1/k) a
        if let Some(value) = self.as_constant(b) {
            let inverse = self.constant(value.recip());
            return self.mul(inverse, a);
        }
        match (self.node(a), self.node(b)) {
            // (-a) / b = -(a / b)
            (Node::Neg(x), _) => {
                let quotient = self.div(x, b);
                self.neg(quotient)
            }
            // a / (-b) = -(a / b)
            (_, Node::Neg(y)) => {
                let quotient = self.div(a, y);
                self.neg(quotient)
            }
            // a / p = a (1/p)
            _ if self.is_run_time(a) && !self.is_run_time(b) => {
                let one = self.one();
                let inverse = self.intern(Node::Div(one, b));
                self.mul(a, inverse)
            }
            _ => self.intern(Node::Div(a, b)),
        }
    }

    /// `a^n` for any integer n; `a^0 = 1` also for a = 0.
    pub fn pow(&mut self, a: ExprId, n: i32) -> ExprId {
        match n {
            // a^0 = 1
            0 => self.one(),
            // a^1 = a
            1 => a,
            // a^(-n) = 1 / a^n
            _ if n < 0 => {
                let power = self.power(a, n.unsigned_abs());
                let one = self.one();
                self.div(one, power)
            }
            _ => self.power(a, n.unsigned_abs()),
        }
    }

    /// `a^n` for n >= 1.
    pub(super) fn power(&mut self, a: ExprId, n: u32) -> ExprId {
        if n == 1 {
            return a;
        }
        match self.node(a) {
            // k^n = m, while that is short
            Node::Constant(id) => {
                let value = self.constant_value(id);
                let bits = value.numer().bits().max(value.denom().bits());
                if bits.saturating_mul(u64::from(n)) > MAX_POWER_BITS {
                    return self.intern(Node::Pow(a, n));
                }
                let value = num_traits::pow(value.clone(), n as usize);
                self.constant(value)
            }
            // (-a)^n = +-(a^n)
            Node::Neg(inner) => {
                let power = self.power(inner, n);
                if n.is_multiple_of(2) { power } else { self.neg(power) }
            }
            // (a^m)^n = a^(m n)
            Node::Pow(base, m) => match m.checked_mul(n) {
                Some(exponent) => self.intern(Node::Pow(base, exponent)),
                None => self.intern(Node::Pow(a, n)),
            },
            _ => self.intern(Node::Pow(a, n)),
        }
    }

    fn pow_sum(&mut self, base: ExprId, n: u32, m: u32) -> ExprId {
        match n.checked_add(m) {
            Some(exponent) => self.power(base, exponent),
            None => {
                let (x, y) = (self.power(base, n), self.power(base, m));
                self.intern(Node::Mul(x.min(y), x.max(y)))
            }
        }
    }

    /// Whether one of two expressions is the sine and the other the cosine of one angle.
    fn same_angle(&self, a: ExprId, b: ExprId) -> bool {
        use UnaryFunction::{Cos, Sin};
        match (self.node(a), self.node(b)) {
            (Node::Unary(Sin, x), Node::Unary(Cos, y))
            | (Node::Unary(Cos, x), Node::Unary(Sin, y)) => x == y,
            _ => false,
        }
    }

    /// Differences of sums that share a summand.
    fn common_summand(&mut self, a: ExprId, b: ExprId) -> Option<ExprId> {
        match (self.node(a), self.node(b)) {
            // (a + b) - (a + c) = b - c
            (Node::Add(x, y), Node::Add(u, v)) => {
                let (rest, other) = if x == u {
                    (y, v)
                } else if x == v {
                    (y, u)
                } else if y == u {
                    (x, v)
                } else if y == v {
                    (x, u)
                } else {
                    return None;
                };
                Some(self.sub(rest, other))
            }
            // (a - b) - (a - c) = c - b
            (Node::Sub(x, y), Node::Sub(u, v)) if x == u => Some(self.sub(v, y)),
            // (a - b) - (c - b) = a - c
            (Node::Sub(x, y), Node::Sub(u, v)) if y == v => Some(self.sub(x, u)),
            // (a + b) - (a - c) = b + c
            (Node::Add(x, y), Node::Sub(u, v)) if x == u => Some(self.add(y, v)),
            (Node::Add(x, y), Node::Sub(u, v)) if y == u => Some(self.add(x, v)),
            // (a - b) - (a + c) = -(b + c)
            (Node::Sub(x, y), Node::Add(u, v)) if x == u || x == v => {
                let sum = self.add(y, if x == u { v } else { u });
                Some(self.neg(sum))
            }
            _ => None,
        }
    }

    /// Where p and q are parameters (or missing, that is 1), so that the sum moves to the prelude.
    /// Between parameters, where p and q are constants.
    fn common_parameter_factor(&mut self, a: ExprId, b: ExprId, minus: bool) -> Option<ExprId> {
        let run_time = self.is_run_time(a) && self.is_run_time(b);
        let one = self.one();
        let split = |dag: &Self, e: ExprId| -> [(ExprId, ExprId); 2] {
            let is_cofactor = |p: ExprId| match run_time {
                true => !dag.is_run_time(p),
                false => dag.as_constant(p).is_some(),
            };
            match dag.node(e) {
                Node::Mul(x, p) if is_cofactor(p) => [(x, p), (e, one)],
                Node::Mul(p, x) if is_cofactor(p) => [(x, p), (e, one)],
                _ => [(e, one), (e, one)],
            }
        };
        let (left, right) = (split(self, a), split(self, b));
        for (x, p) in left {
            for (y, q) in right {
                // a p + a q = a (p + q), a p - a q = a (p - q)
                if x == y {
                    let sum = if minus { self.sub(p, q) } else { self.add(p, q) };
                    return Some(self.mul(x, sum));
                }
            }
        }
        None
    }

    /// Where p and q are parameters, so that their sum moves to the prelude. Between parameters,
    /// where p and q are constants or multiples of pi.
    fn gather_terms(&mut self, a: ExprId, b: ExprId, minus: bool) -> Option<ExprId> {
        let run_time = self.is_run_time(a) || self.is_run_time(b);
        let fixed = |dag: &Self, e: ExprId| match run_time {
            true => !dag.is_run_time(e),
            false => dag.classes(e).is_empty(),
        };
        let (sum, p, sum_first) = match (fixed(self, a), fixed(self, b)) {
            (false, true) => (a, b, true),
            (true, false) => (b, a, false),
            _ => return None,
        };
        // (a + p) + q = a + (p + q), and so with differences
        // The value is `s sum + t p`, with s and t each +1 or -1:
        let (s, t) = (sum_first || !minus, !sum_first || !minus);
        let (x, q, plus_q, plus_x) = match self.node(sum) {
            Node::Add(x, q) if fixed(self, q) && !fixed(self, x) => (x, q, true, true),
            Node::Add(q, x) if fixed(self, q) && !fixed(self, x) => (x, q, true, true),
            Node::Sub(x, q) if fixed(self, q) && !fixed(self, x) => (x, q, false, true),
            Node::Sub(q, x) if fixed(self, q) && !fixed(self, x) => (x, q, true, false),
            _ => return None,
        };
        let q = if s == plus_q { q } else { self.neg(q) };
        let p = if t { p } else { self.neg(p) };
        let parameters = self.add(p, q);
        Some(if s == plus_x { self.add(x, parameters) } else { self.sub(parameters, x) })
    }

    /// Where p and q are parameters, so that their product moves to the prelude. Between
    /// parameters, where p and q are constants.
    fn gather_factors(&mut self, a: ExprId, b: ExprId) -> Option<ExprId> {
        let run_time = self.is_run_time(a) || self.is_run_time(b);
        let fixed = |dag: &Self, e: ExprId| match run_time {
            true => !dag.is_run_time(e),
            false => dag.as_constant(e).is_some(),
        };
        let (product, p) = match (fixed(self, a), fixed(self, b)) {
            (false, true) => (a, b),
            (true, false) => (b, a),
            _ => return None,
        };
        let (x, q) = match self.node(product) {
            Node::Mul(x, q) if fixed(self, q) => (x, q),
            Node::Mul(q, x) if fixed(self, q) => (x, q),
            _ => return None,
        };
        // (a p) q = a (p q)
        let parameters = self.mul(p, q);
        Some(self.mul(x, parameters))
    }
}
