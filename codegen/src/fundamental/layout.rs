//! Which indeterminates an expansion has, and where their exponents stand in a key.

use super::key::Key;
use super::number_angle::{NumberAngles, beyond_quarter_turns};
use crate::expr::{
    AngleAtom, Dag, ExprId, Node, SymbolId, UnaryFunction, angle_atoms, atom_to_expr, free_symbols,
    is_pi, quarter_turns,
};
use crate::number::Rational;
use num_bigint::BigInt;
use num_traits::{One, ToPrimitive, Zero};
use rustc_hash::{FxHashMap, FxHashSet};

/// An indeterminate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Atom {
    /// The angle, or the factor, that one unit of the exponent stands for.
    pub(super) expr: ExprId,
    /// Whether it stands in the coefficients, not in the functions.
    pub(super) is_known: bool,
    /// First bit of its field.
    pub(super) position: usize,
    /// Bits of its field.
    pub(super) width: usize,
    /// Whether its exponent may be negative.
    is_signed: bool,
}

/// An angle: (index into the angles, multiple) for each atom, and the quarter turns.
#[derive(Clone, Debug)]
pub(super) struct Angle {
    pub(super) multiples: Vec<(usize, i64)>,
    pub(super) quarters: u8,
}

/// The fields of a key, lowest first: one bit that tells sine from cosine, angles (functions, then
/// coefficients), factors (functions, then coefficients). One bit is free above each of the four.
#[derive(Clone, Debug, Default)]
pub(super) struct Layout {
    /// Angles, those of the functions first.
    pub(super) angles: Vec<Atom>,
    /// Symbols and opaque expressions, those of the functions first.
    pub(super) factors: Vec<Atom>,
    /// Where the angles of the functions end and those of the coefficients begin.
    pub(super) function_angles_end: usize,
    /// Where the angles end.
    pub(super) angles_end: usize,
    /// Where the factors of the functions end and those of the coefficients begin.
    pub(super) functions_end: usize,
    /// Where the fields end.
    pub(super) end: usize,
    /// The factor of each expression that is one.
    pub(super) factor_of: FxHashMap<ExprId, usize>,
    /// The argument of each sine and cosine, taken apart.
    pub(super) angle_of: FxHashMap<ExprId, Angle>,
}

/// Tells whether a symbol belongs to the coefficients.
pub(super) type KnownTest<'a> = &'a dyn Fn(SymbolId) -> bool;

/// An angle is too large a multiple of another one, or an exponent is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ExponentTooLarge;

/// Largest multiple and exponent.
const MAX_EXPONENT: u32 = 1 << 12;

