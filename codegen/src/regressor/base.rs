//! Base parameters: the combinations of parameters that the torques depend on, theta = B_Eu theta0
//! (thesis 3.5).

use super::coincidence::coincidences;
use super::column::{Regressor, RegressorError, RegressorOptions};
use super::dependence::{Relation, relations};
use super::eliminate::{Reduced, eliminate};
use super::formula::{Part, parts, sum_text};
use super::inexact::{self, InexactEntry};
use super::rank::{PARAMETERS, Ranking, rank};
use super::theta::column_symbol;
use super::turning::table_angles;
use crate::expr::{
    Dag, EvaluateError, ExprId, Node, Residues, UnaryFunction, angle_atoms, evaluate, is_pi, text,
};
use crate::fundamental::{CanonicalError, Fraction};
use crate::model::Robot;
use crate::number::{Rational, Residue, integer};
use num_traits::{One, Signed};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// Why the base parameters of a model are not found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BaseError {
    /// There is no regressor.
    Regressor(RegressorError),
    /// A known parameter or an angle has no exact form.
    Canonical(CanonicalError),
    /// An entry of the model has no exact form.
    Inexact {
        /// The model.
        model: String,
        /// The entry.
        entry: Box<InexactEntry>,
        /// Why it has none.
        error: CanonicalError,
    },
    /// The columns have no value at a random point.
    Evaluate(EvaluateError),
    /// A column to keep that the model does not have.
    NoColumn {
        /// The model.
        model: String,
        /// What was asked for.
        name: String,
    },
    /// An angle of the table has another form for other values of constants.
    Piecewise {
        /// The model.
        model: String,
        /// The angle.
        angle: String,
    },
    /// The relations of the table are not those at random points: an angle of the table is a number
    /// whose sine obeys more than cos^2 + sin^2 = 1, and that matters here.
    Special {
        /// The model.
        model: String,
    },
    /// There are more dependencies than the table explains, and too many functions to write the
    /// columns out; holds how many of each.
    Unexplained {
        /// The model.
        model: String,
        /// Dependencies found modulo p.
        needed: usize,
        /// Dependencies that are proved.
        proved: usize,
    },
}

impl fmt::Display for BaseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Regressor(error) => write!(f, "{error}"),
            Self::Canonical(error) => write!(f, "a known parameter has no exact form: {error}"),
            Self::Inexact { model, entry, error } => write!(
                f,
                "{model}: {entry} has no exact form: {error}\n  hint: declare what it says as a \
                 constant of its own, or take the model's numbers for lengths, angles and gravity"
            ),
            Self::Evaluate(error) => write!(f, "the columns have no value: {error}"),
            Self::NoColumn { model, name } => write!(
                f,
                "{model}: there is no parameter {name} to keep\n  hint: `denavit base {model}` \
                 lists them"
            ),
            Self::Piecewise { model, angle } => write!(
                f,
                "{model}: the angle {angle} has cases with base parameters of their own\n  hint: \
                 declare the angle as a constant, or write the case that holds"
            ),
            Self::Special { model } => write!(
                f,
                "{model}: an angle of the table is a special number for these relations\n  hint: \
                 declare it as a constant, to have the relations of a general angle"
            ),
            Self::Unexplained { model, needed, proved } => write!(
                f,
                "{model}: {needed} columns depend on others, of which {proved} are proved to; the \
                 rest is a coincidence of this geometry or of these terms, and too large to be \
                 written out"
            ),
        }
    }
}

impl std::error::Error for BaseError {}

impl From<CanonicalError> for BaseError {
    fn from(error: CanonicalError) -> Self {
        Self::Canonical(error)
    }
}

impl From<EvaluateError> for BaseError {
    fn from(error: EvaluateError) -> Self {
        Self::Evaluate(error)
    }
}

