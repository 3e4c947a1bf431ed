//! Torques per unit of matter: the twist of a joint, pulled along the chain into the frame of a
//! body, does power on the wrench that each entry of the body's pseudo-inertia needs.

use crate::dynamics::motion::Motion;
use crate::expr::{Dag, ExprId};
use crate::kinematics::Frames;
use crate::spatial::{Matrix, PseudoInertia, Vector, add, cross, dot, zero};

/// The entries of a pseudo-inertia, in the order m, s1, s2, s3, K11, K22, K33, K12, K13, K23.
pub(super) const ENTRIES: usize = 10;

/// The places of the second moments.
pub(super) const SECOND: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// The entries of a pseudo-inertia as a list.
pub(super) fn entries(inertia: &PseudoInertia) -> [ExprId; ENTRIES] {
    let (s, k) = (inertia.first, &inertia.second);
    let [k11, k22, k33, k12, k13, k23] = SECOND.map(|(i, j)| k[i][j]);
    [inertia.mass, s[0], s[1], s[2], k11, k22, k33, k12, k13, k23]
}

/// The pseudo-inertia of a list of entries.
pub(super) fn from_entries(entries: [ExprId; ENTRIES]) -> PseudoInertia {
    let [mass, x, y, z, k11, k22, k33, k12, k13, k23] = entries;
    PseudoInertia {
        second: [[k11, k12, k13], [k12, k22, k23], [k13, k23, k33]],
        first: [x, y, z],
        mass,
    }
}

/// The torque of one joint per unit of each entry of one body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share {
    /// The joint: the body's own, or one that carries it.
    pub(super) joint: usize,
    /// Torque [N m, N] per unit of each entry.
    pub(super) torques: [ExprId; ENTRIES],
}

/// For each body, the shares of its own joint and of all joints that carry it, root first.
pub(super) fn shares(dag: &mut Dag, frames: &Frames, motion: &Motion) -> Vec<Vec<Share>> {
    let mut twists: Vec<Vec<(usize, Vector, Vector)>> = Vec::new();
    let mut result = Vec::new();
    for (i, frame) in frames.frames.iter().enumerate() {
        let carried = frame.parent.map(|p| twists[p].clone()).unwrap_or_default();
        let mut own: Vec<(usize, Vector, Vector)> = carried
            .into_iter()
            .map(|(joint, w, v)| {
                let lever = cross(dag, w, frame.offset);
                let v = add(dag, v, lever);
                (joint, frames.to_child(dag, i, w), frames.to_child(dag, i, v))
            })
            .collect();
        let (zero, mut axis) = (zero(dag), zero(dag));
        axis[2] = dag.one();
        own.push(if frame.is_revolute { (i, axis, zero) } else { (i, zero, axis) });
        let torques = |dag: &mut Dag, &(joint, w, v): &(usize, Vector, Vector)| Share {
            joint,
            torques: power(dag, (w, v), &motion.spread[i], motion.linear[i]),
        };
        result.push(own.iter().map(|twist| torques(dag, twist)).collect());
        twists.push(own);
    }
    result
}

/// The power of the twist (w, v) on the wrench of each entry: with U the spread of the
/// acceleration and a that of the origin, force = U s + m a, moment = vee(U K - (U K)^T) + s x a.
fn power(dag: &mut Dag, (w, v): (Vector, Vector), u: &Matrix, a: Vector) -> [ExprId; ENTRIES] {
    let u32 = dag.sub(u[2][2], u[1][1]);
    let u13 = dag.sub(u[0][0], u[2][2]);
    let u21 = dag.sub(u[1][1], u[0][0]);
    let mut difference = |(x, y): (ExprId, ExprId), (z, t): (ExprId, ExprId)| {
        let (plus, minus) = (dag.mul(x, y), dag.mul(z, t));
        dag.sub(plus, minus)
    };
    let k11 = difference((w[2], u[1][0]), (w[1], u[2][0]));
    let k22 = difference((w[0], u[2][1]), (w[2], u[0][1]));
    let k33 = difference((w[1], u[0][2]), (w[0], u[1][2]));
    let k12 = difference((w[0], u[2][0]), (w[1], u[2][1]));
    let k13 = difference((w[2], u[1][2]), (w[0], u[1][0]));
    let k23 = difference((w[1], u[0][1]), (w[2], u[0][2]));
    let mut plus = |sum: ExprId, x: ExprId, y: ExprId| {
        let product = dag.mul(x, y);
        dag.add(sum, product)
    };
    let (k12, k13, k23) = (plus(k12, w[2], u21), plus(k13, w[1], u13), plus(k23, w[0], u32));
    let lever = cross(dag, a, w);
    let first = [0, 1, 2].map(|k| {
        let column = [u[0][k], u[1][k], u[2][k]];
        let force = dot(dag, v, column);
        dag.add(force, lever[k])
    });
    let mass = dot(dag, v, a);
    [mass, first[0], first[1], first[2], k11, k22, k33, k12, k13, k23]
}
