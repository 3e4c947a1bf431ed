//! Lagrange-Euler from energies by symbolic differentiation (thesis 2.6-2.11).
//!
//! No velocity Jacobian and no angular velocity is formed: the kinetic energy of a body is that of
//! its particles, 1/2 integral |d/dt (o + R r)|^2 dm, which in the place of the scalar I of (2.6)
//! has the trace of `Rdot S Rdot^T` with S = integral r r^T dm. Drives and springs enter by their
//! energies too, friction by a dissipation function whose gradient is -Q_nc.

use super::extract::{RigidBody, coriolis_matrix, without};
use super::frames::{Coordinates, Frame, free_fall, placements};
use super::joint_terms::{acting_side, reflect, reflect_once, stiff_drive};
use super::linear::{add_lists, jacobian, partial, rate};
use super::{Method, MethodResult};
use crate::arena::Handle;
use crate::expr::{Dag, ExprId, Relation, UnaryFunction};
use crate::model::{About, Body, Link, Robot};
use crate::number::ratio;
use crate::spatial::{Matrix, Vector, dot};

/// The energies of a robot, and its dissipation function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Energies {
    /// Kinetic energy of the bodies, in joules.
    pub bodies: ExprId,
    /// Kinetic energy of the rotors about their axes: `1/2 Ia (N qd)^2` each, in joules.
    pub rotors: ExprId,
    /// Potential energy of gravity in joules: `-sum m g . o_c`, with g the acceleration of free
    /// fall.
    pub gravity: ExprId,
    /// Potential energy of springs across joints (2.8), in joules.
    pub springs: ExprId,
    /// Potential of the constant offsets of the drives, in joules.
    pub offsets: ExprId,
    /// Dissipation function R, in watts: the non-conservative forces of friction are -dR/dqd.
    pub dissipation: ExprId,
}

/// Derives the equations of motion from the energies.
pub fn derive(dag: &mut Dag, robot: &Robot) -> MethodResult {
    let at = Coordinates::of(robot);
    let energies = energies(dag, robot);
    let zero = dag.zero();

    let momentum = gradient(dag, energies.bodies, &at.qd);
    let moving = euler_lagrange(dag, &at, energies.bodies, &momentum);
    let gravity = gradient(dag, energies.gravity, &at.q);
    let unaccelerated = without(dag, &moving, &at.qdd);
    let rigid = RigidBody {
        mass_matrix: jacobian(dag, &momentum, &at.qd),
        coriolis_matrix: coriolis_matrix(dag, &at, &unaccelerated),
        torque: add_lists(dag, &moving, &gravity),
        gravity,
    };
    let rigid = rigid.restricted(dag, &at, robot.terms);

    let rotors = if robot.terms.rotor { energies.rotors } else { zero };
    let rotor_momentum = gradient(dag, rotors, &at.qd);
    let rotor_mass = jacobian(dag, &rotor_momentum, &at.qd);
    let rotor_torque = euler_lagrange(dag, &at, rotors, &rotor_momentum);

    let springs = if robot.terms.spring { energies.springs } else { zero };
    let potential = dag.add(springs, energies.offsets);
    let elastic = gradient(dag, potential, &at.q);
    let dissipation = if robot.terms.friction { energies.dissipation } else { zero };
    let friction = gradient(dag, dissipation, &at.qd);
    let drive_torque = add_lists(dag, &elastic, &friction);

    let accelerated = add_lists(dag, &rigid.torque, &rotor_torque);
    let rows = rigid.mass_matrix.iter().zip(&rotor_mass);
    MethodResult {
        method: Method::Lagrange,
        mass_matrix: rows.map(|(body, rotor)| add_lists(dag, body, rotor)).collect(),
        coriolis_matrix: rigid.coriolis_matrix,
        gravity: rigid.gravity,
        inverse_dynamics: add_lists(dag, &accelerated, &drive_torque),
        drive_torque,
    }
}

/// The energies of `robot` as expressions in q and qd.
pub fn energies(dag: &mut Dag, robot: &Robot) -> Energies {
    let at = Coordinates::of(robot);
    let zero = dag.zero();
    let mut sums = Energies {
        bodies: zero,
        rotors: zero,
        gravity: zero,
        springs: zero,
        offsets: zero,
        dissipation: zero,
    };
    let (placements, free_fall) = (placements(dag, robot), free_fall(dag, robot));
    for (id, link) in robot.links.iter() {
        if let Some(body) = &link.body {
            let frame = &placements[id.index()].frame;
            let kinetic = kinetic_energy(dag, &at, frame, body);
            sums.bodies = dag.add(sums.bodies, kinetic);
            let center = frame.point(dag, body.com);
            let height = dot(dag, free_fall, center);
            let weight = dag.mul(body.mass, height);
            sums.gravity = dag.sub(sums.gravity, weight);
        }
        add_joint_energies(dag, link, &mut sums);
    }
    sums
}

