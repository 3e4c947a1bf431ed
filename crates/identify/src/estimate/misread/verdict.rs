//! What two witnesses say of a reading: values that are given, and an estimate.

use super::balance::{Change, LEAST, Shares, root_mean_square};
use super::misreading::Misreading;

/// A witness speaks for a reading if what is left falls to this share,
pub(super) const BETTER: f64 = 0.5;

/// and to less than this: by the model's own values where all joints are in question, or the sign
/// of a torque; other columns of single joints, which other faults of a model's values resemble
/// more, if an estimate speaks for it too, and if not; and by an estimate.
const LEFT_OF_ALL: f64 = 0.63;
const LEFT_OF_ONE: f64 = 0.32;
const LEFT_ALONE: f64 = 0.1;
const LEFT_BY_ESTIMATE: f64 = 0.4;

/// What is of all joints alike changes what is left of half of them, at least.
const HALF: f64 = 0.5;

/// What leaves less than this has nothing to be explained better; for delays, which show in little,
/// an estimate that leaves less than this.
pub(super) const EXPLAINED: f64 = 0.02;
pub(super) const PROMPT: f64 = 0.005;

/// Where a reading makes more of the noise of positions, an estimate speaks for it, too, if less is
/// left all the same: this share in the geometric mean of all joints, where their residuals are so
/// much likelier (the logarithm, of independent samples) than as the log stands.
const LESS: f64 = 0.8;
const LIKELIER: f64 = 30.0;

/// A witness speaks against a reading if more than this many times is left.
pub(super) const WORSE: f64 = 1.25;

/// What an estimate leaves of a log that it explains as the log stands, and the share left by the
/// model's own values below which these are near: then they may be somewhat off, and a reading that
/// they alone speak for is a guess,
pub(crate) const CLEAN: f64 = 0.015;
pub(super) const NEAR: f64 = 0.5;

/// unless they leave next to nothing under it, and no more than this many times what an estimate
/// does: values that are off do not become true by chance.
const TRUE: f64 = 2.0;

/// What two witnesses say of a reading.
pub(super) struct Verdict {
    pub(super) misreading: Misreading,
    pub(super) own: Option<Change>,
    pub(super) fit: Change,
    pub(super) by_own: bool,
    pub(super) by_fit: bool,
    /// Whether an estimate leaves half as much.
    is_halved: bool,
    /// What an estimate leaves of all joints, after over before.
    of_all: f64,
}

impl Verdict {
    /// `own` is what the given values leave, `fit` what an estimate does, both before and after, of
    /// so many independent samples.
    pub(super) fn new(
        misreading: Misreading,
        own: Option<[&Shares; 2]>,
        ([before, after], independent): ([&Shares; 2], f64),
    ) -> Self {
        let fit = Change::of(before, after);
        let own_torques = misreading.torques_of().into_iter().filter_map(|joint| after[joint]);
        let is_explained = own_torques.fold(0.0, f64::max) < LEFT_BY_ESTIMATE;
        let least = match misreading {
            Misreading::Zero(..) => LEAST,
            late if late.is_late() => PROMPT,
            _ => EXPLAINED,
        };
        // what a zero does to the torques of one joint is little to the others
        let is_zero = matches!(misreading, Misreading::Zero(..));
        let is_halved = |change: Change| {
            let of_one = is_zero && change.ratios[0] < BETTER && change.ratios[1] < WORSE;
            let is_less = change.left[1] < BETTER * change.left[0];
            (change.ratio < BETTER && is_less) || of_one
        };
        let is_half = is_halved(fit) && fit.left[0] > least && fit.left[1] < LEFT_BY_ESTIMATE;
        let is_less = misreading.makes_noise() && is_surely_less([before, after], independent);
        let by_fit = is_explained && (is_half || is_less);
        // a torque against that of the model is no parameter that is far off
        let is_sign = matches!(misreading, Misreading::Torque(_, -1.0));
        let most = match (misreading.is_of_all() || is_sign, by_fit) {
            (true, _) => LEFT_OF_ALL,
            (false, true) => LEFT_OF_ONE,
            (false, false) => LEFT_ALONE,
        };
        let change = own.map(|[before, after]| Change::of(before, after));
        let by_own = own.zip(change).is_some_and(|([_, own_after], own)| {
            let is_enough = !misreading.is_of_all() || own.joints >= HALF;
            let left_by_fit = TRUE * root_mean_square(after).max(LEAST);
            let is_true = root_mean_square(own_after) < left_by_fit.min(EXPLAINED);
            let is_guess = match is_zero {
                // a body that is turned about its joint is alike
                true => !by_fit && !is_true,
                false => own.left[0] < NEAR && root_mean_square(before) < CLEAN,
            };
            let least = if is_zero && is_true { LEAST } else { EXPLAINED };
            is_enough && !is_guess && is_halved(own) && own.left[0] > least && own.left[1] < most
        });
        let of_all = root_mean_square(after).max(LEAST) / root_mean_square(before).max(LEAST);
        Self { misreading, own: change, fit, by_own, by_fit, is_halved: is_half, of_all }
    }

