//! Points of bodies that are fixed in space, as far as the table says for every posture.
//!
//! Where joint axes meet, what turns about all of them turns about the point where they meet: a
//! mass there never moves, nor does a pair of opposite masses beside it, to first order. Without
//! weight they are not felt.

use super::turning::{is_along_z, to_child, to_parent};
use crate::expr::{Dag, ExprId};
use crate::fundamental::canonical_generic;
use crate::kinematics::Mechanism;
use crate::model::Terms;
use crate::spatial::{PseudoInertia, Vector, dot, scale, subtract};

/// A point in homogeneous coordinates of a body's frame: `scaled` divided by `scale` \[m\], so that
/// no coordinate is a quotient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Point {
    /// The coordinates times the scale.
    pub scaled: Vector,
    /// The scale, which is not 0.
    pub scale: ExprId,
}

/// What of a body is fixed in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Still {
    Nothing,
    At(Point),
    /// Every point on the z axis of its frame.
    Axis,
}

/// For every body a point that is fixed in space, if it has one.
fn still_points(dag: &mut Dag, mechanism: &Mechanism) -> Vec<Option<Point>> {
    let mut found: Vec<Still> = Vec::new();
    for body in &mechanism.bodies {
        let own = match body.parent.map_or(Still::Axis, |parent| found[parent]) {
            _ if !body.is_revolute => Still::Nothing,
            _ if body.parent.is_none() => Still::Axis,
            Still::Nothing => Still::Nothing,
            Still::At(point) => {
                let offset = scale(dag, point.scale, body.offset);
                let from_origin = subtract(dag, point.scaled, offset);
                let scaled = to_child(dag, &body.turns, from_origin);
                match vanish(dag, &scaled[..2]) {
                    true => Still::At(Point { scaled, ..point }),
                    false => Still::Nothing,
                }
            }
            Still::Axis => {
                let z = [dag.zero(), dag.zero(), dag.one()];
                let axis = to_parent(dag, &body.turns, z);
                meeting(dag, axis, body.offset)
            }
        };
        found.push(own);
    }
    let origin = Point { scaled: [dag.zero(); 3], scale: dag.one() };
    let point = |still| match still {
        Still::Nothing => None,
        Still::At(point) => Some(point),
        Still::Axis => Some(origin),
    };
    found.into_iter().map(point).collect()
}

/// The still points that matter: none where there is weight to be felt.
pub(super) fn still_without_weight(
    dag: &mut Dag,
    mechanism: &Mechanism,
    terms: Terms,
) -> Vec<Option<Point>> {
    match terms.gravity && mechanism.gravity != [dag.zero(); 3] {
        true => vec![None; mechanism.bodies.len()],
        false => still_points(dag, mechanism),
    }
}

/// What of a body is still that turns about a line along `axis` through `offset`, both in the
/// coordinates of a carrier whose z axis is still.
fn meeting(dag: &mut Dag, axis: Vector, offset: Vector) -> Still {
    if is_along_z(dag, axis) {
        return if vanish(dag, &offset[..2]) { Still::Axis } else { Still::Nothing };
    }
    let origin = Point { scaled: [dag.zero(); 3], scale: dag.one() };
    if vanish(dag, &offset[..2]) {
        return Still::At(origin);
    }
    let [along, across] =
        [[axis[0], axis[1]], [axis[1], dag.neg(axis[0])]].map(|[x, y]| [x, y, dag.zero()]);
    let apart = dot(dag, across, offset);
    if !vanish(dag, &[apart]) {
        return Still::Nothing;
    }
    // offset + u axis is on the z axis for u = -(along . offset) / (along . along)
    let (shift, size) = (dot(dag, along, offset), dot(dag, along, along));
    Still::At(Point { scaled: [dag.zero(), dag.zero(), dag.neg(shift)], scale: size })
}

/// Whether all of these are 0, of which only an exact form can tell.
fn vanish(dag: &mut Dag, exprs: &[ExprId]) -> bool {
    canonical_generic(dag, exprs).is_ok_and(|forms| forms.iter().all(|form| form.is_zero()))
}

/// What is not felt of matter at a still point: a mass, and a pair of opposite masses along each
/// axis of the frame.
pub(super) fn unfelt(dag: &mut Dag, point: Point) -> Vec<PseudoInertia> {
    let Point { scaled, scale } = point;
    let mut mass = PseudoInertia::zero(dag);
    mass.mass = dag.mul(scale, scale);
    for i in 0..3 {
        mass.first[i] = dag.mul(scale, scaled[i]);
        for j in 0..3 {
            mass.second[i][j] = dag.mul(scaled[i], scaled[j]);
        }
    }
    let mut list = vec![mass];
    for axis in 0..3 {
        let mut pair = PseudoInertia::zero(dag);
        pair.first[axis] = scale;
        for i in 0..3 {
            pair.second[axis][i] = dag.add(pair.second[axis][i], scaled[i]);
            pair.second[i][axis] = dag.add(pair.second[i][axis], scaled[i]);
        }
        list.push(pair);
    }
    list
}

/// The second moments of matter about a still point, times the square of its scale: all that is
/// felt of it.
pub(super) fn felt(dag: &mut Dag, point: Point, matter: &PseudoInertia) -> Vec<ExprId> {
    let Point { scaled, scale } = point;
    let square = dag.mul(scale, scale);
    let mut list = Vec::new();
    for i in 0..3 {
        for j in i..3 {
            // w^2 K - w (s x^T + x s^T) + m x x^T
            let second = dag.mul(square, matter.second[i][j]);
            let (a, b) = (dag.mul(matter.first[i], scaled[j]), dag.mul(scaled[i], matter.first[j]));
            let sum = dag.add(a, b);
            let first = dag.mul(scale, sum);
            let product = dag.mul(scaled[i], scaled[j]);
            let zeroth = dag.mul(matter.mass, product);
            let rest = dag.sub(zeroth, first);
            list.push(dag.add(second, rest));
        }
    }
    list
}
