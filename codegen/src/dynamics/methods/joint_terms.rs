//! What a joint asks of its drive besides the bodies, as laws of force (thesis 3.14-3.17): for the
//! methods that balance forces. [`lagrange`](super::lagrange) finds the same from energies.

use crate::expr::{Dag, ExprId, Relation, UnaryFunction};
use crate::model::{Drive, Link, Robot, Side};

/// The inertia of each joint's rotor, seen from the joint: tau_joint = N tau_motor and
/// theta_motor = N q give N^2 Ia.
pub(super) fn reflected_inertias(dag: &mut Dag, robot: &Robot) -> Vec<ExprId> {
    let drives = robot.joints().map(|(link, _)| stiff_drive(&robot.links[link]));
    drives
        .map(|drive| match drive.rotor_inertia.filter(|_| robot.terms.rotor) {
            Some(inertia) => reflect(dag, &drive, inertia),
            None => dag.zero(),
        })
        .collect()
}

/// The torque that friction, damping, springs and offset of each joint ask for.
pub(super) fn drive_torques(dag: &mut Dag, robot: &Robot) -> Vec<ExprId> {
    robot
        .joints()
        .map(|(link, _)| {
            let link = &robot.links[link];
            let friction = if robot.terms.friction { friction(dag, link) } else { dag.zero() };
            let springs = if robot.terms.spring { springs(dag, link) } else { dag.zero() };
            let sum = dag.add(friction, springs);
            let offset = link.drive.and_then(|drive| drive.offset).unwrap_or_else(|| dag.zero());
            dag.add(sum, offset)
        })
        .collect()
}

/// The drive as the joint feels it through a stiff gear; behind a series spring, nothing.
pub(super) fn stiff_drive(link: &Link) -> Drive {
    link.drive.filter(|drive| drive.series_elastic.is_none()).unwrap_or_default()
}

/// `N^2 x`, or x without a gear.
pub(super) fn reflect(dag: &mut Dag, drive: &Drive, x: ExprId) -> ExprId {
    match drive.gear_ratio {
        Some(ratio) => {
            let square = dag.mul(ratio, ratio);
            dag.mul(square, x)
        }
        None => x,
    }
}

/// `|N| x`, or x without a gear.
pub(super) fn reflect_once(dag: &mut Dag, drive: &Drive, x: ExprId) -> ExprId {
    match drive.gear_ratio {
        Some(ratio) => {
            let size = dag.unary(UnaryFunction::Abs, ratio);
            dag.mul(size, x)
        }
        None => x,
    }
}

/// `(N^2 fv + damping) qd + |N| fc sign(qd)`.
fn friction(dag: &mut Dag, link: &Link) -> ExprId {
    let (Some(variables), drive) = (link.joint.variables, stiff_drive(link)) else {
        return dag.zero();
    };
    let viscous = drive.viscous.map_or(dag.zero(), |viscous| reflect(dag, &drive, viscous));
    let coefficient = dag.add(viscous, link.joint.damping.unwrap_or_else(|| dag.zero()));
    let smooth = dag.mul(coefficient, variables.qd);
    let coulomb = drive.coulomb.map_or(dag.zero(), |coulomb| reflect_once(dag, &drive, coulomb));
    let sign = dag.unary(UnaryFunction::Sign, variables.qd);
    let dry = dag.mul(coulomb, sign);
    dag.add(smooth, dry)
}

/// `ks (q - qs)`, and `kr (q - qr)` on one side of qr.
fn springs(dag: &mut Dag, link: &Link) -> ExprId {
    let zero = dag.zero();
    let Some(variables) = link.joint.variables else { return zero };
    let mut torque = zero;
    if let Some(spring) = link.joint.spring {
        let stretch = dag.sub(variables.q, spring.angle);
        torque = dag.mul(spring.stiffness, stretch);
    }
    if let Some(spring) = link.drive.and_then(|drive| drive.return_spring) {
        let stretch = dag.sub(variables.q, spring.angle);
        let pull = dag.mul(spring.stiffness, stretch);
        let (left, right) = acting_side(spring.side, variables.q, spring.angle);
        let one_sided = dag.select(Relation::Less, left, right, pull, zero);
        torque = dag.add(torque, one_sided);
    }
    torque
}

/// The sides of the inequality `left < right` under which a one-sided spring acts.
pub(super) fn acting_side(side: Side, q: ExprId, angle: ExprId) -> (ExprId, ExprId) {
    match side {
        Side::Above => (angle, q),
        Side::Below => (q, angle),
    }
}
