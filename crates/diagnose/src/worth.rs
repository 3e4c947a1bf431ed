//! How large an effect is: whether that is worth a name.

use super::hypothesis::{Hypothesis, Part};
use super::search::Search;
use super::span::Span;
use denavit_evidence::policy;

impl Search<'_> {
    /// Whether an effect is large enough for a name beside the others, which are all that `without`
    /// has: one that others nearly do is none.
    pub(super) fn is_worth(&self, without: &Hypothesis, with: &Hypothesis, place: usize) -> bool {
        let joint = |part: &Part| self.weighing.candidates[part.placed.candidate].joint;
        let own = joint(&with.parts[place]);
        let others = (0..without.parts.len()).filter(|&at| joint(&without.parts[at]) == own);
        let most = others.map(|at| self.size(without, at)).fold(0.0, f64::max);
        let size = self.size(with, place);
        let own = || size * self.beyond(with, place) / self.told(with, place);
        let candidate = self.candidate(with, place);
        let is_excuse = || {
            let mut others = (0..without.parts.len()).map(|at| self.candidate(without, at));
            own() <= policy::SAME * most
                || others.any(|other| other.at == candidate.at && other.is_standard())
                    && self.is_no_better(without, with, place)
        };
        // what every drive has is no excuse for the errors of a law
        size > policy::WORTH && (candidate.is_standard() || most == 0.0 || !is_excuse())
    }

    /// What an effect does that others of its hypothesis cannot, as a share of the torque where
    /// that is most.
    fn beyond(&self, hypothesis: &Hypothesis, place: usize) -> f64 {
        let spectra = &self.weighing.spectra;
        let torque = spectra.stacked(&hypothesis.torque(place));
        let others = hypothesis.parts.iter().enumerate().filter(|(at, _)| *at != place);
        let left = Span::of(spectra, others.map(|(_, part)| part)).outside(&torque);
        spectra.largest_share(&spectra.unstacked(&left))
    }

    /// What an effect does at the joint where that is most, as a share of its torque, by what rows
    /// count.
    pub(super) fn told(&self, hypothesis: &Hypothesis, place: usize) -> f64 {
        self.weighing.spectra.largest_share(&hypothesis.torque(place))
    }

    /// What an effect does at the joint where that is most, as a share of its torque.
    pub(super) fn size(&self, hypothesis: &Hypothesis, place: usize) -> f64 {
        self.weighing.size(&hypothesis.taken(place, self.weighing.candidates))
    }
}
