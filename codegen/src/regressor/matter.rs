//! The torque that one unit of matter of a body takes: the power of a twist on the wrench that
//! moves it.
//!
//! With U = [wd]x + [w]x [w]x and a, the acceleration of the origin minus gravity, matter with the
//! pseudo-inertia (K, s, m) takes the force U s + m a and the moment vee(U K - (U K)^T) + s x a.
//! Both functions here are the coefficients of that in a frame's own coordinates, times a twist.

use super::inertial::ENTRIES;
use crate::expr::{Dag, ExprId};
use crate::spatial::{Matrix, Vector, cross, dot};

/// How the frame of a body moves, in its own coordinates.
#[derive(Clone, Copy)]
pub(super) struct FrameMotion {
    /// Angular velocity w.
    pub(super) angular: Vector,
    /// Angular acceleration wd.
    pub(super) angular_rate: Vector,
    /// Acceleration a of the origin minus gravity.
    pub(super) linear: Vector,
}

impl FrameMotion {
    /// U = \[wd\]x + \[w\]x \[w\]x.
    pub(super) fn spread(&self, dag: &mut Dag) -> Matrix {
        let (w, wd) = (self.angular, self.angular_rate);
        let mut product = |i: usize, j: usize| dag.mul(w[i], w[j]);
        let (xx, yy, zz) = (product(0, 0), product(1, 1), product(2, 2));
        let (xy, xz, yz) = (product(0, 1), product(0, 2), product(1, 2));
        let mut minus_sum = |a, b| {
            let sum = dag.add(a, b);
            dag.neg(sum)
        };
        let (a, b, c) = (minus_sum(yy, zz), minus_sum(xx, zz), minus_sum(xx, yy));
        [
            [a, dag.sub(xy, wd[2]), dag.add(xz, wd[1])],
            [dag.add(xy, wd[2]), b, dag.sub(yz, wd[0])],
            [dag.sub(xz, wd[1]), dag.add(yz, wd[0]), c],
        ]
    }
}

/// Power on the wrenches of the entries of a pseudo-inertia, in the order of
/// [`entries`](super::inertial::entries), by the twist (w, v).
pub(super) fn power_on_entries(
    dag: &mut Dag,
    motion: &FrameMotion,
    w: Vector,
    v: Vector,
) -> [ExprId; ENTRIES] {
    let u = motion.spread(dag);
    let k11 = difference(dag, [w[2], u[1][0]], [w[1], u[2][0]]);
    let k22 = difference(dag, [w[0], u[2][1]], [w[2], u[0][1]]);
    let k33 = difference(dag, [w[1], u[0][2]], [w[0], u[1][2]]);
    let [k12, k13, k23] = off_diagonal(dag, &u, w);
    let [x, y, z] = power_on_first(dag, motion, &u, w, v);
    let mass = dot(dag, v, motion.linear);
    [mass, x, y, z, k11, k22, k33, k12, k13, k23]
}

/// Power on the wrenches of the ten parameters of a link, in the order of
/// [`PARAMETERS`](super::inertial::PARAMETERS), by the twist (w, v), in the link's frame.
///
/// A diagonal entry of the tensor takes w.(e wd_e + (body's w x e) w_e): three products, of which
/// the three entries share three.
pub(super) fn power_on_parameters(
    dag: &mut Dag,
    motion: &FrameMotion,
    w: Vector,
    v: Vector,
) -> [ExprId; ENTRIES] {
    let u = motion.spread(dag);
    let [p, q, r] = motion.angular;
    let pairs = [dag.mul(q, r), dag.mul(p, r), dag.mul(p, q)];
    let turning = [0, 1, 2].map(|k| dag.mul(w[k], pairs[k]));
    let diagonal = [0, 1, 2].map(|k| {
        let (next, last) = ((k + 1) % 3, (k + 2) % 3);
        let own = dag.mul(w[k], motion.angular_rate[k]);
        let gyration = dag.sub(turning[next], turning[last]);
        dag.add(own, gyration)
    });
    let [xx, yy, zz] = diagonal;
    let [xy, xz, yz] = off_diagonal(dag, &u, w).map(|power| dag.neg(power));
    let [x, y, z] = power_on_first(dag, motion, &u, w, v);
    let mass = dot(dag, v, motion.linear);
    [mass, x, y, z, xx, yy, zz, xy, xz, yz]
}

/// x0 x1 - y0 y1.
fn difference(dag: &mut Dag, x: [ExprId; 2], y: [ExprId; 2]) -> ExprId {
    let (left, right) = (dag.mul(x[0], x[1]), dag.mul(y[0], y[1]));
    dag.sub(left, right)
}

/// On K12, K13, K23, each with its mirror image.
fn off_diagonal(dag: &mut Dag, u: &Matrix, w: Vector) -> [ExprId; 3] {
    let k12 = difference(dag, [w[0], u[2][0]], [w[1], u[2][1]]);
    let k13 = difference(dag, [w[2], u[1][2]], [w[0], u[1][0]]);
    let k23 = difference(dag, [w[1], u[0][1]], [w[2], u[0][2]]);
    [(k12, 2, 1, 0), (k13, 1, 0, 2), (k23, 0, 2, 1)].map(|(sum, axis, i, j)| {
        let difference = dag.sub(u[i][i], u[j][j]);
        let product = dag.mul(w[axis], difference);
        dag.add(sum, product)
    })
}

/// On the three entries of the first moment.
fn power_on_first(
    dag: &mut Dag,
    motion: &FrameMotion,
    u: &Matrix,
    w: Vector,
    v: Vector,
) -> [ExprId; 3] {
    let lever = cross(dag, motion.linear, w);
    [0, 1, 2].map(|k| {
        let force = dot(dag, v, [u[0][k], u[1][k], u[2][k]]);
        dag.add(force, lever[k])
    })
}
