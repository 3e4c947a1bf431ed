//! Velocities and accelerations of the frames, base to tip.

use crate::expr::{Dag, ExprId};
use crate::kinematics::Frames;
use crate::spatial::{Matrix, Vector, add, cross, dot, negate, zero};

/// Which terms of the motion are carried along; what is left out is 0 and folds away.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terms {
    /// Joint rates.
    pub(crate) rates: bool,
    /// Joint accelerations.
    pub(crate) accelerations: bool,
    /// Gravity, as an acceleration of frame 0.
    pub(crate) gravity: bool,
}

/// The motion of each frame, in its own coordinates.
pub(crate) struct Motion {
    /// Angular velocity [rad/s].
    pub(crate) angular: Vec<Vector>,
    /// Angular acceleration [rad/s^2].
    pub(crate) angular_rate: Vec<Vector>,
    /// U = [wd]x + [w]x [w]x, the acceleration of a body point per unit of distance [1/s^2].
    pub(crate) spread: Vec<Matrix>,
    /// Acceleration of the origin minus gravity [m/s^2].
    pub(crate) linear: Vec<Vector>,
}

/// The motion of all frames. `accelerations` replaces the symbols qdd where they are wanted.
pub(crate) fn motion(
    dag: &mut Dag,
    frames: &Frames,
    terms: Terms,
    accelerations: Option<&[ExprId]>,
) -> Motion {
    let mut result = Motion {
        angular: Vec::new(),
        angular_rate: Vec::new(),
        spread: Vec::new(),
        linear: Vec::new(),
    };
    let base = if terms.gravity { negate(dag, frames.gravity) } else { zero(dag) };
    for (i, frame) in frames.frames.iter().enumerate() {
        let (mut w, mut wd, mut a) = match frame.parent {
            Some(p) => {
                let spread = multiply(dag, result.spread[p], frame.offset);
                let a = add(dag, result.linear[p], spread);
                (result.angular[p], result.angular_rate[p], a)
            }
            None => (zero(dag), zero(dag), base),
        };
        w = frames.to_child(dag, i, w);
        wd = frames.to_child(dag, i, wd);
        a = frames.to_child(dag, i, a);
        let qd = if terms.rates { frame.variables.qd } else { dag.zero() };
        let qdd = match accelerations {
            Some(given) => given[i],
            None if terms.accelerations => frame.variables.qdd,
            None => dag.zero(),
        };
        if frame.is_revolute {
            let (x, y) = (dag.mul(qd, w[1]), dag.mul(qd, w[0]));
            wd = [dag.add(wd[0], x), dag.sub(wd[1], y), dag.add(wd[2], qdd)];
            w[2] = dag.add(w[2], qd);
        } else {
            let two = dag.integer(2);
            let twice = dag.mul(two, qd);
            let (x, y) = (dag.mul(twice, w[1]), dag.mul(twice, w[0]));
            a = [dag.add(a[0], x), dag.sub(a[1], y), dag.add(a[2], qdd)];
        }
        result.spread.push(spread_matrix(dag, w, wd));
        result.angular.push(w);
        result.angular_rate.push(wd);
        result.linear.push(a);
    }
    result
}

/// U = [wd]x + [w]x [w]x.
pub(super) fn spread_matrix(dag: &mut Dag, w: Vector, wd: Vector) -> Matrix {
    let [xx, yy, zz] = w.map(|x| dag.mul(x, x));
    let (xy, xz, yz) = (dag.mul(w[0], w[1]), dag.mul(w[0], w[2]), dag.mul(w[1], w[2]));
    let diagonal = [(yy, zz), (xx, zz), (xx, yy)].map(|(a, b)| {
        let sum = dag.add(a, b);
        dag.neg(sum)
    });
    [
        [diagonal[0], dag.sub(xy, wd[2]), dag.add(xz, wd[1])],
        [dag.add(xy, wd[2]), diagonal[1], dag.sub(yz, wd[0])],
        [dag.sub(xz, wd[1]), dag.add(yz, wd[0]), diagonal[2]],
    ]
}

/// `A v`.
pub(super) fn multiply(dag: &mut Dag, matrix: Matrix, vector: Vector) -> Vector {
    matrix.map(|row| dot(dag, row, vector))
}

/// Angular velocity and velocity of the origin of each frame, in its own coordinates; all 0
/// without `rates`.
pub(super) fn velocities(dag: &mut Dag, frames: &Frames, rates: bool) -> Vec<(Vector, Vector)> {
    let mut result: Vec<(Vector, Vector)> = Vec::new();
    for (i, frame) in frames.frames.iter().enumerate() {
        let (w, v) = match frame.parent {
            Some(p) => {
                let (w, v) = result[p];
                let turning = cross(dag, w, frame.offset);
                (w, add(dag, v, turning))
            }
            None => (zero(dag), zero(dag)),
        };
        let (mut w, mut v) = (frames.to_child(dag, i, w), frames.to_child(dag, i, v));
        let moving = if frame.is_revolute { &mut w[2] } else { &mut v[2] };
        if rates {
            *moving = dag.add(*moving, frame.variables.qd);
        }
        result.push((w, v));
    }
    result
}
