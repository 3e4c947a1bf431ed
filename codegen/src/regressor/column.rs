//! The columns of the regressor: one for each unknown parameter, or product of unknowns.

use super::inertial::{ENTRIES, PARAMETERS, about_origin, entries, unit_matter};
use super::link_frames::{Shortcuts, link_shares};
use super::monomial::{InUnknowns, NotPolynomial, Unknown, in_unknowns, to_expr};
use super::pull::{MatterRegressor, MotionTerms, fixed_base_regressor};
use crate::arena::Handle;
use crate::dynamics::spring_torque;
use crate::expr::{Dag, ExprId, SymbolClass, UnaryFunction, text};
use crate::kinematics::{Frames, Mechanism};
use crate::model::{
    About, Base, Body, BodyEntry, Dimension, Drive, JointEntry, LinkId, Robot, Role, Terms,
    TorqueSide,
};
use crate::spatial::PseudoInertia;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// What the unknowns of a body are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Unknowns {
    /// Bodies with entries of their own: ten parameters about the origin of the link frame, in
    /// which the torques are linear. Bodies written in the user's symbols: their products.
    #[default]
    Parameters,
    /// Every product of mass, centre of mass and inertia entries that appears.
    Products,
}

/// What the regressor has besides the rigid bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct RegressorOptions {
    /// Viscous and Coulomb friction: fv and fc of every joint.
    pub friction: bool,
    /// Reflected rotor inertia: Ia of every joint.
    pub rotor: bool,
    /// A constant torque: off of every joint.
    pub offset: bool,
    /// Only those joint parameters that the model has, not those of every joint.
    pub only_modelled: bool,
    /// What the unknowns of the bodies are.
    pub unknowns: Unknowns,
}

/// Why a model has no regressor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RegressorError {
    /// An unknown stands where the torques are no polynomial in it.
    NotPolynomial {
        /// The model.
        model: String,
        /// The unknown.
        unknown: String,
    },
}

impl fmt::Display for RegressorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::NotPolynomial { model, unknown } = self;
        write!(
            f,
            "{model}: the torques are no polynomial in the unknown {unknown}\n  hint: unknowns may \
             stand in sums, products and powers of body entries; declare {unknown} a constant"
        )
    }
}

impl std::error::Error for RegressorError {}

/// A function of the motion that a column is made of, with coefficients that are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Feature {
    /// The torques per unit of one pseudo-inertia entry of one body.
    Matter { body: usize, entry: usize },
    /// A function of one joint, on its own torque.
    Joint { joint: usize, function: JointFunction },
}

/// The functions of a joint's own motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum JointFunction {
    Rate,
    RateSign,
    Acceleration,
    One,
}

/// One column of R0 and the parameter that it belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// The parameter: `mx_link2`, or a product as `c2^2*m2`.
    pub name: String,
    /// The parameter in the symbols of the model.
    pub value: ExprId,
    /// Its SI unit.
    pub unit: String,
    /// The torque of each joint per unit of the parameter.
    pub entries: Vec<ExprId>,
    /// The link whose body or joint has the parameter, and the prefix of its name (`mx`, `fv`);
    /// none for a product of the model's own unknowns.
    pub owner: Option<(LinkId, &'static str)>,
    /// The column as a combination of features.
    pub(super) definition: Vec<(Feature, ExprId)>,
    /// The link of whose ten parameters it is one, and which.
    pub(super) parameter: Option<(LinkId, usize)>,
}

/// R0 with the left side: zeta = tau - known = R0 theta0.
#[derive(Clone, Debug)]
pub struct Regressor {
    /// The model's name.
    pub model: String,
    /// Holds all expressions, those of the robot among them.
    pub dag: Dag,
    /// The columns, in order.
    pub columns: Vec<Column>,
    /// What each torque has besides the unknowns, and moves to the left side: matter that is known,
    /// joint parameters that are, and springs.
    pub known: Vec<ExprId>,
    /// The links whose joints the rows belong to.
    pub joints: Vec<String>,
    pub(super) mechanism: Mechanism,
    pub(super) terms: Terms,
    /// `known` as a combination of features.
    pub(super) known_features: Vec<(Feature, ExprId)>,
}

impl Regressor {
    /// The regressor of `robot` with its terms, rows on the joint side, or on the motor side where
    /// `side` says so (thesis 3.17: each row over the gear ratio of its stiff drive).
    pub fn new(
        robot: &Robot,
        options: RegressorOptions,
        side: TorqueSide,
    ) -> Result<Self, RegressorError> {
        Self::with_shortcuts(robot, options, side, Shortcuts::default())
    }

