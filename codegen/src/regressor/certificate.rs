//! A proof of rank and relations that anybody can check (`denavit-certificate/1`), and the check.
//!
//! - rank >= r: r rows of the columns that stay, at written points modulo p, have a determinant
//!   that is not 0;
//! - rank <= r: each other column's relation vanishes, exactly. The relation is read as matter, one
//!   amount a body, and settled: from the tips to the base each body hands on what its carrier
//!   feels alike, and what is left must be what the body does not feel. No elimination is done.
//!   Of robots of up to six joints the relations are multiplied out too, and are 0 in every torque;
//!   so is, of any robot, a relation that does not settle: one of special terms or lengths.

use super::base::BaseParameters;
use super::coincidence::{self, written_out};
use super::column::{Regressor, RegressorError, RegressorOptions, Unknowns};
use super::rank::{PARAMETERS, rows_at};
use super::settle::{settle, without_denominators};
use super::turning::table_angles;
use crate::expr::{ClassSet, Dag, ExprId, Node, angle_atoms, is_pi, text};
use crate::fundamental::{Entry, canonical_generic};
use crate::model::{BakeError, Robot, Terms, bake_geometry};
use crate::number::Residue;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt;

/// The tag of a certificate file.
pub const FORMAT: &str = "denavit-certificate/1";

/// The JSON Schema of a certificate file.
pub fn schema() -> &'static str {
    include_str!("certificate-schema.json")
}

/// In [`Certificate::with`]: the geometry is numbers.
const NUMERIC: &str = "numeric";

/// Relations of robots of at most so many joints are multiplied out as well, torque by torque, but
/// where an angle is a number: what is true of that number alone would not be seen.
const MULTIPLIED_OUT_JOINTS: usize = 6;

/// Memory for it: three times what PUMA 560 takes.
const MULTIPLIED_OUT_BYTES: usize = 48 << 20;

/// A certificate, as it stands in its file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    /// [`FORMAT`].
    pub format: String,
    /// The model's name.
    pub model: String,
    /// The hash of the model's content, in hexadecimal.
    pub model_hash: String,
    /// The terms: inertia, coriolis, gravity.
    pub terms: Vec<String>,
    /// What was added: friction, rotor, offset; `products` if bodies are taken by products;
    /// `numeric` if lengths, angles and gravity are the model's numbers.
    pub with: Vec<String>,
    /// The prime.
    pub prime: u64,
    /// The seed of the known parameters' values modulo the prime.
    pub parameters: u64,
    /// Known angles that are numbers, beyond quarter turns, or functions of parameters. Cosine and
    /// sine of each are taken for variables: rank and relations are those of almost every such
    /// angle.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub generic_angles: Vec<String>,
    /// The names of all columns, in order.
    pub columns: Vec<String>,
    /// The columns that stay, each with a row (point, joint) of the determinant.
    pub pivots: Vec<Pivot>,
    /// The relations.
    pub relations: Vec<NullVector>,
}

/// A column that stays.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pivot {
    /// The column's name.
    pub column: String,
    /// The seed of the point.
    pub point: u64,
    /// The row of R0 at that point, from 0.
    pub joint: usize,
}

/// A relation: column = sum of factor * column that stays.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NullVector {
    /// The column that depends.
    pub column: String,
    /// Factors, as expressions in the constants of the model, with the columns that stay.
    pub sum: Vec<(String, String)>,
}

/// What the check of a certificate found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Everything holds.
    Verified {
        /// The number of base parameters.
        rank: usize,
        /// Whether the relations were also multiplied out in every torque, which is done for
        /// robots of up to six joints that take little memory, without angles that are numbers
        /// or sines in a denominator.
        multiplied_out: bool,
    },
    /// It is no certificate of this format.
    Format(String),
    /// A word of `terms` or `with` is not known, or not in its place.
    Words,
    /// It belongs to another model, or to another content of the model.
    OtherModel(String),
    /// The model has other columns.
    OtherColumns,
    /// The model has other angles whose sines are taken for variables.
    OtherAngles,
    /// Pivots and relations do not add up: this column is in both, in none, or twice.
    NotAPartition(String),
    /// The determinant is 0, or a row is named twice.
    RankTooLow,
    /// This column's relation does not hold, or could not be followed.
    Relation(String),
    /// The model has no regressor.
    Regressor(RegressorError),
    /// The model lacks the numbers that the certificate is about.
    Bake(BakeError),
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Verified { rank, multiplied_out } => {
                let by = if *multiplied_out { "by joint and in every torque" } else { "by joint" };
                write!(f, "verified: {rank} base parameters (each relation {by})")
            }
            Self::Format(tag) => write!(f, "`{tag}` is not {FORMAT} with its prime"),
            Self::Words => write!(f, "`terms` or `with` has a word that is unknown or misplaced"),
            Self::OtherModel(name) => {
                write!(f, "the certificate is of `{name}` with another content")
            }
            Self::OtherColumns => write!(f, "the model has other columns"),
            Self::OtherAngles => write!(f, "the model has other angles that are numbers"),
            Self::NotAPartition(column) => {
                write!(f, "{column} is not either one that stays or one that depends")
            }
            Self::RankTooLow => write!(f, "the columns that stay are not shown independent"),
            Self::Relation(column) => write!(f, "the relation of {column} does not hold"),
            Self::Regressor(error) => write!(f, "{error}"),
            Self::Bake(error) => write!(f, "{error}"),
        }
    }
}

