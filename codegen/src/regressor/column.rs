//! The columns of the regressor: one for each unknown parameter, or product of unknowns.

use super::matter::{ENTRIES, entries, from_entries, shares};
use super::monomial::{InUnknowns, NotPolynomial, Unknown, in_unknowns, to_expr};
use crate::arena::Handle;
use crate::dynamics::motion::{self, motion};
use crate::expr::{Dag, ExprId, SymbolClass, UnaryFunction, text};
use crate::kinematics::{Frames, Mechanism};
use crate::model::{
    About, Base, Body, BodyEntry, Dimension, Drive, JointEntry, Link, LinkId, Robot, Role,
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
    /// What each torque has besides the unknowns: it moves to the left side.
    pub known: Vec<ExprId>,
    /// The links whose joints the rows belong to.
    pub joints: Vec<String>,
    pub(super) mechanism: Mechanism,
    pub(super) terms: crate::model::Terms,
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
        let mut dag = robot.dag.clone();
        let mechanism = Mechanism::new(&mut dag, robot);
        let frames = Frames::plain(&mut dag, &mechanism);
        let wanted = robot.terms;
        let terms = motion::Terms {
            rates: wanted.coriolis,
            accelerations: wanted.inertia,
            gravity: wanted.gravity,
        };
        let motion = motion(&mut dag, &frames, terms, None);
        let shares = shares(&mut dag, &frames, &motion);
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
        let n = frames.len();
        let scales = row_scales(&mut dag, robot, side);
        let torques = |dag: &mut Dag, definition: &[(Feature, ExprId)]| {
            let mut rows = vec![dag.zero(); n];
            for &(feature, factor) in definition {
                for (joint, value) in feature_torques(dag, robot, &shares, feature) {
                    let product = dag.mul(factor, value);
                    rows[joint] = dag.add(rows[joint], product);
                }
            }
            (0..n).map(|row| dag.mul(scales[row], rows[row])).collect::<Vec<_>>()
        };
        for column in &mut columns {
            column.entries = torques(&mut dag, &column.definition);
        }
        let known = torques(&mut dag, &known_features);
        let joints = robot.joints().map(|(link, _)| robot.links[link].name.clone()).collect();
        let model = robot.name.clone();
        let terms = wanted;
        Ok(Self { model, dag, columns, known, joints, mechanism, terms, known_features })
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

fn feature_torques(
    dag: &mut Dag,
    robot: &Robot,
    shares: &[Vec<super::matter::Share>],
    feature: Feature,
) -> Vec<(usize, ExprId)> {
    match feature {
        Feature::Matter { body, entry } => {
            shares[body].iter().map(|share| (share.joint, share.torques[entry])).collect()
        }
        Feature::Joint { joint, function } => vec![(joint, function.of(dag, robot, joint))],
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
                self.joint_column(link, entry, given, (Feature::Joint { joint, function }, factor));
            }
        }
    }

    fn joint_column(
        &mut self,
        link: &Link,
        entry: JointEntry,
        given: Option<ExprId>,
        definition: (Feature, ExprId),
    ) {
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
            definition: vec![definition],
            parameter: None,
        });
    }
}

fn name_of(dag: &Dag, expr: ExprId) -> String {
    text::print(dag, expr).to_string()
}

/// The prefixes and units of the ten parameters about the origin of the link frame.
pub(super) const PARAMETERS: [(&str, &str); ENTRIES] = [
    ("m", "kg"),
    ("mx", "kg m"),
    ("my", "kg m"),
    ("mz", "kg m"),
    ("Ixx", "kg m^2"),
    ("Iyy", "kg m^2"),
    ("Izz", "kg m^2"),
    ("Ixy", "kg m^2"),
    ("Ixz", "kg m^2"),
    ("Iyz", "kg m^2"),
];

/// The matter of one unit of one parameter.
fn unit_matter(dag: &mut Dag, place: usize) -> PseudoInertia {
    let (zero, one) = (dag.zero(), dag.one());
    let unit = |at: usize| if at == place { one } else { zero };
    let mut matter =
        PseudoInertia::from_body(dag, zero, [zero; 3], [4, 5, 6, 7, 8, 9].map(unit), false);
    matter.mass = unit(0);
    matter.first = [1, 2, 3].map(unit);
    matter
}

/// Matter as the ten parameters of a frame.
pub(super) fn parameters_of(dag: &mut Dag, matter: &PseudoInertia) -> [ExprId; ENTRIES] {
    let tensor = matter.tensor(dag);
    let [x, y, z] = matter.first;
    let [xx, yy, zz] = [0, 1, 2].map(|i| tensor[i][i]);
    [matter.mass, x, y, z, xx, yy, zz, tensor[0][1], tensor[0][2], tensor[1][2]]
}

/// The ten parameters of a body about the origin of its frame, in the symbols of the model.
fn about_origin(dag: &mut Dag, body: &Body) -> [ExprId; ENTRIES] {
    let first = body.com.map(|c| dag.mul(body.mass, c));
    let mut tensor = body.inertia;
    if body.about == About::Com {
        // Steiner: I + m (c.c 1 - c c^T)
        let c = body.com;
        let squares = [0, 1, 2].map(|k| dag.mul(first[k], c[k]));
        for (place, (i, j)) in [(1, 2), (0, 2), (0, 1)].into_iter().enumerate() {
            let sum = dag.add(squares[i], squares[j]);
            tensor[place] = dag.add(tensor[place], sum);
        }
        for (place, (i, j)) in [(0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
            let product = dag.mul(first[i], c[j]);
            tensor[3 + place] = dag.sub(tensor[3 + place], product);
        }
    }
    let [xx, yy, zz, xy, xz, yz] = tensor;
    [body.mass, first[0], first[1], first[2], xx, yy, zz, xy, xz, yz]
}

/// The matter of a list of ten entries, all 0 but one.
pub(super) fn unit_entry(dag: &Dag, entry: usize) -> PseudoInertia {
    let mut list = [dag.zero(); ENTRIES];
    list[entry] = dag.one();
    from_entries(list)
}
