//! What a simulation knows of a robot besides its functions: names, drives, points, ground.

use crate::error::{Cause, Error};
use denavit_codegen::arena::Handle;
use denavit_codegen::expr::ExprId;
use denavit_codegen::expr::text::nearest;
use denavit_codegen::model::{Base, Contact, Drive, JointKind, Link, Robot, bake};
use denavit_codegen::number::parse_decimal;
use denavit_codegen::program::constant_values;

/// Names, drives, contact points and ground of a plant, with the values of its parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantModel {
    /// The model's name.
    pub name: String,
    /// The content hash of its file; 0 for a plant written by hand.
    pub hash: u64,
    /// Whether it moves in the world x-z plane only, so that its contacts have no y direction.
    pub planar: bool,
    /// Total mass \[kg\].
    pub mass_kg: f64,
    /// Acceleration of free fall [m/s^2].
    pub gravity: [f64; 3],
    /// The moving joints, in the order of q.
    pub joints: Vec<JointModel>,
    /// Names of the links, in the order of the transforms.
    pub links: Vec<String>,
    /// The link that carries each link; none stands on frame 0.
    pub parents: Vec<Option<usize>>,
    /// Points that may touch the ground.
    pub contacts: Vec<PointModel>,
    /// Points whose touching the ground is a fall (thesis 4.1): both ends of a capsule.
    pub fall_points: Vec<PointModel>,
    /// The radius of what must not touch about each of these \[m\].
    pub fall_radii_m: Vec<f64>,
    /// The ground.
    pub ground: GroundModel,
}

/// A joint.
#[derive(Clone, Debug, PartialEq)]
pub struct JointModel {
    /// The name of joint and link.
    pub name: String,
    /// Whether it slides (m, N) or turns (rad, N m).
    pub slides: bool,
    /// Whether something may drive it: all but the generated joints of a floating base.
    pub drivable: bool,
    /// Lowest and highest position.
    pub position_limits: Option<[f64; 2]>,
    /// Lowest and highest torque of the drive, joint side.
    pub torque_limits: Option<[f64; 2]>,
    /// Viscous friction that the plant's bias contains, joint side [N m s/rad, N s/m].
    pub viscous: f64,
    /// Coulomb friction, joint side [N m, N], which the plant's bias leaves out. Of a series
    /// elastic drive it is the motor's own and stands there.
    pub coulomb: f64,
    /// Constant torque that the plant's bias contains [N m, N].
    pub offset: f64,
    /// Motor and gear; none for a passive joint.
    pub drive: Option<DriveModel>,
}

impl JointModel {
    /// A joint without limits, friction and drive, which something may drive all the same.
    pub fn ideal(name: &str, slides: bool) -> Self {
        Self {
            name: name.to_owned(),
            slides,
            drivable: true,
            position_limits: None,
            torque_limits: None,
            viscous: 0.0,
            coulomb: 0.0,
            offset: 0.0,
            drive: None,
        }
    }
}

/// Motor and gear, all entries on the motor's side of the gear (thesis 3.14-3.24).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveModel {
    /// Motor turns per joint turn.
    pub gear_ratio: f64,
    /// [kg m^2].
    pub rotor_inertia: f64,
    /// [N m s/rad].
    pub viscous: f64,
    /// [N m].
    pub coulomb: f64,
    /// A spring between gear and joint.
    pub series_elastic: Option<SeriesElasticModel>,
}

/// Spring and pulleys (thesis 3.18).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeriesElasticModel {
    /// [N/m].
    pub stiffness: f64,
    /// Of the pulley on the gear's side \[m\].
    pub motor_radius: f64,
    /// Of the pulley on the joint's side \[m\].
    pub load_radius: f64,
}

/// A point fixed in a link.
#[derive(Clone, Debug, PartialEq)]
pub struct PointModel {
    /// Its name.
    pub name: String,
    /// Row of [`PlantModel::links`].
    pub link: usize,
    /// Place in the link's frame \[m\].
    pub position: [f64; 3],
}

/// The half space below a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundModel {
    /// A point of the plane \[m\].
    pub point: [f64; 3],
    /// Unit vector away from the ground.
    pub normal: [f64; 3],
}

impl Default for GroundModel {
    fn default() -> Self {
        Self { point: [0.0; 3], normal: [0.0, 0.0, 1.0] }
    }
}

impl GroundModel {
    /// Height of a point above the ground \[m\].
    pub fn height(&self, position: &[f64]) -> f64 {
        let arm: [f64; 3] = std::array::from_fn(|axis| position[axis] - self.point[axis]);
        dot(self.normal, &arm)
    }

