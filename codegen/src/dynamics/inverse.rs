//! Inverse dynamics: the recursive Newton-Euler algorithm in pseudo-inertia form.

use super::motion::{Motion, Terms, motion};
use crate::expr::{Dag, ExprId};
use crate::kinematics::Frames;
use crate::spatial::{Matrix, PseudoInertia, Vector, add, cross, dot};

/// A force and a moment about the origin of a frame, in its coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wrench {
    /// Force \[N\].
    pub(super) force: Vector,
    /// Moment [N m].
    pub(super) moment: Vector,
}

impl Wrench {
    pub(super) fn add(self, dag: &mut Dag, other: Self) -> Self {
        Self {
            force: add(dag, self.force, other.force),
            moment: add(dag, self.moment, other.moment),
        }
    }

    /// The wrench of frame `i` in its parent's coordinates, about the parent's origin.
    pub(super) fn to_parent(self, dag: &mut Dag, frames: &Frames, i: usize) -> Self {
        let force = frames.to_parent(dag, i, self.force);
        let moment = frames.to_parent(dag, i, self.moment);
        let lever = cross(dag, frames.frames[i].offset, force);
        Self { force, moment: add(dag, moment, lever) }
    }

    /// What the joint of frame `i` must give: the component along its axis.
    pub(super) fn along_joint(self, frames: &Frames, i: usize) -> ExprId {
        if frames.frames[i].is_revolute { self.moment[2] } else { self.force[2] }
    }
}

/// The wrench that moves a body: force = U s + m a, moment = vee(U K - (U K)^T) + s x a.
/// 15 multiplications for the moment, where J wd + w x J w takes 24.
pub(super) fn inertial_wrench(
    dag: &mut Dag,
    inertia: &PseudoInertia,
    spread: Matrix,
    linear: Vector,
) -> Wrench {
    let (u, k, s) = (spread, &inertia.second, inertia.first);
    let force = [0, 1, 2].map(|row| {
        let turning = dot(dag, u[row], s);
        let carried = dag.mul(inertia.mass, linear[row]);
        dag.add(turning, carried)
    });
    let u32 = dag.sub(u[2][2], u[1][1]);
    let u13 = dag.sub(u[0][0], u[2][2]);
    let u21 = dag.sub(u[1][1], u[0][0]);
    let (k11, k22, k33) = (k[0][0], k[1][1], k[2][2]);
    let (k12, k13, k23) = (k[0][1], k[0][2], k[1][2]);
    let mut combine = |terms: [(bool, ExprId, ExprId); 5]| {
        terms.into_iter().fold(dag.zero(), |sum, (plus, x, y)| {
            let product = dag.mul(x, y);
            if plus { dag.add(sum, product) } else { dag.sub(sum, product) }
        })
    };
    let turning = [
        combine([
            (true, u[2][0], k12),
            (true, u[2][1], k22),
            (true, u32, k23),
            (false, u[1][0], k13),
            (false, u[1][2], k33),
        ]),
        combine([
            (true, u13, k13),
            (true, u[0][1], k23),
            (true, u[0][2], k33),
            (false, u[2][0], k11),
            (false, u[2][1], k12),
        ]),
        combine([
            (true, u21, k12),
            (true, u[1][0], k11),
            (false, u[0][1], k22),
            (true, u[1][2], k13),
            (false, u[0][2], k23),
        ]),
    ];
    let lever = cross(dag, s, linear);
    Wrench { force, moment: add(dag, turning, lever) }
}

/// Rigid-body joint torques of the given terms of the motion, joint by joint.
pub(super) fn inverse_dynamics(dag: &mut Dag, frames: &Frames, terms: Terms) -> Vec<ExprId> {
    let motion = motion(dag, frames, terms, None);
    let wrenches = body_wrenches(dag, frames, &motion);
    let total = accumulate(dag, frames, wrenches);
    (0..frames.len()).map(|i| total[i].along_joint(frames, i)).collect()
}

/// The wrench that moves each body.
pub(super) fn body_wrenches(dag: &mut Dag, frames: &Frames, motion: &Motion) -> Vec<Wrench> {
    (0..frames.len())
        .map(|i| {
            let inertia = &frames.frames[i].inertia;
            inertial_wrench(dag, inertia, motion.spread[i], motion.linear[i])
        })
        .collect()
}

/// Each frame's own wrench plus those of all bodies that it carries.
pub(super) fn accumulate(dag: &mut Dag, frames: &Frames, mut own: Vec<Wrench>) -> Vec<Wrench> {
    for i in (0..frames.len()).rev() {
        if let Some(p) = frames.frames[i].parent {
            let carried = own[i].to_parent(dag, frames, i);
            own[p] = own[p].add(dag, carried);
        }
    }
    own
}
