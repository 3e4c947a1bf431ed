//! The regressor by pulling joint twists outwards, for arms and for robots on a moving torso.
//!
//! The equation of joint j is the power of the wrenches that move the bodies, at unit rate of the
//! joint. The twist of that rate is carried outwards to each body and multiplied with the wrench
//! of each unit of matter there. Nothing is carried back, so no intermediate result is larger than
//! an entry. On a torso (math: quasi-velocities) the motion of the torso is given by its angular
//! velocity, angular acceleration and acceleration minus gravity, all free, in its own
//! coordinates; its six equations are the moment and the force on it. Whatever holds for the
//! columns in these variables holds in those of a virtual chain, which determine them.

use super::inertial::ENTRIES;
use super::matter::{FrameMotion, power_on_entries};
use crate::expr::{Dag, ExprId, SymbolClass};
use crate::kinematics::Frames;
use crate::model::JointVariables;
use crate::spatial::{Turn, Vector, add, cross, dot, negate, zero};

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

/// The equations of motion as a linear function of the pseudo-inertias of the bodies about the
/// origins of their frames.
#[derive(Clone, Debug)]
pub struct MatterRegressor {
    /// For each equation, for each body, the factors of its ten entries: mass, first moment x, y,
    /// z, then K11, K22, K33, K12, K13, K23.
    pub rows: Vec<Vec<[ExprId; ENTRIES]>>,
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

/// The twist of one equation at unit rate, in a frame's coordinates.
#[derive(Clone, Copy)]
pub(super) struct Twist {
    /// The row.
    pub(super) row: usize,
    /// Angular part.
    pub(super) angular: Vector,
    /// Velocity of the frame's origin.
    pub(super) linear: Vector,
}

/// The motion of one frame and the twists of all equations there.
#[derive(Clone)]
pub(super) struct State {
    pub(super) motion: FrameMotion,
    pub(super) twists: Vec<Twist>,
}

impl State {
    /// Frame 0 of a robot on a fixed base.
    pub(super) fn fixed(dag: &mut Dag, gravity: Vector, terms: MotionTerms) -> Self {
        let still = zero(dag);
        let linear = if terms.gravity { negate(dag, gravity) } else { still };
        let motion = FrameMotion { angular: still, angular_rate: still, linear };
        Self { motion, twists: Vec::new() }
    }

    /// The frame fixed in the same body whose origin is at `offset` (in the coordinates before the
    /// turns) and which is turned by `turns`.
    pub(super) fn moved_then_turned<'a>(
        &self,
        dag: &mut Dag,
        offset: Vector,
        turns: impl Iterator<Item = &'a Turn> + Clone,
    ) -> Self {
        let mut moved = self.clone();
        moved.shift(dag, offset);
        moved.turned(dag, turns)
    }

