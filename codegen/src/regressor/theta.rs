//! theta = B_Eu theta0 by elimination of B (thesis 3.3-3.5): the base parameters of whatever has
//! been decomposed, of a model or of given equations.

use super::column::Column;
use super::rank::{FIRST_POINT, PARAMETERS, insert};
use crate::expr::{
    ClassSet, Dag, EvaluateError, ExprId, Node, Residues, SymbolClass, UnaryFunction, angle_atoms,
    evaluate, substitute,
};
use crate::fundamental::{Decomposition, Echelon, EchelonError, echelon};
use crate::number::{Rational, Residue};
use num_traits::One;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// Seeds of the points at which results are compared with what they came from.
const SEEDS: [u64; 3] = [0x7468_6561, 0x7468_6562, 0x7468_6563];

/// What B_E says of the columns.
#[derive(Clone, Debug)]
pub struct Theta {
    /// B_Eu.
    pub echelon: Echelon,
    /// theta0: the parameter of each column, by name or as a product of unknowns.
    pub columns: Vec<ExprId>,
    /// theta, in the order of the pivots.
    pub parameters: Vec<ExprId>,
}

impl Theta {
    /// Eliminates B in the order in which columns are preferred.
    pub(super) fn new(
        dag: &mut Dag,
        decomposition: &Decomposition,
        order: &[usize],
        columns: Vec<ExprId>,
    ) -> Result<Self, EchelonError> {
        let echelon = echelon(dag, decomposition, order)?;
        let mut parameters = Vec::new();
        for row in &echelon.rows {
            let mut sum = dag.zero();
            for (&column, factor) in row {
                let product = factor.times_expr(dag, columns[column]);
                sum = dag.add(sum, product);
            }
            parameters.push(sum);
        }
        Ok(Self { echelon, columns, parameters })
    }

    /// The rank of B: the number of base parameters.
    pub fn rank(&self) -> usize {
        self.parameters.len()
    }

    /// The columns that are no pivots, in order.
    pub fn dependent(&self) -> impl Iterator<Item = usize> {
        (0..self.columns.len()).filter(|column| !self.echelon.pivots.contains(column))
    }

    /// The columns that a parameter is the sum of, its own first, with their factors.
    pub fn members(&self, dag: &mut Dag, parameter: usize) -> Vec<(usize, ExprId)> {
        let own = self.echelon.pivots[parameter];
        let row = &self.echelon.rows[parameter];
        let others = row.keys().copied().filter(|&column| column != own);
        let members: Vec<usize> = std::iter::once(own).chain(others).collect();
        members.into_iter().map(|column| (column, row[&column].to_expr(dag))).collect()
    }

    /// What a dependent column is the sum of, columns by their parameters.
    pub fn relation(&self, dag: &mut Dag, column: usize) -> ExprId {
        let mut sum = dag.zero();
        for (pivot, factor) in self.echelon.relation(column) {
            let product = factor.times_expr(dag, self.columns[pivot]);
            sum = dag.add(sum, product);
        }
        sum
    }

