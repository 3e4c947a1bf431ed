//! How each body can turn and where its axis can be, as far as the table says for every posture.

use crate::expr::{Dag, ExprId};
use crate::kinematics::Mechanism;
use crate::number::ratio;
use crate::spatial::{PseudoInertia, Turn, Vector};
use std::collections::BTreeSet;

/// What the angular velocity of a body can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Turning {
    /// Always 0.
    Never,
    /// Always along one axis, fixed in the body: given in its frame.
    About(Vector),
    /// More than that.
    Freely,
}

/// The turning of every body.
pub(super) fn turnings(dag: &mut Dag, mechanism: &Mechanism) -> Vec<Turning> {
    let mut result: Vec<Turning> = Vec::new();
    for body in &mechanism.bodies {
        let carried = body.parent.map_or(Turning::Never, |p| result[p]);
        let at_seat = match carried {
            Turning::About(axis) => Turning::About(to_child(dag, &body.turns, axis)),
            other => other,
        };
        result.push(match at_seat {
            Turning::Never if body.is_revolute => {
                Turning::About([dag.zero(), dag.zero(), dag.one()])
            }
            Turning::About(axis) if body.is_revolute && !is_along_z(dag, axis) => Turning::Freely,
            other => other,
        });
    }
    result
}

/// The constant parts of all angles of the table.
pub(super) fn table_angles(mechanism: &Mechanism) -> BTreeSet<ExprId> {
    let turns = mechanism.bodies.iter().flat_map(|body| &body.turns);
    let of_links = mechanism.placements.values().flat_map(|place| &place.turns);
    turns.chain(of_links).map(|turn| turn.angle).collect()
}

/// Whether a vector lies along z.
pub(super) fn is_along_z(dag: &Dag, v: Vector) -> bool {
    v[0] == dag.zero() && v[1] == dag.zero()
}

/// A vector from the coordinates before a list of turns to those after.
pub(super) fn to_child(dag: &mut Dag, turns: &[Turn], vector: Vector) -> Vector {
    turns.iter().fold(vector, |vector, turn| turn.to_child(dag, vector))
}

/// A vector from the coordinates after a list of turns to those before.
pub(super) fn to_parent(dag: &mut Dag, turns: &[Turn], vector: Vector) -> Vector {
    turns.iter().rev().fold(vector, |vector, turn| turn.to_parent(dag, vector))
}

/// Matter from the coordinates before a list of turns to those after.
pub(super) fn unturned(dag: &mut Dag, turns: &[Turn], matter: PseudoInertia) -> PseudoInertia {
    turns.iter().fold(matter, |matter, turn| {
        let back =
            Turn { angle: dag.neg(turn.angle), cos: turn.cos, sin: dag.neg(turn.sin), ..*turn };
        matter.turned(dag, &back)
    })
}

/// Matter that turns about an axis, given in a frame whose z axis is the axis, in the body's frame.
/// The axis comes from the nearest turning joint below, so it is reached through slides alone.
pub(super) fn from_axis(
    dag: &mut Dag,
    mechanism: &Mechanism,
    body: usize,
    matter: PseudoInertia,
) -> PseudoInertia {
    let mut path = Vec::new();
    let mut at = body;
    while !mechanism.bodies[at].is_revolute {
        path.push(at);
        match mechanism.bodies[at].parent {
            Some(parent) => at = parent,
            None => break,
        }
    }
    path.iter()
        .rev()
        .fold(matter, |matter, &slide| unturned(dag, &mechanism.bodies[slide].turns, matter))
}

/// Whether a body moves like a screw about a line that is fixed in space: the z axis of its frame.
pub(super) fn screws(dag: &mut Dag, mechanism: &Mechanism, turnings: &[Turning]) -> Vec<bool> {
    let mut result: Vec<bool> = Vec::new();
    for body in &mechanism.bodies {
        let z = [dag.zero(), dag.zero(), dag.one()];
        let axis = to_parent(dag, &body.turns, z);
        let is_screw = match body.parent {
            None => true,
            Some(p) => {
                // Where the carrier only slides along the axis, the line may be anywhere on it.
                let on_line = turnings[p] == Turning::Never || is_along_z(dag, body.offset);
                result[p] && is_along_z(dag, axis) && on_line
            }
        };
        result.push(is_screw);
    }
    result
}

/// Whether the carrier of joint `j` never moves along the joint's axis: what carries it slides
/// across it and turns about it alone.
pub(super) fn seat_is_still(dag: &mut Dag, mechanism: &Mechanism, j: usize) -> bool {
    let mut axis = [dag.zero(), dag.zero(), dag.one()];
    axis = to_parent(dag, &mechanism.bodies[j].turns, axis);
    let mut at = mechanism.bodies[j].parent;
    while let Some(i) = at {
        let body = &mechanism.bodies[i];
        let passes = if body.is_revolute { is_along_z(dag, axis) } else { axis[2] == dag.zero() };
        if !passes {
            return false;
        }
        axis = to_parent(dag, &body.turns, axis);
        at = body.parent;
    }
    true
}

/// Gravity in the seat of body `j` at q = 0. Where all joints below slide, or turn about axes along
/// that of `j`, its component along the axis is the same in every posture.
pub(super) fn gravity_at_seat(dag: &mut Dag, mechanism: &Mechanism, j: usize) -> Vector {
    let path: Vec<usize> =
        std::iter::successors(Some(j), |&body| mechanism.bodies[body].parent).collect();
    path.iter().rev().fold(mechanism.gravity, |vector, &body| {
        to_child(dag, &mechanism.bodies[body].turns, vector)
    })
}

/// Whether turning joint `j` is alone with its motion: the angular velocity of its carrier has
/// never a component along its axis, so that its rotor is felt like matter of its body.
pub(super) fn is_alone(
    dag: &mut Dag,
    mechanism: &Mechanism,
    turnings: &[Turning],
    j: usize,
) -> bool {
    let body = &mechanism.bodies[j];
    match body.parent.map_or(Turning::Never, |parent| turnings[parent]) {
        Turning::Never => true,
        Turning::About(axis) => to_child(dag, &body.turns, axis)[2] == dag.zero(),
        Turning::Freely => false,
    }
}

/// Matter that turns about z like a rotor of the given inertia about z: J = inertia z z^T.
pub(super) fn like_rotor(dag: &mut Dag, inertia: ExprId) -> PseudoInertia {
    let half = dag.constant(ratio(1, 2));
    let part = dag.mul(half, inertia);
    let mut matter = PseudoInertia::zero(dag);
    for (axis, sign) in [(0, false), (1, false), (2, true)] {
        matter.second[axis][axis] = if sign { dag.neg(part) } else { part };
    }
    matter
}
