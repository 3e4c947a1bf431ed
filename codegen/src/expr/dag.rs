//! The hash-consed graph: nodes, constants and symbols in tables, each node stored once.

use super::row_table::RowTable;
use super::symbol::{ClassSet, Symbol, SymbolClass};
use crate::arena::{Handle, PrimaryMap};
use crate::number::{Rational, integer};
use num_traits::{One, Zero};
use rustc_hash::FxHashMap;
use std::hash::{Hash, Hasher};

crate::handle!(
    /// An expression of a [`Dag`]. Operands always have smaller handles than their users.
    pub ExprId,
    "e"
);
crate::handle!(
    /// A symbol of a [`Dag`].
    pub SymbolId,
    "s"
);
crate::handle!(
    /// A rational constant of a [`Dag`].
    pub ConstantId,
    "k"
);

/// Functions of one argument that are no ring operations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // the names are the documentation
pub enum UnaryFunction {
    Sin,
    Cos,
    Tan,
    Sqrt,
    Exp,
    Log,
    Tanh,
    Abs,
    Sign,
}

/// Functions of two arguments that are no ring operations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum BinaryFunction {
    /// `atan2(y, x)`.
    Atan2,
    /// The smaller of two.
    Min,
    /// The larger of two.
    Max,
}

/// The condition of a selection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Relation {
    /// `left < right`.
    Less,
    /// `left <= right`.
    LessEqual,
    /// `left == right`.
    Equal,
}

/// One node of the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A rational number.
    Constant(ConstantId),
    /// The number pi.
    Pi,
    /// A symbol.
    Symbol(SymbolId),
    /// `-a`.
    Neg(ExprId),
    /// `a + b`, operands in canonical order.
    Add(ExprId, ExprId),
    /// `a - b`.
    Sub(ExprId, ExprId),
    /// `a b`, operands in canonical order.
    Mul(ExprId, ExprId),
    /// `a / b`.
    Div(ExprId, ExprId),
    /// `a^n` with n >= 2.
    Pow(ExprId, u32),
    /// A function of one argument.
    Unary(UnaryFunction, ExprId),
    /// A function of two arguments.
    Binary(BinaryFunction, ExprId, ExprId),
    /// `then` where `left relation right` holds, `otherwise` elsewhere.
    Select {
        /// The condition's relation.
        relation: Relation,
        /// Left side of the condition.
        left: ExprId,
        /// Right side of the condition.
        right: ExprId,
        /// The value where the condition holds.
        then: ExprId,
        /// The value where it does not.
        otherwise: ExprId,
    },
}

impl Node {
    /// Calls `visit` with each operand, left to right.
    pub fn for_each_operand(&self, mut visit: impl FnMut(ExprId)) {
        match *self {
            Self::Constant(_) | Self::Pi | Self::Symbol(_) => {}
            Self::Neg(a) | Self::Pow(a, _) | Self::Unary(_, a) => visit(a),
            Self::Add(a, b)
            | Self::Sub(a, b)
            | Self::Mul(a, b)
            | Self::Div(a, b)
            | Self::Binary(_, a, b) => {
                visit(a);
                visit(b);
            }
            Self::Select { left, right, then, otherwise, .. } => {
                [left, right, then, otherwise].into_iter().for_each(visit);
            }
        }
    }

    /// The same operation on the images of the operands; not folded.
    pub(super) fn map_operands(self, image: impl Fn(ExprId) -> ExprId) -> Self {
        match self {
            Self::Constant(_) | Self::Pi | Self::Symbol(_) => self,
            Self::Neg(a) => Self::Neg(image(a)),
            Self::Add(a, b) => Self::Add(image(a), image(b)),
            Self::Sub(a, b) => Self::Sub(image(a), image(b)),
            Self::Mul(a, b) => Self::Mul(image(a), image(b)),
            Self::Div(a, b) => Self::Div(image(a), image(b)),
            Self::Pow(a, n) => Self::Pow(image(a), n),
            Self::Unary(function, a) => Self::Unary(function, image(a)),
            Self::Binary(function, a, b) => Self::Binary(function, image(a), image(b)),
            Self::Select { relation, left, right, then, otherwise } => Self::Select {
                relation,
                left: image(left),
                right: image(right),
                then: image(then),
                otherwise: image(otherwise),
            },
        }
    }
}

/// A constant as it is looked up. Fractions are in lowest terms, so two are equal where numerators
/// and denominators are. (`Ratio` itself is hashed by its continued fraction, in cubic time.)
#[derive(Clone, Debug)]
struct ConstantKey(Rational);

impl PartialEq for ConstantKey {
    fn eq(&self, other: &Self) -> bool {
        self.0.numer() == other.0.numer() && self.0.denom() == other.0.denom()
    }
}

impl Eq for ConstantKey {}

impl Hash for ConstantKey {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.numer().hash(state);
        self.0.denom().hash(state);
    }
}

/// The graph. Build with its constructors (`add`, `mul`, ...), which fold and share.
#[derive(Clone, Debug)]
pub struct Dag {
    /// Each node once; operands stand before their users.
    nodes: PrimaryMap<ExprId, Node>,
    /// Kept in step with `nodes`: the classes of the symbols below each node.
    classes: Vec<ClassSet>,
    /// The inverse of `nodes`.
    memo: RowTable,
    constants: PrimaryMap<ConstantId, Rational>,
    constant_memo: FxHashMap<ConstantKey, ConstantId>,
    symbols: PrimaryMap<SymbolId, Symbol>,
    symbol_memo: FxHashMap<String, SymbolId>,
    zero: ExprId,
    one: ExprId,
}

