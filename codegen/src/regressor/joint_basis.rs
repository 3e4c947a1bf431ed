//! The base parameters on the joint axes: what is left of each body when all that its carrier feels
//! alike is given to the carrier.
//!
//! Mass on the axis of a turning joint may as well be the carrier's. So each bit of matter of a
//! body goes to its foot on the axis as far as the carrier is concerned, and the body keeps seven
//! numbers: the first moments across the axis and the second moments but the one along it. These
//! are values that say something: the carrier has got masses of real matter at real places. Their
//! columns are entries of the motion in the frame on the axis, where the joint's own twist is
//! (0, 0, 1), which makes them the cheapest basis of the space that all columns span.
//!
//! The change to the parameters of [`BaseParameters`] is exact: both are B_Eu theta0 for two bases
//! of one space, so that the factors of the kept columns are the factors of the change.

use super::base::{BaseError, BaseParameters};
use super::column::{Column, Feature, JointFunction, Regressor};
use super::dependence::{Place, feature_relations};
use super::eliminate::{Row, forget, gauss_jordan, places, rows};
use super::formula::{Part, parts, sum_of};
use super::inertial::ENTRIES;
use super::turning::{Turning, is_along_z, turnings};
use crate::expr::{Dag, ExprId};
use crate::fundamental::{CanonicalError, Field, Fraction};
use crate::model::{LinkId, Robot};
use std::collections::BTreeSet;

/// One base parameter on a joint axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointParameter {
    /// The link whose joint has the axis.
    pub link: LinkId,
    /// What it is, before the name of the link: `sx` and `Kxy` are moments, integrals of x dm and
    /// x y dm of what the body keeps, in the frame on the axis; `Jzz` is Kxx + Kyy of a body that
    /// turns about one axis only; `M` is the mass of what slides. `fv`, `fc`, `Ia`, `off` are
    /// parameters of the joint.
    pub prefix: &'static str,
    /// `PREFIX_LINK`.
    pub name: String,
    /// Its SI unit.
    pub unit: String,
    /// The columns of R0 that it has a share of, with known factors.
    pub members: Vec<(usize, ExprId)>,
    /// The sum by parts.
    pub parts: Vec<Part>,
    /// The sum in the names of the columns.
    pub expression: ExprId,
    /// The sum in the symbols of the model.
    pub value: ExprId,
    /// What it is of the parameters of [`BaseParameters`], by their place there: one row of the
    /// change of basis.
    pub of_kept: Vec<(usize, ExprId)>,
    /// That row by parts; the columns are kept ones and stand for their base parameters.
    pub parts_of_kept: Vec<Part>,
    /// Its column of R.
    pub(super) column: Vec<(Feature, ExprId)>,
}

/// Names of the entries of what a body keeps.
const PREFIXES: [&str; ENTRIES] = ["M", "sx", "sy", "sz", "Kxx", "Kyy", "Kzz", "Kxy", "Kxz", "Kyz"];

const UNITS: [&str; ENTRIES] =
    ["kg", "kg m", "kg m", "kg m", "kg m^2", "kg m^2", "kg m^2", "kg m^2", "kg m^2", "kg m^2"];

/// Entries in the order in which they are kept: those that a carrier feels alike last.
const KEPT_FIRST: [usize; ENTRIES] = [1, 2, 7, 8, 9, KXX, 5, 6, 3, 0];

/// The place of Kxx.
const KXX: usize = 4;

/// Prefix of the moment of inertia of a body that turns about one axis only.
const MOMENT: &str = "Jzz";

