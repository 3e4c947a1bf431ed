//! What the torques that bodies ask for change by where one joint moves a little otherwise.

use super::nominal::{Nominal, Phi};
use super::rows::{PerJoint, of_axes};
use super::signals::{Shared, Signals};
use denavit_measure::JointIndex;
use std::rc::Rc;

/// Derivatives of the loads of all joints, and of what springs pass on, by the position, velocity
/// and acceleration of one joint, at the samples of a motion.
#[derive(Clone, Debug)]
pub(super) struct LoadSlopes {
    pub(super) joint: JointIndex,
    by: [PerJoint; 3],
    /// Joints before springs.
    sprung: Vec<JointIndex>,
}

/// By which a position is moved to either side for a difference [rad, m]: of order 2, so that
/// rounding and the rest of the Taylor series are far below what a first look asks for, 1e-8.
const DIFFERENCE: f64 = 1e-4;

impl LoadSlopes {
    pub(super) fn new(
        nominal: &Nominal<'_>,
        signals: &Signals,
        phi: &Phi,
        joint: JointIndex,
    ) -> Self {
        let moved = |of: fn(&mut Signals) -> &mut Vec<Shared>, by: f64| {
            let mut signals = signals.clone();
            let all = Rc::make_mut(&mut of(&mut signals)[joint.0]);
            all.iter_mut().for_each(|sample| *sample += by);
            of_axes(nominal, &signals, &phi.loads, true)
        };
        // loads are of the second degree in velocities and of the first in accelerations
        let slopes = |of: fn(&mut Signals) -> &mut Vec<Shared>, by: f64| {
            let (mut ahead, behind) = (moved(of, by), moved(of, -by));
            let both = ahead.iter_mut().flatten().zip(behind.iter().flatten());
            both.for_each(|(ahead, behind)| *ahead = (*ahead - behind) / (2.0 * by));
            ahead
        };
        let by = [
            slopes(|signals| &mut signals.q, DIFFERENCE),
            slopes(|signals| &mut signals.qd, 1.0),
            slopes(|signals| &mut signals.qdd, 1.0),
        ];
        let sprung = nominal.springs.iter().map(|spring| spring.joint).collect();
        Self { joint, by, sprung }
    }

    /// The inertia of the bodies about the joint [kg m^2, kg].
    pub(super) fn inertia(&self) -> &[f64] {
        &self.by[2][self.joint.0]
    }

    /// What all equations have more where the joint is ahead of the motion by so much at each
    /// sample [rad, m].
    pub(super) fn of(&self, signals: &Signals, ahead: &[f64]) -> PerJoint {
        let sprung = self.sprung.iter().map(|joint| joint.0);
        self.of_joints((0..self.by[0].len()).chain(sprung), signals, ahead)
    }

    /// The same of the joint's own equation.
    pub(super) fn of_own(&self, signals: &Signals, ahead: &[f64]) -> Vec<f64> {
        self.of_joints([self.joint.0], signals, ahead).swap_remove(0)
    }

    fn of_joints(
        &self,
        joints: impl IntoIterator<Item = usize>,
        signals: &Signals,
        ahead: &[f64],
    ) -> PerJoint {
        let [rates, accelerations] = signals.derivatives(&signals.cell_means(ahead));
        let of_joint = |joint: usize| {
            let [by_q, by_qd, by_qdd] = self.by.each_ref().map(|by| &by[joint]);
            let motion = ahead.iter().zip(&rates).zip(&accelerations);
            let slopes = by_q.iter().zip(by_qd).zip(by_qdd);
            let all = motion.zip(slopes);
            all.map(|(((q, qd), qdd), ((a, b), c))| a * q + b * qd + c * qdd).collect()
        };
        joints.into_iter().map(of_joint).collect()
    }
}