impl Verdict {
    /// Whether everything holds.
    pub fn is_verified(&self) -> bool {
        matches!(self, Self::Verified { .. })
    }
}

/// The constant parts of angles of the table that are numbers, beyond quarter turns, as text.
fn generic_angles(regressor: &Regressor) -> Vec<String> {
    let dag = &regressor.dag;
    let is_generic = |angle: &ExprId| {
        angle_atoms(dag, *angle).iter().any(|(atom, multiple)| match is_pi(dag, atom) {
            true => !(multiple + multiple).is_integer(),
            false => atom.iter().all(|&(expr, _)| !matches!(dag.node(expr), Node::Symbol(_))),
        })
    };
    let angles = table_angles(&regressor.mechanism).into_iter();
    angles.filter(is_generic).map(|angle| text::print(dag, angle).to_string()).collect()
}

fn hash_text(robot: &Robot) -> String {
    format!("{:016x}", robot.hash)
}

fn term_names(terms: Terms) -> Vec<String> {
    let list =
        [(terms.inertia, "inertia"), (terms.coriolis, "coriolis"), (terms.gravity, "gravity")];
    list.iter().filter(|(has, _)| *has).map(|(_, name)| (*name).to_owned()).collect()
}

/// What [`Certificate::with`] has.
fn added_words(options: RegressorOptions, numeric: bool) -> Vec<String> {
    let words = [
        (options.friction, "friction"),
        (options.rotor, "rotor"),
        (options.offset, "offset"),
        (options.only_modelled, "only_modelled"),
        (options.unknowns == Unknowns::Products, "products"),
        (numeric, NUMERIC),
    ];
    words.iter().filter(|(on, _)| *on).map(|(_, word)| (*word).to_owned()).collect()
}

impl Certificate {
    /// The certificate of base parameters found with `options` for `robot`, in whose geometry
    /// numbers took the place of symbols if it is `numeric` ([`bake_geometry`]).
    pub fn new(
        robot: &Robot,
        options: RegressorOptions,
        base: &BaseParameters,
        numeric: bool,
    ) -> Self {
        let name = |column: usize| base.name(column).to_owned();
        let pivots = base
            .ranking
            .pivots
            .iter()
            .zip(&base.ranking.rows)
            .map(|(&column, &(point, joint))| Pivot { column: name(column), point, joint });
        let relations = base.dependent.iter().map(|dependent| NullVector {
            column: name(dependent.column),
            sum: dependent
                .relation
                .iter()
                .map(|&(column, factor)| (base.text(factor), name(column)))
                .collect(),
        });
        Self {
            format: FORMAT.to_owned(),
            model: robot.name.clone(),
            model_hash: hash_text(robot),
            terms: term_names(robot.terms),
            with: added_words(options, numeric),
            prime: Residue::MODULUS,
            parameters: PARAMETERS,
            generic_angles: generic_angles(&base.regressor),
            columns: base.regressor.columns.iter().map(|column| column.name.clone()).collect(),
            pivots: pivots.collect(),
            relations: relations.collect(),
        }
    }

    /// The text of a certificate file.
    pub fn to_text(&self) -> String {
        let text =
            serde_json::to_string_pretty(self).expect("a certificate is strings and numbers");
        text + "\n"
    }