    /// The same with fewer operations, by relations that are proved elsewhere.
    pub(super) fn with_shortcuts(
        robot: &Robot,
        options: RegressorOptions,
        side: TorqueSide,
        shortcuts: Shortcuts,
    ) -> Result<Self, RegressorError> {
        let mut dag = robot.dag.clone();
        let mechanism = Mechanism::new(&mut dag, robot);
        let mut builder = Builder {
            robot,
            options,
            unknowns: unknowns(robot),
            dag,
            mechanism,
            columns: Vec::new(),
            products: BTreeMap::new(),
            known: Vec::new(),
        };
        for link in robot.links.keys() {
            builder.add_link(link)?;
        }
        for (joint, (link, _)) in robot.joints().enumerate() {
            builder.add_joint(joint, link);
        }
        let Builder { mut dag, mut columns, known: known_features, mechanism, .. } = builder;
        let n = mechanism.degrees_of_freedom();
        let terms = motion_terms(robot.terms);
        let mut torques = Torques { robot, mechanism: &mechanism, terms, of_matter: None };
        let known = torques.of(&mut dag, &known_features);
        let springs = robot.joints().map(|(link, _)| spring_torque(&mut dag, robot, link).0);
        let springs: Vec<ExprId> = springs.collect();
        let known: Vec<_> = known.iter().zip(springs).map(|(&a, b)| dag.add(a, b)).collect();
        for column in columns.iter_mut().filter(|column| column.parameter.is_none()) {
            column.entries = torques.of(&mut dag, &column.definition);
        }
        let links: Vec<LinkId> = columns
            .iter()
            .filter_map(|column| column.parameter.filter(|&(_, place)| place == 0))
            .map(|(link, _)| link)
            .collect();
        let shares = link_shares(&mut dag, robot, &mechanism, terms, &links, shortcuts);
        for column in &mut columns {
            let Some((link, place)) = column.parameter else { continue };
            let at = links.iter().position(|&other| other == link).expect("it has ten columns");
            column.entries = vec![dag.zero(); n];
            for (joint, torques) in &shares[at] {
                column.entries[*joint] = torques[place];
            }
        }
        let scales = row_scales(&mut dag, robot, side);
        let mut scaled = |rows: &[ExprId]| -> Vec<ExprId> {
            rows.iter().zip(&scales).map(|(&row, &scale)| dag.mul(scale, row)).collect()
        };
        for column in &mut columns {
            column.entries = scaled(&column.entries);
        }
        let known = scaled(&known);
        let joints = robot.joints().map(|(link, _)| robot.links[link].name.clone()).collect();
        let (model, terms) = (robot.name.clone(), robot.terms);
        Ok(Self { model, dag, columns, known, joints, mechanism, terms, known_features })
    }

    /// The terms of the motion.
    pub(super) fn motion_terms(&self) -> MotionTerms {
        motion_terms(self.terms)
    }

    /// The entries of R0, row by row.
    pub fn entries(&self) -> Vec<ExprId> {
        (0..self.joints.len())
            .flat_map(|row| self.columns.iter().map(move |column| column.entries[row]))
            .collect()
    }

    /// The column of a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }
}

fn motion_terms(terms: Terms) -> MotionTerms {
    MotionTerms { rates: terms.coriolis, accelerations: terms.inertia, gravity: terms.gravity }
}

/// Joint torques of combinations of features.
struct Torques<'a> {
    robot: &'a Robot,
    mechanism: &'a Mechanism,
    terms: MotionTerms,
    /// Those of all bodies' entries, once they are asked for.
    of_matter: Option<MatterRegressor>,
}

impl Torques<'_> {
    fn of(&mut self, dag: &mut Dag, definition: &[(Feature, ExprId)]) -> Vec<ExprId> {
        let mut rows = vec![dag.zero(); self.mechanism.degrees_of_freedom()];
        for &(feature, factor) in definition {
            for (joint, row) in rows.iter_mut().enumerate() {
                let value = self.feature(dag, feature, joint);
                let product = dag.mul(factor, value);
                *row = dag.add(*row, product);
            }
        }
        rows
    }

    fn feature(&mut self, dag: &mut Dag, feature: Feature, row: usize) -> ExprId {
        match feature {
            Feature::Matter { body, entry } => {
                let (mechanism, terms) = (self.mechanism, self.terms);
                let matter = self.of_matter.get_or_insert_with(|| {
                    let frames = Frames::plain(dag, mechanism);
                    fixed_base_regressor(dag, &frames, terms)
                });
                matter.rows[row][body][entry]
            }
            Feature::Joint { joint, .. } if joint != row => dag.zero(),
            Feature::Joint { joint, function } => function.of(dag, self.robot, joint),
        }
    }
}

