//! Series elastic drives, seen from their motors.
//!
//! A log with the angle and the torque of the motor has the balance of the torques before the
//! spring: tau_M = load(q, qd, qdd) + Ia th'' + fv th' + fc sgn(th'), all on the joint's side,
//! since the spring passes on what the load takes (thesis 3.18-3.24). So the drive is one without
//! a spring whose rotor moves otherwise than the joint.
//!
//! The balance of the spring itself is measured, too: k (th - q) = load(q, qd, qdd), with both
//! angles. It has neither friction of the drive nor noise of its torque, but steps of encoders
//! times the stiffness.

use crate::policy::nominal::JOINT;
use denavit_codegen::model::Robot;
use denavit_measure::JointIndex;
use denavit_measure::log::MeasuredLog;
use denavit_plants::regression::{RegressionJoint, SpringStiffness};

/// A robot whose drives are seen from their motors.
#[derive(Clone, Debug)]
pub struct BeforeSprings {
    /// The robot with these drives before their springs.
    pub robot: Robot,
    /// The springs.
    pub springs: Vec<Spring>,
}

/// A spring between a motor and its joint, on the side of the joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// Its joint.
    pub joint: JointIndex,
    /// The name of its stiffness.
    pub name: String,
    /// Its stiffness [N m/rad, N/m].
    pub stiffness: f64,
    /// The standard deviation of that: as the model states it, or else as of joints.
    pub std: f64,
}

/// Brings the logs' motors to the side of their joints, and gives back the robot with these drives
/// before their springs, and the springs; none if the logs do not have angle and torque of any such
/// motor.
///
/// Positive `motor` of a joint is then an angle on the joint's side, `tau` the torque there.
pub fn before_springs(
    robot: &Robot,
    joints: &[RegressionJoint],
    logs: &mut [&mut [MeasuredLog]],
) -> Option<BeforeSprings> {
    let mut moved: Option<BeforeSprings> = None;
    for (place, (link, _)) in robot.joints().enumerate() {
        let is_complete = |log: &MeasuredLog| {
            log.joints[place].motor.is_some() && log.joints[place].motor_torque.is_some()
        };
        let all = || logs.iter().flat_map(|logs| logs.iter());
        if !joints[place].is_elastic || !all().all(is_complete) {
            logs.iter_mut().flat_map(|logs| logs.iter_mut()).for_each(|log| {
                log.joints[place].motor = None;
            });
            continue;
        }
        let ratio = joints[place].gear_ratio;
        for log in logs.iter_mut().flat_map(|logs| logs.iter_mut()) {
            let own = &mut log.joints[place];
            own.motor.iter_mut().flatten().for_each(|angle| *angle /= ratio);
            own.motor_step = own.motor_step.map(|step| step / ratio.abs());
            let torque = own.motor_torque.iter().flatten().map(|torque| torque * ratio);
            own.tau = Some(torque.collect());
        }
        let BeforeSprings { robot: moved, springs } = moved
            .get_or_insert_with(|| BeforeSprings { robot: robot.clone(), springs: Vec::new() });
        let stiffness = joints[place].spring.clone().filter(|spring| spring.value > 0.0);
        springs.extend(stiffness.map(|SpringStiffness { name, value: stiffness, std }| Spring {
            joint: JointIndex(place),
            name,
            stiffness,
            std: std.unwrap_or(JOINT * stiffness),
        }));
        let Some(drive) = &mut moved.links[link].drive else { continue };
        if let Some(spring) = drive.series_elastic.take() {
            let gear = drive.gear_ratio.unwrap_or_else(|| moved.dag.integer(1));
            let pulleys = moved.dag.div(spring.load_radius, spring.motor_radius);
            drive.gear_ratio = Some(moved.dag.mul(gear, pulleys));
        }
    }
    moved
}