    /// Checks the certificate against `robot`, by means that share nothing with its making but the
    /// regressor itself.
    pub fn verify(&self, robot: &Robot) -> Verdict {
        if self.format != FORMAT || self.prime != Residue::MODULUS {
            return Verdict::Format(self.format.clone());
        }
        if self.model != robot.name || self.model_hash != hash_text(robot) {
            return Verdict::OtherModel(self.model.clone());
        }
        let has = |list: &[String], name: &str| list.iter().any(|item| item == name);
        let options = RegressorOptions {
            friction: has(&self.with, "friction"),
            rotor: has(&self.with, "rotor"),
            offset: has(&self.with, "offset"),
            only_modelled: has(&self.with, "only_modelled"),
            unknowns: if has(&self.with, "products") {
                Unknowns::Products
            } else {
                Unknowns::Parameters
            },
        };
        let is_numeric = has(&self.with, NUMERIC);
        let mut robot = match is_numeric {
            false => robot.clone(),
            true => match bake_geometry(robot) {
                Ok(robot) => robot,
                Err(error) => return Verdict::Bake(error),
            },
        };
        robot.terms.inertia = has(&self.terms, "inertia");
        robot.terms.coriolis = has(&self.terms, "coriolis");
        robot.terms.gravity = has(&self.terms, "gravity");
        if self.terms != term_names(robot.terms) || self.with != added_words(options, is_numeric) {
            return Verdict::Words;
        }
        let regressor = match Regressor::new(&robot, options, robot.torque_side) {
            Ok(regressor) => regressor,
            Err(error) => return Verdict::Regressor(error),
        };
        let names = regressor.columns.iter().map(|column| &column.name);
        if !names.eq(self.columns.iter()) {
            return Verdict::OtherColumns;
        }
        if self.generic_angles != generic_angles(&regressor) {
            return Verdict::OtherAngles;
        }
        if let Some(column) = self.not_a_partition() {
            return Verdict::NotAPartition(column);
        }
        if !self.is_independent(&regressor) {
            return Verdict::RankTooLow;
        }
        self.verify_relations(&regressor)
    }

    /// The check of the relations, after which nothing is left to check.
    fn verify_relations(&self, regressor: &Regressor) -> Verdict {
        let mut dag = regressor.dag.clone();
        let joints = regressor.joints.len();
        let mut is_small = joints <= MULTIPLIED_OUT_JOINTS && self.generic_angles.is_empty();
        let mut settled = WrittenOut::new(joints);
        let mut unsettled = WrittenOut::new(joints);
        for relation in &self.relations {
            let refuted = || Verdict::Relation(relation.column.clone());
            let Some(amounts) = amounts(regressor, &mut dag, relation) else { return refuted() };
            let list = match settle(regressor, &mut dag, &amounts) {
                true if !is_small => continue,
                true => &mut settled,
                // a relation of no tree, but perhaps of these terms, or of this geometry
                false => &mut unsettled,
            };
            let Some(amounts) = without_denominators(&mut dag, &amounts) else { return refuted() };
            is_small &= !amounts.iter().any(|&(_, amount)| divides_by_waves(&dag, amount));
            list.push(relation, sums(regressor, &mut dag, &amounts));
        }
        match unsettled.first_not_zero(&mut dag, coincidence::MEMORY_BYTES) {
            Some(None) => {}
            Some(Some(refuted)) => return Verdict::Relation(refuted.to_owned()),
            None => return Verdict::Relation(unsettled.names[0].clone()),
        }
        let first =
            if is_small { settled.first_not_zero(&mut dag, MULTIPLIED_OUT_BYTES) } else { None };
        match first {
            Some(Some(refuted)) => Verdict::Relation(refuted.to_owned()),
            found => Verdict::Verified { rank: self.pivots.len(), multiplied_out: found.is_some() },
        }
    }

    fn not_a_partition(&self) -> Option<String> {
        let mut seen = BTreeSet::new();
        let stay: BTreeSet<&String> = self.pivots.iter().map(|pivot| &pivot.column).collect();
        let pivots = self.pivots.iter().map(|pivot| &pivot.column);
        for column in pivots.chain(self.relations.iter().map(|relation| &relation.column)) {
            if !self.columns.contains(column) || !seen.insert(column) {
                return Some(column.clone());
            }
        }
        for (_, column) in self.relations.iter().flat_map(|relation| &relation.sum) {
            if !stay.contains(column) {
                return Some(column.clone());
            }
        }
        self.columns.iter().find(|column| !seen.contains(column)).cloned()
    }

    /// Whether the square matrix of the named rows and the columns that stay has a determinant
    /// other than 0 modulo p.
    fn is_independent(&self, regressor: &Regressor) -> bool {
        let columns: Option<Vec<usize>> =
            self.pivots.iter().map(|pivot| regressor.find(&pivot.column)).collect();
        let Some(columns) = columns else { return false };
        let points: BTreeSet<u64> = self.pivots.iter().map(|pivot| pivot.point).collect();
        let mut matrix = Vec::new();
        let mut used = BTreeSet::new();
        for point in points {
            let Ok(rows) = rows_at(regressor, &columns, point) else { return false };
            for pivot in self.pivots.iter().filter(|pivot| pivot.point == point) {
                match rows.get(pivot.joint) {
                    Some(row) if used.insert((point, pivot.joint)) => matrix.push(row.clone()),
                    _ => return false,
                }
            }
        }
        self.parameters == PARAMETERS && determinant(matrix) != Residue::ZERO
    }
}

