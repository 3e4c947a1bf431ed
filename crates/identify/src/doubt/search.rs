//! The search for the reading of columns that explains logs best.

use super::misreading::Misreading;
use super::policy;
use super::reading::{Reading, hypotheses};
use super::sample::Sample;
use super::weigh::{Beliefs, Believed, Noise, Shares, Trust, together};
use crate::estimate::noise_of_positions;
use denavit_evidence::policy::NAMED;
use denavit_measure::JointIndex;
use denavit_measure::condition::Conditioned;

/// What search and answers have in common.
pub(super) struct Search<'a> {
    pub(super) sample: Sample<'a>,
    pub(super) beliefs: Beliefs,
    /// How much of each joint's torque noise of the positions makes by the values that are given:
    /// where that explains what these leave, nothing is tried that makes less of it, whatever is
    /// true; and how much of what an estimate of the columns as they are leaves: no reading leaves
    /// less than that.
    pub(super) noise: [Vec<f64>; 2],
    /// Signals are at most so many samples late.
    pub(super) latest: isize,
    /// Seconds of a sample.
    pub(super) step_s: f64,
}

/// A mistake that explains the logs better.
pub(super) struct Found {
    pub(super) misreading: Misreading,
    /// Log odds that it was made.
    pub(super) log_odds: f64,
    /// By how much the log evidence grows of an estimate, whatever values are given.
    pub(super) by_estimate: f64,
    /// Whether values that are given are near the truth with it.
    is_near: bool,
    /// Its size in standard errors, if it has one.
    pub(super) errors: Option<f64>,
}

/// A reading, and what its rows say.
struct Weighed {
    all: Vec<Believed>,
    /// Of each column of torque.
    noise: Vec<Noise>,
}

impl Weighed {
    fn of_estimate(&self) -> &Believed {
        self.all.last().expect("values are off in some way")
    }
}

