//! Which effects: one more as long as the evidence asks for it, each exchanged for what does better
//! in its place.

use super::candidate::Candidate;
use super::hypothesis::{Hypothesis, Part};
use super::weighing::{Placed, Weighing, add};
use denavit_codegen::effect::Occurrence;
use denavit_evidence::{Glance, Terms, policy};

/// One step of a search, for a report.
#[derive(Clone, Debug)]
pub struct Step {
    /// The candidate that was weighed.
    pub added: usize,
    /// Whether it was added: the last one of a search may not have been.
    pub is_taken: bool,
    /// The log of the odds that it is missing.
    pub log_odds: f64,
    /// What it does at the joint where that is most, as a share of its torque.
    pub size: f64,
    /// The candidates that came next, with their log odds.
    pub runners_up: Vec<(usize, f64)>,
}

/// What every candidate does from where its search begins.
pub(super) struct Search<'a> {
    pub(super) weighing: Weighing<'a>,
    /// For each candidate its starts.
    pub(super) screen: Vec<Vec<Part>>,
    /// The log of what all candidates are expected to weigh together.
    pub(super) log_choices: f64,
    /// Most effects that are added.
    pub(super) most: usize,
    /// Whether it may end to begin again with other numbers of the model.
    pub(super) may_move: bool,
    /// What noise leaves of each channel, as a share of its torque.
    pub(super) floor: Vec<f64>,
}

/// The log odds of an effect before any log is looked at.
fn log_occurrence(candidate: &Candidate) -> f64 {
    match candidate.occurrence {
        Occurrence::Standard | Occurrence::Common => 0.0,
        Occurrence::Uncommon => policy::UNCOMMON,
        Occurrence::Rare => policy::RARE,
    }
}

impl<'a> Search<'a> {
    /// Evaluates all candidates that the model does not have, but those that are the same with the
    /// numbers of a search before, of which `screen` has what it saw, if there was one. `watch`
    /// hears which share is done, and says whether to go on.
    pub(super) fn new(
        weighing: Weighing<'a>,
        [given, most]: [usize; 2],
        mut screen: Vec<Vec<Part>>,
        watch: &mut dyn FnMut(f64) -> bool,
    ) -> Self {
        let candidates = weighing.candidates;
        screen.resize(candidates.len(), Vec::new());
        let before = weighing.base.weigh(&[], None, policy::ROUNDS[1]);
        let glance = Glance::new(&weighing.base, &[], &before.variances);
        for (number, candidate) in candidates.iter().enumerate().skip(given) {
            if !watch(number as f64 / candidates.len() as f64) {
                break;
            }
            if !screen[number].is_empty() && weighing.is_of_motion(candidate) {
                continue;
            }
            let all = weighing.starts(candidate);
            let log_share = -(all.len().max(1) as f64).ln();
            let all = weighing.nearest(number, all, &glance);
            let placed = all.iter().filter_map(|start| weighing.start(number, start, log_share));
            screen[number] = placed.map(|(placed, terms)| Part { placed, terms }).collect();
        }
        let weights = candidates.iter().skip(given).map(|one| log_occurrence(one).exp());
        let log_choices = weights.sum::<f64>().max(1.0).ln();
        let floor = vec![0.0; weighing.spectra.torque.len()];
        Self { weighing, screen, log_choices, most, may_move: false, floor }
    }

    /// What was seen of each candidate that does the same in a search with other numbers.
    pub(super) fn kept(mut self) -> Vec<Vec<Part>> {
        for (candidate, own) in self.weighing.candidates.iter().zip(&mut self.screen) {
            if !self.weighing.is_of_motion(candidate) {
                own.clear();
            }
        }
        self.screen
    }

    /// The step to the best of some hypotheses.
    pub(super) fn step(&self, now: &Hypothesis, all: &[Hypothesis]) -> Option<Step> {
        let worth = |one: &Hypothesis| self.is_worth(now, one, one.parts.len() - 1);
        let best = all.iter().find(|one| worth(one)).or(all.first())?;
        let odds = |one: &Hypothesis| {
            Some((one.parts.last()?.placed.candidate, one.posterior - now.posterior))
        };
        let (added, log_odds) = odds(best)?;
        let others = all.iter().filter_map(odds).filter(|(candidate, _)| *candidate != added);
        Some(Step {
            added,
            is_taken: worth(best) && log_odds > policy::NAMED,
            log_odds,
            size: self.size(best, best.parts.len() - 1),
            runners_up: others.take(5).collect(),
        })
    }

