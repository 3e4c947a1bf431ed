//! One order for expressions that does not depend on the order of their making.
//!
//! Handles are in the order in which an algorithm happened to build; what people read is sorted by
//! structure instead: simple before complex, symbols by class and name, `q2` before `q10`.

use super::dag::{BinaryFunction, Dag, ExprId, Node, Relation, UnaryFunction};
use super::symbol::SymbolClass;
use crate::arena::SecondaryMap;
use crate::number::Rational;
use std::cmp::Ordering;

/// The ranks of all expressions below some outputs.
///
/// Nodes are ranked by height, then among those of one height by kind and the ranks of their
/// operands, which are known by then: exact, without recursion, in O(n log n) for n nodes. Two
/// graphs that hold the same expressions sort them alike.
#[derive(Clone, Debug)]
pub struct Order {
    rank: SecondaryMap<ExprId, u32>,
}

/// What tells two nodes of one height apart, the ranks of operands of sums and products sorted.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Shape {
    Atom,
    Pow([u32; 1], u32),
    Neg([u32; 1]),
    Mul([u32; 2]),
    Div([u32; 2]),
    Add([u32; 2]),
    Sub([u32; 2]),
    Unary(UnaryFunction, [u32; 1]),
    Binary(BinaryFunction, [u32; 2]),
    Select(Relation, [u32; 4]),
}

impl Order {
    /// Ranks what the outputs reach.
    pub fn of(dag: &Dag, outputs: &[ExprId]) -> Self {
        let mut height = SecondaryMap::<ExprId, u32>::filled(0, dag.len());
        let mut exprs = dag.topological(outputs);
        for &expr in &exprs {
            let mut tallest = None;
            dag.node(expr).for_each_operand(|operand| tallest = tallest.max(Some(height[operand])));
            height.set(expr, tallest.map_or(0, |below| below + 1));
        }
        exprs.sort_by_key(|&expr| (height[expr], expr));
        let mut order = Self { rank: SecondaryMap::filled(0, dag.len()) };
        let mut next = 0;
        for level in exprs.chunk_by(|&a, &b| height[a] == height[b]) {
            let mut level: Vec<(Shape, ExprId)> =
                level.iter().map(|&expr| (order.shape(dag, expr), expr)).collect();
            level.sort_by(|(shape, a), (other, b)| {
                shape.cmp(other).then_with(|| compare_atoms(dag, *a, *b))
            });
            for (_, expr) in level {
                order.rank.set(expr, next);
                next += 1;
            }
        }
        order
    }

    /// The rank of an expression that the outputs reach.
    pub fn rank(&self, expr: ExprId) -> u32 {
        self.rank[expr]
    }

    /// Compares two expressions that the outputs reach.
    pub fn compare(&self, a: ExprId, b: ExprId) -> Ordering {
        self.rank[a].cmp(&self.rank[b])
    }

    fn shape(&self, dag: &Dag, expr: ExprId) -> Shape {
        let rank = |operand: ExprId| self.rank[operand];
        let sorted = |a: ExprId, b: ExprId| [rank(a).min(rank(b)), rank(a).max(rank(b))];
        match dag.node(expr) {
            Node::Constant(_) | Node::Pi | Node::Symbol(_) => Shape::Atom,
            Node::Neg(a) => Shape::Neg([rank(a)]),
            Node::Add(a, b) => Shape::Add(sorted(a, b)),
            Node::Sub(a, b) => Shape::Sub([rank(a), rank(b)]),
            Node::Mul(a, b) => Shape::Mul(sorted(a, b)),
            Node::Div(a, b) => Shape::Div([rank(a), rank(b)]),
            Node::Pow(a, n) => Shape::Pow([rank(a)], n),
            Node::Unary(function, a) => Shape::Unary(function, [rank(a)]),
            Node::Binary(BinaryFunction::Atan2, a, b) => {
                Shape::Binary(BinaryFunction::Atan2, [rank(a), rank(b)])
            }
            Node::Binary(function, a, b) => Shape::Binary(function, sorted(a, b)),
            Node::Select { relation, left, right, then, otherwise } => {
                Shape::Select(relation, [left, right, then, otherwise].map(rank))
            }
        }
    }
}

/// Numbers, then pi, then symbols; anything else is equal here.
fn compare_atoms(dag: &Dag, a: ExprId, b: ExprId) -> Ordering {
    #[derive(PartialEq, Eq, PartialOrd, Ord)]
    enum Atom<'a> {
        Number(&'a Rational),
        Pi,
        Symbol(u8, SymbolName<'a>),
        Other,
    }
    let atom = |expr| match dag.node(expr) {
        Node::Constant(id) => Atom::Number(dag.constant_value(id)),
        Node::Pi => Atom::Pi,
        Node::Symbol(id) => {
            let symbol = &dag.symbols()[id];
            Atom::Symbol(class_rank(symbol.class), SymbolName(&symbol.name))
        }
        _ => Atom::Other,
    };
    atom(a).cmp(&atom(b))
}

/// Parameters before variables, as in `m1*l1*qdd1`.
fn class_rank(class: SymbolClass) -> u8 {
    match class {
        SymbolClass::Inertia => 0,
        SymbolClass::Drive => 1,
        SymbolClass::Geometry => 2,
        SymbolClass::Time | SymbolClass::State => 3,
        SymbolClass::Configuration => 4,
        SymbolClass::Rate => 5,
        SymbolClass::Acceleration => 6,
        SymbolClass::Effort => 7,
    }
}

/// A name, compared as people sort: runs of digits by their value.
#[derive(PartialEq, Eq)]
struct SymbolName<'a>(&'a str);

impl Ord for SymbolName<'_> {
    fn cmp(&self, other: &Self) -> Ordering {
        let (mut a, mut b) = (self.0.as_bytes(), other.0.as_bytes());
        while let (Some(&x), Some(&y)) = (a.first(), b.first()) {
            if x.is_ascii_digit() && y.is_ascii_digit() {
                let (left, right) = (split_digits(&mut a), split_digits(&mut b));
                let by_value = left.len().cmp(&right.len()).then(left.cmp(right));
                if by_value != Ordering::Equal {
                    return by_value;
                }
            } else if x != y {
                return x.cmp(&y);
            } else {
                (a, b) = (&a[1..], &b[1..]);
            }
        }
        // `q1` and `q01` are equal so far: the text decides.
        a.len().cmp(&b.len()).then(self.0.cmp(other.0))
    }
}

impl PartialOrd for SymbolName<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Takes the digits that `text` starts with, without leading zeros.
fn split_digits<'a>(text: &mut &'a [u8]) -> &'a [u8] {
    let end = text.iter().position(|byte| !byte.is_ascii_digit()).unwrap_or(text.len());
    let (digits, rest) = text.split_at(end);
    *text = rest;
    let zeros = digits.iter().position(|&digit| digit != b'0').unwrap_or(digits.len());
    &digits[zeros..]
}