/// A column that is a combination of columns that stay.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dependent {
    /// The column.
    pub column: usize,
    /// What it is the sum of: columns that stay, with their known factors; none if it is 0.
    pub relation: Vec<(usize, ExprId)>,
    /// That sum, each column written as its parameter.
    pub expression: ExprId,
    /// The same by parts.
    pub parts: Vec<Part>,
}

/// One base parameter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BaseParameter {
    /// The column that stays.
    pub column: usize,
    /// The parameters that it is the sum of, that of its own column first, with known factors.
    pub members: Vec<(usize, ExprId)>,
    /// The sum, with members of the same factor grouped, in the names of the columns.
    pub expression: ExprId,
    /// The same by parts.
    pub parts: Vec<Part>,
    /// The sum in the symbols of the model.
    pub value: ExprId,
}

impl BaseParameter {
    /// Whether it is a parameter alone: that parameter can be identified by itself.
    pub fn is_alone(&self) -> bool {
        self.members.len() == 1
    }
}

/// The base parameters of a model.
#[derive(Clone, Debug)]
pub struct BaseParameters {
    /// R0; its graph also holds the expressions below.
    pub regressor: Regressor,
    /// The order in which columns were preferred, first to keep first.
    pub order: Vec<usize>,
    /// The base parameters, in that order.
    pub parameters: Vec<BaseParameter>,
    /// The columns that depend on others, or are 0, in column order.
    pub dependent: Vec<Dependent>,
    /// Rank, pivots and their rows modulo p.
    pub ranking: Ranking,
    /// Relations that the table alone does not tell.
    pub(super) coincidences: Vec<Relation>,
    symbols: Vec<ExprId>,
}

impl BaseParameters {
    /// The number of base parameters.
    pub fn rank(&self) -> usize {
        self.parameters.len()
    }

    /// The name of a column.
    pub fn name(&self, column: usize) -> &str {
        &self.regressor.columns[column].name
    }

    /// The columns that are 0.
    pub fn zero(&self) -> Vec<usize> {
        let zero = self.dependent.iter().filter(|dependent| dependent.relation.is_empty());
        zero.map(|dependent| dependent.column).collect()
    }

    /// An expression as text.
    pub fn text(&self, expr: ExprId) -> String {
        text::print(&self.regressor.dag, expr).to_string()
    }

    /// A sum of parameters as text.
    pub fn sum_text(&self, parts: &[Part]) -> String {
        sum_text(&self.regressor, parts)
    }

    /// The symbol, or the product, that stands for a column's parameter in the formulas.
    pub fn symbol(&self, column: usize) -> ExprId {
        self.symbols[column]
    }

    /// The parameters that can be identified by themselves: their columns are in no relation.
    pub fn alone(&self) -> Vec<usize> {
        let alone = self.parameters.iter().filter(|parameter| parameter.is_alone());
        alone.map(|parameter| parameter.column).collect()
    }
}

/// The base parameters of `robot`, columns named in `keep` being kept before others.
pub fn base_parameters(
    robot: &Robot,
    options: RegressorOptions,
    keep: &[String],
) -> Result<BaseParameters, BaseError> {
    let regressor =
        Regressor::new(robot, options, robot.torque_side).map_err(BaseError::Regressor)?;
    reduce(regressor, keep).map_err(|error| match error {
        BaseError::Canonical(error) => match inexact::find(robot, error) {
            Some(entry) => {
                BaseError::Inexact { model: robot.name.clone(), entry: Box::new(entry), error }
            }
            None => BaseError::Canonical(error),
        },
        other => other,
    })
}