impl Default for Dag {
    fn default() -> Self {
        Self::new()
    }
}

impl Dag {
    /// A graph that holds 0 and 1 alone.
    pub fn new() -> Self {
        let mut dag = Self {
            nodes: PrimaryMap::new(),
            classes: Vec::new(),
            memo: RowTable::new(),
            constants: PrimaryMap::new(),
            constant_memo: FxHashMap::default(),
            symbols: PrimaryMap::new(),
            symbol_memo: FxHashMap::default(),
            zero: ExprId::from_index(0),
            one: ExprId::from_index(1),
        };
        dag.constant(Rational::zero());
        dag.constant(Rational::one());
        dag
    }

    /// The constant 0.
    pub fn zero(&self) -> ExprId {
        self.zero
    }

    /// The constant 1.
    pub fn one(&self) -> ExprId {
        self.one
    }

    /// The number pi.
    pub fn pi(&mut self) -> ExprId {
        self.intern(Node::Pi)
    }

    /// A rational constant.
    pub fn constant(&mut self, value: Rational) -> ExprId {
        let key = ConstantKey(value);
        let id = match self.constant_memo.get(&key) {
            Some(&id) => id,
            None => {
                let id = self.constants.push(key.0.clone());
                self.constant_memo.insert(key, id);
                id
            }
        };
        self.intern(Node::Constant(id))
    }

    /// An integer constant.
    pub fn integer(&mut self, value: i64) -> ExprId {
        self.constant(integer(value))
    }

    /// The symbol `name`, made if there is none. A name has one class for ever: asking again with
    /// another class is a broken invariant of the caller.
    pub fn symbol(&mut self, name: &str, class: SymbolClass) -> ExprId {
        let id = match self.symbol_memo.get(name) {
            Some(&id) => id,
            None => {
                let symbol = Symbol { name: name.to_owned(), class };
                let id = self.symbols.push(symbol);
                self.symbol_memo.insert(name.to_owned(), id);
                id
            }
        };
        let known = self.symbols[id].class;
        assert!(known == class, "symbol {name} is {known:?}, asked for as {class:?}");
        self.intern(Node::Symbol(id))
    }

    /// The symbol called `name`, if there is one.
    pub fn find_symbol(&self, name: &str) -> Option<SymbolId> {
        self.symbol_memo.get(name).copied()
    }

    /// The expression of a symbol.
    pub fn symbol_expr(&mut self, id: SymbolId) -> ExprId {
        self.intern(Node::Symbol(id))
    }

    /// The symbols, in the order of their making.
    pub fn symbols(&self) -> &PrimaryMap<SymbolId, Symbol> {
        &self.symbols
    }

    /// The node of an expression.
    pub fn node(&self, expr: ExprId) -> Node {
        self.nodes[expr]
    }

    /// Number of nodes ever made.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is no node: never, for 0 and 1 are always there.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The value of a constant of the table.
    pub fn constant_value(&self, id: ConstantId) -> &Rational {
        &self.constants[id]
    }

    /// The rational value of an expression that is a constant.
    pub fn as_constant(&self, expr: ExprId) -> Option<&Rational> {
        match self.nodes[expr] {
            Node::Constant(id) => Some(&self.constants[id]),
            _ => None,
        }
    }

    /// The symbol that an expression is.
    pub fn as_symbol(&self, expr: ExprId) -> Option<&Symbol> {
        match self.nodes[expr] {
            Node::Symbol(id) => Some(&self.symbols[id]),
            _ => None,
        }
    }

    /// The classes of the symbols below an expression.
    pub fn classes(&self, expr: ExprId) -> ClassSet {
        self.classes[expr.index()]
    }

    /// Whether the expression can change from sample to sample.
    pub fn is_run_time(&self, expr: ExprId) -> bool {
        self.classes(expr).is_run_time()
    }

    /// The nodes that the outputs reach, operands before users. The time grows with these, not with
    /// the graph.
    pub fn topological(&self, outputs: &[ExprId]) -> Vec<ExprId> {
        let mut marked = vec![false; self.nodes.len()];
        let mut reached = Vec::new();
        let mut visit = |expr: ExprId, pending: &mut Vec<ExprId>| {
            if !std::mem::replace(&mut marked[expr.index()], true) {
                pending.push(expr);
            }
        };
        let mut pending = Vec::new();
        outputs.iter().for_each(|&output| visit(output, &mut pending));
        while let Some(expr) = pending.pop() {
            reached.push(expr);
            self.nodes[expr].for_each_operand(|operand| visit(operand, &mut pending));
        }
        reached.sort_unstable();
        reached
    }

    /// Stores a node as it is, or finds it. Only the constructors of `fold.rs` call this: a node
    /// that a law would change must not be stored.
    pub(super) fn intern(&mut self, node: Node) -> ExprId {
        let is_same = |row: usize| self.nodes[ExprId::from_index(row)] == node;
        let vacancy = match self.memo.find(&node, is_same) {
            Ok(row) => return ExprId::from_index(row),
            Err(vacancy) => vacancy,
        };
        let mut classes = match node {
            Node::Symbol(id) => ClassSet::of(self.symbols[id].class),
            _ => ClassSet::EMPTY,
        };
        node.for_each_operand(|operand| classes = classes.union(self.classes[operand.index()]));
        let expr = self.nodes.push(node);
        self.classes.push(classes);
        self.memo.insert(vacancy, expr.index());
        expr
    }
}
