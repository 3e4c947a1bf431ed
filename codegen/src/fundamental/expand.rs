//! Expressions written out as trigonometric polynomials, within a memory limit.

use super::key::Key;
use super::layout::{ExponentTooLarge, Layout, as_wave};
use super::series::{Series, SeriesError};
use super::whole::{Overflow, Whole};
use crate::expr::{Dag, ExprId, Node, UnaryFunction};
use rustc_hash::FxHashMap;
use std::fmt;

/// How much memory an expansion may take, if nothing else is asked for: 2 GiB.
pub const DEFAULT_MEMORY_BYTES: usize = 2 << 30;

/// How far an expansion is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Nodes of the graph that are written out.
    pub done: usize,
    /// Nodes to be written out.
    pub total: usize,
    /// Terms in memory.
    pub terms: usize,
}

/// What an expansion may use, and whom it tells how far it is.
pub struct Expansion<'a> {
    /// Memory for terms, in bytes.
    pub memory_bytes: usize,
    /// Called now and then.
    pub progress: &'a mut dyn FnMut(Progress),
}

impl Expansion<'_> {
    /// How many terms fit the memory.
    pub(super) fn allowed_terms<const N: usize, C>(&self) -> usize {
        // A hash table that grows holds its terms three times for a moment.
        self.memory_bytes / size_of::<(Key<N>, C)>() / 3
    }
}

/// Why an expression was not written out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FourierError {
    /// The terms do not fit the memory allowed.
    Memory {
        /// The limit in bytes.
        limit_bytes: usize,
        /// Nodes that were written out, and nodes in all.
        done: usize,
        /// Nodes in all.
        total: usize,
    },
    /// An angle is more than 4096 times another one, or an exponent as large.
    ExponentTooLarge,
    /// More indeterminates than any key has room for.
    TooManyIndeterminates,
    /// Division by zero.
    DivisionByZero,
}

impl fmt::Display for FourierError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Memory { limit_bytes, done, total } => write!(
                f,
                "written out, the expressions take more than the {} MiB of memory allowed \
                 ({done} of {total} intermediate results were done)\n  hint: leave out the \
                 Coriolis terms, which add no dependency between parameters, or allow more memory",
                limit_bytes >> 20
            ),
            Self::ExponentTooLarge => write!(
                f,
                "an exponent, or the multiple of an angle, is more than 4096: too large to write \
                 out"
            ),
            Self::TooManyIndeterminates => {
                write!(f, "there are too many angles and symbols to write the expressions out")
            }
            Self::DivisionByZero => write!(f, "division by zero"),
        }
    }
}

impl std::error::Error for FourierError {}

impl From<ExponentTooLarge> for FourierError {
    fn from(_: ExponentTooLarge) -> Self {
        Self::ExponentTooLarge
    }
}

/// Why an expansion with given sizes of keys and integers stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stop {
    /// The integers are too small.
    Overflow,
    Error(FourierError),
}

impl Stop {
    /// The terms do not fit the memory.
    pub(super) fn too_large(expansion: &Expansion<'_>, done: usize, total: usize) -> Self {
        Self::Error(FourierError::Memory { limit_bytes: expansion.memory_bytes, done, total })
    }
}

impl From<Overflow> for Stop {
    fn from(_: Overflow) -> Self {
        Self::Overflow
    }
}

