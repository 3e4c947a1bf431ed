//! The regressor by pulling joint twists outwards, for arms and for robots on a moving torso.
//!
//! The equation of joint j is the power of the wrenches that move the bodies, at unit rate of the
//! joint. The twist of that rate is carried outwards to each body and multiplied with the wrench
//! of each unit of matter there. Nothing is carried back, so no intermediate result is larger than
//! an entry. On a torso (math: quasi-velocities) the motion of the torso is given by its angular
//! velocity, angular acceleration and acceleration minus gravity, all free, in its own
//! coordinates; its six equations are the moment and the force on it. Whatever holds for the
//! columns in these variables holds in those of a virtual chain, which determine them.

use crate::expr::{Dag, ExprId, SymbolClass};
use crate::kinematics::{Frame, Frames};
use crate::spatial::{Matrix, Vector, add, cross, dot, negate, zero, zero_matrix};

/// Which terms the equations have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MotionTerms {
    /// Joint rates, and the angular velocity of the torso.
    pub rates: bool,
    /// Joint accelerations.
    pub accelerations: bool,
    /// Gravity.
    pub gravity: bool,
}

/// The ten entries of a pseudo-inertia, in the order of the columns of [`MatterRegressor`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // the names are the documentation
pub enum MatterEntry {
    Mass,
    FirstX,
    FirstY,
    FirstZ,
    K11,
    K22,
    K33,
    K12,
    K13,
    K23,
}

/// The equations of motion as a linear function of the pseudo-inertias of the bodies about the
/// origins of their frames.
#[derive(Clone, Debug)]
pub struct MatterRegressor {
    /// For each equation, for each body, the factors of its ten entries in the order of
    /// [`MatterEntry`].
    pub rows: Vec<Vec<[ExprId; 10]>>,
    /// The equation of each row.
    pub equations: Vec<Equation>,
}

/// What an equation balances.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Equation {
    /// The moment on the torso about an axis of its frame [N m].
    TorsoMoment(usize),
    /// The force on the torso along an axis of its frame \[N\].
    TorsoForce(usize),
    /// The torque or force of a joint [N m, N], by its number among the joint variables.
    Joint(usize),
}

/// The motion of one frame and the twists of all equations there.
#[derive(Clone)]
struct State {
    angular: Vector,
    angular_rate: Vector,
    /// Acceleration of the origin minus gravity.
    linear: Vector,
    /// U = \[wd\]x + \[w\]x \[w\]x.
    spread: Matrix,
    /// (row, angular part, linear part).
    twists: Vec<(usize, Vector, Vector)>,
}

/// The regressor of a robot on a fixed base. Bodies are the frames.
pub fn fixed_base_regressor(dag: &mut Dag, frames: &Frames, terms: MotionTerms) -> MatterRegressor {
    let linear = if terms.gravity { negate(dag, frames.gravity) } else { zero(dag) };
    let still = zero(dag);
    let base = State {
        angular: still,
        angular_rate: still,
        linear,
        spread: zero_matrix(dag),
        twists: Vec::new(),
    };
    let equations = (0..frames.len()).map(Equation::Joint).collect();
    pull(dag, frames, None, &base, (equations, terms))
}

/// How a torso moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TorsoMotion {
    /// In space: six equations.
    Spatial,
    /// In the x-y plane of its own frame: the moment about z, the forces along x and y.
    Planar,
}

/// The regressor of a robot whose frame `torso` moves freely. Joints up to the torso have no
/// equations and no variables, and bodies on them no columns (all 0).
pub fn torso_regressor(
    dag: &mut Dag,
    frames: &Frames,
    (torso, motion): (usize, TorsoMotion),
    terms: MotionTerms,
) -> MatterRegressor {
    let (zero, one) = (dag.zero(), dag.one());
    let (turns, moves): (&[usize], &[usize]) = match motion {
        TorsoMotion::Spatial => (&[0, 1, 2], &[0, 1, 2]),
        TorsoMotion::Planar => (&[2], &[0, 1]),
    };
    let mut free = |name: &str, class, axes: &[usize], wanted: bool| {
        [0, 1, 2].map(|axis| match wanted && axes.contains(&axis) {
            true => dag.symbol(&format!("{name}_torso_{}", ["x", "y", "z"][axis]), class),
            false => zero,
        })
    };
    let accelerates = terms.accelerations;
    let angular = free("w", SymbolClass::Rate, turns, terms.rates);
    let angular_rate = free("wd", SymbolClass::Acceleration, turns, accelerates);
    let linear = free("a", SymbolClass::Acceleration, moves, accelerates || terms.gravity);
    let unit = |axis: usize| [0, 1, 2].map(|k| if k == axis { one } else { zero });
    let none = [zero; 3];
    let moments = turns.iter().map(|&axis| (Equation::TorsoMoment(axis), unit(axis), none));
    let forces = moves.iter().map(|&axis| (Equation::TorsoForce(axis), none, unit(axis)));
    let (mut equations, mut twists) = (Vec::new(), Vec::new());
    for (row, (equation, angular, linear)) in moments.chain(forces).enumerate() {
        equations.push(equation);
        twists.push((row, angular, linear));
    }
    let spread = spread(dag, angular, angular_rate);
    let base = State { angular, angular_rate, linear, spread, twists };
    equations.extend((torso + 1..frames.len()).map(Equation::Joint));
    pull(dag, frames, Some(torso), &base, (equations, terms))
}

