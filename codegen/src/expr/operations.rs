//! Counting the operations that an expression costs.

use super::dag::{BinaryFunction, Dag, ExprId, Node, UnaryFunction};
use rustc_hash::FxHashSet;

/// How many operations expressions cost, shared ones once. Only what can change from sample to
/// sample counts; what depends on parameters alone counts as `prelude`, whatever it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Multiplications.
    pub mul: usize,
    /// Additions and subtractions.
    pub add: usize,
    /// Negations.
    pub neg: usize,
    /// Divisions.
    pub div: usize,
    /// Square roots.
    pub sqrt: usize,
    /// Evaluations of sine and cosine of one angle.
    pub sincos: usize,
    /// Selections, minima, maxima, absolute values, signs.
    pub select: usize,
    /// Other functions: tan, exp, log, tanh, atan2.
    pub function: usize,
    /// Operations on parameters alone.
    pub prelude: usize,
}

impl Operations {
    /// The operations of `outputs`.
    pub fn count(dag: &Dag, outputs: &[ExprId]) -> Self {
        let mut total = Self::default();
        let mut angles = FxHashSet::default();
        let mut powers = FxHashSet::default();
        for expr in dag.topological(outputs) {
            let node = dag.node(expr);
            if matches!(node, Node::Constant(_) | Node::Pi | Node::Symbol(_)) {
                continue;
            }
            if !dag.is_run_time(expr) {
                total.prelude += 1;
                continue;
            }
            match node {
                Node::Add(..) | Node::Sub(..) => total.add += 1,
                Node::Mul(..) => total.mul += 1,
                Node::Neg(_) => total.neg += 1,
                Node::Div(..) => total.div += 1,
                Node::Pow(base, n) => total.mul += power_steps(base, n, &mut powers),
                Node::Unary(UnaryFunction::Sin | UnaryFunction::Cos, angle) => {
                    total.sincos += usize::from(angles.insert(angle));
                }
                Node::Unary(UnaryFunction::Sqrt, _) => total.sqrt += 1,
                Node::Unary(UnaryFunction::Abs | UnaryFunction::Sign, _)
                | Node::Binary(BinaryFunction::Min | BinaryFunction::Max, ..)
                | Node::Select { .. } => total.select += 1,
                Node::Unary(..) | Node::Binary(BinaryFunction::Atan2, ..) => total.function += 1,
                Node::Constant(_) | Node::Pi | Node::Symbol(_) => {}
            }
        }
        total
    }

    /// Operations of a call, of any kind; those of the prelude are not among them.
    pub const fn total(&self) -> usize {
        let arithmetic = self.mul + self.add + self.neg + self.div;
        arithmetic + self.sqrt + self.sincos + self.select + self.function
    }

    /// What formulations are compared by, in sixteenths of an operation: multiplications,
    /// additions and divisions count one each; sine with cosine as much as 16 (it takes about 20
    /// of them); changes of sign, which mostly vanish, break ties.
    pub const fn price(&self) -> usize {
        let arithmetic = self.mul + self.add + self.div + self.sqrt + self.select + self.function;
        16 * (arithmetic + 16 * self.sincos) + self.neg
    }
}

/// New multiplications for `base^n` by squaring, where `seen` holds the powers there already.
fn power_steps(base: ExprId, n: u32, seen: &mut FxHashSet<(ExprId, u32)>) -> usize {
    let (mut steps, mut rest) = (0, n);
    while rest > 1 && seen.insert((base, rest)) {
        steps += 1;
        rest = if rest % 2 == 0 { rest / 2 } else { rest - 1 };
    }
    steps
}
