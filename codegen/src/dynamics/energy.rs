//! Kinetic and potential energy, and momentum.

use super::motion::{multiply, velocities};
use crate::expr::{Dag, ExprId};
use crate::kinematics::{Frames, World};
use crate::number::ratio;
use crate::spatial::{PseudoInertia, Vector, add, cross, dot, scale, subtract, zero};

/// Linear momentum, and angular momentum about the frame's origin, of each body in its frame:
/// p = m v + w x s, L = J w + s x v.
fn body_momenta(dag: &mut Dag, frames: &Frames) -> Vec<[Vector; 4]> {
    let velocities = velocities(dag, frames, true);
    (0..frames.len())
        .map(|i| {
            let (w, v) = velocities[i];
            let inertia = &frames.frames[i].inertia;
            let carried = scale(dag, inertia.mass, v);
            let turning = cross(dag, w, inertia.first);
            let linear = add(dag, carried, turning);
            let tensor = inertia.tensor(dag);
            let spin = multiply(dag, tensor, w);
            let orbital = cross(dag, inertia.first, v);
            [linear, add(dag, spin, orbital), w, v]
        })
        .collect()
}

/// T = sum (p . v + L . w) / 2 over the bodies \[J\]; rotors are added by the caller.
pub(super) fn kinetic_energy(dag: &mut Dag, frames: &Frames) -> ExprId {
    let momenta = body_momenta(dag, frames);
    let mut twice = dag.zero();
    for [linear, angular, w, v] in momenta {
        for (momentum, velocity) in [(linear, v), (angular, w)] {
            let product = dot(dag, momentum, velocity);
            twice = dag.add(twice, product);
        }
    }
    let half = dag.constant(ratio(1, 2));
    dag.mul(half, twice)
}

/// All matter in the coordinates and about the origin of frame 0.
pub(super) fn matter_in_base(
    dag: &mut Dag,
    frames: &Frames,
    composites: &[PseudoInertia],
) -> (ExprId, Vector) {
    let (mut mass, mut first) = (dag.zero(), zero(dag));
    for (i, frame) in frames.frames.iter().enumerate() {
        if frame.parent.is_none() {
            let carried = super::composite::to_parent(dag, frames, i, &composites[i]);
            mass = dag.add(mass, carried.mass);
            first = add(dag, first, carried.first);
        }
    }
    (mass, first)
}

/// P = -g . (sum m o) \[J\].
pub(super) fn potential_energy(
    dag: &mut Dag,
    frames: &Frames,
    composites: &[PseudoInertia],
) -> ExprId {
    let (_, first) = matter_in_base(dag, frames, composites);
    let work = dot(dag, frames.gravity, first);
    dag.neg(work)
}

/// The same frames with all matter divided by the total mass, a parameter: their first moments are
/// the centre of mass, at no cost at run time.
pub(super) fn per_total_mass(dag: &mut Dag, frames: &Frames) -> Frames {
    let total = frames.frames.iter().fold(dag.zero(), |sum, frame| {
        let mass = frame.inertia.mass;
        dag.add(sum, mass)
    });
    let one = dag.one();
    let share = dag.div(one, total);
    let mut scaled = frames.clone();
    for frame in &mut scaled.frames {
        frame.inertia = frame.inertia.scaled(dag, share);
    }
    scaled
}

/// Position of the centre of mass in frame 0 \[m\].
pub(super) fn center_of_mass(dag: &mut Dag, frames: &Frames) -> Vector {
    let fractions = per_total_mass(dag, frames);
    let composites = super::composite::composites(dag, &fractions);
    matter_in_base(dag, &fractions, &composites).1
}

/// Angular momentum of each body about the centre of mass of all, in frame 0 [kg m^2/s].
pub(super) fn angular_momenta(dag: &mut Dag, frames: &Frames) -> Vec<Vector> {
    let momenta = body_momenta(dag, frames);
    let world = World::new(dag, frames);
    let center = center_of_mass(dag, frames);
    let about_center = |(i, [linear, angular, ..]): (usize, [Vector; 4])| {
        let linear = world.vector(dag, Some(i), linear);
        let spin = world.vector(dag, Some(i), angular);
        let lever = subtract(dag, world.origin(i), center);
        let orbital = cross(dag, lever, linear);
        add(dag, spin, orbital)
    };
    momenta.into_iter().enumerate().map(about_center).collect()
}

/// Linear momentum [kg m/s] and angular momentum about the centre of mass [kg m^2/s], in frame 0.
pub(super) fn momentum(dag: &mut Dag, frames: &Frames) -> [Vector; 2] {
    let mut momenta: Vec<(Vector, Vector)> =
        body_momenta(dag, frames).iter().map(|&[linear, angular, ..]| (linear, angular)).collect();
    let (mut linear, mut angular) = (zero(dag), zero(dag));
    for i in (0..frames.len()).rev() {
        let frame = &frames.frames[i];
        let p = frames.to_parent(dag, i, momenta[i].0);
        let spin = frames.to_parent(dag, i, momenta[i].1);
        let orbital = cross(dag, frame.offset, p);
        let l = add(dag, spin, orbital);
        let (sum_p, sum_l) = match frame.parent {
            Some(parent) => (momenta[parent].0, momenta[parent].1),
            None => (linear, angular),
        };
        let sum = (add(dag, sum_p, p), add(dag, sum_l, l));
        match frame.parent {
            Some(parent) => momenta[parent] = sum,
            None => (linear, angular) = sum,
        }
    }
    let com = center_of_mass(dag, frames);
    let orbital = cross(dag, com, linear);
    [linear, subtract(dag, angular, orbital)]
}
