//! C and the derivatives of inverse dynamics, from composites: D is never differentiated.
//!
//! With V = [w^, v; 0, 0] the twist of a frame and P the pseudo-inertia, Q = P V^T summed over what
//! a joint carries gives the Christoffel matrix
//! C_ji = <S_j, P Sd_i^T + Q S_i^T> for j at or below i, and
//! C_ij = <D-wrench of i, Sd_j> + <S_i^ Q, S_j> for j below i,
//! where S is the joint's unit twist and Sd = ad_V S. The derivative of the torques with respect to
//! qd is 2 C; with respect to q it follows from P, Q and the wrench that each joint passes on.

use super::composite::{to_parent, unit_wrench};
use super::inverse::{Wrench, accumulate, body_wrenches};
use super::motion::{Terms, motion, velocities};
use crate::expr::{Dag, ExprId};
use crate::kinematics::Frames;
use crate::spatial::{
    Matrix, PseudoInertia, Vector, add, add_matrix, cross, dot, scale, subtract, transpose, vee,
    zero,
};

/// Q = P V^T: its upper 3x3 block and its last row (the last column is 0).
#[derive(Clone, Copy)]
struct Moving {
    block: Matrix,
    row: Vector,
}

/// A twist about a frame's origin: angular and linear part.
type Twist = (Vector, Vector);

/// What C and the derivatives share.
struct Carried {
    composites: Vec<PseudoInertia>,
    moving: Vec<Moving>,
    /// Sd of each joint.
    unit_rate: Vec<Twist>,
    velocities: Vec<Twist>,
}

/// `factor` multiplies Q alone: on the bodies' parameters, where it costs nothing at run time.
fn carried(dag: &mut Dag, frames: &Frames, rates: bool, factor: i64) -> Carried {
    let velocities = velocities(dag, frames, rates);
    let mut composites: Vec<_> = frames.frames.iter().map(|frame| frame.inertia).collect();
    let factor = dag.integer(factor);
    let mut moving: Vec<Moving> = (0..frames.len())
        .map(|i| {
            let scaled = composites[i].scaled(dag, factor);
            body_moving(dag, &scaled, velocities[i])
        })
        .collect();
    for i in (0..frames.len()).rev() {
        if let Some(p) = frames.frames[i].parent {
            let matter = to_parent(dag, frames, i, &composites[i]);
            composites[p] = composites[p].add(dag, &matter);
            let carried = moving_to_parent(dag, frames, i, moving[i]);
            moving[p] = Moving {
                block: add_matrix(dag, moving[p].block, carried.block),
                row: add(dag, moving[p].row, carried.row),
            };
        }
    }
    let unit_rate = (0..frames.len())
        .map(|i| {
            let (w, v) = velocities[i];
            if frames.frames[i].is_revolute {
                (across_z(dag, w), across_z(dag, v))
            } else {
                (zero(dag), across_z(dag, w))
            }
        })
        .collect();
    Carried { composites, moving, unit_rate, velocities }
}

/// `a x z`.
fn across_z(dag: &mut Dag, a: Vector) -> Vector {
    [a[1], dag.neg(a[0]), dag.zero()]
}

/// Q of one body: block row k is w x K_k + s_k v, the last row w x s + m v.
fn body_moving(dag: &mut Dag, inertia: &PseudoInertia, (w, v): Twist) -> Moving {
    let block = [0, 1, 2].map(|k| {
        let turning = cross(dag, w, inertia.second[k]);
        let carried = scale(dag, inertia.first[k], v);
        add(dag, turning, carried)
    });
    let turning = cross(dag, w, inertia.first);
    let carried = scale(dag, inertia.mass, v);
    Moving { block, row: add(dag, turning, carried) }
}

fn moving_to_parent(dag: &mut Dag, frames: &Frames, i: usize, moving: Moving) -> Moving {
    let frame = &frames.frames[i];
    let turns = frame.turns().rev();
    let block = turns.fold(moving.block, |block, turn| turn.matrix_to_parent(dag, block));
    let row = frames.to_parent(dag, i, moving.row);
    let block = [0, 1, 2].map(|k| {
        let shift = scale(dag, frame.offset[k], row);
        add(dag, block[k], shift)
    });
    Moving { block, row }
}