/// Relations to multiply out: the sums that are to vanish, torque by torque.
struct WrittenOut {
    names: Vec<String>,
    torques: Vec<Vec<ExprId>>,
}

impl WrittenOut {
    fn new(joints: usize) -> Self {
        Self { names: Vec::new(), torques: vec![Vec::new(); joints] }
    }

    fn push(&mut self, relation: &NullVector, sums: Vec<ExprId>) {
        self.names.push(relation.column.clone());
        self.torques.iter_mut().zip(sums).for_each(|(row, sum)| row.push(sum));
    }

    /// The first relation that is not 0 in every torque. None if they cannot be multiplied out.
    fn first_not_zero(&self, dag: &mut Dag, memory_bytes: usize) -> Option<Option<&str>> {
        if self.names.is_empty() {
            return Some(None);
        }
        let found = written_out(dag, &self.torques, memory_bytes)?;
        let coefficients: Vec<ExprId> =
            found.coefficients.iter().map(|one| one.to_expr(dag)).collect();
        // sines and cosines of the angles of the table obey s^2 + c^2 = 1
        let forms = canonical_generic(dag, &coefficients).ok()?;
        let is_left = |entry: &Entry| !forms[entry.coefficient as usize].is_zero();
        let mut columns = found.columns.iter().zip(&self.names);
        let left = columns.find(|(column, _)| column.iter().any(is_left));
        Some(left.map(|(_, name)| name.as_str()))
    }
}

/// The determinant by condensation on the corner: a row is exchanged where the corner is 0.
fn determinant(mut matrix: Vec<Vec<Residue>>) -> Residue {
    let mut product = Residue::ONE;
    while !matrix.is_empty() {
        let Some(at) = matrix.iter().position(|row| row[0] != Residue::ZERO) else {
            return Residue::ZERO;
        };
        let corner = matrix.swap_remove(at);
        if (matrix.len() - at) % 2 == 1 {
            product = -product;
        }
        product = product * corner[0];
        let inverse = corner[0].inverse().expect("the corner is not 0");
        for row in &mut matrix {
            let factor = row[0] * inverse;
            let rest = row.iter().zip(&corner).skip(1);
            *row = rest.map(|(&value, &top)| value - factor * top).collect();
        }
    }
    product
}

/// What a relation says of the columns: amounts that sum to 0.
fn amounts(
    regressor: &Regressor,
    dag: &mut Dag,
    relation: &NullVector,
) -> Option<Vec<(usize, ExprId)>> {
    let minus_one = dag.integer(-1);
    let mut amounts = vec![(regressor.find(&relation.column)?, minus_one)];
    for (factor, name) in &relation.sum {
        let resolve = &mut |dag: &mut Dag, name: &str| {
            let id = dag.find_symbol(name)?;
            let known = !ClassSet::of(dag.symbols()[id].class).is_run_time();
            known.then(|| dag.symbol_expr(id))
        };
        amounts.push((regressor.find(name)?, text::parse(dag, factor, resolve).ok()?));
    }
    Some(amounts)
}

/// The sums of columns in these amounts, torque by torque.
fn sums(regressor: &Regressor, dag: &mut Dag, amounts: &[(usize, ExprId)]) -> Vec<ExprId> {
    let mut sums = vec![dag.zero(); regressor.joints.len()];
    for &(column, amount) in amounts {
        for (sum, &entry) in sums.iter_mut().zip(&regressor.columns[column].entries) {
            let product = dag.mul(amount, entry);
            *sum = dag.add(*sum, product);
        }
    }
    sums
}

/// Whether there is a sine or cosine in a denominator, which [`vanishing`] cannot cancel.
fn divides_by_waves(dag: &Dag, expr: ExprId) -> bool {
    let has_wave = |divisor: ExprId| {
        let mut nodes = dag.topological(&[divisor]).into_iter();
        nodes.any(|node| matches!(dag.node(node), Node::Unary(..)))
    };
    dag.topological(&[expr]).into_iter().any(|node| match dag.node(node) {
        Node::Div(_, divisor) => has_wave(divisor),
        _ => false,
    })
}
