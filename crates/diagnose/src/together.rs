//! Effects that are added at once, since none of them is seen alone.
//!
//! Viscous and Coulomb friction of one drive are both large, and a band of frequencies that one of
//! them explains the other one fills. Noise is what is left of each band, so that either alone
//! leaves all bands loud, and is fitted to those that have most lines. A rigid model of a robot
//! lacks both at every drive. Drives hardly notice each other, so all that lack a pair get theirs
//! in one round.

use super::candidate::Candidate;
use super::hypothesis::{Hypothesis, Part};
use super::search::{Search, Step};
use denavit_codegen::effect::Occurrence;
use denavit_evidence::policy;
use std::collections::BTreeMap;

/// Two effects of one place, by the gain that a first look sees.
type Pairs<'a> = Vec<(f64, [&'a Part; 2])>;

impl Search<'_> {
    /// A hypothesis with two more common effects of one place that is better than each of those of
    /// one more that are worth it, and with those of other places that are better there; all of
    /// them are worth it.
    pub(super) fn together(
        &self,
        now: &Hypothesis,
        room: usize,
        all: &[Hypothesis],
    ) -> Option<Hypothesis> {
        let glance = self.glance(now, &now.parts);
        let is_common = |candidate: usize| {
            let one: &Candidate = &self.weighing.candidates[candidate];
            one.occurrence == Occurrence::Common && one.joint.is_some()
        };
        let is_linear = |part: &&Part| part.terms.is_curved.iter().all(|is| !is);
        let seen = self.seen(&glance, &now.parts, &is_common);
        let common: Vec<&Part> = seen.iter().map(|(_, part)| *part).filter(is_linear).collect();
        let at = |part: &Part| self.weighing.candidates[part.placed.candidate].at.clone();
        let mut places: BTreeMap<String, Pairs<'_>> = BTreeMap::new();
        for (number, one) in common.iter().enumerate() {
            for other in common[number + 1..].iter().filter(|other| at(other) == at(one)) {
                let gain = glance.see(&one.terms.beside(&other.terms)).gain;
                places.entry(at(one)).or_default().push((gain, [one, other]));
            }
        }
        let mut places: Vec<(String, Pairs<'_>)> = places.into_iter().collect();
        for (_, pairs) in &mut places {
            pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
        }
        places.sort_by(|a, b| b.1[0].0.total_cmp(&a.1[0].0));
        let mut found: Option<Hypothesis> = None;
        for (at, pairs) in &places {
            let beside = found.as_ref().unwrap_or(now);
            if beside.parts.len() + 2 > now.parts.len() + room {
                break;
            }
            // the first one is held against effects of all places
            let is_rival = |one: &Hypothesis| {
                let place = one.parts.len() - 1;
                let is_near = found.is_none() || self.candidate(one, place).at == *at;
                is_near && self.is_worth(now, one, place)
            };
            let single = all.iter().find(|one| is_rival(one));
            let least = single.map_or(policy::NAMED, |one| one.posterior - now.posterior);
            if pairs[0].0 < least {
                continue;
            }
            let pair = self.pair(beside, pairs);
            let is_better = pair.posterior - beside.posterior > least;
            if is_better && self.are_both_worth(beside, &pair) {
                found = Some(pair);
            }
        }
        found
    }

    /// What was found with the best pair of one place.
    fn pair(&self, now: &Hypothesis, pairs: &Pairs<'_>) -> Hypothesis {
        let weighed = pairs.iter().take(policy::PAIRS).map(|(_, [one, other])| {
            let more = [(*one).clone(), (*other).clone()];
            self.weighed([&now.parts[..], &more].concat(), Some(now), policy::ROUNDS[0])
        });
        let best = weighed.max_by(|a, b| a.posterior.total_cmp(&b.posterior));
        best.expect("a place has pairs")
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

    /// The steps to effects that were added together: all have the odds of all.
    pub(super) fn steps_together(&self, now: &Hypothesis, next: &Hypothesis) -> Vec<Step> {
        let step = |place: usize| Step {
            added: next.parts[place].placed.candidate,
            is_taken: true,
            log_odds: next.posterior - now.posterior,
            size: self.size(next, place),
            runners_up: Vec::new(),
        };
        (now.parts.len()..next.parts.len()).map(step).collect()
    }
}