/// The wrench of P A^T + Q B^T for a twist A = (aw, av) and the turning part B of another:
/// force = its last row, moment = vee of its block.
fn wrench_of(
    dag: &mut Dag,
    inertia: &PseudoInertia,
    moving: &Moving,
    (aw, av): Twist,
    bw: Vector,
) -> Wrench {
    let block = [0, 1, 2].map(|k| {
        let turning = cross(dag, aw, inertia.second[k]);
        let carried = scale(dag, inertia.first[k], av);
        let own = add(dag, turning, carried);
        let moved = cross(dag, bw, moving.block[k]);
        add(dag, own, moved)
    });
    let turning = cross(dag, aw, inertia.first);
    let carried = scale(dag, inertia.mass, av);
    let own = add(dag, turning, carried);
    let moved = cross(dag, bw, moving.row);
    // The rows pair with the transposed twist: vee of the transpose.
    Wrench { force: add(dag, own, moved), moment: vee(dag, transpose(block)) }
}

/// <S_i^ Q, .> as a wrench: force = last column (0), moment = vee of the block.
fn left_wrench(dag: &mut Dag, is_revolute: bool, moving: &Moving) -> Wrench {
    let zero_row = zero(dag);
    let block = if is_revolute {
        let first = moving.block[1].map(|x| dag.neg(x));
        [first, moving.block[0], zero_row]
    } else {
        [zero_row, zero_row, moving.row]
    };
    Wrench { force: zero_row, moment: vee(dag, block) }
}

/// Whether a joint turns, as the turning part of its unit twist.
fn unit_turn(dag: &Dag, is_revolute: bool) -> Vector {
    let last = if is_revolute { dag.one() } else { dag.zero() };
    [dag.zero(), dag.zero(), last]
}

/// <wrench, twist>.
fn power(dag: &mut Dag, wrench: Wrench, (w, v): Twist) -> ExprId {
    let turning = dot(dag, wrench.moment, w);
    let sliding = dot(dag, wrench.force, v);
    dag.add(turning, sliding)
}

/// C, row by row: the Christoffel one, for which dD/dt - 2 C is skew.
pub(super) fn coriolis_matrix(dag: &mut Dag, frames: &Frames) -> Vec<Vec<ExprId>> {
    let n = frames.len();
    let carried = carried(dag, frames, true, 1);
    let mut c = vec![vec![dag.zero(); n]; n];
    for i in 0..n {
        let is_revolute = frames.frames[i].is_revolute;
        let (inertia, moving) = (&carried.composites[i], &carried.moving[i]);
        let turn = unit_turn(dag, is_revolute);
        let mut below = wrench_of(dag, inertia, moving, carried.unit_rate[i], turn);
        let mut left = left_wrench(dag, is_revolute, moving);
        let mut unit = unit_wrench(dag, frames, i, inertia);
        for j in frames.chain(i) {
            c[j][i] = below.along_joint(frames, j);
            if j != i {
                let moved = power(dag, unit, carried.unit_rate[j]);
                c[i][j] = dag.add(moved, left.along_joint(frames, j));
            }
            if frames.frames[j].parent.is_some() {
                below = below.to_parent(dag, frames, j);
                left = left.to_parent(dag, frames, j);
                unit = unit.to_parent(dag, frames, j);
            }
        }
    }
    c
}

/// Derivatives of the rigid-body torques.
pub(super) struct InverseDerivatives {
    /// dtau_i/dq_j.
    pub(super) by_position: Vec<Vec<ExprId>>,
    /// dtau_i/dqd_j = 2 C_ij.
    pub(super) by_rate: Vec<Vec<ExprId>>,
}