impl JointFunction {
    /// The function of a joint, by its number among the joint variables.
    pub(super) fn of(self, dag: &mut Dag, robot: &Robot, joint: usize) -> ExprId {
        let (_, variables) = robot.joints().nth(joint).expect("the joint is there");
        match self {
            Self::Rate => variables.qd,
            Self::RateSign => dag.unary(UnaryFunction::Sign, variables.qd),
            Self::Acceleration => variables.qdd,
            Self::One => dag.one(),
        }
    }
}

/// What the row of each joint is multiplied with.
pub(super) fn row_scales(dag: &mut Dag, robot: &Robot, side: TorqueSide) -> Vec<ExprId> {
    let one = dag.one();
    let mut scales = Vec::new();
    for (link, _) in robot.joints() {
        let drive = robot.links[link].drive.filter(|drive| drive.series_elastic.is_none());
        let gear = drive.and_then(|drive| drive.gear_ratio);
        scales.push(match gear {
            Some(ratio) if side == TorqueSide::Motor => dag.div(one, ratio),
            _ => one,
        });
    }
    scales
}

/// The symbols that are to be found: unknowns and body entries that are not marked known.
fn unknowns(robot: &Robot) -> BTreeSet<ExprId> {
    robot
        .parameters
        .values()
        .filter(|parameter| !parameter.known)
        .filter(|parameter| matches!(parameter.role, Role::Unknown | Role::Body(..)))
        .map(|parameter| parameter.symbol)
        .collect()
}

struct Builder<'a> {
    robot: &'a Robot,
    options: RegressorOptions,
    unknowns: BTreeSet<ExprId>,
    dag: Dag,
    mechanism: Mechanism,
    columns: Vec<Column>,
    /// The column of each product of unknowns.
    products: BTreeMap<Unknown, usize>,
    known: Vec<(Feature, ExprId)>,
}

