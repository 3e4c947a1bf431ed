//! Forward dynamics by articulated bodies: linear in the number of joints, without D.

use super::inverse::{Wrench, inertial_wrench};
use super::motion::{multiply, spread_matrix};
use crate::expr::{Dag, ExprId};
use crate::kinematics::Frames;
use crate::spatial::{
    Matrix, PseudoInertia, Turn, Vector, add, add_matrix, cross, dot, negate, scale, transpose,
    zero,
};

/// The 6x6 inertia that a joint feels: moment = J wd + H a, force = H^T wd + M a, for the angular
/// acceleration wd and the acceleration a of the frame's origin.
#[derive(Clone, Copy)]
struct ArticulatedInertia {
    rotational: Matrix,
    coupling: Matrix,
    linear: Matrix,
}

/// What the sweep back to the root keeps for the sweep out.
struct Joint {
    /// The inertia's column along the joint: moment and force of a unit joint acceleration.
    column: (Vector, Vector),
    /// The joint's own entry of that column.
    pivot: ExprId,
    /// Torque that is left for the joint's own acceleration.
    rest: ExprId,
}

/// The part of a frame's acceleration that its parent's motion and the rates alone give.
struct Drift {
    angular: Vector,
    linear: Vector,
}

/// qdd of the given joint torques (friction and the like already taken away). `rotors[i]` is the
/// reflected inertia on joint i.
pub(super) fn forward_dynamics(
    dag: &mut Dag,
    frames: &Frames,
    torques: &[ExprId],
    rotors: &[ExprId],
) -> Vec<ExprId> {
    let n = frames.len();
    let (drifts, mut bias) = drifts_and_bias(dag, frames);
    let mut inertias: Vec<ArticulatedInertia> =
        frames.frames.iter().map(|frame| rigid(dag, &frame.inertia)).collect();
    let mut joints: Vec<Option<Joint>> = (0..n).map(|_| None).collect();
    for i in (0..n).rev() {
        let is_revolute = frames.frames[i].is_revolute;
        let inertia = inertias[i];
        let column = if is_revolute {
            (inertia.rotational.map(|row| row[2]), inertia.coupling[2])
        } else {
            (inertia.coupling.map(|row| row[2]), inertia.linear.map(|row| row[2]))
        };
        let own = if is_revolute { column.0[2] } else { column.1[2] };
        let pivot = dag.add(own, rotors[i]);
        let rest = dag.sub(torques[i], bias[i].along_joint(frames, i));
        joints[i] = Some(Joint { column, pivot, rest });
        let Some(p) = frames.frames[i].parent else { continue };
        let rigid_joint = rotors[i] == dag.zero();
        let felt = Felt { is_revolute, rigid_joint, inertia, column, pivot, rest };
        let (reduced, wrench) = felt.by_parent(dag, &drifts[i], bias[i], torques[i]);
        let moved = to_parent(dag, frames, i, &reduced);
        inertias[p] = ArticulatedInertia {
            rotational: add_matrix(dag, inertias[p].rotational, moved.rotational),
            coupling: add_matrix(dag, inertias[p].coupling, moved.coupling),
            linear: add_matrix(dag, inertias[p].linear, moved.linear),
        };
        let carried = wrench.to_parent(dag, frames, i);
        bias[p] = bias[p].add(dag, carried);
    }
    let joints: Vec<Joint> = joints.into_iter().flatten().collect();
    accelerations(dag, frames, &drifts, &joints)
}

/// The sweep out: accelerations from the root to the tips.
fn accelerations(
    dag: &mut Dag,
    frames: &Frames,
    drifts: &[Drift],
    joints: &[Joint],
) -> Vec<ExprId> {
    let mut motion: Vec<(Vector, Vector)> = Vec::new();
    let mut result = Vec::new();
    for (i, frame) in frames.frames.iter().enumerate() {
        let (wd, a) = match frame.parent {
            Some(p) => {
                let (wd, a) = motion[p];
                let turning = cross(dag, wd, frame.offset);
                (wd, add(dag, a, turning))
            }
            None => (zero(dag), negate(dag, frames.gravity)),
        };
        let (wd, a) = (frames.to_child(dag, i, wd), frames.to_child(dag, i, a));
        let mut wd = add(dag, wd, drifts[i].angular);
        let mut a = add(dag, a, drifts[i].linear);
        let joint = &joints[i];
        let (turning, sliding) = (dot(dag, joint.column.0, wd), dot(dag, joint.column.1, a));
        let taken = dag.add(turning, sliding);
        let rest = dag.sub(joint.rest, taken);
        let one = dag.one();
        let share = dag.div(one, joint.pivot);
        let acceleration = dag.mul(rest, share);
        result.push(acceleration);
        let moving = if frame.is_revolute { &mut wd[2] } else { &mut a[2] };
        *moving = dag.add(*moving, acceleration);
        motion.push((wd, a));
    }
    result
}