/// The base parameters of `base` in the other basis: as many, in the order of the joints, those of
/// bodies before those of joints.
pub fn joint_basis(
    base: &mut BaseParameters,
    robot: &Robot,
) -> Result<Vec<JointParameter>, BaseError> {
    let mut dag = std::mem::take(&mut base.regressor.dag);
    let found = independent(base, &mut dag);
    let turnings = turnings(&mut dag, &base.regressor.mechanism);
    base.regressor.dag = dag;
    let Found { field, columns, basis } = found?;
    if basis.len() != base.rank() {
        let model = base.regressor.model.clone();
        let (needed, proved) = (columns.len() - base.rank(), columns.len() - basis.len());
        return Err(BaseError::Unexplained { model, needed, proved });
    }
    let links: Vec<LinkId> = robot.joints().map(|(link, _)| link).collect();
    let mut parameters = Vec::new();
    for (feature, row) in basis {
        let shares = columns
            .iter()
            .enumerate()
            .filter_map(|(column, row)| Some((column, row.get(&Place::Feature(feature))?.clone())));
        let mut shares: Vec<(usize, Fraction)> = shares.collect();
        // The body's own first, then what comes from further out by lengths.
        shares.sort_by_key(|(_, share)| share.as_number().is_none());
        let own = base.regressor.columns.iter().position(|column| is_own(column, feature));
        let (joint, prefix, unit) = match (feature, own) {
            (Feature::Matter { body, entry }, _) => {
                let moving = &base.regressor.mechanism.bodies[body];
                let is_about_z = match turnings[body] {
                    Turning::About(axis) => is_along_z(&base.regressor.dag, axis),
                    _ => false,
                };
                let is_moment = moving.is_revolute && is_about_z && entry == KXX;
                (body, if is_moment { MOMENT } else { PREFIXES[entry] }, UNITS[entry].to_owned())
            }
            (Feature::Joint { joint, .. }, own) => {
                let own = own.expect("a function of a joint that is kept has a column");
                let own = &base.regressor.columns[own];
                let (_, prefix) = own.owner.expect("the column is of a joint");
                (joint, prefix, own.unit.clone())
            }
        };
        // The column of a joint's parameter stays what it is, gear ratio and all.
        let scale = own.map(|own| &columns[own][&Place::Feature(feature)]);
        let (shares, row) = scaled(&field, shares, row, scale)?;
        let name = format!("{prefix}_{}", robot.links[links[joint]].name);
        let titled = Titled { link: links[joint], prefix, name, unit };
        parameters.push(parameter(base, titled, &shares, &row));
    }
    Ok(parameters)
}

/// The columns of R0 over independent features, and which of these are a basis.
struct Found {
    field: Field,
    /// Each column of R0 as a combination of features.
    columns: Vec<Row>,
    /// Each feature of the basis with the column that it stands for: itself, and features whose
    /// amounts are always multiples of its own.
    basis: Vec<(Feature, Row)>,
}

fn independent(base: &BaseParameters, dag: &mut Dag) -> Result<Found, CanonicalError> {
    let regressor = &base.regressor;
    let mut relations = feature_relations(regressor, dag);
    relations.extend(base.coincidences.iter().cloned());
    let (field, mut rows) = rows(dag, &relations)?;
    let used: BTreeSet<Feature> = regressor
        .columns
        .iter()
        .flat_map(|column| column.definition.iter().map(|&(feature, _)| feature))
        .collect();
    let is_unused = |place: &Place| matches!(place, Place::Feature(one) if !used.contains(one));
    let unused: Vec<Place> = places(&rows).into_iter().filter(is_unused).collect();
    forget(&field, &mut rows, &unused)?;
    let mut kept_first: Vec<Feature> = used.into_iter().collect();
    kept_first.sort_by_key(|&feature| rank_of(regressor, feature));
    let kept_first: Vec<Place> = kept_first.into_iter().map(Place::Feature).collect();
    let count = regressor.columns.len();
    let order: Vec<Place> =
        (0..count).map(Place::Column).chain(kept_first.iter().rev().copied()).collect();
    let mut reduced = gauss_jordan(&field, rows, &order)?;
    let columns: Vec<Row> = (0..count)
        .map(|column| {
            let row = reduced.remove(&Place::Column(column)).expect("a column has a definition");
            let features = row.into_iter().filter(|(place, _)| matches!(place, Place::Feature(_)));
            features.map(|(place, factor)| (place, factor.negated())).collect()
        })
        .collect();
    // Features of which the columns never have but fixed proportions go together.
    let together = gauss_jordan(&field, columns.clone(), &kept_first)?;
    let basis = together.into_iter().filter_map(|(place, row)| match place {
        Place::Feature(feature) => Some((feature, row)),
        Place::Column(_) => None,
    });
    Ok(Found { field, columns, basis: basis.collect() })
}