fn pull(
    dag: &mut Dag,
    frames: &Frames,
    torso: Option<usize>,
    base: &State,
    (equations, terms): (Vec<Equation>, MotionTerms),
) -> MatterRegressor {
    let zero = dag.zero();
    let mut rows = vec![vec![[zero; 10]; frames.len()]; equations.len()];
    let mut states: Vec<Option<State>> = Vec::new();
    for (i, frame) in frames.frames.iter().enumerate() {
        let state = if torso == Some(i) {
            Some(base.clone())
        } else {
            let parent = match (frame.parent, torso) {
                (Some(p), _) => states[p].clone(),
                (None, None) => Some(base.clone()),
                (None, Some(_)) => None,
            };
            let row = equations.iter().position(|&equation| equation == Equation::Joint(i));
            parent
                .zip(row)
                .map(|(parent, row)| step(dag, frames, (i, frame), &parent, (row, terms)))
        };
        if let Some(state) = &state {
            for &(row, angular, linear) in &state.twists {
                rows[row][i] = powers(dag, state, angular, linear);
            }
        }
        states.push(state);
    }
    MatterRegressor { rows, equations }
}

/// The state of frame `i` from that of its parent.
fn step(
    dag: &mut Dag,
    frames: &Frames,
    (i, frame): (usize, &Frame),
    parent: &State,
    (row, terms): (usize, MotionTerms),
) -> State {
    let (zero, one) = (dag.zero(), dag.one());
    let qd = if terms.rates { frame.variables.qd } else { zero };
    let qdd = if terms.accelerations { frame.variables.qdd } else { zero };
    let turning = parent.spread.map(|row| dot(dag, row, frame.offset));
    let linear = add(dag, parent.linear, turning);
    let mut linear = frames.to_child(dag, i, linear);
    let mut angular = frames.to_child(dag, i, parent.angular);
    let mut angular_rate = frames.to_child(dag, i, parent.angular_rate);
    let mut twists = Vec::new();
    for &(row, w, v) in &parent.twists {
        let moved = cross(dag, w, frame.offset);
        let v = add(dag, v, moved);
        twists.push((row, frames.to_child(dag, i, w), frames.to_child(dag, i, v)));
    }
    let (along, none) = ([zero, zero, one], [zero; 3]);
    let rate = if frame.is_revolute { qd } else { dag.add(qd, qd) };
    let (x, y) = (dag.mul(rate, angular[1]), dag.mul(rate, angular[0]));
    let changed = if frame.is_revolute { &mut angular_rate } else { &mut linear };
    *changed = [dag.add(changed[0], x), dag.sub(changed[1], y), dag.add(changed[2], qdd)];
    if frame.is_revolute {
        angular[2] = dag.add(angular[2], qd);
        twists.push((row, along, none));
    } else {
        twists.push((row, none, along));
    }
    let spread = spread(dag, angular, angular_rate);
    State { angular, angular_rate, linear, spread, twists }
}

/// U = \[wd\]x + \[w\]x \[w\]x.
fn spread(dag: &mut Dag, w: Vector, wd: Vector) -> Matrix {
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

/// The power of the wrench of each unit of matter on a twist (w, v).
///
/// The wrench of matter is force = U s + m a, moment = vee(U K - (U K)^T) + s x a; what is said
/// here are its coefficients, entry by entry.
fn powers(dag: &mut Dag, state: &State, w: Vector, v: Vector) -> [ExprId; 10] {
    let (u, a) = (&state.spread, state.linear);
    let mut difference_of_products = |x: [ExprId; 2], y: [ExprId; 2]| {
        let (left, right) = (dag.mul(x[0], x[1]), dag.mul(y[0], y[1]));
        dag.sub(left, right)
    };
    let k11 = difference_of_products([w[2], u[1][0]], [w[1], u[2][0]]);
    let k22 = difference_of_products([w[0], u[2][1]], [w[2], u[0][1]]);
    let k33 = difference_of_products([w[1], u[0][2]], [w[0], u[1][2]]);
    let k12 = difference_of_products([w[0], u[2][0]], [w[1], u[2][1]]);
    let k13 = difference_of_products([w[2], u[1][2]], [w[0], u[1][0]]);
    let k23 = difference_of_products([w[1], u[0][1]], [w[2], u[0][2]]);
    let mut with_diagonal = |sum: ExprId, w: ExprId, i: usize, j: usize| {
        let difference = dag.sub(u[i][i], u[j][j]);
        let product = dag.mul(w, difference);
        dag.add(sum, product)
    };
    let k12 = with_diagonal(k12, w[2], 1, 0);
    let k13 = with_diagonal(k13, w[1], 0, 2);
    let k23 = with_diagonal(k23, w[0], 2, 1);
    let lever = cross(dag, a, w);
    let first = [0, 1, 2].map(|k| {
        let turning = dot(dag, v, [u[0][k], u[1][k], u[2][k]]);
        dag.add(turning, lever[k])
    });
    let mass = dot(dag, v, a);
    [mass, first[0], first[1], first[2], k11, k22, k33, k12, k13, k23]
}