    /// The tangents: forward, then to the left of it. For a ground that faces up forward is
    /// towards x.
    pub fn tangents(&self) -> [[f64; 3]; 2] {
        // y x n, or z x n for a wall that faces y
        let mut forward = cross([0.0, 1.0, 0.0], self.normal);
        if dot(forward, &forward).sqrt() < 1e-6 {
            forward = cross([0.0, 0.0, 1.0], self.normal);
        }
        let size = dot(forward, &forward).sqrt();
        let forward = forward.map(|entry| entry / size);
        [forward, cross(self.normal, forward)]
    }

    /// A point along the tangents \[m\].
    pub fn along(&self, position: &[f64]) -> [f64; 2] {
        self.tangents().map(|tangent| dot(tangent, position))
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: &[f64]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A value for a parameter in place of the model's own.
#[derive(Clone, Debug, PartialEq)]
pub struct Override {
    /// The parameter's name: `ks_right_ankle_x`.
    pub parameter: String,
    /// Its value, in the parameter's unit.
    pub value: f64,
}

/// The robot with overridden values, all of them numbers.
pub(super) fn baked(robot: &Robot, overrides: &[Override]) -> Result<Robot, Error> {
    let mut robot = robot.clone();
    for Override { parameter, value } in overrides {
        let Some(id) = robot.find_parameter(parameter) else {
            let names = robot.parameters.values().map(|p| p.name.as_str());
            let meant = nearest(parameter, names).map(str::to_owned);
            return Err(Cause::UnknownParameter(parameter.clone(), meant).into());
        };
        let exact = parse_decimal(&format!("{value:?}"))
            .map_err(|_| Cause::NotFinite(parameter.clone()))?;
        robot.parameters[id].default = Some(robot.dag.constant(exact));
    }
    let robot = bake(&robot)?;
    // the nominal parameters have been checked
    if !overrides.is_empty() {
        robot.links.values().try_for_each(|link| check_signs(&robot, link))?;
    }
    Ok(robot)
}

fn check_signs(robot: &Robot, link: &Link) -> Result<(), Error> {
    let mut given: Vec<(&'static str, Option<ExprId>)> = vec![
        ("the damping", link.joint.damping),
        ("the spring's stiffness", link.joint.spring.map(|spring| spring.stiffness)),
    ];
    if let Some(body) = &link.body {
        let [xx, yy, zz, ..] = body.inertia;
        given.extend([("the mass", Some(body.mass)), ("Ixx", Some(xx))]);
        given.extend([("Iyy", Some(yy)), ("Izz", Some(zz))]);
    }
    if let Some(drive) = &link.drive {
        let (elastic, back) = (drive.series_elastic, drive.return_spring);
        given.extend([
            ("the rotor's inertia", drive.rotor_inertia),
            ("the viscous friction", drive.viscous),
            ("the Coulomb friction", drive.coulomb),
            ("the drive's stiffness", elastic.map(|elastic| elastic.stiffness)),
            ("the return spring's stiffness", back.map(|spring| spring.stiffness)),
        ]);
    }
    for (what, entry) in given {
        let value = entry.map_or(0.0, |entry| value(robot, entry));
        if value < 0.0 {
            return Err(Cause::Negative { what, link: link.name.clone(), value }.into());
        }
    }
    Ok(())
}

/// Places that must stay off the ground by a radius \[m\], of a robot whose parameters are numbers.
pub fn fall_points(robot: &Robot) -> impl Iterator<Item = (PointModel, f64)> {
    robot.bodies_that_must_not_touch.iter().flat_map(move |body| {
        let [radius_m] = values(robot, [body.radius]);
        body.ends.iter().map(move |end| {
            let (name, link) = (body.name.clone(), body.link.index());
            (PointModel { name, link, position: values(robot, *end) }, radius_m)
        })
    })
}

/// Gravity and ground are as far from each other's directions as rounding takes them.
const STRAIGHT: f64 = 1e-12;

impl PlantModel {
    /// The acceleration of free fall, where it goes straight down onto level ground [m/s^2].
    pub fn fall_onto_level_ground(&self) -> Option<f64> {
        let [x, y, z] = self.gravity;
        let (size, [_, _, up]) = (x.hypot(y).hypot(z), self.ground.normal);
        let is_level = up > 1.0 - STRAIGHT;
        (is_level && z < 0.0 && x.hypot(y) <= STRAIGHT * size).then_some(size)
    }

    /// The joint of a floating base in space whose quarter turn makes its coordinates singular: the
    /// second of three that turn, its roll.
    pub fn singular_base_joint(&self) -> Option<usize> {
        let base = self.joints.get(..6).filter(|base| base.iter().all(|joint| !joint.drivable))?;
        let slides = [true, true, true, false, false, false];
        base.iter().map(|joint| joint.slides).eq(slides).then_some(4)
    }

    /// The description of a robot whose parameters are numbers.
    pub(super) fn of_baked(robot: &Robot) -> Self {
        let joints = robot.joints().map(|(link, _)| joint_model(robot, &robot.links[link]));
        let point = |contact: &Contact| PointModel {
            name: contact.name.clone(),
            link: contact.link.index(),
            position: values(robot, contact.position),
        };
        let (fall_points, fall_radii_m) = fall_points(robot).unzip();
        let masses: Vec<ExprId> =
            robot.links.values().filter_map(|link| link.body.map(|body| body.mass)).collect();
        let normal = values(robot, robot.ground.normal);
        let length = normal.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
        Self {
            name: robot.name.clone(),
            hash: robot.hash,
            planar: robot.base == Base::PlanarFloating,
            mass_kg: constant_values(&robot.dag, &masses).iter().sum(),
            gravity: values(robot, robot.gravity),
            joints: joints.collect(),
            links: robot.links.values().map(|link| link.name.clone()).collect(),
            parents: robot.links.values().map(|link| link.parent.map(Handle::index)).collect(),
            contacts: robot.contacts.values().map(point).collect(),
            fall_points,
            fall_radii_m,
            ground: GroundModel {
                point: values(robot, robot.ground.point),
                normal: normal.map(|entry| entry / length),
            },
        }
    }

    /// The joints with a spring between motor and link, of which laws of added effects tell the
    /// one side from the other.
    pub fn sprung_joints(&self) -> impl Iterator<Item = usize> + '_ {
        let has_spring =
            |joint: &JointModel| joint.drive.is_some_and(|drive| drive.series_elastic.is_some());
        (0..self.joints.len()).filter(move |&joint| has_spring(&self.joints[joint]))
    }

    /// The joint of that name.
    pub fn find_joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.name == name)
    }
}