impl Builder<'_> {
    fn add_link(&mut self, link: LinkId) -> Result<(), RegressorError> {
        let Some(body) = self.robot.links[link].body else { return Ok(()) };
        let Some(index) = self.mechanism.placements[link].body else { return Ok(()) };
        let is_own = self.options.unknowns == Unknowns::Parameters && self.has_own_entries(link);
        if is_own {
            self.add_parameters(link, index, &body);
            return Ok(());
        }
        let placement = self.mechanism.placements[link].clone();
        let dag = &mut self.dag;
        let central = body.about == About::Com;
        let own = PseudoInertia::from_body(dag, body.mass, body.com, body.inertia, central);
        let carried = entries(&placement.carry(dag, &own));
        // In the link's own frame the products come in the order m, m c, then inertias.
        for entry in entries(&own) {
            let terms = self.split(entry)?;
            terms.keys().for_each(|product| _ = self.product_column(product));
        }
        for (entry, expr) in carried.into_iter().enumerate() {
            let feature = Feature::Matter { body: index, entry };
            for (product, factor) in self.split(expr)? {
                match self.product_column(&product) {
                    Some(column) => self.columns[column].definition.push((feature, factor)),
                    None => self.known.push((feature, factor)),
                }
            }
        }
        Ok(())
    }

    fn split(&mut self, expr: ExprId) -> Result<InUnknowns, RegressorError> {
        in_unknowns(&mut self.dag, expr, &self.unknowns).map_err(|NotPolynomial(unknown)| {
            RegressorError::NotPolynomial {
                model: self.robot.name.clone(),
                unknown: name_of(&self.dag, unknown),
            }
        })
    }

    /// The column of a product of unknowns; none for the product of none.
    fn product_column(&mut self, product: &Unknown) -> Option<usize> {
        if product.is_empty() {
            return None;
        }
        if let Some(&column) = self.products.get(product) {
            return Some(column);
        }
        let value = to_expr(&mut self.dag, product);
        let unit = self.product_unit(product);
        let name = name_of(&self.dag, value);
        self.columns.push(Column {
            name,
            value,
            unit,
            entries: Vec::new(),
            owner: None,
            definition: Vec::new(),
            parameter: None,
        });
        self.products.insert(product.clone(), self.columns.len() - 1);
        Some(self.columns.len() - 1)
    }

    fn product_unit(&self, product: &Unknown) -> String {
        let mut dimension = Some(Dimension::NONE);
        for &(unknown, exponent) in product {
            let parameter = self.robot.parameters.values().find(|p| p.symbol == unknown);
            let unit = parameter.and_then(|p| p.unit.as_ref());
            let power = unit.and_then(|unit| {
                unit.dimension().power(i32::try_from(exponent).unwrap_or(i32::MAX))
            });
            dimension = dimension.zip(power).and_then(|(a, b)| a.times(b));
        }
        dimension.map_or_else(String::new, |dimension| dimension.to_string())
    }

    /// Whether all ten entries of a body are unknown symbols of their own.
    fn has_own_entries(&self, link: LinkId) -> bool {
        BodyEntry::ALL.iter().all(|&entry| {
            let mut own = self.robot.parameters.values();
            own.any(|p| p.role == Role::Body(link, entry) && !p.known)
        })
    }

    fn add_parameters(&mut self, link: LinkId, index: usize, body: &Body) {
        let values = about_origin(&mut self.dag, body);
        let placement = self.mechanism.placements[link].clone();
        let name = &self.robot.links[link].name;
        for (place, (prefix, unit)) in PARAMETERS.into_iter().enumerate() {
            let matter = unit_matter(&mut self.dag, place);
            let carried = entries(&placement.carry(&mut self.dag, &matter));
            let zero = self.dag.zero();
            let definition = (0..ENTRIES)
                .filter(|&entry| carried[entry] != zero)
                .map(|entry| (Feature::Matter { body: index, entry }, carried[entry]))
                .collect();
            self.columns.push(Column {
                name: format!("{prefix}_{name}"),
                value: values[place],
                unit: unit.to_owned(),
                entries: Vec::new(),
                owner: Some((link, prefix)),
                definition,
                parameter: Some((link, place)),
            });
        }
    }

    fn add_joint(&mut self, joint: usize, id: LinkId) {
        let link = &self.robot.links[id];
        let generated = match self.robot.base {
            Base::Fixed => 0,
            Base::Floating => 6,
            Base::PlanarFloating => 3,
        };
        let drive = link.drive.unwrap_or_default();
        if id.index() < generated {
            return;
        }
        let gear = drive.gear_ratio.unwrap_or_else(|| self.dag.one());
        let (square, size) = (self.dag.mul(gear, gear), self.dag.unary(UnaryFunction::Abs, gear));
        let one = self.dag.one();
        let stiff = drive.series_elastic.is_none();
        let damping = if link.joint.damping.is_some() { one } else { square };
        let of = self.options;
        let viscous = drive.viscous.or(link.joint.damping);
        let Drive { coulomb, rotor_inertia, offset, .. } = drive;
        for (wanted, entry, given, function, factor) in [
            (of.friction && stiff, JointEntry::Viscous, viscous, JointFunction::Rate, damping),
            (of.friction && stiff, JointEntry::Coulomb, coulomb, JointFunction::RateSign, size),
            (
                of.rotor && stiff,
                JointEntry::RotorInertia,
                rotor_inertia,
                JointFunction::Acceleration,
                square,
            ),
            (of.offset, JointEntry::Offset, offset, JointFunction::One, one),
        ] {
            if wanted && (given.is_some() || !of.only_modelled) {
                self.joint_column(id, entry, given, (Feature::Joint { joint, function }, factor));
            }
        }
    }

    fn joint_column(
        &mut self,
        id: LinkId,
        entry: JointEntry,
        given: Option<ExprId>,
        definition: (Feature, ExprId),
    ) {
        let mut parameters = self.robot.parameters.values();
        let own = parameters.find(|parameter| parameter.role == Role::Joint(id, entry));
        if let Some((value, true)) = given.zip(own.map(|parameter| parameter.known)) {
            let (feature, factor) = definition;
            self.known.push((feature, self.dag.mul(factor, value)));
            return;
        }
        let link = &self.robot.links[id];
        let name = format!("{}_{}", entry.prefix(), link.name);
        let value = given.unwrap_or_else(|| self.dag.symbol(&name, SymbolClass::Drive));
        let slides = link.joint.kind == crate::model::JointKind::Prismatic;
        let unit = match (entry, slides) {
            (JointEntry::Viscous, false) => "N m s/rad",
            (JointEntry::Viscous, true) => "N s/m",
            (JointEntry::RotorInertia, false) => "kg m^2",
            (JointEntry::RotorInertia, true) => "kg",
            (_, false) => "N m",
            (_, true) => "N",
        };
        self.columns.push(Column {
            name,
            value,
            unit: unit.to_owned(),
            entries: Vec::new(),
            owner: Some((id, entry.prefix())),
            definition: vec![definition],
            parameter: None,
        });
    }
}

fn name_of(dag: &Dag, expr: ExprId) -> String {
    text::print(dag, expr).to_string()
}