/// 1/2 m |d/dt p|^2 + 1/2 tr(Rdot S Rdot^T) about the centre of mass p; about the origin o of the
/// link frame there is the cross term m d/dt o . Rdot c besides.
fn kinetic_energy(dag: &mut Dag, at: &Coordinates, frame: &Frame, body: &Body) -> ExprId {
    let point = match body.about {
        About::Com => frame.point(dag, body.com),
        About::Origin => frame.origin,
    };
    let entries = [&point[..], &frame.rotation.concat()[..]].concat();
    let rates = rate(dag, &entries, &at.q, &at.qd);
    let velocity: Vector = [rates[0], rates[1], rates[2]];
    let turning: Matrix = [0, 1, 2].map(|row| [0, 1, 2].map(|column| rates[3 + 3 * row + column]));

    let square = dot(dag, velocity, velocity);
    let mut doubled = dag.mul(body.mass, square);
    let spread = second_moments(dag, body);
    for row in turning {
        let weighted = spread.map(|column| dot(dag, column, row));
        let turned = dot(dag, weighted, row);
        doubled = dag.add(doubled, turned);
    }
    if body.about == About::Origin {
        let arm = turning.map(|row| dot(dag, row, body.com));
        let cross_term = dot(dag, velocity, arm);
        let twice_mass = dag.add(body.mass, body.mass);
        let product = dag.mul(twice_mass, cross_term);
        doubled = dag.add(doubled, product);
    }
    halved(dag, doubled)
}

/// S = integral of r r^T dm about the tensor's own point: tr(I)/2 1 - I.
fn second_moments(dag: &mut Dag, body: &Body) -> Matrix {
    let [xx, yy, zz, xy, xz, yz] = body.inertia;
    let [xy, xz, yz] = [xy, xz, yz].map(|product| dag.neg(product));
    let mut diagonal = |plus: [ExprId; 2], minus: ExprId| {
        let sum = dag.add(plus[0], plus[1]);
        let difference = dag.sub(sum, minus);
        halved(dag, difference)
    };
    let (sxx, syy, szz) = (diagonal([yy, zz], xx), diagonal([xx, zz], yy), diagonal([xx, yy], zz));
    [[sxx, xy, xz], [xy, syy, yz], [xz, yz, szz]]
}

/// Adds the energies of a joint's rotor, springs and offset, and the dissipation of its friction.
fn add_joint_energies(dag: &mut Dag, link: &Link, sums: &mut Energies) {
    let Some(variables) = link.joint.variables else { return };
    let (drive, zero) = (stiff_drive(link), dag.zero());
    let square_rate = dag.mul(variables.qd, variables.qd);
    if let Some(inertia) = drive.rotor_inertia {
        let reflected = reflect(dag, &drive, inertia);
        sums.rotors = add_half_product(dag, sums.rotors, reflected, square_rate);
    }
    if let Some(spring) = link.joint.spring {
        let elongation = dag.sub(variables.q, spring.angle);
        let square = dag.mul(elongation, elongation);
        sums.springs = add_half_product(dag, sums.springs, spring.stiffness, square);
    }
    if let Some(spring) = link.drive.and_then(|drive| drive.return_spring) {
        let stretch = dag.sub(variables.q, spring.angle);
        let (left, right) = acting_side(spring.side, variables.q, spring.angle);
        let elongation = dag.select(Relation::Less, left, right, stretch, zero);
        let square = dag.mul(elongation, elongation);
        sums.springs = add_half_product(dag, sums.springs, spring.stiffness, square);
    }
    if let Some(offset) = link.drive.and_then(|drive| drive.offset) {
        let work = dag.mul(offset, variables.q);
        sums.offsets = dag.add(sums.offsets, work);
    }
    for viscous in
        drive.viscous.map(|fv| reflect(dag, &drive, fv)).into_iter().chain(link.joint.damping)
    {
        sums.dissipation = add_half_product(dag, sums.dissipation, viscous, square_rate);
    }
    if let Some(coulomb) = drive.coulomb {
        let reflected = reflect_once(dag, &drive, coulomb);
        let speed = dag.unary(UnaryFunction::Abs, variables.qd);
        let power = dag.mul(reflected, speed);
        sums.dissipation = dag.add(sums.dissipation, power);
    }
}

/// `sum + 1/2 factor square`.
fn add_half_product(dag: &mut Dag, sum: ExprId, factor: ExprId, square: ExprId) -> ExprId {
    let product = dag.mul(factor, square);
    let half = halved(dag, product);
    dag.add(sum, half)
}

fn halved(dag: &mut Dag, x: ExprId) -> ExprId {
    let half = dag.constant(ratio(1, 2));
    dag.mul(half, x)
}

/// d/dt dK/dqd - dK/dq, with the momentum dK/dqd given.
fn euler_lagrange(
    dag: &mut Dag,
    at: &Coordinates,
    kinetic: ExprId,
    momentum: &[ExprId],
) -> Vec<ExprId> {
    let (positions, rates) = ([&at.q[..], &at.qd].concat(), [&at.qd[..], &at.qdd].concat());
    let momentum_rate = rate(dag, momentum, &positions, &rates);
    let slope = gradient(dag, kinetic, &at.q);
    momentum_rate.iter().zip(slope).map(|(&rate, slope)| dag.sub(rate, slope)).collect()
}

/// The derivatives of a scalar by each symbol.
fn gradient(dag: &mut Dag, scalar: ExprId, symbols: &[ExprId]) -> Vec<ExprId> {
    symbols.iter().map(|&symbol| partial(dag, &[scalar], symbol)[0]).collect()
}