/// The base parameters of a regressor.
pub fn reduce(mut regressor: Regressor, keep: &[String]) -> Result<BaseParameters, BaseError> {
    let order = order(&regressor, keep)?;
    let mut angles = table_angles(&regressor.mechanism).into_iter();
    if let Some(angle) = angles.find(|&angle| may_be_square(&regressor.dag, angle)) {
        let angle = text::print(&regressor.dag, angle).to_string();
        return Err(BaseError::Piecewise { model: regressor.model, angle });
    }
    let mut dag = regressor.dag.clone();
    let mut relations = relations(&regressor, &mut dag);
    let mut reduced = eliminate(&mut dag, &relations, &order)?;
    let ranking = rank(&regressor, &order)?;
    let mut others = Vec::new();
    if ranking.dependent.len() > reduced.len() {
        let left: Vec<usize> =
            order.iter().copied().filter(|column| !reduced.contains_key(column)).collect();
        others = coincidences(&regressor, &mut dag, &left).unwrap_or_default();
        relations.extend(others.iter().cloned());
        reduced = eliminate(&mut dag, &relations, &order)?;
    }
    regressor.dag = dag;
    if ranking.dependent.len() != reduced.len() {
        return Err(BaseError::Unexplained {
            model: regressor.model.clone(),
            needed: ranking.dependent.len(),
            proved: reduced.len(),
        });
    }
    let dependent = dependents(&mut regressor, &reduced);
    check(&regressor.dag, &regressor.model, &dependent, &ranking)?;
    let parameters = ranking
        .pivots
        .iter()
        .map(|&column| base_parameter(&mut regressor, column, &reduced))
        .collect();
    let Regressor { dag, columns, .. } = &mut regressor;
    let symbols = columns.iter().map(|column| column_symbol(dag, column)).collect();
    let coincidences = others;
    Ok(BaseParameters { regressor, order, parameters, dependent, ranking, coincidences, symbols })
}

/// Whether an angle has cases of which one is a quarter turn: another geometry than the rest.
fn may_be_square(dag: &Dag, angle: ExprId) -> bool {
    let is_square = |case: ExprId| {
        let mut atoms = angle_atoms(dag, case).into_iter();
        atoms.all(|(atom, multiple)| is_pi(dag, &atom) && (&multiple + &multiple).is_integer())
    };
    dag.topological(&[angle]).into_iter().any(|node| match dag.node(node) {
        Node::Select { then, otherwise, .. } => is_square(then) || is_square(otherwise),
        Node::Unary(UnaryFunction::Sign, _) => true,
        _ => false,
    })
}

/// `keep` names columns, or by their prefix (`mx`) those of all links.
fn order(regressor: &Regressor, keep: &[String]) -> Result<Vec<usize>, BaseError> {
    let mut order: Vec<usize> = Vec::new();
    for name in keep {
        let is_of = |column: usize| {
            let owner = regressor.columns[column].owner;
            owner.is_some_and(|(_, prefix)| prefix == name.as_str())
        };
        let found: Vec<usize> = match regressor.find(name) {
            Some(column) => vec![column],
            None => (0..regressor.columns.len()).filter(|&column| is_of(column)).collect(),
        };
        if found.is_empty() {
            return Err(BaseError::NoColumn { model: regressor.model.clone(), name: name.clone() });
        }
        for column in found {
            if !order.contains(&column) {
                order.push(column);
            }
        }
    }
    let first: BTreeSet<usize> = order.iter().copied().collect();
    order.extend((0..regressor.columns.len()).filter(|column| !first.contains(column)));
    Ok(order)
}

fn dependents(regressor: &mut Regressor, reduced: &BTreeMap<usize, Reduced>) -> Vec<Dependent> {
    let mut dependents = Vec::new();
    for (&column, row) in reduced {
        let others = row.iter().filter(|&(&other, _)| other != column);
        let relation: Vec<_> = others
            .map(|(&other, value)| (other, value.negated().to_expr(&mut regressor.dag)))
            .collect();
        let expression = combination(regressor, &relation, &[]);
        let parts = parts(regressor, &relation);
        dependents.push(Dependent { column, relation, expression, parts });
    }
    dependents
}