/// Velocity-dependent accelerations between parent and child, and the wrench of each body at zero
/// acceleration.
fn drifts_and_bias(dag: &mut Dag, frames: &Frames) -> (Vec<Drift>, Vec<Wrench>) {
    let zero_vector = zero(dag);
    let mut angular: Vec<Vector> = Vec::new();
    let mut spreads: Vec<Matrix> = Vec::new();
    let (mut drifts, mut bias) = (Vec::new(), Vec::new());
    for (i, frame) in frames.frames.iter().enumerate() {
        let qd = frame.variables.qd;
        let w = frame.parent.map_or(zero_vector, |p| angular[p]);
        let mut w = frames.to_child(dag, i, w);
        let mut drift = Drift { angular: zero_vector, linear: zero_vector };
        if frame.is_revolute {
            let (x, y) = (dag.mul(qd, w[1]), dag.mul(qd, w[0]));
            drift.angular = [x, dag.neg(y), dag.zero()];
        } else {
            let two = dag.integer(2);
            let twice = dag.mul(two, qd);
            let (x, y) = (dag.mul(twice, w[1]), dag.mul(twice, w[0]));
            drift.linear = [x, dag.neg(y), dag.zero()];
        }
        if frame.is_revolute {
            w[2] = dag.add(w[2], qd);
        }
        if let Some(p) = frame.parent {
            let spread = multiply(dag, spreads[p], frame.offset);
            let spread = frames.to_child(dag, i, spread);
            drift.linear = add(dag, drift.linear, spread);
        }
        let spread = spread_matrix(dag, w, zero_vector);
        bias.push(inertial_wrench(dag, &frame.inertia, spread, zero_vector));
        drifts.push(drift);
        angular.push(w);
        spreads.push(spread);
    }
    (drifts, bias)
}

/// A rigid body: J, H = s^ and M = m 1.
fn rigid(dag: &mut Dag, inertia: &PseudoInertia) -> ArticulatedInertia {
    let (z, m) = (dag.zero(), inertia.mass);
    let [x, y, w] = inertia.first;
    let [minus_x, minus_y, minus_w] = negate(dag, inertia.first);
    ArticulatedInertia {
        rotational: inertia.tensor(dag),
        coupling: [[z, minus_w, y], [w, z, minus_x], [minus_y, x, z]],
        linear: [[m, z, z], [z, m, z], [z, z, m]],
    }
}

/// A joint and what lies beyond it, as its parent will feel it.
struct Felt {
    is_revolute: bool,
    /// Whether the joint has no inertia of its own: then the felt inertia is 0 along its axis.
    rigid_joint: bool,
    inertia: ArticulatedInertia,
    column: (Vector, Vector),
    pivot: ExprId,
    rest: ExprId,
}

impl Felt {
    /// The inertia without what the joint gives way to, and the wrench at zero acceleration.
    fn by_parent(
        &self,
        dag: &mut Dag,
        drift: &Drift,
        bias: Wrench,
        torque: ExprId,
    ) -> (ArticulatedInertia, Wrench) {
        let reduced = self.reduced(dag);
        let one = dag.one();
        let share = dag.div(one, self.pivot);
        let yielding = dag.mul(self.rest, share);
        let transposed = transpose(reduced.coupling);
        let mut moment = self.wrench_part(
            dag,
            [bias.moment, self.column.0],
            [reduced.rotational, reduced.coupling],
            drift,
            yielding,
        );
        let mut force = self.wrench_part(
            dag,
            [bias.force, self.column.1],
            [transposed, reduced.linear],
            drift,
            yielding,
        );
        if self.rigid_joint {
            // Along its axis a joint without inertia passes on exactly its torque.
            let along = if self.is_revolute { &mut moment[2] } else { &mut force[2] };
            *along = torque;
        }
        (reduced, Wrench { force, moment })
    }

