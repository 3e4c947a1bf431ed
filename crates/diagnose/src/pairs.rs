//! Two effects at once, where neither is seen alone.
//!
//! Viscous and Coulomb friction of one drive are both large, and a band of frequencies that one of
//! them explains the other one fills. Noise is what is left of each band, so that either alone
//! leaves all bands loud, and is fitted to those that have most lines.

use super::candidate::Candidate;
use super::hypothesis::{Hypothesis, Part};
use super::search::{Search, Step};
use denavit_codegen::effect::Occurrence;
use denavit_evidence::policy;

impl Search<'_> {
    /// A hypothesis of two more common effects of one place that is better than each of those of
    /// one more that are worth it, and in which both are worth it.
    pub(super) fn pair(&self, now: &Hypothesis, all: &[Hypothesis]) -> Option<Hypothesis> {
        let single = all.iter().find(|one| self.is_worth(now, one, one.parts.len() - 1));
        let least = single.map_or(now.posterior + policy::NAMED, |one| one.posterior);
        let glance = self.glance(now, &now.parts);
        let is_common = |candidate: usize| {
            let one: &Candidate = &self.weighing.candidates[candidate];
            one.occurrence == Occurrence::Common && one.joint.is_some()
        };
        let is_linear = |part: &&Part| part.terms.is_curved.iter().all(|is| !is);
        let seen = self.seen(&glance, &now.parts, &is_common);
        let common: Vec<&Part> = seen.iter().map(|(_, part)| *part).filter(is_linear).collect();
        let at = |part: &Part| &self.weighing.candidates[part.placed.candidate].at;
        let mut pairs: Vec<(f64, [&Part; 2])> = Vec::new();
        for (place, one) in common.iter().enumerate() {
            for other in common[place + 1..].iter().filter(|other| at(other) == at(one)) {
                let gain = glance.see(&one.terms.beside(&other.terms)).gain;
                pairs.push((gain, [one, other]));
            }
        }
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
        let weighed = pairs.iter().take(policy::PAIRS).map(|(_, [one, other])| {
            let more = [(*one).clone(), (*other).clone()];
            self.weighed([&now.parts[..], &more].concat(), Some(now), policy::ROUNDS[0])
        });
        let best = weighed.max_by(|a, b| a.posterior.total_cmp(&b.posterior))?;
        (best.posterior > least && self.are_both_worth(now, &best)).then_some(best)
    }

    /// Whether each of the last two effects of a hypothesis is asked for beside the other one.
    fn are_both_worth(&self, now: &Hypothesis, pair: &Hypothesis) -> bool {
        let count = pair.parts.len();
        [count - 2, count - 1].into_iter().all(|place| {
            let mut others = pair.parts.clone();
            others.remove(place);
            let without = self.weighed(others, Some(now), policy::ROUNDS[0]);
            pair.posterior > without.posterior + policy::NAMED
                && self.is_worth(&without, pair, place)
        })
    }

    /// The steps to a pair: both have its odds.
    pub(super) fn steps_of_pair(&self, now: &Hypothesis, pair: &Hypothesis) -> Vec<Step> {
        let count = pair.parts.len();
        let step = |place: usize| Step {
            added: pair.parts[place].placed.candidate,
            is_taken: true,
            log_odds: pair.posterior - now.posterior,
            size: self.size(pair, place),
            runners_up: Vec::new(),
        };
        [count - 2, count - 1].map(step).to_vec()
    }
}
