//! Matter on the axis of a turning joint: what the body feels of it, its carrier feels alike.
//!
//! The torque of every other joint per unit of mass, of first moment and of second moment on the
//! axis is what the carrier's parameters already have; the joint's own torque is 0. Where the axis
//! is an axis of both link frames, three of the link's ten parameters follow from the other seven
//! and from the carrier's, by a few operations on parameters alone.

use super::inertial::ENTRIES;
use super::link_frames::{LinkShares, Shortcuts};
use crate::expr::{Dag, ExprId};
use crate::kinematics::Placement;
use crate::number::integer;
use crate::spatial::{Turn, Vector, negate};

/// An axis that is, up to sign, an axis of a frame.
pub(super) struct Axle {
    /// The frame's axis.
    axis: usize,
    /// Whether it points the other way.
    is_opposite: bool,
    /// A point of it: the origin of the joint's frame.
    point: Vector,
}

/// Torques of unit matter on an axis.
struct OnAxis {
    mass: ExprId,
    first: ExprId,
    second: ExprId,
}

/// Where the first moments, the diagonal and the rest of the tensor stand among the parameters.
const FIRST: usize = 1;
const DIAGONAL: usize = 4;

/// The place of an entry of the tensor across the diagonal.
fn across(i: usize, j: usize) -> usize {
    6 + i + j
}

impl Axle {
    /// The axis in the link frame of the carrier.
    pub(super) fn of_carrier(dag: &mut Dag, point: Vector, turns: &[Turn]) -> Option<Self> {
        let z = [dag.zero(), dag.zero(), dag.one()];
        let direction = turns.iter().rev().fold(z, |vector, turn| turn.to_parent(dag, vector));
        Self::new(dag, direction, point)
    }

    /// The axis in the link frame of the body, which is placed so in the joint's frame.
    pub(super) fn of_body(dag: &mut Dag, link: &Placement) -> Option<Self> {
        let z = [dag.zero(), dag.zero(), dag.one()];
        let mut turned =
            |vector| link.turns.iter().fold(vector, |vector, turn| turn.to_child(dag, vector));
        let (direction, offset) = (turned(z), turned(link.offset));
        let point = negate(dag, offset);
        Self::new(dag, direction, point)
    }

    fn new(dag: &Dag, direction: Vector, point: Vector) -> Option<Self> {
        let axis = (0..3).find(|&k| direction[k] != dag.zero())?;
        let length = dag.as_constant(direction[axis])?;
        let others = (0..3).filter(|&k| direction[k] != dag.zero()).count();
        let is_opposite = *length == integer(-1);
        (others == 1 && (is_opposite || *length == integer(1))).then_some(Self {
            axis,
            is_opposite,
            point,
        })
    }

    /// Torques of unit matter on the axis, from those of the parameters of the link.
    fn matter(&self, dag: &mut Dag, torques: &[ExprId; ENTRIES]) -> OnAxis {
        let zero = dag.zero();
        let z = [0, 1, 2].map(|k| if k == self.axis { dag.one() } else { zero });
        let second = self.second(dag, torques);
        // s = z at the point: the second moments z r^T + r z^T come with it.
        let first = self.first_without(dag, torques, second);
        let first = dag.add(first, torques[FIRST + self.axis]);
        let first = if self.is_opposite { dag.neg(first) } else { first };
        let mut mass = torques[0];
        for k in 0..3 {
            let moment = dag.mul(self.point[k], torques[FIRST + k]);
            mass = dag.add(mass, moment);
        }
        let around = self.around(dag, torques, second, z);
        OnAxis { mass: dag.add(mass, around), first, second }
    }

    /// Of the second moment z z^T: the tensor 1 - z z^T.
    fn second(&self, dag: &mut Dag, torques: &[ExprId; ENTRIES]) -> ExprId {
        let [i, j] = self.others();
        dag.add(torques[DIAGONAL + i], torques[DIAGONAL + j])
    }

    /// The frame's other two axes.
    fn others(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    /// Of the second moments z r^T + r z^T, r the point.
    fn first_without(&self, dag: &mut Dag, torques: &[ExprId; ENTRIES], second: ExprId) -> ExprId {
        let two = dag.integer(2);
        let along = dag.mul(two, self.point[self.axis]);
        let mut sum = dag.mul(along, second);
        for k in self.others() {
            let product = dag.mul(self.point[k], torques[across(self.axis, k)]);
            sum = dag.sub(sum, product);
        }
        sum
    }

    /// Of the second moments r r^T, r the point.
    fn around(
        &self,
        dag: &mut Dag,
        torques: &[ExprId; ENTRIES],
        second: ExprId,
        z: Vector,
    ) -> ExprId {
        let mut sum = dag.zero();
        for k in 0..3 {
            let own = match z[k] == dag.zero() {
                true => {
                    let [i, j] = [(k + 1) % 3, (k + 2) % 3];
                    dag.add(torques[DIAGONAL + i], torques[DIAGONAL + j])
                }
                false => second,
            };
            let square = dag.mul(self.point[k], self.point[k]);
            let product = dag.mul(square, own);
            sum = dag.add(sum, product);
            for l in k + 1..3 {
                let two = dag.integer(2);
                let pair = dag.mul(self.point[k], self.point[l]);
                let pair = dag.mul(two, pair);
                let product = dag.mul(pair, torques[across(k, l)]);
                sum = dag.sub(sum, product);
            }
        }
        sum
    }

    /// Replaces torques of the body's link by what follows from the carrier's.
    pub(super) fn spare(
        &self,
        dag: &mut Dag,
        shares: &mut LinkShares,
        seat: &Self,
        carrier: &[(usize, [ExprId; ENTRIES])],
        shortcuts: Shortcuts,
    ) {
        let zero = dag.zero();
        for (joint, torques) in shares {
            let on_axis = match carrier.iter().find(|(other, _)| other == joint) {
                Some((_, of_carrier)) => seat.matter(dag, of_carrier),
                None => OnAxis { mass: zero, first: zero, second: zero },
            };
            let [i, j] = self.others();
            if shortcuts.second {
                let (kept, derived) = (i.min(j), i.max(j));
                torques[DIAGONAL + derived] = dag.sub(on_axis.second, torques[DIAGONAL + kept]);
            }
            if shortcuts.first {
                let first = match self.is_opposite {
                    true => dag.neg(on_axis.first),
                    false => on_axis.first,
                };
                let rest = self.first_without(dag, torques, on_axis.second);
                torques[FIRST + self.axis] = dag.sub(first, rest);
            }
            if shortcuts.mass {
                let mut rest = zero;
                for k in 0..3 {
                    let moment = dag.mul(self.point[k], torques[FIRST + k]);
                    rest = dag.add(rest, moment);
                }
                let z = [0, 1, 2].map(|k| if k == self.axis { dag.one() } else { zero });
                let around = self.around(dag, torques, on_axis.second, z);
                let rest = dag.add(rest, around);
                torques[0] = dag.sub(on_axis.mass, rest);
            }
        }
    }
}