    /// The best of hypotheses of one more effect that is worth it, by its plainest name.
    pub(super) fn chosen(&self, now: &Hypothesis, all: Vec<Hypothesis>) -> Option<Hypothesis> {
        let best = all.iter().find(|one| self.is_worth(now, one, one.parts.len() - 1))?;
        Some(self.plainest(best, best.parts.len() - 1, all.iter()).clone())
    }

    /// Of hypotheses that have another effect in one place: the best of those that are plainer than
    /// the one given, and of those plainer than that, and so on; or else the one given.
    pub(super) fn plainest<'h>(
        &self,
        best: &'h Hypothesis,
        place: usize,
        all: impl Iterator<Item = &'h Hypothesis>,
    ) -> &'h Hypothesis {
        let (mut chosen, mut plain): (_, Vec<_>) = (best, all.collect());
        loop {
            plain.retain(|one| self.is_plainer(one, chosen, place));
            let next = plain.iter().max_by(|a, b| a.posterior.total_cmp(&b.posterior));
            let Some(next) = next else { return chosen };
            chosen = next;
        }
    }

    /// Whether an effect in a place is plainer than that of another hypothesis, and as good.
    pub(super) fn is_plainer(&self, one: &Hypothesis, than: &Hypothesis, place: usize) -> bool {
        let [own, other] = [one, than].map(|of| self.candidate(of, place));
        let is_as_good = own.at == other.at && one.posterior > than.posterior - policy::NAMED;
        let [count, others] = [own, other].map(|of| of.law.parameters().len());
        let is_usual = own.at == other.at && own.occurrence < other.occurrence && count <= others;
        own.is_plainer_than(other)
            && (is_as_good || is_usual && self.is_same(one, than, place, own.occurrence))
    }

    /// Whether a hypothesis, with something so often `met`, leaves hardly more than another one
    /// with an effect in one place. What every drive has is there anyhow: a law that leaves more
    /// than it does beyond that is not it either.
    pub(super) fn is_same(
        &self,
        one: &Hypothesis,
        than: &Hypothesis,
        place: usize,
        met: Occurrence,
    ) -> bool {
        let at = &self.candidate(than, place).at;
        let mut all = than.torque(place);
        let is_beside = |&other: &usize| other != place && &self.candidate(than, other).at == at;
        let others = (0..than.parts.len()).filter(is_beside);
        others.for_each(|at| add(&mut all, &than.torque(at), 1.0));
        let spectra = &self.weighing.spectra;
        let little = policy::SAME * spectra.largest_share(&all);
        // beside a law that leaves nothing but noise, more than that noise is something
        let at_most = || {
            let open = self.weighing.open(than, &self.floor).into_iter().enumerate();
            let open = open.map(|(at, open)| spectra.share(&all, at) == 0.0 || open > policy::LEFT);
            let left = self.weighing.left(than).into_iter().map(|left| left.min(little));
            open.zip(left).map(|(is_open, left)| if is_open { little } else { left }).collect()
        };
        self.leaves_hardly_more(one, than, place, &at_most)
            || met == Occurrence::Standard && self.is_no_better(one, than, place)
    }

    /// Whether an effect of a hypothesis does less beyond another one than it leaves, beside all
    /// that every drive has, that is no noise.
    pub(super) fn is_no_better(&self, one: &Hypothesis, than: &Hypothesis, place: usize) -> bool {
        self.leaves_hardly_more(one, than, place, &|| {
            let at = &self.candidate(than, place).at;
            let is_missing = |candidate: &usize| {
                let other = &self.weighing.candidates[*candidate];
                let is_absent = !than.candidates().contains(candidate);
                other.is_standard() && &other.at == at && is_absent
            };
            let missing = (0..self.screen.len()).filter(is_missing);
            let missing = missing.filter_map(|candidate| self.screen[candidate].first().cloned());
            let parts = than.parts.iter().cloned().chain(missing).collect();
            let beside = self.weighed(parts, Some(than), policy::ROUNDS[0]);
            self.weighing.open(&beside, &self.floor)
        })
    }

    /// Whether a hypothesis leaves of each channel less than what is `allowed` more than another
    /// one with an effect in one place, and less than a share of what that effect does, without
    /// moving the model's own numbers for it.
    fn leaves_hardly_more(
        &self,
        one: &Hypothesis,
        than: &Hypothesis,
        place: usize,
        allowed: &dyn Fn() -> Vec<f64>,
    ) -> bool {
        let moved = |of: &Hypothesis| 0.5 * of.weighed.own.iter().map(|z| z * z).sum::<f64>();
        let left = |of: &Hypothesis| self.weighing.left(of);
        let more = left(one).into_iter().zip(left(than));
        let more = more.map(|(one, than)| (one * one - than * than).max(0.0).sqrt());
        let more: Vec<f64> = more.collect();
        let share = policy::LEFT_OF_EXPLAINED * self.told(than, place);
        more.iter().all(|more| *more < share)
            && moved(one) - moved(than) < policy::NAMED
            && more.iter().zip(allowed()).all(|(more, allowed)| *more < allowed)
    }

    pub(super) fn candidate(&self, hypothesis: &Hypothesis, place: usize) -> &Candidate {
        self.of(&hypothesis.parts[place])
    }

    fn of(&self, part: &Part) -> &Candidate {
        &self.weighing.candidates[part.placed.candidate]
    }

    /// A first look from parts, with the variances of a hypothesis.
    pub(super) fn glance(&self, now: &Hypothesis, parts: &[Part]) -> Glance {
        let terms: Vec<&Terms> = parts.iter().map(|part| &part.terms).collect();
        Glance::new(&self.weighing.base, &terms, &now.weighed.variances)
    }

    /// What a first look sees of each candidate beside `parts`, at the best of its starts: the best
    /// candidate first.
    pub(super) fn seen(
        &self,
        glance: &Glance,
        parts: &[Part],
        is_asked: &dyn Fn(usize) -> bool,
    ) -> Vec<(f64, &Part)> {
        let of = |candidate: usize| self.weighing.candidates[candidate].law.only_one_of();
        let is_there = |candidate: usize| {
            let own = of(candidate);
            let mut others = parts.iter().map(|part| part.placed.candidate);
            others.any(|other| other == candidate || own.is_some() && of(other) == own)
        };
        let mut seen: Vec<(f64, &Part)> = Vec::new();
        for (candidate, own) in self.screen.iter().enumerate() {
            if is_there(candidate) || !is_asked(candidate) {
                continue;
            }
            let prior = log_occurrence(&self.weighing.candidates[candidate]);
            let gain = |part: &Part| glance.see(&part.terms).gain + prior + part.placed.log_share;
            let gains = own.iter().map(|part| (gain(part), part));
            seen.extend(gains.max_by(|a, b| a.0.total_cmp(&b.0)));
        }
        seen.sort_by(|a, b| b.0.total_cmp(&a.0));
        seen
    }

    /// Hypotheses of one more effect behind `parts`, those that the evidence asks for most first.
    /// If `rivals_of` is an effect, its place and a look from parts and it, those that may stand in
    /// its place: where it is, and where a first look sees less beside it. What is seen as well
    /// elsewhere is missing as well.
    pub(super) fn with_one_more(
        &self,
        now: &Hypothesis,
        parts: &[Part],
        is_asked: &dyn Fn(usize) -> bool,
        rivals_of: Option<(&Glance, &Part, usize)>,
    ) -> Vec<Hypothesis> {
        let glance = self.glance(now, parts);
        let seen = self.seen(&glance, parts, is_asked);
        let place = rivals_of.map_or(parts.len(), |(.., place)| place);
        let at = |part: &Part| &self.of(part).at;
        let is_rival = |(_, part): &&(f64, &Part)| {
            let gain = |glance: &Glance| glance.see(&part.terms).gain;
            rivals_of.is_none_or(|(beside, own, _)| {
                at(own) == at(part) || gain(beside) < gain(&glance) - policy::NAMED
            })
        };
        let mut all: Vec<Hypothesis> = Vec::new();
        for (gain, part) in seen.iter().filter(is_rival) {
            // what a first look promises is not always kept: the best is what was weighed
            let best = all.iter().max_by(|a, b| a.posterior.total_cmp(&b.posterior));
            let most = best.map_or(0.0, |one| (one.posterior - now.posterior).max(0.0));
            let is_near = *gain > most - policy::FAR.max(policy::FAR_SHARE * most);
            let is_plain = |one: &Hypothesis| {
                let other = self.candidate(one, place);
                at(part) == &other.at && self.of(part).is_plainer_than(other)
            };
            let is_asked = is_near || *gain > policy::NAMED && best.is_some_and(is_plain);
            if all.len() == policy::WEIGHED || !gain.is_finite() {
                break;
            }
            if is_asked {
                let mut parts = parts.to_vec();
                parts.insert(place, (*part).clone());
                let first = self.weighed(parts, Some(now), policy::ROUNDS[0]);
                let one = self.linearised(first, &self.near(part), policy::ROUNDS[0]);
                all.push(self.turned(one, place));
            }
        }
        all.sort_by(|a, b| b.posterior.total_cmp(&a.posterior));
        all
    }

    /// A hypothesis whose effect in a place turns what the model's own numbers do, weighed by those
    /// that it has: where these had it in them, it is not what it is.
    fn turned(&self, mut one: Hypothesis, place: usize) -> Hypothesis {
        let weighing = &self.weighing;
        let is_elsewhere = |one: &Hypothesis| {
            let turns = self.candidate(one, place).law.turns_numbers();
            let more = || {
                let torques = weighing.torques_at(&weighing.numbers(one));
                weighing.change(&one.taken(place, weighing.candidates), &torques)
            };
            turns && weighing.base.nats(&more(), &one.weighed.variances) > policy::NAMED
        };
        if !self.may_move || !is_elsewhere(&one) {
            return one;
        }
        for _ in 0..policy::LINEARISED {
            let z = weighing.numbers(&one);
            let other = weighing.in_same_data(&z, &one.all_taken(weighing.candidates));
            let next = self.settled_in(other, &one);
            if next.posterior < one.posterior + policy::NAMED {
                break;
            }
            one = Hypothesis { elsewhere: Some(z), ..next };
        }
        one
    }

    /// A hypothesis with all of its effects linearised at their most likely values.
    pub(super) fn resettled(&self, one: &Hypothesis) -> Hypothesis {
        match one.elsewhere {
            Some(_) => one.clone(),
            None => self.settled(one.parts.clone(), Some(one)),
        }
    }

    /// Effects together, weighed where all of them are linearised at their most likely values.
    pub(super) fn settled(&self, parts: Vec<Part>, from: Option<&Hypothesis>) -> Hypothesis {
        let first = self.weighed(parts, from, policy::ROUNDS[1]);
        self.linearised(first, &|_| true, policy::ROUNDS[1])
    }

    /// What was found, linearised where effects have a shape: one that is off has no slope, and its
    /// values nothing of what is not known of its shape.
    pub(super) fn shaped(&self, found: Hypothesis) -> Hypothesis {
        let moved = (!found.is_shaped()).then(|| self.moved(&found, &|_| true, 1.0));
        let Some((parts, _)) = moved.flatten() else { return found };
        let first = self.weighed(parts, Some(&found), policy::ROUNDS[1]);
        self.linearised(first, &|_| true, policy::ROUNDS[1])
    }

    /// What was found, weighed by the numbers that it has, without what does the same beside it.
    pub(super) fn without_twins(&self, found: &Hypothesis) -> Hypothesis {
        let mut now = found.clone();
        for round in 0..policy::LINEARISED {
            let z = self.weighing.numbers(&now);
            let mut weighing = self.weighing.beside(&z, &now.all_taken(self.weighing.candidates));
            weighing.base = weighing.base_beside(&now.parts);
            let next = Hypothesis { elsewhere: Some(z), ..self.settled_in(weighing, &now) };
            let change = (next.posterior - now.posterior).abs();
            now = next;
            if round > 0 && change < policy::SETTLED {
                break;
            }
        }
        now
    }

    /// Effects weighed among other numbers of the model, or beside other effects.
    pub(super) fn settled_in(&self, weighing: Weighing<'a>, found: &Hypothesis) -> Hypothesis {
        let parts = found.parts.iter().map(|part| weighing.part(&part.placed)).collect();
        let floor = self.floor.clone();
        let other = Self { weighing, screen: Vec::new(), floor, ..*self };
        other.settled(parts, Some(found))
    }

    /// Candidates that notice where an effect is linearised: effects of other joints hardly do.
    fn near(&self, part: &Part) -> impl Fn(&Candidate) -> bool {
        let joint = self.weighing.candidates[part.placed.candidate].joint;
        move |one| joint.is_none() || one.joint.is_none() || one.joint == joint
    }

    /// A hypothesis whose effects that are asked for are linearised at their most likely values.
    /// Where an effect is off its shape has no slope, so that the first round says how large it
    /// is, and the next ones how it is shaped.
    fn linearised(
        &self,
        first: Hypothesis,
        is_asked: &dyn Fn(&Candidate) -> bool,
        rounds: usize,
    ) -> Hypothesis {
        let (mut now, mut best) = (first.clone(), first);
        let mut share = 1.0;
        for round in 0..policy::LINEARISED {
            let Some((parts, gain)) = self.moved(&now, is_asked, share) else { break };
            if round > 0 && gain < policy::SETTLED {
                break;
            }
            now = self.weighed(parts, Some(&now), rounds);
            if now.posterior > best.posterior {
                best = now.clone();
            } else if round > 1 {
                // too far, for a law that bends on the way
                (now, share) = (best.clone(), 0.5 * share);
            }
        }
        best
    }

    /// The parts with those that are asked for moved to their most likely values, curved ones by a
    /// share of the way, and what that gains; none if no law of these is curved.
    fn moved(
        &self,
        hypothesis: &Hypothesis,
        is_asked: &dyn Fn(&Candidate) -> bool,
        share: f64,
    ) -> Option<(Vec<Part>, f64)> {
        let candidates = self.weighing.candidates;
        let is_moved = |part: &Part| {
            let is_curved = part.terms.is_curved.iter().any(|is| *is);
            is_curved && is_asked(self.of(part))
        };
        if !hypothesis.parts.iter().any(is_moved) {
            return None;
        }
        let mut steps = Vec::new();
        let mut parts = Vec::new();
        let factors = hypothesis.by_parts(&hypothesis.weighed.step);
        for (part, factors) in hypothesis.parts.iter().zip(factors) {
            if !is_moved(part) {
                steps.resize(steps.len() + factors.len(), 0.0);
                parts.push(part.clone());
                continue;
            }
            let values = part.placed.moved(candidates, factors, share);
            steps.extend(part.steps_to(&values));
            let placed = Placed { values, ..part.placed.clone() };
            parts.push(Part { terms: self.weighing.terms(&placed), placed });
        }
        let gain = hypothesis.weighed.gain(&steps);
        Some((parts, gain))
    }

    /// The log odds of an effect at its start, among all, before any log is looked at.
    pub(super) fn log_prior(&self, part: &Part) -> f64 {
        part.placed.log_share + log_occurrence(self.of(part)) - self.log_choices
    }

    /// Effects together, weighed.
    pub(super) fn weighed(
        &self,
        parts: Vec<Part>,
        from: Option<&Hypothesis>,
        rounds: usize,
    ) -> Hypothesis {
        let terms: Vec<&Terms> = parts.iter().map(|part| &part.terms).collect();
        let start = from.map(|from| from.weighed.variances.as_slice());
        let weighed = self.weighing.base.weigh(&terms, start, rounds);
        let of_parts: f64 = parts.iter().map(|part| self.log_prior(part)).sum();
        let more = policy::ONE_MORE * parts.len().saturating_sub(1) as f64;
        Hypothesis {
            posterior: weighed.log_evidence + of_parts + more,
            parts,
            weighed,
            elsewhere: None,
        }
    }
}
