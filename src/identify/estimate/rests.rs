//! Rests of joints that move in between: their rows count beside a constant.
//!
//! While a joint rests its friction is anything that holds it, and not the sign of its rate. Where
//! its motor carries the load of the motion of the others, which shows parameters that nothing else
//! may show, friction is a constant of the rest, and the rows count beside it. Where stiction or a
//! brake carries it, the torque does not follow the load, or an estimate leaves more of it than
//! while the joint moves: such rows are left out.

use super::condensed::Condensed;
use super::left_out::LeftOut;
use super::misread::nominal_values;
use super::rows::BlockMaker;
use super::weights::ByLog;
use crate::identify::condition::Conditioned;
use crate::plants::regression::{CoulombLaw, RegressionModel};
use std::ops::Range;

/// How much the torque of a joint at rest must be like the load that the model's own values make of
/// the motion of the others, as a correlation.
const ALIKE: f64 = 0.7;

/// The variance of what is left at rest over that of what an estimate from motion alone leaves of
/// motion, above which something else than the motor holds the joint.
const HELD: f64 = 4.0;

impl LeftOut {
    /// Counts rests in which the torque of a joint follows the load that the model's values make.
    pub(super) fn add_rests(&mut self, model: &RegressionModel, logs: &[Conditioned]) {
        let values = nominal_values(model).filter(|_| model.law == CoulombLaw::Sign);
        let Some(values) = values else { return };
        for (number, log) in logs.iter().enumerate() {
            let awake = |joint: usize| {
                self.rows[number][joint].as_ref().filter(|_| log.torque[joint].is_some())?;
                let rests = log.counted_rests(joint)?;
                Some(rests.into_iter().map(|rests| !rests).collect())
            };
            self.awake[number] = (0..log.joints()).map(awake).collect();
            let follows = self.follows(model, (number, log), &values);
            for (awake, follows) in self.awake[number].iter_mut().zip(follows) {
                awake.take_if(|_| !follows);
            }
        }
    }

    /// Whether the torque of each joint follows the load while it rests.
    fn follows(
        &self,
        model: &RegressionModel,
        (number, log): (usize, &Conditioned),
        values: &[f64],
    ) -> Vec<bool> {
        let rests = self.all_rests((number, log));
        // the squares of torque and load, and their product
        let mut sums = vec![[0.0; 3]; rests.len()];
        let mut maker = BlockMaker::resting(model, log, &rests);
        for (joint, (rests, sums)) in rests.iter().zip(&mut sums).enumerate() {
            let own: Vec<f64> = model.pattern()[joint].iter().map(|&at| values[at]).collect();
            for rest in rests {
                maker.for_each_of(rest.clone(), |block| {
                    let Some(left) = block.residual(joint, &own) else { return };
                    let Some([_, torque]) = &block.torque[joint] else { return };
                    for (left, torque) in left.iter().zip(torque) {
                        let load = torque - left;
                        let squares = [torque * torque, load * load, torque * load];
                        sums.iter_mut().zip(squares).for_each(|(sum, one)| *sum += one);
                    }
                });
            }
        }
        let follows = |[torque, load, both]: [f64; 3]| {
            both > 0.0 && both * both > ALIKE.powi(2) * torque * load
        };
        sums.into_iter().map(follows).collect()
    }

    /// The samples in which a joint rests and counts, of those that are left after decimation.
    pub(super) fn rests(
        &self,
        (number, log): (usize, &Conditioned),
        joint: usize,
    ) -> Vec<Range<usize>> {
        let Some(awake) = &self.awake[number][joint] else { return Vec::new() };
        let mut rests: Vec<Range<usize>> = Vec::new();
        let counts = log.counts(awake, 0, log.samples());
        for at in (0..counts.len()).filter(|&at| counts[at]) {
            match rests.last_mut().filter(|last| last.end == at) {
                Some(last) => last.end = at + 1,
                None => rests.push(at..at + 1),
            }
        }
        rests
    }

    /// The same of all joints.
    pub(super) fn all_rests(&self, log: (usize, &Conditioned)) -> Vec<Vec<Range<usize>>> {
        (0..self.awake[log.0].len()).map(|joint| self.rests(log, joint)).collect()
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

    /// The same without rests of joints in which something else than their motors holds them: phi
    /// leaves more of their torques there than an estimate from motion alone does of that; `moving`
    /// is the mean square of it, by log and joint. None if there are none.
    pub(super) fn without_held(
        &self,
        model: &RegressionModel,
        logs: &[Conditioned],
        (phi, moving): (&[f64], &ByLog),
    ) -> Option<Self> {
        let alone = self.of_rests_alone()?;
        let left = Condensed::counted(model, (logs, &alone)).mean_squares(phi);
        let mut fewer = self.clone();
        for (log, awake) in fewer.awake.iter_mut().enumerate() {
            for (joint, awake) in awake.iter_mut().enumerate() {
                awake.take_if(|_| left[log][joint] > HELD * moving[log][joint]);
            }
        }
        (0..logs.len()).for_each(|log| fewer.keep_enough((log, logs)));
        (fewer != *self).then_some(fewer)
    }
}

impl Condensed {
    /// The mean square of what phi leaves of each joint in each log.
    pub(super) fn mean_squares(&self, phi: &[f64]) -> ByLog {
        let triangles = self.whole();
        let mut left = self.squares(&triangles, phi);
        for (left, triangle) in left.iter_mut().flatten().zip(triangles.iter().flatten()) {
            *left /= triangle.rows().max(1) as f64;
        }
        left
    }
}
