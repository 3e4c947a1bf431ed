//! The rounds of a search: effects are added until the evidence asks for no more.

use super::hypothesis::{Hypothesis, Part};
use super::search::{Search, Step};
use super::weighing::{Placed, Weighing};
use denavit_evidence::policy;
use std::collections::BTreeSet;

/// What would do in the place of an effect.
#[derive(Clone)]
pub(super) struct Rival {
    /// At its most likely values.
    pub(super) placed: Placed,
    /// The log of the odds of what is there against it, beside the others as they were then.
    pub(super) log_odds: f64,
}

/// What a search found.
pub(super) struct Found {
    /// The model without effects.
    pub(super) before: Hypothesis,
    /// The model with what was found.
    pub(super) after: Hypothesis,
    /// For each effect that was found, others in its place.
    pub(super) rivals: Vec<Vec<Rival>>,
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
        &mut self,
        begun: &[Placed],
        watch: &mut dyn FnMut(&[usize]) -> bool,
    ) -> Found {
        let before = self.weighed(Vec::new(), None, policy::ROUNDS[1]);
        let parts: Vec<Part> = begun.iter().map(|placed| self.weighing.part(placed)).collect();
        let mut now = match parts.is_empty() {
            true => before.clone(),
            false => self.settled(parts, None),
        };
        let (mut steps, mut moved, mut unmerged) = (Vec::new(), None, BTreeSet::new());
        // What else would do in the place of each, once all have been looked at.
        let mut rivals = now.parts.is_empty().then(Vec::new);
        // Exchanges must not lead round in circles.
        let mut seen = vec![now.names()];
        let (is_full, is_stopped) = loop {
            let is_stopped = !watch(&now.candidates());
            let room = self.most.saturating_sub(now.parts.len());
            let next = (room > 0 && !is_stopped).then(|| self.next(&now, room, &mut steps));
            if let Some(next) = next.flatten() {
                // Effects of other joints hardly notice: they are looked at in the end.
                let new = now.parts.len()..next.parts.len();
                let joints: Vec<_> = new.map(|place| self.candidate(&next, place).joint).collect();
                let (next, _) =
                    self.exchanged(next, &|one| joints.contains(&one.joint), &mut unmerged);
                if !seen.contains(&next.names()) {
                    seen.push(next.names());
                    rivals = None;
                    now = next;
                    moved = if self.may_move { self.moved_numbers(&now) } else { None };
                    if moved.is_some() {
                        break (false, false);
                    }
                    continue;
                }
            }
            if rivals.is_some() || is_stopped {
                break (room == 0, is_stopped);
            }
            let (next, others) = self.exchanged(now.clone(), &|_| true, &mut unmerged);
            let is_new = !seen.contains(&next.names());
            (now, rivals) = (next, Some(others));
            moved.clone_from(&now.elsewhere);
            if !is_new || moved.is_some() {
                break (room == 0, false);
            }
            seen.push(now.names());
        };
        let (dropped, rivals) = (Vec::new(), rivals.unwrap_or_default());
        Found { before, after: now, rivals, steps, is_full, is_stopped, dropped, moved }
    }

    /// What was found with one more effect that is worth it, or with several, if there are any.
    fn next(&self, now: &Hypothesis, room: usize, steps: &mut Vec<Step>) -> Option<Hypothesis> {
        let all = self.with_one_more(now, &now.parts, &|_| true, None);
        if let Some(next) = self.together(now, room, &all) {
            steps.extend(self.steps_together(now, &next));
            return Some(next);
        }
        let step = self.step(now, &all)?;
        let is_taken = step.is_taken;
        steps.push(step);
        let chosen = is_taken.then(|| self.chosen(now, all).expect("a step was taken"))?;
        Some(self.resettled(&chosen))
    }

    /// What was found without the effect in one place, which is no candidate then. Others are
    /// exchanged, and none is added: what did not repeat is like many an effect.
    pub(super) fn drop(&mut self, found: &mut Found, place: usize) {
        self.may_move = false; // no search begins again after this one
        let dropped = found.after.parts[place].placed.candidate;
        self.screen[dropped].clear();
        let rest = self.settled(found.after.without(place), Some(&found.after));
        let (after, rivals) = self.exchanged(rest, &|_| true, &mut BTreeSet::new());
        found.dropped.push(dropped);
        (found.after, found.rivals) = (after, rivals);
    }

    /// The model's own numbers by what was found, if the logs are more likely where laws are
    /// evaluated with these, or the laws do something else there that is worth a name: an angle
    /// that is off by much turns what the numbers do, and a gain scales it.
    fn moved_numbers(&self, now: &Hypothesis) -> Option<Vec<f64>> {
        if now.elsewhere.is_some() {
            return now.elsewhere.clone();
        }
        let Weighing { z, candidates, .. } = &self.weighing;
        let beside = self.weighing.beside(z, &now.all_taken(candidates));
        let beside = self.settled_in(beside, now);
        let (z, taken) = (self.weighing.numbers(&beside), beside.all_taken(candidates));
        let other = self.weighing.beside(&z, &taken);
        let change =
            |taken| other.spectra.largest_share(&self.weighing.change(taken, &other.torques));
        if taken.iter().any(|taken| change(taken) > policy::WORTH) {
            return Some(z);
        }
        let moved = self.settled_in(other, now);
        let gain = moved.weighed.log_evidence - now.weighed.log_evidence;
        (gain > policy::NAMED).then_some(z)
    }
}