impl Search<'_> {
    /// The shares that values which are given leave under a reading, and those that an estimate
    /// does.
    pub(super) fn left(&mut self, reading: &Reading) -> (Option<Shares>, Shares) {
        let by_values = self.beliefs.values.clone().map(|phi| self.sample.left_by(reading, &phi));
        let estimate = self.straight(reading).all.pop().expect("values are off in some way");
        (by_values, self.sample.left_by(reading, &estimate.phi))
    }

    /// Weighs a reading that others are held against.
    fn straight(&mut self, reading: &Reading) -> Weighed {
        let rows = self.sample.rows(reading);
        // all joints count alike: else one that is explained badly could be given up for another
        let noise = |independent: Vec<f64>| -> Vec<Noise> {
            let independent = independent.into_iter().fold(f64::INFINITY, f64::min);
            self.noise[1].iter().map(|&share| Noise { independent, share }).collect()
        };
        let by_filter = noise(self.sample.independent_by_filter());
        let all = self.beliefs.weigh(&rows, &reading.by_joint(&by_filter));
        let phi = &all.last().expect("values are off in some way").phi;
        let noise = noise(self.sample.independent(reading, phi));
        let all = self.beliefs.weigh(&rows, &reading.by_joint(&noise));
        Weighed { all, noise }
    }

    /// Weighs another reading of the same columns.
    fn other(&mut self, reading: &Reading, straight: &Weighed) -> Weighed {
        let rows = self.sample.rows(reading);
        let all = self.beliefs.weigh(&rows, &reading.by_joint(&straight.noise));
        Weighed { all, noise: straight.noise.clone() }
    }

    /// Finds how much noise of the positions makes of what is left: by values, or by an estimate,
    /// which noise makes smaller, and no more than is left.
    pub(super) fn learn_noise(&mut self, logs: &[&Conditioned]) {
        let model = self.sample.model;
        let straight = Reading::straight(model.joints.len());
        self.noise[1] = vec![0.0; model.joints.len()];
        let estimate = self.straight(&straight).all.pop().expect("values are off in some way");
        let left = self.sample.left_by(&straight, &estimate.phi);
        let made = noise_of_positions(model, logs, estimate.phi.as_slice());
        for (joint, made) in made.into_iter().enumerate() {
            let by_values = self.noise[0].get(joint).copied().unwrap_or(0.0);
            self.noise[1][joint] = made.max(by_values).min(left[joint].unwrap_or(0.0));
        }
    }

    /// The mistake that is believed most, beside a reading.
    pub(super) fn best(&mut self, reading: &Reading) -> Option<Found> {
        let straight = self.straight(reading);
        let mut found: Vec<Found> = Vec::new();
        let fit = self.sample.left_by(reading, &straight.of_estimate().phi);
        let values = self.beliefs.values.clone();
        let own = values.map(|phi| self.sample.left_by(reading, &phi));
        let is_noisy = self.is_noise(&fit) || own.is_some_and(|own| self.is_noise(&own));
        for one in self.tried(reading, &fit, is_noisy) {
            let other = self.other(&reading.with(one, &self.sample.model.joints), &straight);
            found.push(Found::new(one, &straight, &other, None));
        }
        found.extend(self.along_lines(reading, &straight, is_noisy));
        let best = found.into_iter().max_by(|a, b| a.log_odds.total_cmp(&b.log_odds))?;
        (best.log_odds > NAMED).then_some(best)
    }

    /// The mistakes of no size that are worth an estimate.
    fn tried(&mut self, reading: &Reading, fit: &Shares, is_noisy: bool) -> Vec<Misreading> {
        let model = self.sample.model;
        let mut tried = hypotheses(model, &|joint| fit[joint.0].is_some());
        tried.retain(|one| reading.with(*one, &model.joints) != *reading);
        tried.retain(|one| !(is_noisy && one.hides_noise()));
        // nothing is seen of a position that does not change
        tried.retain(|one| one.positions_of().iter().all(|&joint| self.sample.moves(joint)));
        let Some(values) = self.beliefs.values.clone() else { return tried };
        // those that the values like best, as far as all are too many
        let mut liked: Vec<(f64, Misreading)> = Vec::new();
        for one in tried {
            let left = self.sample.left_by(&reading.with(one, &model.joints), &values);
            let size = |share: f64| share.max(denavit_evidence::policy::NOISE_LEVEL).ln();
            liked.push((left.iter().flatten().map(|share| size(*share)).sum(), one));
        }
        liked.sort_by(|a, b| a.0.total_cmp(&b.0));
        liked.truncate(policy::ESTIMATED);
        liked.into_iter().map(|(_, one)| one).collect()
    }

    /// Whether noise of the positions explains what is left of some torque.
    fn is_noise(&self, left: &Shares) -> bool {
        let mut both = left.iter().zip(&self.noise[0]);
        both.any(|(left, noise)| left.is_some_and(|left| *noise > policy::NOISE_OF_LEFT * left))
    }

    /// Lines that begin at a reading: delays, unless something is late already, constants and
    /// gains. Noise of the positions makes parameters smaller, which gains and delays resemble.
    fn lines(&self, reading: &Reading, is_noisy: bool) -> Vec<Misreading> {
        let joints = &self.sample.model.joints;
        let real = (0..joints.len()).map(JointIndex).filter(|joint| !joints[joint.0].is_base);
        let several = real.clone().count() > 1;
        let measured = |joint: &JointIndex| self.sample.is_measured(*joint);
        let moving: Vec<JointIndex> =
            real.clone().filter(|&joint| self.sample.moves(joint)).collect();
        let mut lines = Vec::new();
        if self.latest > 0 && !reading.is_shifted() && !is_noisy {
            lines.push(Misreading::Late(0));
            let one_by_one = moving.iter().filter(|_| several);
            lines.extend(one_by_one.clone().map(|&joint| Misreading::LatePosition(joint, 0)));
            let measured = one_by_one.copied().filter(measured);
            lines.extend(measured.map(|joint| Misreading::LateTorque(joint, 0)));
        }
        lines.extend(moving.iter().map(|&joint| Misreading::Zero(joint, 0.0)));
        let offset = |joint| Misreading::TorqueOffset(joint, 0.0);
        lines.extend(real.clone().filter(measured).map(offset));
        let gains = real.filter(measured).filter(|_| several && !is_noisy);
        lines.extend(gains.map(|joint| Misreading::TorqueGain(joint, 1.0)));
        lines
    }

    /// The best readings on lines.
    fn along_lines(&mut self, reading: &Reading, straight: &Weighed, is_noisy: bool) -> Vec<Found> {
        let lines = self.lines(reading, is_noisy);
        let torque = self.sample.torques(reading);
        let deviation: Vec<f64> =
            lines.iter().map(|line| line.deviation(self.step_s, &torque)).collect();
        // of values that are off by little and by much the slopes are others
        let noise = reading.by_joint(&straight.noise);
        let mut found = Vec::new();
        for (trust, one) in self.beliefs.trusts().into_iter().zip(&straight.all) {
            let rows = &self.sample.rows_along(reading, &lines, &one.phi);
            let gain = |line: usize| {
                let beside = Some((line, deviation[line]));
                let with = self.beliefs.weigh_with(rows, &noise, beside, trust);
                with.log_evidence - one.log_evidence
            };
            let mut promising: Vec<(f64, usize)> =
                (0..lines.len()).map(|line| (gain(line), line)).collect();
            promising.retain(|(gain, _)| *gain > NAMED);
            promising.sort_by(|a, b| b.0.total_cmp(&a.0));
            for &(_, line) in promising.iter().take(policy::FOLLOWED) {
                let (line, deviation) = (lines[line], deviation[line]);
                found.extend(self.along(reading, straight, line, deviation, trust, one));
            }
        }
        found
    }

    /// The best reading on a line, if values are believed so far.
    fn along(
        &mut self,
        reading: &Reading,
        straight: &Weighed,
        line: Misreading,
        deviation: f64,
        trust: Trust,
        from: &Believed,
    ) -> Option<Found> {
        let mut phi = from.phi.clone();
        let (mut size, mut std) = (0.0, deviation);
        let model = self.sample.model;
        for _ in 0..policy::LINEARISED {
            let here = reading.with(line.of_size(size), &model.joints);
            let rows = self.sample.rows_along(&here, &[line], &phi);
            let noise = here.by_joint(&straight.noise);
            let beside = Some((0, deviation));
            let told = self.beliefs.weigh_with(&rows, &noise, beside, trust);
            let (step, error) = told.more?;
            let before = size;
            size += (step * deviation).clamp(-2.0 * deviation, 2.0 * deviation);
            if line.is_late() {
                size = size.round().clamp(-self.latest as f64, self.latest as f64);
            }
            (phi, std) = (told.phi, error * deviation);
            if (size - before).abs() < policy::STEPS_SETTLED * std.max(f64::MIN_POSITIVE) {
                break;
            }
        }
        let misreading = line.of_size(size);
        let other = reading.with(misreading, &model.joints);
        if other == *reading {
            return None;
        }
        let other = self.other(&other, straight);
        let sized = Sized { size: size / deviation, std: std / deviation };
        Some(Found::new(misreading, straight, &other, Some(sized)))
    }
}