/// The exact factors against those found modulo p: two computations that share nothing.
fn check(
    dag: &Dag,
    model: &str,
    dependent: &[Dependent],
    ranking: &Ranking,
) -> Result<(), BaseError> {
    let mut ring = Residues::with_parameters(PARAMETERS, PARAMETERS);
    for (column, values) in &ranking.dependent {
        let exact = dependent.iter().find(|exact| exact.column == *column);
        let relation = exact.map_or(&[][..], |exact| &exact.relation);
        let factors: Vec<ExprId> = relation.iter().map(|&(_, factor)| factor).collect();
        let residues = evaluate(dag, &factors, &mut ring)?;
        for (&pivot, &value) in ranking.pivots.iter().zip(values) {
            let place = relation.iter().position(|&(other, _)| other == pivot);
            let ours = place.map_or(Residue::ZERO, |place| residues[place]);
            if ours != value || exact.is_none() {
                return Err(BaseError::Special { model: model.to_owned() });
            }
        }
    }
    Ok(())
}

fn base_parameter(
    regressor: &mut Regressor,
    column: usize,
    reduced: &BTreeMap<usize, Reduced>,
) -> BaseParameter {
    let one = Fraction::number(Rational::one());
    let mut members = vec![(column, one)];
    for (&dependent, row) in reduced {
        if let Some(factor) = row.get(&column) {
            members.push((dependent, factor.negated()));
        }
    }
    let groups = groups(&members);
    let members: Vec<(usize, ExprId)> = members
        .iter()
        .map(|(member, factor)| (*member, factor.to_expr(&mut regressor.dag)))
        .collect();
    let expression = combination(regressor, &members, &groups);
    let dag = &mut regressor.dag;
    let mut value = dag.zero();
    for &(member, factor) in &members {
        let product = dag.mul(factor, regressor.columns[member].value);
        value = dag.add(value, product);
    }
    let parts = parts(regressor, &members);
    BaseParameter { column, members, expression, parts, value }
}

/// Members of the same factor, up to sign: the place of the first of them, and the sign to it.
fn groups(members: &[(usize, Fraction)]) -> Vec<(usize, bool)> {
    let mut groups: Vec<(usize, bool)> = Vec::new();
    for (place, (_, factor)) in members.iter().enumerate() {
        let opposite = factor.negated();
        let leader = (0..place).find_map(|other| {
            let is_leader = groups[other].0 == other;
            let same = members[other].1 == *factor;
            let opposed = members[other].1 == opposite;
            (is_leader && (same || opposed)).then_some((other, opposed))
        });
        groups.push(leader.unwrap_or((place, false)));
    }
    groups
}

/// The sum of the columns' names times their factors; `groups` (if not empty) says which factor
/// stands before which sum.
fn combination(
    regressor: &mut Regressor,
    members: &[(usize, ExprId)],
    groups: &[(usize, bool)],
) -> ExprId {
    let Regressor { dag, columns, .. } = regressor;
    let names: Vec<ExprId> =
        members.iter().map(|&(column, _)| column_symbol(dag, &columns[column])).collect();
    let mut total = dag.zero();
    for (leader, &(_, factor)) in members.iter().enumerate() {
        if groups.get(leader).is_some_and(|&(first, _)| first != leader) {
            continue;
        }
        let mut sum = names[leader];
        for (place, &(first, is_opposite)) in groups.iter().enumerate() {
            if first == leader && place != leader {
                sum = if is_opposite {
                    dag.sub(sum, names[place])
                } else {
                    dag.add(sum, names[place])
                };
            }
        }
        // A minus sign belongs before the product.
        let (factor, is_negative) = match dag.node(factor) {
            Node::Neg(inner) => (inner, true),
            _ => match dag.as_constant(factor).cloned() {
                Some(value) if value.is_negative() => (dag.constant(value * integer(-1)), true),
                _ => (factor, false),
            },
        };
        let product = dag.mul(factor, sum);
        total = if is_negative { dag.sub(total, product) } else { dag.add(total, product) };
    }
    total
}
