//! The state of a simulated robot.

use std::ops::Range;

/// Positions and rates of joints and motors at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// \[s\].
    pub t_s: f64,
    /// Joint positions, in the order of the plant [rad, m].
    pub q: Vec<f64>,
    /// Joint rates [rad/s, m/s].
    pub qd: Vec<f64>,
    /// Motor angles of the series elastic joints, in joint order, before the gear \[rad\].
    pub motor: Vec<f64>,
    /// Their rates [rad/s].
    pub motor_rate: Vec<f64>,
    /// States of the laws of added effects; where there are none, a run begins with their own
    /// initial values.
    pub laws: Vec<f64>,
}

impl State {
    /// At rest at t = 0 in this position; motors, if any, with relaxed springs.
    pub fn resting(q: Vec<f64>) -> Self {
        Self { qd: vec![0.0; q.len()], q, ..Self::default() }
    }
}

/// Where the parts of a state stand in the vector that is integrated: q, motor angles, qd, motor
/// rates, states of laws, then two integrals: work put in, and energy lost to friction \[J\].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    pub(super) joints: usize,
    pub(super) motors: usize,
    pub(super) laws: usize,
}

/// The integrals at the end of the vector.
pub(super) const INTEGRALS: usize = 2;

impl Layout {
    pub(super) fn len(self) -> usize {
        2 * (self.joints + self.motors) + self.laws + INTEGRALS
    }

    /// Number of positions, of joints and motors.
    pub(super) fn positions(self) -> usize {
        self.joints + self.motors
    }

    /// Where the rates of the joints stand.
    pub(super) fn joint_rates(self) -> Range<usize> {
        self.positions()..self.positions() + self.joints
    }

    pub(super) fn parts(self, y: &[f64]) -> Parts<'_> {
        let (q, rest) = y.split_at(self.joints);
        let (motor, rest) = rest.split_at(self.motors);
        let (qd, rest) = rest.split_at(self.joints);
        let (motor_rate, rest) = rest.split_at(self.motors);
        let (laws, integrals) = rest.split_at(self.laws);
        Parts { q, qd, motor, motor_rate, laws, work_in: integrals[0], lost: integrals[1] }
    }

    pub(super) fn pack(self, state: &State) -> Vec<f64> {
        let mut y = Vec::with_capacity(self.len());
        for part in [&state.q, &state.motor, &state.qd, &state.motor_rate, &state.laws] {
            y.extend_from_slice(part);
        }
        y.resize(self.len(), 0.0);
        y
    }

    pub(super) fn unpack(self, t_s: f64, y: &[f64]) -> State {
        let parts = self.parts(y);
        State {
            t_s,
            q: parts.q.to_vec(),
            qd: parts.qd.to_vec(),
            motor: parts.motor.to_vec(),
            motor_rate: parts.motor_rate.to_vec(),
            laws: parts.laws.to_vec(),
        }
    }
}

impl<'a> Parts<'a> {
    /// Those of a state.
    pub(super) fn of(state: &'a State) -> Self {
        let State { q, qd, motor, motor_rate, laws, .. } = state;
        Self { q, qd, motor, motor_rate, laws, work_in: 0.0, lost: 0.0 }
    }
}

/// The parts of an integrated vector.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parts<'a> {
    pub(super) q: &'a [f64],
    pub(super) qd: &'a [f64],
    pub(super) motor: &'a [f64],
    pub(super) motor_rate: &'a [f64],
    pub(super) laws: &'a [f64],
    pub(super) work_in: f64,
    pub(super) lost: f64,
}