    pub(super) fn is_believed(&self) -> bool {
        let against_fit = self.fit.ratio > WORSE && self.fit.left[1] > EXPLAINED;
        let against_own = self.own.is_some_and(|own| own.ratio > WORSE && own.left[1] > EXPLAINED);
        (self.by_own && !against_fit) || (self.by_fit && !against_own)
    }

    pub(super) fn is_sure(&self) -> bool {
        if self.misreading.is_by_degrees() {
            return self.by_own && self.by_fit;
        }
        let is_near = self.own.is_some_and(|own| own.left[0] < NEAR);
        let by_fit = self.by_fit && self.is_halved;
        by_fit || (self.by_own && self.misreading.is_of_all() && !is_near)
    }

    /// Less is better. What is late in one joint explains that joint as well as what is late in
    /// all: there all count.
    pub(super) fn rank(&self) -> f64 {
        let fit = if self.misreading.is_by_degrees() { self.of_all } else { self.fit.ratio };
        self.own.map_or(1.0, |own| own.ratio) * fit
    }
}

/// Whether less is left after than before, by more than chance.
fn is_surely_less([before, after]: [&Shares; 2], independent: f64) -> bool {
    let both = before.iter().zip(after).filter_map(|(before, after)| before.zip(*after));
    let of = |(before, after): (f64, f64)| (before.max(LEAST) / after.max(LEAST)).ln();
    let all: Vec<f64> = both.map(of).collect();
    let sum: f64 = all.iter().sum();
    independent * sum > LIKELIER && sum > -LESS.ln() * all.len() as f64
}

#[cfg(test)]
mod tests {
    use super::super::misreading::ExchangedColumns;
    use super::*;

    fn verdict(misreading: Misreading, own: [f64; 2], fit: f64) -> Verdict {
        let [before, after] = own.map(|own| vec![Some(own); 2]);
        let fit = vec![Some(fit); 2];
        Verdict::new(misreading, Some([&before, &after]), ([&fit, &fit], 100.0))
    }

    /// The model's own values alone: against an estimate that explains the log as it stands they
    /// say nothing where they are near, and they refuse nothing then.
    #[test]
    fn guesses_yield_to_estimates_that_explain_the_log() {
        let of_one = Misreading::Exchanged([0, 1], ExchangedColumns::Positions);
        assert!(!verdict(of_one, [0.2, 0.05], 0.003).is_believed());
        assert!(verdict(Misreading::Torques(1e-3), [900.0, 0.05], 0.003).is_sure());
        let of_all = verdict(Misreading::Angles(-1.0), [0.15, 0.05], 0.05);
        assert!(of_all.is_believed() && !of_all.is_sure());
    }

    /// What is halved of one joint is not halved of all: 19 % to 15 % is no other unit.
    #[test]
    fn a_small_share_that_falls_does_not_halve_what_is_left() {
        let [before, after] = [[0.03, 0.27], [0.001, 0.21]].map(|left| left.map(Some).to_vec());
        let fit = vec![Some(0.05); 2];
        let told = |own| Verdict::new(Misreading::Time(1e3), Some(own), ([&fit, &fit], 100.0));
        assert!(!told([&before, &after]).is_believed());
        let halved = [0.001, 0.1].map(Some).to_vec();
        assert!(told([&before, &halved]).is_believed());
    }

    /// The zero of a joint whose body can turn instead is told by values that are true with it.
    #[test]
    fn zeros_that_no_estimate_sees_need_values_that_are_true() {
        let zero = Misreading::Zero(1, 0.1);
        let told = verdict(zero, [0.2, 0.004], 0.003);
        assert!(told.is_believed() && !told.is_sure());
        assert!(!verdict(zero, [0.2, 0.05], 0.003).is_believed());
    }

    /// A faster time makes more of noise: what leaves 0.8 % of 1.2 then is told of many samples,
    /// and not of a few; a slower time makes less of it in any case.
    #[test]
    fn less_that_is_left_of_more_noise_is_told() {
        let [before, after] = [0.012, 0.008].map(|left| vec![Some(left); 2]);
        let told = |time, samples| {
            Verdict::new(Misreading::Time(time), None, ([&before, &after], samples))
        };
        let many = told(0.1, 100.0);
        assert!(many.is_believed() && !many.is_sure());
        assert!(!told(0.1, 20.0).is_believed() && !told(10.0, 100.0).is_believed());
    }
}