/// Functions of joints are kept before matter, and matter near the base before what it carries; a
/// turning rotor is matter if it can be.
fn rank_of(regressor: &Regressor, feature: Feature) -> (usize, usize, usize) {
    match feature {
        Feature::Joint { joint, function } => {
            let is_matter = function == JointFunction::Acceleration
                && regressor.mechanism.bodies[joint].is_revolute;
            (if is_matter { 2 } else { 0 }, joint, 0)
        }
        Feature::Matter { body, entry } => {
            let place = KEPT_FIRST.iter().position(|&other| other == entry);
            (1, body, place.expect("all entries are listed"))
        }
    }
}

/// Whether a column is a parameter of a joint that stands before this function alone.
fn is_own(column: &Column, feature: Feature) -> bool {
    let is_of_joint = matches!(feature, Feature::Joint { .. });
    is_of_joint && matches!(column.definition[..], [(only, _)] if only == feature)
}

/// Shares of columns in a parameter.
type Shares = Vec<(usize, Fraction)>;

/// The shares of a parameter divided, and its column multiplied, by `scale`.
fn scaled(
    field: &Field,
    mut shares: Shares,
    mut row: Row,
    scale: Option<&Fraction>,
) -> Result<(Shares, Row), CanonicalError> {
    if let Some(scale) = scale.filter(|scale| !scale.is_one()) {
        let inverse = field.inverse(scale)?;
        for (_, share) in &mut shares {
            *share = field.multiply(share, &inverse)?;
        }
        for factor in row.values_mut() {
            *factor = field.multiply(factor, scale)?;
        }
    }
    Ok((shares, row))
}

/// What a parameter is called.
struct Titled {
    link: LinkId,
    prefix: &'static str,
    name: String,
    unit: String,
}

fn parameter(
    base: &mut BaseParameters,
    Titled { link, prefix, name, unit }: Titled,
    shares: &Shares,
    row: &Row,
) -> JointParameter {
    let kept: Vec<usize> = base.parameters.iter().map(|parameter| parameter.column).collect();
    let symbols: Vec<ExprId> =
        (0..base.regressor.columns.len()).map(|column| base.symbol(column)).collect();
    let regressor = &mut base.regressor;
    let mut with_expressions = |shares: &mut dyn Iterator<Item = &(usize, Fraction)>| {
        let dag = &mut regressor.dag;
        shares.map(|(column, share)| (*column, share.to_expr(dag))).collect::<Vec<_>>()
    };
    let members = with_expressions(&mut shares.iter());
    let by_kept = with_expressions(&mut shares.iter().filter(|(column, _)| kept.contains(column)));
    let column = row.iter().filter_map(|(&place, factor)| match place {
        Place::Feature(feature) => Some((feature, factor.to_expr(&mut regressor.dag))),
        Place::Column(_) => None,
    });
    let column = column.collect();
    let (own, of_kept) = (parts(regressor, &members), parts(regressor, &by_kept));
    let expression = sum_of(&mut regressor.dag, &own, &symbols);
    let values: Vec<ExprId> = regressor.columns.iter().map(|column| column.value).collect();
    let value = sum_of(&mut regressor.dag, &own, &values);
    let place = |column| kept.iter().position(|&other| other == column);
    JointParameter {
        link,
        prefix,
        name,
        unit,
        members,
        parts: own,
        expression,
        value,
        of_kept: by_kept
            .into_iter()
            .map(|(column, factor)| (place(column).expect("it is kept"), factor))
            .collect(),
        parts_of_kept: of_kept,
        column,
    }
}