    /// bias + A drift + column yielding.
    fn wrench_part(
        &self,
        dag: &mut Dag,
        [bias, column]: [Vector; 2],
        [by_angular, by_linear]: [Matrix; 2],
        drift: &Drift,
        yielding: ExprId,
    ) -> Vector {
        let turning = multiply(dag, by_angular, drift.angular);
        let sliding = multiply(dag, by_linear, drift.linear);
        let given = scale(dag, yielding, column);
        let sum = add(dag, bias, turning);
        let rest = add(dag, sliding, given);
        add(dag, sum, rest)
    }

    /// I - U U^T / d.
    fn reduced(&self, dag: &mut Dag) -> ArticulatedInertia {
        let one = dag.one();
        let share = dag.div(one, self.pivot);
        let (turning, sliding) = self.column;
        let part_turning = scale(dag, share, turning);
        let part_sliding = scale(dag, share, sliding);
        let mut reduced = self.inertia;
        for r in 0..3 {
            for q in 0..3 {
                if q >= r {
                    let product = dag.mul(part_turning[r], turning[q]);
                    reduced.rotational[r][q] = dag.sub(self.inertia.rotational[r][q], product);
                    reduced.rotational[q][r] = reduced.rotational[r][q];
                    let product = dag.mul(part_sliding[r], sliding[q]);
                    reduced.linear[r][q] = dag.sub(self.inertia.linear[r][q], product);
                    reduced.linear[q][r] = reduced.linear[r][q];
                }
                let product = dag.mul(turning[r], part_sliding[q]);
                reduced.coupling[r][q] = dag.sub(self.inertia.coupling[r][q], product);
            }
        }
        if self.rigid_joint {
            self.clear_axis(dag, &mut reduced);
        }
        reduced
    }

    /// Along the axis of a joint without inertia nothing is felt: U - U d / d = 0.
    fn clear_axis(&self, dag: &Dag, reduced: &mut ArticulatedInertia) {
        let zero = dag.zero();
        for r in 0..3 {
            if self.is_revolute {
                reduced.rotational[r][2] = zero;
                reduced.rotational[2][r] = zero;
                reduced.coupling[2][r] = zero;
            } else {
                reduced.linear[r][2] = zero;
                reduced.linear[2][r] = zero;
                reduced.coupling[r][2] = zero;
            }
        }
    }
}

/// The inertia of frame `i` in its parent's coordinates, about the parent's origin.
fn to_parent(
    dag: &mut Dag,
    frames: &Frames,
    i: usize,
    inertia: &ArticulatedInertia,
) -> ArticulatedInertia {
    let frame = &frames.frames[i];
    let turned = |dag: &mut Dag, matrix: Matrix| {
        let turns = frame.turns().rev();
        turns.fold(matrix, |matrix, turn: &Turn| turn.matrix_to_parent(dag, matrix))
    };
    let rotational = turned(dag, inertia.rotational);
    let coupling = turned(dag, inertia.coupling);
    let linear = turned(dag, inertia.linear);
    let r = frame.offset;
    // a_child = a + wd x r and n_parent = n + r x f:
    // H' = H + r^ M, J' = J + r^ H^T - H' r^.
    let lever = transpose(linear).map(|column| cross(dag, r, column));
    let moved_coupling = add_matrix(dag, coupling, transpose(lever));
    let by_force = coupling.map(|column| cross(dag, r, column));
    let by_motion = moved_coupling.map(|row| cross(dag, r, row));
    let mut moved_rotational = rotational;
    for k in 0..3 {
        for q in k..3 {
            let half = dag.add(rotational[k][q], by_force[q][k]);
            moved_rotational[k][q] = dag.add(half, by_motion[k][q]);
            moved_rotational[q][k] = moved_rotational[k][q];
        }
    }
    ArticulatedInertia { rotational: moved_rotational, coupling: moved_coupling, linear }
}
