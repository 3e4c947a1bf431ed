//! Effects that were found, each exchanged for what does better in its place.

use super::candidate::Candidate;
use super::hypothesis::{Hypothesis, Part};
use super::rounds::Rival;
use super::search::Search;
use super::weighing::Placed;
use denavit_evidence::policy;
use std::collections::BTreeSet;

impl Search<'_> {
    /// Exchanges effects that are asked for by what does better in their place, until nothing does;
    /// with what else would do in the place of each. An exchange has those of its joint looked at
    /// again. `unmerged` are pairs of candidates for which nothing else would do.
    pub(super) fn exchanged(
        &self,
        mut now: Hypothesis,
        is_asked: &dyn Fn(&Candidate) -> bool,
        unmerged: &mut BTreeSet<[usize; 2]>,
    ) -> (Hypothesis, Vec<Vec<Rival>>) {
        let unseen = |now: &Hypothesis| -> Vec<Option<Vec<Rival>>> {
            let asked = |place: usize| is_asked(self.candidate(now, place));
            (0..now.parts.len()).map(|place| (!asked(place)).then(Vec::new)).collect()
        };
        let mut rivals = unseen(&now);
        let mut exchanges = 0;
        // The search begins again with what was weighed by other numbers.
        while now.elsewhere.is_none() {
            let may_exchange = exchanges < MOST_EXCHANGES * (1 + now.parts.len());
            let Some(place) = rivals.iter().position(Option::is_none) else {
                let merged = may_exchange.then(|| self.merged(&now, is_asked, unmerged));
                let Some(merged) = merged.flatten() else { break };
                (now, exchanges) = (merged, exchanges + 1);
                rivals = unseen(&now);
                continue;
            };
            let joint = self.candidate(&now, place).joint;
            let (own, others) = (now.parts[place].clone(), now.without(place));
            let rest = self.weighed(others.clone(), Some(&now), policy::ROUNDS[0]);
            // what others took over is not needed any more
            let is_idle = now.posterior - rest.posterior < policy::NAMED
                || !self.is_worth(&rest, &now, place);
            let mut all = Vec::new();
            let next = if is_idle && may_exchange {
                rivals.remove(place);
                Some(rest)
            } else {
                let beside = self.glance(&now, &now.parts);
                let is_other = |candidate| candidate != own.placed.candidate;
                let of = Some((&beside, &own, place));
                all = self.with_one_more(&rest, &others, &is_other, of);
                all.retain(|one| {
                    one.posterior <= now.posterior || !self.is_missing_beside(&own, one, place)
                });
                let better = self.better(&now, &rest, place, &all).filter(|_| may_exchange);
                better.map(|one| self.resettled(one))
            };
            let Some(next) = next else {
                // A better formula of the same is no rival of the plain name.
                all.retain(|one| {
                    one.posterior <= now.posterior || !self.is_plainer(&now, one, place)
                });
                let rival = |one: &Hypothesis| Rival {
                    placed: Placed { values: one.values(place), ..one.parts[place].placed.clone() },
                    log_odds: now.posterior - one.posterior,
                };
                rivals[place] = Some(all.iter().map(rival).collect());
                continue;
            };
            (now, exchanges) = (next, exchanges + 1);
            for (place, rivals) in rivals.iter_mut().enumerate() {
                let other = self.candidate(&now, place);
                if other.joint == joint && is_asked(other) {
                    *rivals = None;
                }
            }
        }
        (now, rivals.into_iter().flatten().collect())
    }

    /// Whether an effect is asked for beside a hypothesis, whose one in a place stays worth it, and
    /// may be added to it.
    fn is_missing_beside(&self, own: &Part, one: &Hypothesis, place: usize) -> bool {
        let last = one.parts.len();
        if last == self.most {
            return false;
        }
        let parts = [&one.parts[..], std::slice::from_ref(own)].concat();
        let both = self.weighed(parts, Some(one), policy::ROUNDS[0]);
        let without = self.weighed(both.without(place), Some(&both), policy::ROUNDS[0]);
        both.posterior - one.posterior > policy::NAMED
            && self.is_worth(one, &both, last)
            && self.is_worth(&without, &both, place)
    }

    /// What is better in a place than what is there: of all hypotheses, and the present one, the
    /// plainest that does nearly as well as the best. Held against the best alone, a plain name
    /// stayed although another plain one was better.
    fn better<'h>(
        &self,
        now: &'h Hypothesis,
        rest: &Hypothesis,
        place: usize,
        all: &'h [Hypothesis],
    ) -> Option<&'h Hypothesis> {
        let best = all.iter().find(|one| self.is_worth(rest, one, place))?;
        let best = if best.posterior > now.posterior { best } else { now };
        let plainest = self.plainest(best, place, all.iter().chain([now]));
        (plainest.candidates() != now.candidates()).then_some(plainest)
    }

    /// One effect in place of two that act at one place that is asked for, if that is more likely.
    fn merged(
        &self,
        now: &Hypothesis,
        is_asked: &dyn Fn(&Candidate) -> bool,
        unmerged: &mut BTreeSet<[usize; 2]>,
    ) -> Option<Hypothesis> {
        let of = |place: usize| self.candidate(now, place);
        let count = now.parts.len();
        let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
        for (a, b) in pairs.filter(|&(a, b)| of(a).at == of(b).at && is_asked(of(a))) {
            let both = [a, b].map(|place| now.parts[place].placed.candidate);
            if !unmerged.insert(both) {
                continue;
            }
            let mut others = now.parts.clone();
            others.remove(b);
            others.remove(a);
            let rest = self.weighed(others.clone(), Some(now), policy::ROUNDS[0]);
            let is_there = |candidate: usize| {
                self.weighing.candidates[candidate].at == of(a).at && !both.contains(&candidate)
            };
            let all = self.with_one_more(&rest, &others, &is_there, None);
            let last = others.len();
            // two that are met more often are plainer than one
            let met = of(a).occurrence.max(of(b).occurrence);
            let is_better = |one: &Hypothesis| {
                let is_rarer = self.candidate(one, last).occurrence > met;
                let least = if is_rarer { policy::NAMED } else { 0.0 };
                one.posterior > now.posterior + least
                    && !(is_rarer && self.is_same(now, one, last, met))
            };
            let best = all.iter().find(|one| self.is_worth(&rest, one, last));
            let next = best.map(|best| self.plainest(best, last, all.iter()));
            if let Some(next) = next.filter(|one| is_better(one)) {
                return Some(self.resettled(next));
            }
        }
        None
    }
}

/// Exchanges of one round for each effect, at most.
const MOST_EXCHANGES: usize = 4;
