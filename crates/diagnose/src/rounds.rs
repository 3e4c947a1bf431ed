//! The rounds of a search: effects are added until the evidence asks for no more.

use super::candidate::Candidate;
use super::hypothesis::{Hypothesis, Part};
use super::search::{Search, Step};
use super::weighing::{Placed, Weighing};
use denavit_evidence::policy;

/// What a search found.
pub(super) struct Found {
    /// The model without effects.
    pub(super) before: Hypothesis,
    /// The model with what was found.
    pub(super) after: Hypothesis,
    /// For each effect that was found, others in its place.
    pub(super) rivals: Vec<Vec<Hypothesis>>,
    /// How it came about.
    pub(super) steps: Vec<Step>,
    /// Whether as many effects were found as are allowed.
    pub(super) is_full: bool,
    /// Whether the search was stopped.
    pub(super) is_stopped: bool,
    /// Candidates that make logs less likely that their values were not fitted to.
    pub(super) dropped: Vec<usize>,
    /// The model's own numbers to begin again with: the search ended since what it found moves
    /// them.
    pub(super) moved: Option<Vec<f64>>,
}

impl Search<'_> {
    /// Searches which candidates are missing, from what a search before has found. `watch` hears of
    /// what was found so far, and says whether to go on.
    pub(super) fn run(
        &self,
        (begun, may_move): (&[Placed], bool),
        watch: &mut dyn FnMut(&[usize]) -> bool,
    ) -> Found {
        let before = self.weighed(Vec::new(), None, policy::ROUNDS[1]);
        let parts: Vec<Part> = begun.iter().map(|placed| self.weighing.part(placed)).collect();
        let mut now = match parts.is_empty() {
            true => before.clone(),
            false => {
                self.linearised(self.weighed(parts, None, policy::ROUNDS[1]), policy::ROUNDS[1])
            }
        };
        let (mut steps, mut moved) = (Vec::new(), None);
        // What else would do in the place of each, once all have been looked at.
        let mut rivals = now.parts.is_empty().then(Vec::new);
        // Exchanges must not lead round in circles.
        let mut seen = vec![now.names()];
        let (is_full, is_stopped) = loop {
            let is_stopped = !watch(&now.candidates());
            let room = self.options.most_effects.saturating_sub(now.parts.len());
            let next = (room > 0 && !is_stopped).then(|| self.next((&now, room), &mut steps));
            if let Some(next) = next.flatten() {
                // Effects of other joints hardly notice: they are looked at in the end.
                let joint = |one: &Candidate| one.joint;
                let last = joint(self.candidate(&next, next.parts.len() - 1));
                let (next, _) = self.exchanged(next, &|one| joint(one) == last);
                if !seen.contains(&next.names()) {
                    seen.push(next.names());
                    rivals = None;
                    now = next;
                    moved = if may_move { self.moved_numbers(&now) } else { None };
                    if moved.is_some() {
                        break (false, false);
                    }
                    continue;
                }
            }
            if rivals.is_some() || is_stopped {
                break (room == 0, is_stopped);
            }
            let (next, others) = self.exchanged(now.clone(), &|_| true);
            let is_new = !seen.contains(&next.names());
            (now, rivals) = (next, Some(others));
            if !is_new {
                break (room == 0, false);
            }
            seen.push(now.names());
        };
        let (dropped, rivals) = (Vec::new(), rivals.unwrap_or_default());
        Found { before, after: now, rivals, steps, is_full, is_stopped, dropped, moved }
    }

    /// What was found with one more effect that is worth it, or with a pair, if there are any.
    fn next(&self, (now, room): (&Hypothesis, usize), steps: &mut Vec<Step>) -> Option<Hypothesis> {
        let all = self.with_one_more(now, &now.parts, &|_| true);
        if let Some(pair) = self.pair(now, &all).filter(|_| room > 1) {
            steps.extend(self.steps_of_pair(now, &pair));
            return Some(pair);
        }
        let step = self.step(now, &all)?;
        let is_taken = step.is_taken;
        steps.push(step);
        is_taken.then(|| self.chosen(now, all).expect("a step was taken"))
    }

    /// What was found without the effect in one place.
    pub(super) fn drop(&self, found: &mut Found, place: usize) {
        let mut parts = found.after.parts.clone();
        found.dropped.push(parts.remove(place).placed.candidate);
        let rest = self.weighed(parts, Some(&found.after), policy::ROUNDS[1]);
        let (after, rivals) = self.exchanged(rest.clone(), &|_| true);
        // What was dropped must not come back, or this would not end.
        let is_back = after.candidates().iter().any(|one| found.dropped.contains(one));
        (found.after, found.rivals) = if is_back { (rest, Vec::new()) } else { (after, rivals) };
    }

    /// The model's own numbers by what was found, if the logs are more likely where laws are
    /// evaluated with these: a law of an angle that is off by much turns what the numbers do, too.
    fn moved_numbers(&self, now: &Hypothesis) -> Option<Vec<f64>> {
        let Weighing { sets, candidates, given, .. } = &self.weighing;
        let z = &now.weighed.own[..sets[0].columns.len()];
        let other = Weighing::new(sets.clone(), (candidates, given), z);
        let parts = now.parts.iter().map(|part| other.part(&part.placed)).collect();
        let other = Self { weighing: other, screen: Vec::new(), ..*self };
        let start = Some(now);
        let moved =
            other.linearised(other.weighed(parts, start, policy::ROUNDS[1]), policy::ROUNDS[1]);
        let gain = moved.weighed.log_evidence - now.weighed.log_evidence;
        (gain > policy::NAMED).then(|| z.to_vec())
    }
}