/// The derivatives of the torques. `accelerations` replaces the symbols qdd where they are wanted.
///
/// Q counts twice everywhere here (2 C, and the term 2 Q Sd of the derivative by position), so it
/// is summed from doubled inertias, and Sd is doubled for the part P Sd of 2 C.
pub(super) fn inverse_derivatives(
    dag: &mut Dag,
    frames: &Frames,
    terms: Terms,
    accelerations: Option<&[ExprId]>,
) -> InverseDerivatives {
    let n = frames.len();
    let carried = carried(dag, frames, terms.rates, 2);
    let motion = motion(dag, frames, terms, accelerations);
    let own = body_wrenches(dag, frames, &motion);
    let total = accumulate(dag, frames, own);
    let second: Vec<Twist> = (0..n)
        .map(|i| {
            let turning = {
                let (w, v) = carried.velocities[i];
                cross(dag, w, v)
            };
            let vd = subtract(dag, motion.linear[i], turning);
            let is_revolute = frames.frames[i].is_revolute;
            let acceleration = (motion.angular_rate[i], vd);
            second_rate(dag, is_revolute, carried.velocities[i], acceleration, carried.unit_rate[i])
        })
        .collect();
    let two = dag.integer(2);
    let doubled: Vec<Twist> =
        carried.unit_rate.iter().map(|&(w, v)| (scale(dag, two, w), scale(dag, two, v))).collect();
    let mut by_position = vec![vec![dag.zero(); n]; n];
    let mut by_rate = by_position.clone();
    for i in 0..n {
        let is_revolute = frames.frames[i].is_revolute;
        let (inertia, moving) = (&carried.composites[i], &carried.moving[i]);
        let turn = unit_turn(dag, is_revolute);
        let mut rate = wrench_of(dag, inertia, moving, doubled[i], turn);
        let mut position = wrench_of(dag, inertia, moving, second[i], carried.unit_rate[i].0);
        position = turned_wrench(dag, is_revolute, total[i], position);
        let mut left = left_wrench(dag, is_revolute, moving);
        let mut unit = unit_wrench(dag, frames, i, inertia);
        for j in frames.chain(i) {
            by_rate[j][i] = rate.along_joint(frames, j);
            by_position[j][i] = position.along_joint(frames, j);
            if j != i {
                let moved = power(dag, unit, doubled[j]);
                by_rate[i][j] = dag.add(moved, left.along_joint(frames, j));
                let inertial = power(dag, unit, second[j]);
                let turning = power(dag, left, carried.unit_rate[j]);
                by_position[i][j] = dag.add(inertial, turning);
            }
            if frames.frames[j].parent.is_some() {
                rate = rate.to_parent(dag, frames, j);
                position = position.to_parent(dag, frames, j);
                left = left.to_parent(dag, frames, j);
                unit = unit.to_parent(dag, frames, j);
            }
        }
    }
    InverseDerivatives { by_position, by_rate }
}

/// Sdd = ad_A S + ad_V ad_V S of joint `i`, with A the spatial acceleration (gravity included).
fn second_rate(
    dag: &mut Dag,
    is_revolute: bool,
    (w, v): Twist,
    (wd, vd): Twist,
    (rate_w, rate_v): Twist,
) -> Twist {
    if !is_revolute {
        let turning = cross(dag, w, rate_v);
        let direct = across_z(dag, wd);
        return (zero(dag), add(dag, direct, turning));
    }
    let (direct_w, direct_v) = (across_z(dag, wd), across_z(dag, vd));
    let turning_w = cross(dag, w, rate_w);
    let turning_v = cross(dag, w, rate_v);
    let sliding = cross(dag, v, rate_w);
    let second_v = add(dag, turning_v, sliding);
    (add(dag, direct_w, turning_w), add(dag, direct_v, second_v))
}

/// Adds S x* f: the wrench that the joint passes on turns with it.
fn turned_wrench(dag: &mut Dag, is_revolute: bool, passed: Wrench, wrench: Wrench) -> Wrench {
    let z_cross = |dag: &mut Dag, a: Vector| [dag.neg(a[1]), a[0], dag.zero()];
    let by_force = z_cross(dag, passed.force);
    if is_revolute {
        let by_moment = z_cross(dag, passed.moment);
        wrench.add(dag, Wrench { force: by_force, moment: by_moment })
    } else {
        Wrench { force: wrench.force, moment: add(dag, wrench.moment, by_force) }
    }
}
