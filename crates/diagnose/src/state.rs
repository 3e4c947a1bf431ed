//! A model with the effects that it has so far, fitted to the logs for training and judged with
//! others.

use super::candidate::Candidate;
use super::data::{Data, ModelTorques};
use super::floor::NoiseFloor;
use super::hypothesis::{Hypothesis, Part};
use super::nominal::NominalAt;
use super::problem::{Fitted, Found, Problem};
use super::search::{Search, SearchOptions};
use super::simulated::{MotionGap, Moved, NotMoved};
use super::weighing::{Placed, Weighing};
pub(super) use crate::policy::state::MOST_Z;
use denavit_evidence::{Terms, policy};

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
    /// Logs to fit.
    pub(super) train: &'a Data<'a>,
    /// Logs to judge with.
    pub(super) held_out: &'a Data<'a>,
    /// What may be missing.
    pub(super) candidates: &'a [Candidate],
    /// What the model has of them: the first effects of every state.
    pub(super) given: Vec<Taken>,
    /// The model as a file, to be moved along the logs, with the filter of these \[Hz\].
    pub(super) moved: Option<(&'a Moved<'a>, f64)>,
    /// Floors of the logs to fit.
    pub(super) train_floor: &'a [NoiseFloor],
    /// Floors of the logs to judge with.
    pub(super) held_out_floor: &'a [NoiseFloor],
}

/// A model with effects, fitted to the logs for training.
#[derive(Clone)]
pub(super) struct State {
    /// The effects.
    pub(super) taken: Vec<Taken>,
    /// For each effect the standard deviations of its parameters.
    pub(super) deviations: Vec<Vec<f64>>,
    /// The nominal model's own parameters, in their deviations.
    pub(super) z: Vec<f64>,
    /// What is left of the logs that were fitted [N m, N].
    pub(super) residual: Vec<f64>,
    /// What is left of the others.
    pub(super) held_out_residual: Vec<f64>,
    /// Torques that the model gives the motion of the logs.
    pub(super) torques: [Vec<ModelTorques>; 2],
}

/// Rounds in which entries of z are held.
const MOST_HELD: usize = 8;

impl<'a> Setting<'a> {
    /// Effects that a model has.
    pub(super) fn effects<'s>(&'s self, taken: &'s [Taken]) -> Effects<'s> {
        Effects { candidates: self.candidates, taken }
    }

    /// The model with effects that were found by all logs, fitted to those for training alone.
    pub(super) fn state(&self, parts: &[Part], z: &[f64]) -> State {
        let weighing = Weighing::new(vec![self.train], self.effects(&self.given), z);
        let (all, options) = (self.candidates.len(), SearchOptions::default());
        let search = Search::new(weighing, all, options, &mut |_| true);
        let parts = parts.iter().map(|part| search.weighing.part(&part.placed)).collect();
        let fitted = search.settled(parts, None);
        self.fitted_state(&search.weighing, &fitted)
    }

    fn fitted_state(&self, weighing: &Weighing<'_>, fitted: &Hypothesis) -> State {
        let z = fitted.weighed.own[..self.train.columns.len()].to_vec();
        let mut taken = weighing.given(&fitted.weighed.own);
        let mut deviations: Vec<Vec<f64>> = self
            .given
            .iter()
            .map(|one| {
                let beliefs = self.candidates[one.candidate].law.beliefs();
                beliefs.iter().map(|belief| belief.std).collect()
            })
            .collect();
        for (place, part) in fitted.parts.iter().enumerate() {
            let candidate = part.placed.candidate;
            let parameters = self.candidates[candidate].law.parameters();
            let values = fitted.values(place).into_iter().zip(parameters);
            let values = values.map(|(value, one)| value.clamp(one.bounds[0], one.bounds[1]));
            taken.push(Taken { candidate, values: values.collect() });
            deviations.push(fitted.deviations(place));
        }
        let torques = [self.train, self.held_out].map(|data| data.model_torques(&z));
        let left = |data: &Data<'a>, torques: &Vec<ModelTorques>| {
            data.left(&self.fitted(&taken), &z, torques)
        };
        State {
            residual: left(self.train, &torques[0]),
            held_out_residual: left(self.held_out, &torques[1]),
            taken,
            deviations,
            z,
            torques,
        }
    }

    /// Held-out logs alone, in which effects are weighed.
    pub(super) fn judging(&self, z: &[f64]) -> Weighing<'_> {
        Weighing::new(vec![self.held_out], self.effects(&self.given), z)
    }

    /// The log of the evidence of held-out logs with the effects as those that were fitted have
    /// them. Noise is that of the held-out logs: what changes between logs is no reason to leave
    /// an effect out.
    pub(super) fn log_predicted(&self, judging: &Weighing<'_>, state: &State) -> f64 {
        let found = state.taken.iter().zip(&state.deviations).skip(self.given.len());
        let terms = found.map(|(taken, deviations)| {
            let Taken { candidate, values } = taken.clone();
            let (center, deviations) = (values.clone(), deviations.clone());
            judging.terms(&Placed { candidate, values, center, deviations, log_share: 0.0 })
        });
        let terms: Vec<Terms> = terms.collect();
        let all: Vec<&Terms> = terms.iter().collect();
        judging.base.weigh(&all, None, policy::ROUNDS[1]).log_evidence
    }

    /// What the model as it is given leaves of a set of logs: those fitted, or the others.
    pub(super) fn as_given(&self, set: usize) -> Vec<f64> {
        let data = [self.train, self.held_out][set];
        let z = vec![0.0; data.columns.len()];
        data.left(&self.fitted(&self.given), &z, &data.model_torques(&z))
    }

    /// The laws of effects with their values.
    fn fitted(&self, taken: &[Taken]) -> Vec<Fitted<'a>> {
        let of = |one: &Taken| Fitted {
            law: self.candidates[one.candidate].law.as_ref(),
            values: one.values.clone(),
        };
        taken.iter().map(of).collect()
    }

    /// The gap of the model in motion along a set of logs: those fitted, or the others.
    pub(super) fn motion_gap(
        &self,
        set: usize,
        taken: &[Taken],
        z: &[f64],
    ) -> Result<MotionGap, NotMoved> {
        let Some((moved, cutoff_hz)) = self.moved else { return Ok(MotionGap::default()) };
        let model = NominalAt { nominal: self.train.nominal, z };
        moved.gap(set, cutoff_hz, model, self.effects(taken))
    }
}

impl Data<'_> {
    /// What a model with z and laws leaves of the rows.
    fn left(&self, laws: &[Fitted<'_>], z: &[f64], torques: &[ModelTorques]) -> Vec<f64> {
        let mut residual = self.residual_of(z);
        for fitted in laws {
            for (log, torques) in torques.iter().enumerate() {
                let signals = &self.signals[log];
                let motion = torques.motion(self.nominal, signals);
                let response = fitted.law.response(motion, &fitted.values);
                self.in_rows(log, signals, &response).subtract_from(&mut residual);
            }
        }
        residual
    }
}

/// Fits laws with every entry of z free until it is at a bound.
pub(super) fn within(
    problem: &Problem<'_>,
    laws: &mut [Fitted<'_>],
    torques: &[ModelTorques],
) -> Found {
    let mut held = vec![None; problem.data.columns.len()];
    let mut found = problem.fit(laws, torques);
    for _ in 0..MOST_HELD {
        let fitted = laws.iter_mut().zip(&found.values);
        fitted.for_each(|(law, values)| law.values.clone_from(values));
        if !super::held::hold(&mut held, &found.z, MOST_Z) {
            break;
        }
        found = problem.holding(&held).fit(laws, torques);
    }
    found
}
