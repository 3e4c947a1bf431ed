//! Effects that are added at once, since none of them is seen alone.
//!
//! Viscous and Coulomb friction of one drive are both large, and a band of frequencies that one of
//! them explains the other one fills: either alone leaves all bands loud. A rigid model lacks both
//! at every drive, and bodies that are put right for one joint are wrong for others. So all that
//! every drive has is added, which is the model that robots are identified with (Gautier, Khalil
//! 1990), and what is not asked for beside the rest is taken away again.

use super::hypothesis::{Hypothesis, Part};
use super::search::{Search, Step};
use denavit_evidence::policy;

impl Search<'_> {
    /// A hypothesis with several more of the effects that every drive has that is better than each
    /// of those of one more effect that is worth it; all of these are asked for.
    pub(super) fn together(
        &self,
        now: &Hypothesis,
        room: usize,
        all: &[Hypothesis],
    ) -> Option<Hypothesis> {
        let is_worth = |one: &&Hypothesis| self.is_worth(now, one, one.parts.len() - 1);
        let single = all.iter().find(is_worth);
        let least = single.map_or(policy::NAMED, |one| one.posterior - now.posterior);
        let is_standard = |candidate: usize| {
            let one = &self.weighing.candidates[candidate];
            one.is_standard() && one.joint.is_some()
        };
        let glance = self.glance(now, &now.parts);
        let seen = self.seen(&glance, &now.parts, &is_standard);
        let is_linear = |part: &&Part| part.terms.is_curved.iter().all(|is| !is);
        let more: Vec<Part> =
            seen.iter().map(|(_, part)| *part).filter(is_linear).cloned().collect();
        let terms = more.iter().map(|part| part.terms.clone());
        let promised = glance.see(&terms.reduce(|all, one| all.beside(&one))?).gain;
        if promised < least {
            return None;
        }
        let first = now.parts.len();
        let parts = [&now.parts[..], &more].concat();
        let mut found = self.weighed(parts, Some(now), policy::ROUNDS[0]);
        while let Some(fewer) = self.without_one(&found, first, first + room) {
            found = fewer;
        }
        let are_several = found.parts.len() > first + 1;
        (are_several && found.posterior - now.posterior > least).then_some(found)
    }

    /// A hypothesis without one of its later effects that is not asked for, that which is seen
    /// least; none if all of them are asked for and not more than may be.
    fn without_one(&self, all: &Hypothesis, first: usize, most: usize) -> Option<Hypothesis> {
        let seen = |place: usize| {
            let both = all.values(place).into_iter().zip(all.deviations(place));
            both.map(|(value, deviation)| (value / deviation).abs()).fold(0.0, f64::max)
        };
        let mut places: Vec<usize> = (first..all.parts.len()).collect();
        places.sort_by(|a, b| seen(*a).total_cmp(&seen(*b)));
        let are_too_many = all.parts.len() > most;
        places.into_iter().find_map(|place| {
            let without = self.weighed(all.without(place), Some(all), policy::ROUNDS[0]);
            let is_asked = all.posterior - without.posterior > policy::NAMED
                && self.is_worth(&without, all, place);
            (are_too_many || !is_asked).then_some(without)
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