fn values<const N: usize>(robot: &Robot, entries: [ExprId; N]) -> [f64; N] {
    let values = constant_values(&robot.dag, &entries);
    std::array::from_fn(|entry| values[entry])
}

fn value(robot: &Robot, entry: ExprId) -> f64 {
    values(robot, [entry])[0]
}

fn joint_model(robot: &Robot, link: &Link) -> JointModel {
    let range = |range: [ExprId; 2]| values(robot, range);
    let terms = robot.terms;
    let drive = link.drive.map(|drive| drive_model(robot, &drive));
    let stiff = drive.filter(|drive| drive.series_elastic.is_none());
    let reflected = stiff.map_or(0.0, |d| d.gear_ratio * d.gear_ratio * d.viscous);
    let damping = link.joint.damping.filter(|_| terms.friction).map_or(0.0, |d| value(robot, d));
    let offset = link.drive.and_then(|drive| drive.offset);
    JointModel {
        name: link.name.clone(),
        slides: link.joint.kind == JointKind::Prismatic,
        drivable: !link.name.starts_with("base_") || robot.base == Base::Fixed,
        position_limits: link.limits.position.map(range),
        torque_limits: link.limits.torque.map(range),
        viscous: reflected + damping,
        coulomb: stiff.map_or(0.0, |d| d.gear_ratio.abs() * d.coulomb),
        offset: offset.map_or(0.0, |offset| value(robot, offset)),
        drive,
    }
}

fn drive_model(robot: &Robot, drive: &Drive) -> DriveModel {
    let given = |entry: Option<ExprId>, absent: f64| entry.map_or(absent, |e| value(robot, e));
    let friction = |entry: Option<ExprId>| given(entry.filter(|_| robot.terms.friction), 0.0);
    DriveModel {
        gear_ratio: given(drive.gear_ratio, 1.0),
        rotor_inertia: given(drive.rotor_inertia.filter(|_| robot.terms.rotor), 0.0),
        viscous: friction(drive.viscous),
        coulomb: friction(drive.coulomb),
        series_elastic: drive.series_elastic.map(|elastic| SeriesElasticModel {
            stiffness: value(robot, elastic.stiffness),
            motor_radius: value(robot, elastic.motor_radius),
            load_radius: value(robot, elastic.load_radius),
        }),
    }
}