/// The size of a mistake and its error, in deviations of what is believed of it.
struct Sized {
    size: f64,
    std: f64,
}

impl Found {
    fn new(misreading: Misreading, before: &Weighed, after: &Weighed, size: Option<Sized>) -> Self {
        // Laplace's: how much narrower than believed the logs make it, and how far off it is
        let cost = size.as_ref().map_or(0.0, |one| one.std.ln() - 0.5 * one.size * one.size);
        let gain = together(&after.all) - together(&before.all);
        let of_estimate = |one: &Weighed| one.of_estimate().log_evidence;
        Self {
            misreading,
            log_odds: policy::MISLABELLED + gain + cost,
            by_estimate: of_estimate(after) - of_estimate(before) + cost,
            is_near: after.all.len() > 1
                && after.all[1..].iter().all(|one| one.log_evidence < after.all[0].log_evidence),
            errors: size.map(|one| one.size / one.std),
        }
    }

    /// Whether nothing else explains it. What differs by degrees may be a law that the model lacks,
    /// and what values alone tell may be values that are off, unless they are near with it.
    pub(super) fn is_sure(&self) -> bool {
        let by_estimate = self.by_estimate > NAMED;
        match self.misreading {
            Misreading::Late(_) => by_estimate && self.is_near,
            one if one.is_by_degrees() => false,
            _ => by_estimate || self.is_near,
        }
    }
}