/// The nodes that are expanded: those that the outputs reach without going into an angle.
pub(super) fn expanded_nodes(dag: &Dag, outputs: &[ExprId]) -> Vec<ExprId> {
    let mut seen: FxHashSet<ExprId> = outputs.iter().copied().collect();
    let mut pending: Vec<ExprId> = outputs.to_vec();
    let mut nodes = Vec::new();
    while let Some(expr) = pending.pop() {
        nodes.push(expr);
        if as_wave(dag, expr).is_none() {
            dag.node(expr).for_each_operand(|operand| {
                if seen.insert(operand) {
                    pending.push(operand);
                }
            });
        }
    }
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// The argument of a sine or cosine, and whether it is a sine.
pub(super) fn as_wave(dag: &Dag, expr: ExprId) -> Option<(ExprId, bool)> {
    match dag.node(expr) {
        Node::Unary(UnaryFunction::Sin, angle) => Some((angle, true)),
        Node::Unary(UnaryFunction::Cos, angle) => Some((angle, false)),
        _ => None,
    }
}

/// Whether an expression may not be expanded: it is an indeterminate, unless its operands say
/// otherwise.
fn is_factor(dag: &Dag, expr: ExprId) -> bool {
    match dag.node(expr) {
        Node::Symbol(_) | Node::Pi | Node::Binary(..) | Node::Select { .. } => true,
        Node::Unary(..) => as_wave(dag, expr).is_none(),
        Node::Div(_, divisor) => !is_monomial(dag, divisor),
        _ => false,
    }
}

/// Whether an expression is a product of symbols as it stands.
fn is_monomial(dag: &Dag, expr: ExprId) -> bool {
    let mut pending = vec![expr];
    while let Some(expr) = pending.pop() {
        match dag.node(expr) {
            Node::Constant(_) | Node::Pi | Node::Symbol(_) => {}
            Node::Neg(a) | Node::Pow(a, _) => pending.push(a),
            Node::Mul(a, b) | Node::Div(a, b) => pending.extend([a, b]),
            _ => return false,
        }
    }
    true
}

impl Layout {
    /// The layout for all `nodes` (operands first). `chains` are lists of angles that may be
    /// replaced by their cumulated sums.
    pub(super) fn new(
        dag: &mut Dag,
        nodes: &[ExprId],
        is_known: KnownTest,
        chains: &[Vec<ExprId>],
    ) -> Result<Self, ExponentTooLarge> {
        let mut layout = Self::default();
        layout.find_angles(dag, nodes, is_known)?;
        for &expr in nodes {
            if !is_factor(dag, expr) {
                continue;
            }
            let inverse = match dag.node(expr) {
                Node::Div(_, divisor) => {
                    let one = dag.one();
                    dag.div(one, divisor)
                }
                _ => expr,
            };
            let index = layout.factors.iter().position(|atom| atom.expr == inverse);
            layout.factor_of.insert(expr, index.unwrap_or(layout.factors.len()));
            if index.is_none() {
                let is_known = depends_on_known(dag, inverse, is_known);
                layout.factors.push(Atom::new(inverse, is_known));
            }
        }
        layout.sort_known_last();
        layout.place(dag, nodes, chains)?;
        Ok(layout)
    }

    fn find_angles(
        &mut self,
        dag: &mut Dag,
        nodes: &[ExprId],
        is_known: KnownTest,
    ) -> Result<(), ExponentTooLarge> {
        let mut arguments: Vec<ExprId> =
            nodes.iter().filter_map(|&expr| as_wave(dag, expr)).map(|(angle, _)| angle).collect();
        arguments.sort_unstable();
        arguments.dedup();
        let numbers = NumberAngles::among(dag, arguments.iter().copied());
        let mut units = Units::default();
        let mut apart = Vec::new();
        for argument in arguments {
            let mut parts: Vec<(usize, Rational)> = Vec::new();
            let mut quarters = 0;
            for (atom, mut coefficient) in angle_atoms(dag, argument) {
                let is_pi = is_pi(dag, &atom);
                if is_pi {
                    let (whole, rest) = beyond_quarter_turns(&coefficient);
                    quarters = quarter_turns(&Rational::from_integer(whole));
                    coefficient = rest;
                }
                if !coefficient.is_zero() {
                    let is_number = is_pi || atom.is_empty();
                    let unit = is_number.then(|| numbers.unit(&coefficient, is_pi));
                    parts.push((units.index(atom, &coefficient, unit), coefficient));
                }
            }
            apart.push((argument, parts, quarters));
        }
        for (atom, unit) in &units.0 {
            let factor = dag.constant(unit.clone());
            let atom = atom_to_expr(dag, atom);
            let angle = dag.mul(factor, atom);
            self.angles.push(Atom::new(angle, depends_on_known(dag, angle, is_known)));
        }
        for (argument, parts, quarters) in apart {
            let mut multiples = Vec::new();
            for (index, coefficient) in parts {
                let multiple = (coefficient / &units.0[index].1).to_integer();
                multiples.push((index, multiple.to_i64().ok_or(ExponentTooLarge)?));
            }
            self.angle_of.insert(argument, Angle { multiples, quarters });
        }
        Ok(())
    }

    /// What belongs to the functions stands before what belongs to the coefficients.
    fn sort_known_last(&mut self) {
        let order = |atoms: &mut Vec<Atom>| {
            let mut indices: Vec<usize> = (0..atoms.len()).collect();
            indices.sort_by_key(|&index| atoms[index].is_known);
            let mut rank = vec![0; atoms.len()];
            indices.iter().enumerate().for_each(|(new, &old)| rank[old] = new);
            *atoms = indices.iter().map(|&index| atoms[index].clone()).collect();
            rank
        };
        let rank = order(&mut self.angles);
        let multiples = self.angle_of.values_mut().flat_map(|angle| &mut angle.multiples);
        multiples.for_each(|(index, _)| *index = rank[*index]);
        let rank = order(&mut self.factors);
        self.factor_of.values_mut().for_each(|index| *index = rank[*index]);
    }

    /// Gives every atom a field wide enough for all exponents that can come up.
    fn place(
        &mut self,
        dag: &Dag,
        nodes: &[ExprId],
        chains: &[Vec<ExprId>],
    ) -> Result<(), ExponentTooLarge> {
        let bounds = self.exponent_bounds(dag, nodes)?;
        let mut wanted = bounds[..self.angles.len()].to_vec();
        for chain in chains {
            let members: Vec<usize> = chain.iter().filter_map(|&q| self.find_angle(q)).collect();
            // A cumulated angle has the exponent of its own angle minus that of the next one.
            for pair in members.windows(2) {
                wanted[pair[0]] += bounds[pair[1]];
            }
        }
        self.angles.iter_mut().for_each(|atom| atom.is_signed = true);
        let (angle_bounds, factor_bounds) = (&wanted, &bounds[self.angles.len()..]);
        self.function_angles_end = place_part(&mut self.angles, angle_bounds, false, 1);
        self.angles_end =
            place_part(&mut self.angles, angle_bounds, true, self.function_angles_end);
        self.functions_end = place_part(&mut self.factors, factor_bounds, false, self.angles_end);
        self.end = place_part(&mut self.factors, factor_bounds, true, self.functions_end);
        Ok(())
    }

    /// The angle whose unit is `expr`.
    pub(super) fn find_angle(&self, expr: ExprId) -> Option<usize> {
        self.angles.iter().position(|atom| atom.expr == expr)
    }

    /// The largest absolute exponent of each atom in any of the nodes: a sum has the larger one of
    /// its operands, a product at most the sum. Angles come first.
    fn exponent_bounds(
        &mut self,
        dag: &Dag,
        nodes: &[ExprId],
    ) -> Result<Vec<u32>, ExponentTooLarge> {
        let (angles, total) = (self.angles.len(), self.angles.len() + self.factors.len());
        let mut of_node: FxHashMap<ExprId, Vec<u32>> = FxHashMap::default();
        let mut largest = vec![0; total];
        for &expr in nodes {
            let mut bound = vec![0; total];
            let mut join = |with: &[u32], combine: fn(u32, u32) -> u32| {
                bound.iter_mut().zip(with).for_each(|(a, &b)| *a = combine(*a, b));
            };
            let combine_sum = |a: u32, b: u32| a.saturating_add(b);
            match dag.node(expr) {
                Node::Neg(a) => join(&of_node[&a], u32::max),
                Node::Add(a, b) | Node::Sub(a, b) => {
                    join(&of_node[&a], u32::max);
                    join(&of_node[&b], u32::max);
                }
                Node::Mul(a, b) => {
                    join(&of_node[&a], combine_sum);
                    join(&of_node[&b], combine_sum);
                }
                Node::Div(a, b) => {
                    join(&of_node[&a], combine_sum);
                    join(&of_node[&b], combine_sum);
                    for (atom, &used) in self.factors.iter_mut().zip(&of_node[&b][angles..]) {
                        atom.is_signed |= used > 0;
                    }
                }
                Node::Pow(a, n) => {
                    let scaled: Vec<u32> =
                        of_node[&a].iter().map(|&bound| bound.saturating_mul(n)).collect();
                    join(&scaled, u32::max);
                }
                _ => {}
            }
            if let Some((argument, _)) = as_wave(dag, expr) {
                for &(index, multiple) in &self.angle_of[&argument].multiples {
                    bound[index] = u32::try_from(multiple.unsigned_abs()).unwrap_or(u32::MAX);
                }
            }
            if let Some(&factor) = self.factor_of.get(&expr) {
                bound[angles + factor] += 1;
            }
            if bound.iter().any(|&bound| bound > MAX_EXPONENT) {
                return Err(ExponentTooLarge);
            }
            largest.iter_mut().zip(&bound).for_each(|(a, &b)| *a = b.max(*a));
            of_node.insert(expr, bound);
        }
        Ok(largest)
    }

    /// The key of an atom.
    pub(super) fn unit<const N: usize>(atom: &Atom, exponent: i64) -> Key<N> {
        Key::shifted(exponent, atom.position)
    }

    /// The exponents of the fields of `atoms`, which begin at the lowest field of the key.
    pub(super) fn exponents<const N: usize>(
        &self,
        atoms: &[Atom],
        mut key: Key<N>,
    ) -> Vec<(usize, i32)> {
        let mut exponents = Vec::new();
        for (index, atom) in atoms.iter().enumerate() {
            let mut exponent = key.bits(atom.position, atom.width) as i64;
            if atom.is_signed && exponent >> (atom.width - 1) & 1 == 1 {
                exponent -= 1 << atom.width;
            }
            if exponent != 0 {
                key = key.minus(Self::unit(atom, exponent));
                exponents.push((index, exponent as i32));
            }
        }
        exponents
    }
}

/// Angles of which all others are sums of whole multiples: an atom and the fraction of it.
#[derive(Default)]
struct Units(Vec<(AngleAtom, Rational)>);

impl Units {
    /// The unit of which `coefficient` times an atom is a whole multiple: the one given, or 1/n of
    /// the atom, with n common to all its fractions.
    fn index(&mut self, atom: AngleAtom, coefficient: &Rational, given: Option<Rational>) -> usize {
        let is_wanted = |(other, unit): &(AngleAtom, Rational)| {
            *other == atom && given.as_ref().is_none_or(|given| given == unit)
        };
        let one_of = |n: BigInt| Rational::new(BigInt::one(), n);
        match (self.0.iter().position(is_wanted), given) {
            (Some(index), given) => {
                if given.is_none() {
                    // lcm(a, b) = a (b / gcd(a, b))
                    let (a, b) = (self.0[index].1.denom(), coefficient.denom());
                    self.0[index].1 = one_of(a * Rational::new(a.clone(), b.clone()).denom());
                }
                index
            }
            (None, given) => {
                let unit = given.unwrap_or_else(|| one_of(coefficient.denom().clone()));
                self.0.push((atom, unit));
                self.0.len() - 1
            }
        }
    }
}

/// Places the known atoms, or the others, from bit `at` on, and returns where the next part begins.
fn place_part(atoms: &mut [Atom], bounds: &[u32], known: bool, mut at: usize) -> usize {
    for (atom, &bound) in atoms.iter_mut().zip(bounds).filter(|(atom, _)| atom.is_known == known) {
        (atom.position, atom.width) = (at, bits(bound) + usize::from(atom.is_signed));
        at += atom.width;
    }
    at + 1
}

impl Atom {
    fn new(expr: ExprId, is_known: bool) -> Self {
        Self { expr, is_known, position: 0, width: 0, is_signed: false }
    }
}

/// Whether all symbols below an expression are known.
fn depends_on_known(dag: &Dag, expr: ExprId, is_known: KnownTest) -> bool {
    let symbols = free_symbols(dag, &[expr]);
    symbols.into_iter().all(is_known)
}

/// Bits of an unsigned number.
fn bits(value: u32) -> usize {
    (32 - value.leading_zeros()) as usize
}