    /// Whether f^T B_u theta, with the columns of the pivots alone, is `right` at random points
    /// modulo a prime: equation by equation what R0 theta0 was before anything was decomposed.
    pub fn holds(
        &self,
        dag: &mut Dag,
        decomposition: &Decomposition,
        right: &[ExprId],
    ) -> Result<bool, EvaluateError> {
        let f: Vec<ExprId> = decomposition.functions.iter().map(|one| one.to_expr(dag)).collect();
        let b: Vec<ExprId> =
            decomposition.coefficients.iter().map(|one| one.to_expr(dag)).collect();
        let all = [&f, &b, &self.parameters, right].concat();
        let all = with_whole_angles(dag, &all);
        for seed in SEEDS {
            let values = evaluate(dag, &all, &mut Residues::new(seed))?;
            let (f, rest) = values.split_at(f.len());
            let (b, rest) = rest.split_at(b.len());
            let (theta, right) = rest.split_at(self.parameters.len());
            let mut sums = vec![Residue::ZERO; right.len()];
            for (&pivot, &parameter) in self.echelon.pivots.iter().zip(theta) {
                for entry in &decomposition.columns[pivot] {
                    let sum = &mut sums[entry.equation as usize];
                    let factor = b[entry.coefficient as usize] * f[entry.function as usize];
                    *sum = *sum + factor * parameter;
                }
            }
            if sums != right {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The rank of the columns of the pivots at random points modulo a prime: less than
    /// [`Theta::rank`] if functions that count as different obey a relation, as 1/cos^2 and tan^2.
    pub fn rank_at_points(
        &self,
        dag: &mut Dag,
        decomposition: &Decomposition,
    ) -> Result<usize, EvaluateError> {
        let f: Vec<ExprId> = decomposition.functions.iter().map(|one| one.to_expr(dag)).collect();
        let b: Vec<ExprId> =
            decomposition.coefficients.iter().map(|one| one.to_expr(dag)).collect();
        let all = with_whole_angles(dag, &[f.as_slice(), &b].concat());
        let mut found = Vec::new();
        let (mut idle, mut point) = (0, FIRST_POINT);
        while idle < 3 && found.len() < self.rank() {
            let mut ring = Residues::with_parameters(point, PARAMETERS);
            let values = evaluate(dag, &all, &mut ring)?;
            let (f, b) = values.split_at(f.len());
            let mut rows: BTreeMap<u32, Vec<Residue>> = BTreeMap::new();
            for (place, &pivot) in self.echelon.pivots.iter().enumerate() {
                for entry in &decomposition.columns[pivot] {
                    let row = rows.entry(entry.equation);
                    let row = row.or_insert_with(|| vec![Residue::ZERO; self.rank()]);
                    let product = b[entry.coefficient as usize] * f[entry.function as usize];
                    row[place] = row[place] + product;
                }
            }
            let before = found.len();
            for row in rows.into_values() {
                insert(&mut found, row);
            }
            idle = if found.len() > before { 0 } else { idle + 1 };
            point += 1;
        }
        Ok(found.len())
    }
}

/// The same with every symbol replaced by a multiple of itself, so that no angle has a fraction of
/// one: modulo a prime, half an angle is a point of its own. What holds for all values of the
/// symbols holds of their multiples, and the other way round.
fn with_whole_angles(dag: &mut Dag, exprs: &[ExprId]) -> Vec<ExprId> {
    let mut common = Rational::one();
    for expr in dag.topological(exprs) {
        let Node::Unary(UnaryFunction::Sin | UnaryFunction::Cos, angle) = dag.node(expr) else {
            continue;
        };
        for (atom, multiple) in angle_atoms(dag, angle) {
            let is_number = atom.iter().all(|&(factor, _)| dag.as_symbol(factor).is_none());
            if !is_number {
                // lcm(a, b) = a (b / gcd(a, b))
                let left = &common * multiple;
                common *= Rational::from_integer(left.denom().clone());
            }
        }
    }
    if common.is_one() {
        return exprs.to_vec();
    }
    let mut multiples = FxHashMap::default();
    for expr in dag.topological(exprs) {
        let Some(symbol) = dag.as_symbol(expr) else { continue };
        // Variables are divided by constants, a few at most.
        let power = if ClassSet::of(symbol.class).is_run_time() { 4 } else { 1 };
        let factor = dag.constant(common.pow(power));
        multiples.insert(expr, dag.mul(factor, expr));
    }
    substitute(dag, exprs, &multiples)
}

/// The order of `count` columns, those of `keep` before others. The error is what is not found.
pub(super) fn order_of<N: AsRef<str>>(
    keep: &[N],
    count: usize,
    mut find: impl FnMut(&N) -> Option<usize>,
) -> Result<Vec<usize>, String> {
    let mut order: Vec<usize> = Vec::new();
    for wanted in keep {
        let place = find(wanted).ok_or_else(|| wanted.as_ref().to_owned())?;
        if !order.contains(&place) {
            order.push(place);
        }
    }
    let rest: Vec<usize> = (0..count).filter(|place| !order.contains(place)).collect();
    order.extend(rest);
    Ok(order)
}

/// The symbol that stands for a column's parameter in formulas: a product stands for itself.
pub(super) fn column_symbol(dag: &mut Dag, column: &Column) -> ExprId {
    if let Some(id) = dag.find_symbol(&column.name) {
        return dag.symbol_expr(id);
    }
    match column.parameter {
        Some(_) => dag.symbol(&column.name, SymbolClass::Inertia),
        None => column.value,
    }
}
