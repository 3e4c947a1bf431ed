//! What a regression knows of the joints, and the joint parameters that are to be found.

use denavit_codegen::arena::Handle;
use denavit_codegen::expr::{ExprId, SymbolClass};
use denavit_codegen::model::{Base, Drive, JointKind, Link, Robot, TorqueSide, bake_geometry};
use denavit_codegen::program::constant_values;
use denavit_codegen::regressor::RegressorOptions;

/// A joint of a regression.
#[derive(Clone, Debug, PartialEq)]
pub struct RegressionJoint {
    /// The name of joint and link.
    pub name: String,
    /// Whether it slides (m, N) or turns (rad, N m).
    pub slides: bool,
    /// Whether it is a virtual joint of a floating base: its row is a component of the wrench on
    /// the base.
    pub is_base: bool,
    /// Lowest and highest position.
    pub position_limits: Option<[f64; 2]>,
    /// Largest speed either way.
    pub velocity_limit: Option<f64>,
    /// Largest acceleration either way.
    pub acceleration_limit: Option<f64>,
    /// Lowest and highest torque of the drive, joint side.
    pub torque_limits: Option<[f64; 2]>,
    /// What a torque of its motor is multiplied with to be one along the joint axis: the turns of
    /// the motor for one of the joint, a spring between them being relaxed; 1 without a gear.
    pub gear_ratio: f64,
    /// Where logs that do not say it themselves have its torque, by the model.
    pub torque_side: TorqueSide,
    /// Whether it has a drive: no torque is measured of one that has none.
    pub is_driven: bool,
    /// Whether a spring is between motor and joint, so that the motor's torque is not the joint's.
    pub is_elastic: bool,
    /// The stiffness of that spring on the side of the joint, where the model gives it a value.
    pub spring: Option<SpringStiffness>,
}

/// The stiffness of a series spring on the side of its joint.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringStiffness {
    /// The name of the model's parameter, or of the link.
    pub name: String,
    /// Torque by how far the motor is ahead on the joint's side [N m/rad, N/m].
    pub value: f64,
    /// Its standard deviation, where the model states it.
    pub std: Option<f64>,
}

/// The robot with exactly the joint parameters that `options` ask for: what is asked for of every
/// joint gets a symbol where the model has none, what is not asked for is gone.
pub(super) fn with_joint_parameters(robot: &Robot, options: RegressorOptions) -> Robot {
    let mut robot = robot.clone();
    let generated = match robot.base {
        Base::Fixed => 0,
        Base::Floating => 6,
        Base::PlanarFloating => 3,
    };
    let all = !options.only_modelled;
    // The joint side throughout: `read_log` brings measurements there.
    robot.torque_side = TorqueSide::Joint;
    robot.terms.friction = options.friction && (robot.terms.friction || all);
    robot.terms.rotor = options.rotor && (robot.terms.rotor || all);
    let links: Vec<_> = robot.joints().map(|(link, _)| link).collect();
    for id in links {
        let (name, is_generated) = (robot.links[id].name.clone(), id.index() < generated);
        let damping = robot.links[id].joint.damping;
        let has_drive = robot.links[id].drive.is_some();
        let mut drive: Drive = robot.links[id].drive.unwrap_or_default();
        let stiff = drive.series_elastic.is_none();
        let dag = &mut robot.dag;
        let mut settle = |entry: &mut Option<ExprId>, wanted: bool, given: bool, prefix: &str| {
            if !wanted {
                *entry = None;
            } else if entry.is_none() && !given && all && !is_generated {
                *entry = Some(dag.symbol(&format!("{prefix}_{name}"), SymbolClass::Drive));
            }
        };
        if stiff {
            settle(&mut drive.viscous, options.friction, damping.is_some(), "fv");
            settle(&mut drive.coulomb, options.friction, false, "fc");
            settle(&mut drive.rotor_inertia, options.rotor, false, "Ia");
        }
        settle(&mut drive.offset, options.offset, false, "off");
        let link = &mut robot.links[id];
        if !options.friction {
            link.joint.damping = None;
        }
        if has_drive || drive != Drive::default() {
            link.drive = Some(drive);
        }
    }
    robot
}

/// The joints with the values of their limits; a limit without a value is left out.
pub(super) fn described_joints(robot: &Robot, side: TorqueSide) -> Vec<RegressionJoint> {
    // Limits are symbol-free; gear ratios may be constants.
    let baked = bake_geometry(robot).unwrap_or_else(|_| robot.clone());
    let value = |expr: ExprId| -> Option<f64> {
        let is_number = baked.dag.classes(expr).is_empty();
        is_number.then(|| constant_values(&baked.dag, &[expr])[0])
    };
    let range = |range: [ExprId; 2]| Some([value(range[0])?, value(range[1])?]);
    let one = |link: &Link| {
        let of_symbol = |entry: ExprId| {
            let parameter = robot.parameters.values().find(|p| p.symbol == entry);
            value(parameter.and_then(|p| p.default).unwrap_or(entry))
        };
        let spring = link.drive.and_then(|drive| drive.series_elastic).and_then(|elastic| {
            let lever = of_symbol(elastic.load_radius)?.powi(2);
            let own = robot.parameters.values().find(|p| p.symbol == elastic.stiffness);
            let std = own.and_then(|own| own.std).and_then(value);
            Some(SpringStiffness {
                name: own.map_or(&link.name, |own| &own.name).clone(),
                value: lever * of_symbol(elastic.stiffness)?,
                std: std.map(|std| lever * std),
            })
        });
        let gear = link.drive.and_then(|drive| drive.gear_ratio).and_then(of_symbol);
        let pulleys = link.drive.and_then(|drive| drive.series_elastic).and_then(|elastic| {
            Some(of_symbol(elastic.load_radius)? / of_symbol(elastic.motor_radius)?)
        });
        RegressionJoint {
            name: link.name.clone(),
            slides: link.joint.kind == JointKind::Prismatic,
            is_base: link.name.starts_with("base_") && robot.base != Base::Fixed,
            position_limits: link.limits.position.and_then(range),
            velocity_limit: link.limits.velocity.and_then(value),
            acceleration_limit: link.limits.acceleration.and_then(value),
            torque_limits: link.limits.torque.and_then(range),
            gear_ratio: gear.unwrap_or(1.0) * pulleys.unwrap_or(1.0),
            torque_side: side,
            is_driven: link.drive.is_some(),
            is_elastic: link.drive.is_some_and(|drive| drive.series_elastic.is_some()),
            spring,
        }
    };
    robot.joints().map(|(link, _)| one(&robot.links[link])).collect()
}
