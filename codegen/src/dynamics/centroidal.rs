//! Momentum of all bodies about their centre of mass: its matrix, and its derivative by time.
//!
//! As in `momentum`, rotors of drives do not count: they turn about axes that the bodies carry, and
//! only the mass matrix has them.

use super::composite::{composites, unit_wrench};
use super::energy;
use super::inverse::{Wrench, accumulate, body_wrenches};
use super::motion::{Terms, motion};
use crate::expr::{Dag, ExprId};
use crate::kinematics::{Frames, World};
use crate::spatial::{PseudoInertia, Vector, add, cross, scale, subtract, zero};

/// The wrench that moves all bodies, about the origin of frame 0, in its coordinates.
pub(super) fn total_wrench(dag: &mut Dag, frames: &Frames, terms: Terms) -> Wrench {
    let motion = motion(dag, frames, terms, None);
    let own = body_wrenches(dag, frames, &motion);
    let carried = accumulate(dag, frames, own);
    let nothing = Wrench { force: zero(dag), moment: zero(dag) };
    let roots = (0..frames.len()).filter(|&i| frames.frames[i].parent.is_none());
    roots.fold(nothing, |sum, root| {
        let wrench = carried[root].to_parent(dag, frames, root);
        sum.add(dag, wrench)
    })
}

/// Acceleration of the centre of mass, in frame 0.
pub(super) fn center_of_mass_acceleration(
    dag: &mut Dag,
    frames: &Frames,
    accelerations: bool,
) -> Vector {
    let fractions = energy::per_total_mass(dag, frames);
    let terms = Terms { rates: true, accelerations, gravity: false };
    total_wrench(dag, &fractions, terms).force
}

/// A, 6 x n, row by row: A qd is linear momentum, then angular momentum about the centre of mass.
///
/// A column is the momentum of what its joint carries at a unit velocity: the composite's unit
/// wrench, brought to the centre of mass.
pub(super) fn momentum_matrix(dag: &mut Dag, frames: &Frames) -> Vec<ExprId> {
    let composites = composites(dag, frames);
    let world = World::new(dag, frames);
    let (mass, first) = energy::matter_in_base(dag, frames, &composites);
    let one = dag.one();
    let share = dag.div(one, mass);
    let center = scale(dag, share, first);
    let columns: Vec<[Vector; 2]> = (0..frames.len())
        .map(|j| {
            let unit = unit_wrench(dag, frames, j, &composites[j]);
            let linear = world.vector(dag, Some(j), unit.force);
            let spin = world.vector(dag, Some(j), unit.moment);
            if !frames.frames[j].is_revolute && carries_all(dag, frames, j) {
                return [linear, zero(dag)];
            }
            let lever = subtract(dag, world.origin(j), center);
            let orbital = cross(dag, lever, linear);
            [linear, add(dag, spin, orbital)]
        })
        .collect();
    let row = |k: usize| columns.iter().map(move |column| column[k / 3][k % 3]);
    (0..6).flat_map(row).collect()
}

/// Whether a joint carries all matter: where it slides, nothing turns about the centre of mass.
fn carries_all(dag: &Dag, frames: &Frames, j: usize) -> bool {
    let nothing = PseudoInertia::zero(dag);
    let is_carried = |i: usize| frames.chain(i).any(|on| on == j);
    (0..frames.len()).all(|i| is_carried(i) || frames.frames[i].inertia == nothing)
}

/// (d/dt A) qd: the derivative of the momentum at qdd = 0.
pub(super) fn momentum_bias(dag: &mut Dag, frames: &Frames) -> Vec<ExprId> {
    let terms = Terms { rates: true, accelerations: false, gravity: false };
    let wrench = total_wrench(dag, frames, terms);
    let center = energy::center_of_mass(dag, frames);
    let orbital = cross(dag, center, wrench.force);
    [wrench.force, subtract(dag, wrench.moment, orbital)].concat()
}
