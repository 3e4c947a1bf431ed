//! Rests of joints that move in between: their rows count beside a constant.
//!
//! While a joint rests its friction is anything that holds it, and not the sign of its rate. Where
//! its motor carries the load of the motion of the others, which shows parameters that nothing else
//! may show, friction is a constant of the rest, and the rows count beside it. Where stiction or a
//! brake carries it, an estimate leaves more of it than while the joint moves: such rows are left
//! out.

use super::left_out::{LeftOut, NumberedLog};
use super::left_over::Left;
use crate::policy::rests::{HELD, OF_FRICTION, WORST};
use denavit_measure::condition::Conditioned;
use denavit_measure::{JointIndex, LogIndex, SampleIndex};
use denavit_plants::regression::{CoulombLaw, RegressionModel};
use std::ops::Range;

impl LeftOut {
    /// Counts rests of joints whose torque was measured.
    pub(super) fn add_rests(&mut self, model: &RegressionModel, logs: &[Conditioned]) {
        if model.law != CoulombLaw::Sign {
            return;
        }
        for (number, log) in logs.iter().enumerate() {
            let awake = |joint: usize| {
                self.rows[number][joint].as_ref().filter(|_| log.torque[joint].is_some())?;
                let rests = log.counted_rests(JointIndex(joint))?;
                Some(rests.into_iter().map(|rests| !rests).collect())
            };
            self.awake[number] = (0..log.joints()).map(awake).collect();
        }
    }

    /// The samples in which a joint rests and counts, of those that are left after decimation.
    pub(super) fn rests(
        &self,
        NumberedLog { number, log }: NumberedLog<'_>,
        joint: JointIndex,
    ) -> Vec<Range<usize>> {
        let Some(awake) = &self.awake[number.0][joint.0] else { return Vec::new() };
        let mut rests: Vec<Range<usize>> = Vec::new();
        let counts = log.counts(awake, SampleIndex(0), log.samples());
        for at in (0..counts.len()).filter(|&at| counts[at]) {
            match rests.last_mut().filter(|last| last.end == at) {
                Some(last) => last.end = at + 1,
                None => rests.push(at..at + 1),
            }
        }
        rests
    }

    /// The same of all joints.
    pub(super) fn all_rests(&self, log: NumberedLog<'_>) -> Vec<Vec<Range<usize>>> {
        (0..self.awake[log.number.0].len())
            .map(|joint| self.rests(log, JointIndex(joint)))
            .collect()
    }

    /// The same with rests left out.
    pub(super) fn without_rests(mut self) -> Self {
        self.awake.iter_mut().flatten().for_each(|awake| *awake = None);
        self
    }

    /// Whether there are rests that count.
    pub(super) fn has_rests(&self) -> bool {
        self.awake.iter().flatten().any(Option::is_some)
    }

    /// Nothing counts but rests; none without any.
    fn of_rests_alone(&self) -> Option<Self> {
        if !self.has_rests() {
            return None;
        }
        let mut alone = self.clone();
        let all = |awake: &Option<Vec<bool>>| awake.as_ref().map(|awake| vec![true; awake.len()]);
        alone.rows = self.awake.iter().map(|of_log| of_log.iter().map(all).collect()).collect();
        Some(alone)
    }

    /// The same without the worst of rests in which something else than its motor holds a joint:
    /// phi leaves more of their torques there than an estimate from motion alone does of that;
    /// `moving` is what that leaves, by log and joint. None if there are none.
    pub(super) fn without_held(
        &self,
        model: &RegressionModel,
        logs: &[Conditioned],
        phi: &[f64],
        moving: &[Vec<Left>],
    ) -> Option<Self> {
        let left = self.of_rests_alone()?.left(model, logs, phi);
        let held = |log: usize, joint: usize| {
            self.awake[log][joint].as_ref()?;
            left[log][joint].held(&moving[log][joint])
        };
        let all =
            (0..logs.len()).flat_map(|log| (0..left[log].len()).map(move |joint| (log, joint)));
        // what holds one joint may be taken for parameters of others
        let most = all.clone().filter_map(|(log, joint)| held(log, joint)).fold(0.0, f64::max);
        let mut fewer = self.clone();
        for (log, joint) in all {
            if held(log, joint).is_some_and(|held| held >= WORST * most) {
                fewer.awake[log][joint] = None;
            }
        }
        (0..logs.len()).map(LogIndex).for_each(|log| fewer.keep_enough(log, logs));
        (fewer != *self).then_some(fewer)
    }
}

impl Left {
    /// How much more is left of a joint at rest than of motion, if something else than its motor
    /// holds it: so much of its friction, and more than noise, or, where noise of positions is
    /// larger in motion, more of what is none.
    fn held(&self, moving: &Self) -> Option<f64> {
        let left = self.mean_square();
        let is_more = left > HELD * moving.mean_square()
            || self.is_no_noise() && left > HELD * moving.without_noise();
        let is_held = is_more && left > (OF_FRICTION * moving.friction).powi(2);
        is_held.then(|| left / moving.mean_square().max(f64::MIN_POSITIVE))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use denavit_numerics::Random;
    use std::collections::VecDeque;

    const ROWS: usize = 600;
    const APART: usize = 4;

    /// What is left: a slow wave and white noise.
    fn left(seed: u64, [wave, noise]: [f64; 2]) -> Left {
        let mut random = Random::new(seed);
        let mut left = Left { apart: APART as f64, friction: 1.0, ..Left::default() };
        let mut recent = VecDeque::new();
        for k in 0..ROWS {
            let slow = wave * (0.05 * k as f64).sin();
            left.add(Some(slow + noise * random.normal()), &mut recent);
        }
        left
    }

    /// Stiction is told beside motion in which noise of the positions is ten times as large, by
    /// being slow, and beside motion without noise by its size; noise is none, however large it is,
    /// nor is what is little beside friction.
    #[test]
    fn what_holds_a_joint_is_told_from_noise() {
        for seed in [1, 2, 3] {
            let told = |rest: [f64; 2], moving: [f64; 2]| {
                left(seed, rest).held(&left(seed + 10, moving)).is_some()
            };
            assert!(told([0.4, 0.1], [0.0, 1.0]));
            assert!(told([0.4, 0.4], [0.0, 0.02]));
            assert!(!told([0.0, 0.5], [0.0, 0.4]));
            assert!(!told([0.0, 0.5], [0.0, 1.0]));
            assert!(!told([0.1, 0.02], [0.0, 0.01]));
            assert!(!told([0.4, 0.1], [0.4, 0.1]));
        }
    }
}
