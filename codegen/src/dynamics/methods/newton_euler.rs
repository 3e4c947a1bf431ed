//! Newton-Euler with explicit joint constraints (thesis 2.2.1, appendix A.1.1), for any tree in
//! three dimensions.
//!
//! Each link has six coordinates of its own. For each there are six equations of balance (A.1-A.6,
//! with the Euler term that (2.5) lacks in space), in which the joints appear as unknown wrenches,
//! and for each joint the equations that hold its two links together (A.7-A.10), differentiated
//! twice (A.11-A.14). [`eliminate`] solves them for accelerations and constraint wrenches, and the
//! wrench along the axis of a joint is what its drive has to give. [`dae`] hands out the equations
//! before elimination.

mod dae;

pub use dae::{BodySymbols, Dae, dae};

use super::extract::RigidBody;
use super::frames::{Coordinates, Placement, central_tensor, free_fall, placements};
use super::linear::{apply, multiply};
use super::{Method, MethodResult};
use crate::arena::Handle;
use crate::expr::Dag;
use crate::model::{Convention, JointKind, JointVariables, Link, LinkId, Robot};
use crate::spatial::{Matrix, Vector, add, cross, scale, subtract, transpose, zero};

/// A link as Newton and Euler see it. World coordinates in SI units; the reference
/// point is the centre of mass, for a link without body its origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinkMotion {
    /// Position of the reference point.
    pub position: Vector,
    /// Link coordinates to world coordinates.
    pub rotation: Matrix,
    /// Velocity of the reference point [m/s].
    pub velocity: Vector,
    /// Angular velocity [rad/s].
    pub angular_velocity: Vector,
    /// Acceleration of the reference point [m/s^2].
    pub acceleration: Vector,
    /// Angular acceleration [rad/s^2].
    pub angular_acceleration: Vector,
}

/// What the carrying link does to the carried one through their joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JointWrench {
    /// The point of the joint, fixed in the carried link.
    pub point: Vector,
    /// Direction of the joint axis.
    pub axis: Vector,
    /// Force on the carried link.
    pub force: Vector,
    /// Moment on the carried link about the point of the joint [N m].
    pub moment: Vector,
}

/// The solution of the equations of all links, in terms of q, qd and qdd.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Elimination {
    /// By link.
    pub motions: Vec<LinkMotion>,
    /// By link: the wrench of the joint that carries it.
    pub wrenches: Vec<JointWrench>,
}

/// Derives the equations of motion by eliminating the constraint wrenches.
pub fn derive(dag: &mut Dag, robot: &Robot) -> MethodResult {
    let Elimination { wrenches, .. } = eliminate(dag, robot);
    let torque = robot
        .joints()
        .map(|(link, _)| {
            let JointWrench { axis, force, moment, .. } = wrenches[link.index()];
            match robot.links[link].joint.kind {
                JointKind::Prismatic => crate::spatial::dot(dag, axis, force),
                JointKind::Revolute | JointKind::Fixed => crate::spatial::dot(dag, axis, moment),
            }
        })
        .collect();
    let at = Coordinates::of(robot);
    RigidBody::from_torque(dag, &at, torque).with_joint_terms(dag, robot, Method::NewtonEuler)
}

/// Solves the constraints for the accelerations, base to tips, and the balances for the joint
/// wrenches, tips to base: the system is block triangular in this order.
pub fn eliminate(dag: &mut Dag, robot: &Robot) -> Elimination {
    let placements = placements(dag, robot);
    let mut motions: Vec<LinkMotion> = Vec::with_capacity(robot.links.len());
    for (id, link) in robot.links.iter() {
        let parent = match link.parent {
            Some(parent) => motions[parent.index()],
            None => ground(dag),
        };
        let motion = solve_constraints(dag, robot, link, &placements[id.index()], &parent);
        motions.push(motion);
    }
    let wrenches = solve_balances(dag, robot, &placements, &motions);
    Elimination { motions, wrenches }
}

/// Frame 0 as a link that rests.
fn ground(dag: &Dag) -> LinkMotion {
    let rest = zero(dag);
    LinkMotion {
        position: rest,
        rotation: super::linear::identity(dag),
        velocity: rest,
        angular_velocity: rest,
        acceleration: rest,
        angular_acceleration: rest,
    }
}

/// The point of the joint: on the axis, and fixed in the carried link.
fn joint_point(robot: &Robot, link: &Link, placement: &Placement) -> Vector {
    match (robot.convention, link.joint.kind) {
        (Convention::Standard, JointKind::Revolute) => placement.joint_origin,
        // a standard prismatic joint carries its own frame along, not frame i-1
        _ => placement.frame.origin,
    }
}

