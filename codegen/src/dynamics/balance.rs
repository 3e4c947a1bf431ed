//! Points of the ground plane that tell how a robot keeps its balance.
//!
//! The plane goes through a point p0 and has the normal n, of any length. With F and M the force
//! and the moment (about the origin) that the ground must give, the moment about a point z of the
//! plane is along n where n x (M - z x F) = 0, so that z = (n x M + F (n . p0)) / (n . F).

use super::candidate::Candidate;
use super::centroidal::{center_of_mass_acceleration, total_wrench};
use super::composite::to_parent;
use super::energy;
use super::inverse::Wrench;
use crate::expr::{Dag, ExprId, UnaryFunction};
use crate::kinematics::Mechanism;
use crate::model::{LinkId, Robot};
use crate::spatial::{Vector, add, cross, dot, negate, scale, subtract};

/// The point of the plane where the ground can give a wrench by a force, and a moment along its
/// normal.
fn acting_point(dag: &mut Dag, robot: &Robot, wrench: Wrench) -> Vector {
    let (normal, point) = (robot.ground.normal, robot.ground.point);
    let distance = dot(dag, normal, point);
    let turning = cross(dag, normal, wrench.moment);
    let carried = scale(dag, distance, wrench.force);
    let sum = add(dag, turning, carried);
    let pressing = dot(dag, normal, wrench.force);
    let one = dag.one();
    let share = dag.div(one, pressing);
    scale(dag, share, sum)
}

/// The point where gravity and inertia of all bodies have no moment but along the normal.
pub(super) fn zero_moment_point(dag: &mut Dag, candidate: &Candidate<'_>) -> Vector {
    let wrench = total_wrench(dag, candidate.frames, candidate.terms());
    acting_point(dag, candidate.robot, wrench)
}

/// The same, where the rigid body that carries the link has its weight but rests.
///
/// Its own matter is that of the table: regrouping has given a part of it to the body before. What
/// regrouping made of the foot, less the foot's own matter, moves; the difference is a matter of
/// parameters alone.
pub(super) fn foot_rotation_indicator(
    dag: &mut Dag,
    candidate: &Candidate<'_>,
    link: LinkId,
) -> Vector {
    let frames = candidate.frames;
    let foot = candidate.mechanism.placements[link].body.expect("the link is on a body");
    let mut own = Mechanism::new(dag, candidate.robot).bodies[foot].inertia;
    let minus = dag.integer(-1);
    let taken = own.scaled(dag, minus);
    let mut rest = candidate.mechanism.bodies[foot].inertia.add(dag, &taken);
    if let Some(turn) = frames.frames[foot].attachment {
        (own, rest) = (own.turned(dag, &turn), rest.turned(dag, &turn));
    }
    let mut others = frames.clone();
    others.frames[foot].inertia = rest;
    let terms = candidate.terms();
    let mut wrench = total_wrench(dag, &others, terms);
    if terms.gravity {
        let carried = frames.chain(foot).fold(own, |own, i| to_parent(dag, frames, i, &own));
        let lift = negate(dag, frames.gravity);
        let force = scale(dag, carried.mass, lift);
        let moment = cross(dag, carried.first, lift);
        wrench = wrench.add(dag, Wrench { force, moment });
    }
    acting_point(dag, candidate.robot, wrench)
}

/// The centre of mass above the ground.
struct Pendulum {
    /// Its foot of the perpendicular on the plane.
    foot: Vector,
    /// Height over gravity, both along the normal: h / g [s^2].
    square_time: ExprId,
}

fn pendulum(dag: &mut Dag, candidate: &Candidate<'_>) -> Pendulum {
    let robot = candidate.robot;
    let center = energy::center_of_mass(dag, candidate.frames);
    let above = subtract(dag, center, robot.ground.point);
    let height = dot(dag, robot.ground.normal, above);
    let falling = dot(dag, robot.ground.normal, robot.gravity);
    let pressing = dag.neg(falling);
    let one = dag.one();
    let share = dag.div(one, pressing);
    let along = tangential(dag, robot, above);
    let foot = add(dag, robot.ground.point, along);
    Pendulum { foot, square_time: dag.mul(share, height) }
}

/// The part of a vector along the ground.
fn tangential(dag: &mut Dag, robot: &Robot, vector: Vector) -> Vector {
    let normal = robot.ground.normal;
    let square = dot(dag, normal, normal);
    let one = dag.one();
    let share = dag.div(one, square);
    let direction = scale(dag, share, normal);
    let size = dot(dag, normal, vector);
    let across = scale(dag, size, direction);
    subtract(dag, vector, across)
}

/// The zero-moment point of all mass in the centre of mass, which keeps its height.
pub(super) fn cart_table_zmp(dag: &mut Dag, candidate: &Candidate<'_>) -> Vector {
    let robot = candidate.robot;
    let Pendulum { foot, square_time } = pendulum(dag, candidate);
    let acceleration = center_of_mass_acceleration(dag, candidate.frames, true);
    let acceleration = tangential(dag, robot, acceleration);
    let gravity = tangential(dag, robot, robot.gravity);
    let falling = subtract(dag, gravity, acceleration);
    let shift = scale(dag, square_time, falling);
    add(dag, foot, shift)
}

/// Where the linear inverted pendulum comes to rest if it is supported there.
pub(super) fn capture_point(dag: &mut Dag, candidate: &Candidate<'_>) -> Vector {
    let robot = candidate.robot;
    let Pendulum { foot, square_time } = pendulum(dag, candidate);
    let fractions = energy::per_total_mass(dag, candidate.frames);
    let [velocity, _] = energy::momentum(dag, &fractions);
    let velocity = tangential(dag, robot, velocity);
    let time = dag.unary(UnaryFunction::Sqrt, square_time);
    let moved = scale(dag, time, velocity);
    let gravity = tangential(dag, robot, robot.gravity);
    let hanging = scale(dag, square_time, gravity);
    let resting = add(dag, foot, hanging);
    add(dag, resting, moved)
}
