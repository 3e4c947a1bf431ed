//! A model with the effects that it has so far, fitted to the logs for training and judged with
//! others.

use super::candidate::Candidate;
use super::data::{Data, ModelTorques};
use super::floor::NoiseFloor;
use super::hypothesis::{Hypothesis, Part};
use super::law::Motion;
use super::search::Search;
use super::weighing::{Placed, Weighing};
use crate::policy::state::ALIKE_PERIODS;
pub(super) use crate::policy::state::MOST_Z;
use denavit_evidence::{Spectrum, Terms, policy};
use denavit_measure::Split;
use denavit_numerics::variance_of_sum;

/// An effect that was taken into the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Taken {
    /// Its number among the candidates.
    pub candidate: usize,
    /// The values of its parameters.
    pub values: Vec<f64>,
}

/// Effects of a model, by their numbers among all that may be missing.
#[derive(Clone, Copy)]
pub(super) struct Effects<'a> {
    /// What may be missing, after what the model has.
    pub(super) candidates: &'a [Candidate],
    /// Those that the model has, at their values.
    pub(super) taken: &'a [Taken],
}

/// Logs, candidates and floors: what does not change during a search.
pub(super) struct Setting<'a> {
    /// Logs to fit, and to judge with.
    pub(super) data: Split<&'a Data<'a>>,
    /// What may be missing.
    pub(super) candidates: &'a [Candidate],
    /// What the model has of them: the first effects of every state.
    pub(super) given: Vec<Taken>,
    /// Floors of the logs.
    pub(super) floors: Split<&'a [NoiseFloor]>,
}

/// A model with effects, fitted to the logs for training.
#[derive(Clone)]
pub(super) struct State {
    /// The effects.
    pub(super) taken: Vec<Taken>,
    /// For each effect the standard deviations of its parameters.
    pub(super) deviations: Vec<Vec<f64>>,
    /// For each effect that was found the same by what is left at each time.
    pub(super) by_time: Vec<Vec<f64>>,
    /// Effects that were found which no motion of the logs for training has act: they have their
    /// values by all logs.
    pub(super) untrained: Vec<usize>,
    /// The nominal model's own parameters, in their deviations.
    pub(super) z: Vec<f64>,
    /// What is left of the rows of the logs [N m, N].
    pub(super) residual: Split<Vec<f64>>,
    /// Torques that the model gives the motion of the logs.
    pub(super) torques: Split<Vec<ModelTorques>>,
}

impl<'a> Setting<'a> {
    /// Effects that a model has.
    pub(super) fn effects<'s>(&'s self, taken: &'s [Taken]) -> Effects<'s> {
        Effects { candidates: self.candidates, taken }
    }

    /// The model with effects that were found by all logs, fitted to those for training alone.
    pub(super) fn state(&self, found: &Hypothesis, z: &[f64]) -> State {
        let z = found.elsewhere.as_deref().unwrap_or(z);
        let taken = found.all_taken(self.candidates);
        let effects = self.effects(&self.given);
        let mut weighing = Weighing::new(vec![self.data.train], effects, [z, z], &taken);
        let parts = found.parts.iter().map(|part| weighing.part(&part.placed));
        let parts: Vec<Part> = parts.collect();
        weighing.base = weighing.base_beside(&parts);
        let search = Search::new(weighing, [self.candidates.len(), 0], Vec::new(), &mut |_| true);
        let fitted = search.shaped(search.settled(parts, None));
        self.fitted_state(&search.weighing, [found, &fitted])
    }

