//! What is left of torques: how much, and whether it is noise.

use super::left_out::LeftOut;
use super::rows::BlockMaker;
use denavit_evidence::policy::NAMED;
use denavit_measure::condition::Conditioned;
use denavit_plants::regression::RegressionModel;
use std::collections::VecDeque;

/// What is left of the torque of a joint in a log.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Left {
    pub(super) rows: f64,
    pub(super) squares: f64,
    /// Of rows half a period of the filter's cutoff apart their products, and mean squares.
    pub(super) alike: f64,
    pub(super) both: f64,
    /// Rows in that time.
    pub(super) apart: f64,
    /// Coulomb friction of the joint [N m, N].
    pub(super) friction: f64,
}

/// Samples that are left in so many periods of the filter's cutoff.
pub(crate) fn samples_of(log: &Conditioned, periods: f64) -> usize {
    let cutoff = log.filter.as_ref().map_or(0.5, |filter| filter.cutoff());
    ((periods / (cutoff * log.decimation.max(1) as f64)).ceil().min(1e6) as usize).max(1)
}

impl Left {
    /// Of no rows, that are compared with those so many before.
    pub(crate) fn over(apart: usize) -> Self {
        Self { apart: apart as f64, ..Self::default() }
    }

    /// Adds a row, or one that does not count; `recent` are those before, the last one first.
    pub(crate) fn add(&mut self, one: Option<f64>, recent: &mut VecDeque<Option<f64>>) {
        if let Some(one) = one {
            self.rows += 1.0;
            self.squares += one * one;
            if let Some(Some(other)) = recent.get(self.apart as usize - 1) {
                self.alike += one * other;
                self.both += 0.5 * (one * one + other * other);
            }
        }
        recent.push_front(one);
        recent.truncate(self.apart as usize);
    }

    pub(super) fn mean_square(&self) -> f64 {
        self.squares / self.rows.max(1.0)
    }

    /// The mean square of what is no noise.
    pub(crate) fn without_noise(&self) -> f64 {
        let alike = if self.both > 0.0 { self.alike / self.both } else { 0.0 };
        // rows that are independent, by whose number a correlation is likelier than none
        let nats = 0.25 * self.rows / self.apart * alike * alike;
        if alike > 0.0 && nats > NAMED { alike * self.mean_square() } else { 0.0 }
    }

    /// Whether most of it is no noise.
    pub(super) fn is_no_noise(&self) -> bool {
        2.0 * self.without_noise() > self.mean_square()
    }
}

impl LeftOut {
    /// What phi leaves of the rows that count, by log and joint.
    pub(super) fn left(
        &self,
        model: &RegressionModel,
        logs: &[Conditioned],
        phi: &[f64],
    ) -> Vec<Vec<Left>> {
        let of_joint = |joint: usize| model.pattern()[joint].iter().map(|&at| phi[at]).collect();
        let own: Vec<Vec<f64>> = (0..model.joints.len()).map(of_joint).collect();
        let of_log = |(number, log): (usize, &Conditioned)| {
            let apart = samples_of(log, 0.5);
            let rests = self.all_rests((number, log));
            let mut maker = BlockMaker::resting(model, log, &rests);
            let mut left: Vec<Left> = (0..own.len())
                .map(|joint| Left {
                    apart: apart as f64,
                    friction: maker.coulomb_friction(joint, phi),
                    ..Left::default()
                })
                .collect();
            let mut recent = vec![VecDeque::new(); left.len()];
            maker.for_each(|block| {
                for (joint, (left, recent)) in left.iter_mut().zip(&mut recent).enumerate() {
                    let Some(all) = block.residual(joint, &own[joint]) else { continue };
                    let counts = self.counts((number, log), joint, (block.first, block.samples));
                    for (k, one) in all.into_iter().enumerate() {
                        let one = counts.as_ref().is_none_or(|counts| counts[k]).then_some(one);
                        left.add(one, recent);
                    }
                }
            });
            left
        };
        logs.iter().enumerate().map(of_log).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows are compared with those half a period before, none that does not count between.
    #[test]
    fn rows_are_compared_over_half_a_period() {
        let mut left = Left { apart: 2.0, ..Left::default() };
        let mut recent = VecDeque::new();
        for one in [Some(1.0), None, Some(3.0), Some(5.0), None, Some(7.0)] {
            left.add(one, &mut recent);
        }
        assert_eq!((left.rows, left.squares), (4.0, 84.0));
        assert_eq!((left.alike, left.both), (3.0 + 35.0, 5.0 + 37.0));
    }
}