    /// The same with the offset in the coordinates after the turns.
    pub(super) fn turned_then_moved<'a>(
        &self,
        dag: &mut Dag,
        offset: Vector,
        turns: impl Iterator<Item = &'a Turn> + Clone,
    ) -> Self {
        let mut turned = self.turned(dag, turns);
        turned.shift(dag, offset);
        turned
    }

    pub(super) fn shift(&mut self, dag: &mut Dag, offset: Vector) {
        if offset == zero(dag) {
            return;
        }
        let spread = self.motion.spread(dag).map(|row| dot(dag, row, offset));
        self.motion.linear = add(dag, self.motion.linear, spread);
        for twist in &mut self.twists {
            let lever = cross(dag, twist.angular, offset);
            twist.linear = add(dag, twist.linear, lever);
        }
    }

    pub(super) fn turned<'a>(
        &self,
        dag: &mut Dag,
        turns: impl Iterator<Item = &'a Turn> + Clone,
    ) -> Self {
        let mut turn =
            |vector: Vector| turns.clone().fold(vector, |vector, turn| turn.to_child(dag, vector));
        let FrameMotion { angular, angular_rate, linear } = self.motion;
        let motion = FrameMotion {
            angular: turn(angular),
            angular_rate: turn(angular_rate),
            linear: turn(linear),
        };
        let twists = self.twists.iter().map(|twist| Twist {
            row: twist.row,
            angular: turn(twist.angular),
            linear: turn(twist.linear),
        });
        Self { motion, twists: twists.collect() }
    }

    /// The frame that a joint moves, from the one it would be without rates of its own.
    pub(super) fn jointed(
        mut self,
        dag: &mut Dag,
        variables: JointVariables,
        is_revolute: bool,
        row: usize,
        terms: MotionTerms,
    ) -> Self {
        let (zero, one) = (dag.zero(), dag.one());
        let qd = if terms.rates { variables.qd } else { zero };
        let qdd = if terms.accelerations { variables.qdd } else { zero };
        let motion = &mut self.motion;
        let rate = if is_revolute { qd } else { dag.add(qd, qd) };
        let (x, y) = (dag.mul(rate, motion.angular[1]), dag.mul(rate, motion.angular[0]));
        let changed = if is_revolute { &mut motion.angular_rate } else { &mut motion.linear };
        *changed = [dag.add(changed[0], x), dag.sub(changed[1], y), dag.add(changed[2], qdd)];
        let (along, none) = ([zero, zero, one], [zero; 3]);
        let (angular, linear) = if is_revolute { (along, none) } else { (none, along) };
        if is_revolute {
            motion.angular[2] = dag.add(motion.angular[2], qd);
        }
        self.twists.push(Twist { row, angular, linear });
        self
    }
}

/// The regressor of a robot on a fixed base. Bodies are the frames.
pub fn fixed_base_regressor(dag: &mut Dag, frames: &Frames, terms: MotionTerms) -> MatterRegressor {
    let base = State::fixed(dag, frames.gravity, terms);
    let equations = (0..frames.len()).map(Equation::Joint).collect();
    pull(dag, frames, None, &base, equations, terms)
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
    torso: usize,
    motion: TorsoMotion,
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
    let motion = FrameMotion {
        angular: free("w", SymbolClass::Rate, turns, terms.rates),
        angular_rate: free("wd", SymbolClass::Acceleration, turns, accelerates),
        linear: free("a", SymbolClass::Acceleration, moves, accelerates || terms.gravity),
    };
    let unit = |axis: usize| [0, 1, 2].map(|k| if k == axis { one } else { zero });
    let none = [zero; 3];
    let moments = turns.iter().map(|&axis| (Equation::TorsoMoment(axis), unit(axis), none));
    let forces = moves.iter().map(|&axis| (Equation::TorsoForce(axis), none, unit(axis)));
    let (mut equations, mut twists) = (Vec::new(), Vec::new());
    for (row, (equation, angular, linear)) in moments.chain(forces).enumerate() {
        equations.push(equation);
        twists.push(Twist { row, angular, linear });
    }
    equations.extend((torso + 1..frames.len()).map(Equation::Joint));
    pull(dag, frames, Some(torso), &State { motion, twists }, equations, terms)
}

fn pull(
    dag: &mut Dag,
    frames: &Frames,
    torso: Option<usize>,
    base: &State,
    equations: Vec<Equation>,
    terms: MotionTerms,
) -> MatterRegressor {
    let zero = dag.zero();
    let mut rows = vec![vec![[zero; ENTRIES]; frames.len()]; equations.len()];
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
            parent.zip(row).map(|(parent, row)| {
                let turns = frame.seat.iter().chain(&frame.joint_turn);
                let seat = parent.moved_then_turned(dag, frame.offset, turns);
                seat.jointed(dag, frame.variables, frame.is_revolute, row, terms)
            })
        };
        if let Some(State { motion, twists }) = &state {
            for twist in twists {
                rows[twist.row][i] = power_on_entries(dag, motion, twist.angular, twist.linear);
            }
        }
        states.push(state);
    }
    MatterRegressor { rows, equations }
}
