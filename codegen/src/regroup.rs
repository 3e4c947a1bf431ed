//! Regrouping: matter that two bodies feel alike is given to the one nearer the base.
//!
//! Matter on the axis of a turning joint does not feel the joint's angle, so the mass, the first
//! moment along the axis and K33 of the carried body may as well belong to the carrying one. The
//! whole second moment K of a sliding body does not feel the slide. And a body that only ever turns
//! about its own z axis feels K11 and K22 only by their sum, and K12 not
//! at all. These are the structural null vectors
//! of the regressor, as a map on pseudo-inertias: exact, valid in every tree, and all of it on
//! parameters, so that run-time code has fewer terms and the same values. Torques, energies,
//! momenta and the centre of mass keep their values; what one body feels alone does not.

use crate::expr::Dag;
use crate::kinematics::{Mechanism, Placement};
use crate::number::ratio;
use crate::spatial::{Axis, PseudoInertia};

/// The regrouped mechanism.
pub fn regroup(dag: &mut Dag, mechanism: &Mechanism) -> Mechanism {
    let mut regrouped = mechanism.clone();
    for i in (0..regrouped.bodies.len()).rev() {
        // A massless carrier would gain parameters instead of losing them.
        let carrier = mechanism.bodies[i].parent.filter(|&p| !mechanism.is_massless(dag, p));
        if let Some(parent) = carrier {
            let body = &regrouped.bodies[i];
            let (moved, kept) = split(dag, &body.inertia, body.is_revolute);
            let seat = Placement {
                body: Some(parent),
                turns: body.turns.clone(),
                offset: if body.is_revolute { body.offset } else { [dag.zero(); 3] },
            };
            regrouped.bodies[i].inertia = kept;
            let moved = seat.carry(dag, &moved);
            let total = regrouped.bodies[parent].inertia.add(dag, &moved);
            regrouped.bodies[parent].inertia = total;
        }
    }
    for i in 0..regrouped.bodies.len() {
        if turns_about_z_alone(dag, mechanism, i) {
            let (zero, half) = (dag.zero(), dag.constant(ratio(1, 2)));
            let second = &mut regrouped.bodies[i].inertia.second;
            let sum = dag.add(second[0][0], second[1][1]);
            // What is carried on gets a second moment that no turn about z changes; at the root
            // one entry is one addition less.
            let is_root = mechanism.bodies[i].parent.is_none();
            let equal = dag.mul(half, sum);
            (second[0][0], second[1][1]) = if is_root { (sum, zero) } else { (equal, equal) };
            (second[0][1], second[1][0]) = (zero, zero);
        }
    }
    regrouped
}

/// What the carrier may have, and what the body must keep.
fn split(dag: &Dag, inertia: &PseudoInertia, is_revolute: bool) -> (PseudoInertia, PseudoInertia) {
    let zero = PseudoInertia::zero(dag);
    let (mut moved, mut kept) = (zero, *inertia);
    if is_revolute {
        moved.second[2][2] = inertia.second[2][2];
        moved.first[2] = inertia.first[2];
        moved.mass = inertia.mass;
        kept.second[2][2] = dag.zero();
        kept.first[2] = dag.zero();
        kept.mass = dag.zero();
    } else {
        moved.second = inertia.second;
        kept.second = zero.second;
    }
    (moved, kept)
}

/// Whether the angular velocity of body `i` always lies along its z axis: every joint below it
/// that turns has a parallel axis.
fn turns_about_z_alone(dag: &Dag, mechanism: &Mechanism, i: usize) -> bool {
    let mut turns_between = Vec::new();
    let mut at = Some(i);
    while let Some(j) = at {
        let body = &mechanism.bodies[j];
        let parallel = turns_between.iter().all(|sin| *sin == dag.zero());
        if body.is_revolute && !parallel {
            return false;
        }
        let tilts = body.turns.iter().filter(|turn| turn.axis == Axis::X).map(|turn| turn.sin);
        turns_between.extend(tilts);
        at = body.parent;
    }
    true
}