/// The constraint equations of one joint, solved for the motion of the carried link. With s and r
/// from the reference points of parent and link to the point of the joint, axis z, and u the rate
/// at which the joint slides (0 if it turns), f the rate at which it turns (0 if it slides):
///
/// - `w = w_p + f z` and `wd = wd_p + fd z + w_p x f z`
/// - `v + w x r = v_p + w_p x s + u z`
/// - `a + wd x r + w x (w x r) = a_p + wd_p x s + w_p x (w_p x s) + ud z + 2 w_p x u z`
fn solve_constraints(
    dag: &mut Dag,
    robot: &Robot,
    link: &Link,
    placement: &Placement,
    parent: &LinkMotion,
) -> LinkMotion {
    let position = reference_point(dag, link, placement);
    let point = joint_point(robot, link, placement);
    let (s, r) = (subtract(dag, point, parent.position), subtract(dag, point, position));
    let rest = zero(dag);
    let joint_rates = |dag: &mut Dag, kind: JointKind| match link.joint.variables {
        Some(JointVariables { qd, qdd, .. }) if link.joint.kind == kind => {
            [scale(dag, qd, placement.axis), scale(dag, qdd, placement.axis)]
        }
        _ => [rest; 2],
    };
    let [turning, turning_rate] = joint_rates(dag, JointKind::Revolute);
    let [sliding, sliding_rate] = joint_rates(dag, JointKind::Prismatic);

    let angular_velocity = add(dag, parent.angular_velocity, turning);
    let swept = cross(dag, parent.angular_velocity, turning);
    let relative = add(dag, turning_rate, swept);
    let angular_acceleration = add(dag, parent.angular_acceleration, relative);

    let carried = cross(dag, parent.angular_velocity, s);
    let of_point = add(dag, parent.velocity, carried);
    let of_point = add(dag, of_point, sliding);
    let own = cross(dag, angular_velocity, r);
    let velocity = subtract(dag, of_point, own);

    let of_parent = point_acceleration(dag, parent, s);
    let coriolis = cross(dag, parent.angular_velocity, sliding);
    let twice = add(dag, coriolis, coriolis);
    let along = add(dag, sliding_rate, twice);
    let of_point = add(dag, of_parent, along);
    let unknown = LinkMotion {
        position,
        rotation: placement.frame.rotation,
        velocity,
        angular_velocity,
        acceleration: rest,
        angular_acceleration,
    };
    let own = point_acceleration(dag, &unknown, r);
    LinkMotion { acceleration: subtract(dag, of_point, own), ..unknown }
}

/// `a + wd x r + w x (w x r)`.
fn point_acceleration(dag: &mut Dag, link: &LinkMotion, r: Vector) -> Vector {
    let tangential = cross(dag, link.angular_acceleration, r);
    let velocity = cross(dag, link.angular_velocity, r);
    let centripetal = cross(dag, link.angular_velocity, velocity);
    let turning = add(dag, tangential, centripetal);
    add(dag, link.acceleration, turning)
}

fn reference_point(dag: &mut Dag, link: &Link, placement: &Placement) -> Vector {
    match &link.body {
        Some(body) => placement.frame.point(dag, body.com),
        None => placement.frame.origin,
    }
}

/// The balances of all links, solved for the joint wrenches. For a link with reference point x:
///
/// - `m a = m g + f - sum of f_c`
/// - `I wd + w x I w = n + (p - x) x f - sum of (n_c + (p_c - x) x f_c)`
///
/// where f, n act at the link's own joint p and f_c, n_c, with the opposite sign, at the joints
/// p_c of the links that it carries.
fn solve_balances(
    dag: &mut Dag,
    robot: &Robot,
    placements: &[Placement],
    motions: &[LinkMotion],
) -> Vec<JointWrench> {
    let rest = zero(dag);
    let mut wrenches: Vec<JointWrench> = robot
        .links
        .iter()
        .map(|(id, link)| {
            let placement = &placements[id.index()];
            let point = joint_point(robot, link, placement);
            JointWrench { point, axis: placement.axis, force: rest, moment: rest }
        })
        .collect();
    for (id, link) in robot.links.iter().rev() {
        let motion = &motions[id.index()];
        let [mut force, mut moment] = inertial_wrench(dag, robot, link, motion);
        let carried: Vec<LinkId> = robot.tree.children(Some(id)).collect();
        for child in carried {
            let JointWrench { point, force: child_force, moment: child_moment, .. } =
                wrenches[child.index()];
            let arm = subtract(dag, point, motion.position);
            let lever = cross(dag, arm, child_force);
            force = add(dag, force, child_force);
            moment = add(dag, moment, child_moment);
            moment = add(dag, moment, lever);
        }
        let wrench = &mut wrenches[id.index()];
        let arm = subtract(dag, wrench.point, motion.position);
        let lever = cross(dag, arm, force);
        wrench.moment = subtract(dag, moment, lever);
        wrench.force = force;
    }
    wrenches
}

/// `m (a - g)` and `I wd + w x I w`: what the joints of a link must supply together.
fn inertial_wrench(dag: &mut Dag, robot: &Robot, link: &Link, motion: &LinkMotion) -> [Vector; 2] {
    let Some(body) = &link.body else { return [zero(dag); 2] };
    let free_fall = free_fall(dag, robot);
    let falling = subtract(dag, motion.acceleration, free_fall);
    let force = scale(dag, body.mass, falling);
    let central = central_tensor(dag, body);
    let turned = multiply(dag, motion.rotation, central);
    let tensor = multiply(dag, turned, transpose(motion.rotation));
    let accelerated = apply(dag, tensor, motion.angular_acceleration);
    let momentum = apply(dag, tensor, motion.angular_velocity);
    let gyroscopic = cross(dag, motion.angular_velocity, momentum);
    [force, add(dag, accelerated, gyroscopic)]
}