/// The series of `outputs`, in order. `nodes` are those of the layout.
pub(super) fn expand<const N: usize, C: Whole>(
    dag: &Dag,
    nodes: &[ExprId],
    outputs: &[ExprId],
    layout: &Layout,
    expansion: &mut Expansion<'_>,
) -> Result<FxHashMap<ExprId, Series<N, C>>, Stop> {
    let mut uses: FxHashMap<ExprId, usize> = FxHashMap::default();
    for &expr in nodes.iter().filter(|&&expr| as_wave(dag, expr).is_none()) {
        dag.node(expr).for_each_operand(|operand| *uses.entry(operand).or_default() += 1);
    }
    outputs.iter().for_each(|&output| *uses.entry(output).or_default() += 1);
    let allowed = expansion.allowed_terms::<N, C>();
    let mut values: FxHashMap<ExprId, Series<N, C>> = FxHashMap::default();
    let mut terms = 0;
    for (done, &expr) in nodes.iter().enumerate() {
        let too_large = Stop::too_large(expansion, done, nodes.len());
        let limit = allowed.saturating_sub(terms);
        let series = node(dag, expr, layout, limit, &values).map_err(|stop| match stop {
            NodeStop::Series(SeriesError::Overflow) => Stop::Overflow,
            NodeStop::Series(SeriesError::TooManyTerms) => too_large,
            NodeStop::DivisionByZero => Stop::Error(FourierError::DivisionByZero),
        })?;
        if as_wave(dag, expr).is_none() {
            // A series is kept only as long as something still needs it.
            dag.node(expr).for_each_operand(|operand| {
                let left = uses.get_mut(&operand).expect("operands were counted");
                *left -= 1;
                if *left == 0 {
                    let gone = values.remove(&operand).expect("operands come first");
                    terms -= gone.terms.len();
                }
            });
        }
        terms += series.terms.len();
        if terms > allowed {
            return Err(too_large);
        }
        values.insert(expr, series);
        if done % 256 == 0 || done + 1 == nodes.len() {
            let progress = Progress { done: done + 1, total: nodes.len(), terms };
            (expansion.progress)(progress);
        }
    }
    Ok(values)
}

enum NodeStop {
    Series(SeriesError),
    DivisionByZero,
}

impl From<SeriesError> for NodeStop {
    fn from(error: SeriesError) -> Self {
        Self::Series(error)
    }
}

impl From<Overflow> for NodeStop {
    fn from(_: Overflow) -> Self {
        Self::Series(SeriesError::Overflow)
    }
}

fn node<const N: usize, C: Whole>(
    dag: &Dag,
    expr: ExprId,
    layout: &Layout,
    limit: usize,
    values: &FxHashMap<ExprId, Series<N, C>>,
) -> Result<Series<N, C>, NodeStop> {
    let product = |a: &Series<N, C>, b: &Series<N, C>| a.times(b, layout.angles_end, limit);
    let factor = || {
        let atom = &layout.factors[layout.factor_of[&expr]];
        Series::key(Layout::unit(atom, 1))
    };
    Ok(match dag.node(expr) {
        Node::Constant(id) => Series::constant(dag.constant_value(id))?,
        Node::Neg(a) => values[&a].clone().negated(),
        Node::Add(a, b) => values[&a].plus(&values[&b], false)?,
        Node::Sub(a, b) => values[&a].plus(&values[&b], true)?,
        Node::Mul(a, b) => product(&values[&a], &values[&b])?,
        Node::Div(a, b) => {
            let divisor = &values[&b];
            if divisor.terms.is_empty() {
                return Err(NodeStop::DivisionByZero);
            }
            match divisor.inverse(layout.angles_end) {
                Some(inverse) => product(&values[&a], &inverse)?,
                None => product(&values[&a], &factor())?,
            }
        }
        Node::Pow(a, n) => {
            let mut power = values[&a].clone();
            for bit in (0..31 - n.leading_zeros()).rev() {
                power = product(&power, &power)?;
                if n >> bit & 1 == 1 {
                    power = product(&power, &values[&a])?;
                }
            }
            power
        }
        Node::Unary(UnaryFunction::Cos, angle) => wave(layout, angle, false),
        Node::Unary(UnaryFunction::Sin, angle) => wave(layout, angle, true),
        _ => factor(),
    })
}

/// The cosine or sine of an angle.
fn wave<const N: usize, C: Whole>(layout: &Layout, angle: ExprId, is_sine: bool) -> Series<N, C> {
    let angle = &layout.angle_of[&angle];
    let key = angle.multiples.iter().fold(Key::ZERO, |key, &(index, multiple)| {
        key.plus(Layout::unit(&layout.angles[index], multiple))
    });
    // Each quarter turn makes cos from sin, and -sin from cos.
    let (mut is_sine, mut is_negated) = (is_sine, false);
    for _ in 0..angle.quarters {
        is_negated ^= !is_sine;
        is_sine = !is_sine;
    }
    let wave = Series::wave(key, is_sine);
    if is_negated { wave.negated() } else { wave }
}