    fn fitted_state(&self, weighing: &Weighing<'_>, by: [&Hypothesis; 2]) -> State {
        let [found, fitted] = by;
        let z = fitted.weighed.own[..self.data.train.columns.len()].to_vec();
        let mut taken = weighing.given(&fitted.weighed.own);
        let beliefs = self.given.iter().map(|one| self.candidates[one.candidate].law.beliefs());
        let of_given = beliefs.map(|all| all.iter().map(|belief| belief.std).collect());
        let mut deviations: Vec<Vec<f64>> = of_given.collect();
        let acts =
            |&place: &usize| weighing.size(&found.taken(place, self.candidates)) > policy::WORTH;
        let (trained, untrained): (Vec<usize>, _) = (0..fitted.parts.len()).partition(acts);
        for place in 0..fitted.parts.len() {
            let own = by[usize::from(trained.contains(&place))];
            taken.push(own.taken(place, self.candidates));
            deviations.push(own.deviations(place));
        }
        let torques = self.data.map(|data| data.model_torques(&z, self.effects(&taken)));
        let left = |data: &Data<'a>, torques: &[ModelTorques]| {
            data.left(self.effects(&taken), &z, torques)
        };
        let residual = Split {
            train: left(self.data.train, &torques.train),
            held_out: left(self.data.held_out, &torques.held_out),
        };
        let by_time = self.deviations_by_time(weighing, fitted, &residual.train);
        State { taken, deviations, by_time, untrained, z, residual, torques }
    }

    /// The deviations of what was found by what is left at each time: where a law is not quite what
    /// it is named, most is left where it acts, and moves its values (White 1980).
    fn deviations_by_time(
        &self,
        weighing: &Weighing<'_>,
        fitted: &Hypothesis,
        residual: &[f64],
    ) -> Vec<Vec<f64>> {
        let Data { signals, stretches, .. } = self.data.train;
        let terms: Vec<&Terms> = fitted.parts.iter().map(|part| &part.terms).collect();
        let deviation = |influence: &Spectrum| {
            let influence = weighing.spectra.to_rows(&weighing.sets, influence).swap_remove(0);
            let mut moved: Vec<Vec<f64>> = vec![Vec::new(); signals.len()];
            for stretch in stretches {
                let moved = &mut moved[stretch.log.0];
                moved.resize(moved.len().max(stretch.rows), 0.0);
                let rows = stretch.range().map(|row| influence[row] * residual[row]);
                moved.iter_mut().zip(rows).for_each(|(sum, by)| *sum += by);
            }
            let all = signals.iter().zip(&moved);
            let squares = all.map(|(log, moved)| {
                let together = ALIKE_PERIODS / log.torque_hz / log.row_step_s();
                variance_of_sum(moved, (together as usize).max(1))
            });
            squares.sum::<f64>().sqrt()
        };
        let influences = weighing.base.influences(&terms, &fitted.weighed.variances);
        let of_factors: Vec<f64> = influences.iter().map(deviation).collect();
        let by_parts = fitted.parts.iter().zip(fitted.by_parts(&of_factors));
        let of = |(part, own): (&Part, &[f64])| {
            part.placed.deviations.iter().zip(own).map(|(one, factor)| one * factor).collect()
        };
        by_parts.map(of).collect()
    }

    /// Held-out logs alone, in which effects are weighed.
    pub(super) fn judging(&self, z: &[f64]) -> Weighing<'_> {
        Weighing::new(vec![self.data.held_out], self.effects(&self.given), [z, z], &[])
    }

    /// The errors of the values of an effect that was found: how far they may be from those of
    /// another motion, and no less than what is left moves them.
    pub(super) fn errors(&self, state: &State, by_all: &Hypothesis, place: usize) -> Vec<f64> {
        let both = self.apart(state, by_all, place).into_iter().zip(&state.by_time[place]);
        both.map(|(apart, by_time)| apart.max(*by_time)).collect()
    }

    /// The deviations of an effect that was found. Another law than what is there has other values
    /// in another motion (Chow 1960): they are no less than how far values by the logs for training
    /// are from those by all logs. Of a law that is there that is less than its deviation, most of
    /// the time, and says nothing new.
    fn apart(&self, state: &State, by_all: &Hypothesis, place: usize) -> Vec<f64> {
        let own = self.given.len() + place;
        let apart = state.taken[own].values.iter().zip(by_all.values(place));
        let both = state.deviations[own].iter().zip(apart);
        both.map(|(deviation, (one, other))| deviation.max((one - other).abs())).collect()
    }

    /// Held-out logs with the effects as those that were fitted have them, weighed. Noise is that
    /// of the held-out logs: what changes between logs is no reason to leave an effect out. What
    /// every drive has may have other values in another motion: of anything else that is what is
    /// asked. In what they are weighed comes with them.
    pub(super) fn predicted<'s>(
        &self,
        judging: &Weighing<'s>,
        state: &State,
        by_all: &Hypothesis,
    ) -> (Weighing<'s>, Hypothesis) {
        let found = &state.taken[self.given.len()..];
        let judging = judging.beside(&judging.z, found);
        let parts = found.iter().enumerate().map(|(place, taken)| {
            let Taken { candidate, values } = taken.clone();
            let deviations = match self.candidates[candidate].is_standard() {
                true => self.apart(state, by_all, place),
                false => state.deviations[self.given.len() + place].clone(),
            };
            let center = values.clone();
            judging.part(&Placed { candidate, values, center, deviations, log_share: 0.0 })
        });
        let parts: Vec<Part> = parts.collect();
        let terms: Vec<&Terms> = parts.iter().map(|part| &part.terms).collect();
        let base = judging.base_beside(&parts);
        let weighed = base.weigh(&terms, None, policy::ROUNDS[1]);
        (judging, Hypothesis { posterior: weighed.log_evidence, parts, weighed, elsewhere: None })
    }

    /// What the model as it is given leaves of a set of logs.
    pub(super) fn as_given(&self, data: &Data<'_>) -> Vec<f64> {
        let (z, given) = (vec![0.0; data.columns.len()], self.effects(&self.given));
        data.left(given, &z, &data.model_torques(&z, given))
    }
}

impl Data<'_> {
    /// What a model with z and effects leaves of the rows.
    fn left(&self, effects: Effects<'_>, z: &[f64], torques: &[ModelTorques]) -> Vec<f64> {
        let mut residual = self.residual_of(z);
        for Taken { candidate, values } in effects.taken {
            let law = effects.candidates[*candidate].law.as_ref();
            let of = |motion: Motion<'_>| law.response(motion, values);
            self.in_rows(&of, torques).subtract_from(&mut residual);
        }
        residual
    }
}
