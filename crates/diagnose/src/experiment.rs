//! The separating experiment: a motion within the limits of the robot that tells names apart which
//! the logs do not.
//!
//! What one effect does to the torques of a motion is fitted by another one, with everything that
//! the model is not sure of: what is left, over the noise floor of the logs, is their separation.
//! The motion makes the least of these large. What it will say is then simulated: torques of the
//! one or the other, with the noise of the logs, told apart as a diagnosis does.

use super::blocks::{block_costs, paired};
use super::candidate::Candidate;
use super::data::{Data, ModelTorques};
use super::error::{Cause, Error};
use super::floor::rms;
use super::followed::Follower;
use super::nominal::Nominal;
use super::problem::{Fitted, Problem};
use super::signals::{Filters, Signals};
use super::state::{Taken, within};
use super::turning::turning;
use crate::policy::experiment::{DISTINCT, ROWS_PER_SAMPLE};
use denavit_codegen::model::Robot;
use denavit_codegen::regressor::functions::modelled;
use denavit_excite::{Ends, ExciteOptions, Family, Feasible};
use denavit_measure::JointIndex;
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_numerics::Random;
use denavit_plants::trajectory::Reference;
use serde_json::{Value, json};

/// Length of a lap \[s\].
const LAP_S: f64 = 10.0;

/// Motions at random of which the best is improved, motions that are tried to improve it, and logs
/// that are simulated of each name.
const STARTS: usize = 9;
const STEPS: usize = 24;
const DRAWS: usize = 20;

/// Harmonics of the Fourier series that joints follow: few go far, many are fast.
const HARMONICS: [usize; 3] = [2, 3, 5];

/// An experiment that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// The candidates that it is to tell from the one that was found.
    pub rivals: Vec<usize>,
    /// What each joint follows.
    pub references: Vec<Reference>,
    /// The trajectory file.
    pub file: Value,
    /// Length of a lap \[s\].
    pub duration_s: f64,
    /// The least separation of two names: what the one leaves of the other, root of the sum of
    /// squares over deviations of noise, samples that noise makes alike counted once.
    pub separation: f64,
    /// The same of the motion of the logs.
    pub separation_before: f64,
    /// The share of simulated logs in which the right name was told from each other one by so many
    /// standard errors as a diagnosis asks for.
    pub power: f64,
    /// How many logs were simulated.
    pub draws: usize,
}

/// What names are to be told apart in: the state of a diagnosis.
pub(super) struct Ambiguity<'a> {
    pub(super) nominal: &'a Nominal<'a>,
    pub(super) candidates: &'a [Candidate],
    /// A log, its filters and its floor: as the next one will be.
    pub(super) log: &'a Signals,
    pub(super) filters: Filters,
    pub(super) floor: &'a [f64],
    /// The nominal model's own parameters, in their deviations.
    pub(super) z: &'a [f64],
    /// The names: what was found, then what would do as well.
    pub(super) names: Vec<Taken>,
    /// The other effects, which are there in any case.
    pub(super) others: Vec<Taken>,
}

/// A motion with what the names do there.
struct Seen<'a> {
    data: Data<'a>,
    torques: Vec<ModelTorques>,
    deviation: Vec<f64>,
    /// For each name its rows.
    names: Vec<Vec<f64>>,
}

impl Ambiguity<'_> {
    /// Looks for an experiment.
    pub(super) fn separate(&self, robot: &Robot, seed: u64) -> Result<Experiment, Error> {
        let nominal = self.nominal;
        let is_lost = |joint: &usize| {
            self.log.motor[*joint].is_some()
                && nominal.spring_equation(JointIndex(*joint)).is_none()
        };
        if let Some(joint) = (0..nominal.model.joints.len()).find(is_lost) {
            return Err(Cause::NoExperiment(nominal.lacks_stiffness(JointIndex(joint))).into());
        }
        let of_harmonics = |harmonics: usize| {
            let excite = ExciteOptions {
                family: Family::Fourier { harmonics },
                duration_s: LAP_S,
                // The motor before a spring is ahead by what accelerations take, and must not jump.
                ends: Ends {
                    at_rest: true,
                    unaccelerated: !nominal.springs.is_empty(),
                    closed: true,
                },
                with: modelled(robot),
                seed,
                ..ExciteOptions::default()
            };
            Feasible::new(robot, &excite)
        };
        let spaces = HARMONICS.into_iter().map(of_harmonics).collect::<Result<Vec<_>, _>>();
        let mut spaces = spaces.map_err(Cause::Limits)?;
        let rest = || "even at rest a limit of the robot is exceeded".to_owned();
        let found = self.best(&mut spaces, seed);
        let (separation, x, space) = found.ok_or_else(|| Cause::NoExperiment(rest()))?;
        let feasible = &spaces[space];
        let references = feasible.references(&x);
        let seen = self.log_of(&references).and_then(|log| self.seen(log));
        let power = seen.map_or(0.0, |seen| self.power(&seen, seed));
        let rivals: Vec<usize> = self.names[1..].iter().map(|one| one.candidate).collect();
        let separation_before = self.seen(self.log.clone()).map_or(0.0, |seen| self.least(&seen));
        let name = |candidate: usize| self.candidates[candidate].name();
        let remarks = json!({
            "separates": name(self.names[0].candidate),
            "from": rivals.iter().map(|&one| name(one)).collect::<Vec<String>>(),
            "separation": separation,
            "separation_before": separation_before,
            "power": power,
            "draws": DRAWS,
            "seed": seed,
        });
        let title = format!("{}_separating", self.nominal.model.model);
        Ok(Experiment {
            file: feasible.to_json(&x, &title, &remarks),
            rivals,
            references,
            duration_s: LAP_S,
            separation,
            separation_before,
            power,
            draws: DRAWS,
        })
    }

    /// The motion of the largest separation, with its space: the best of some at random, moved at
    /// random as long as that makes it better.
    fn best(&self, spaces: &mut [Feasible], seed: u64) -> Option<(f64, Vec<f64>, usize)> {
        let mut best: Option<(f64, Vec<f64>, usize)> = None;
        let is_better = |best: &Option<(f64, Vec<f64>, usize)>, value: f64| {
            value.is_finite() && best.as_ref().is_none_or(|(most, ..)| value > *most)
        };
        for start in 0..STARTS {
            let space = start % spaces.len();
            let feasible = &mut spaces[space];
            let Some(x) = feasible.random(start) else { continue };
            let value = self.value(feasible, &x);
            if is_better(&best, value) {
                best = Some((value, x, space));
            }
        }
        let mut random = Random::new(seed);
        let mut reach = 0.5;
        for _ in 0..STEPS {
            let Some((_, x, space)) = &best else { break };
            let (size, space) = (rms(x), *space);
            // Also larger, until a limit is reached.
            let larger = 1.0 + reach * random.uniform();
            let moved = x.iter().map(|x| larger * x + reach * size * random.normal()).collect();
            let feasible = &mut spaces[space];
            let Some(moved) = feasible.within(moved) else { continue };
            let value = self.value(feasible, &moved);
            if is_better(&best, value) {
                best = Some((value, moved, space));
                reach = f64::min(1.0, 1.3 * reach);
            } else {
                reach *= 0.85;
            }
        }
        best
    }

    fn value(&self, feasible: &Feasible, x: &[f64]) -> f64 {
        let log = self.log_of(&feasible.references(x));
        let seen = log.and_then(|log| self.seen(log));
        seen.map_or(f64::NEG_INFINITY, |seen| self.least(&seen))
    }

    /// One lap, and as much of the next as the edges of filters take; none if no motion of motors
    /// before springs makes the joints follow.
    fn log_of(&self, references: &[Reference]) -> Option<Signals> {
        let step_s = self.log.log_step_s;
        let rows = (1.1 * LAP_S / step_s) as usize;
        let position = |reference: &Reference| -> Vec<f64> {
            (0..rows).map(|k| reference.at((step_s * k as f64) % LAP_S).position).collect()
        };
        let mut motors = vec![None; references.len()];
        if !self.nominal.springs.is_empty() {
            let follower = Follower {
                nominal: self.nominal,
                z: self.z,
                laws: self.names[..1].iter().chain(&self.others).map(|o| self.fitted(o)).collect(),
                log: self.log,
            };
            motors = follower.motors(references, rows, LAP_S)?;
        }
        let joint = |(joint, reference): (usize, &Reference)| JointSignals {
            q: position(reference),
            motor: motors[joint].clone(),
            // What is measured is made afterwards, in the rows.
            tau: self.log.torque[joint].as_ref().map(|_| vec![0.0; rows]),
            ..JointSignals::default()
        };
        let log = MeasuredLog {
            file: "the experiment".to_owned(),
            step_s,
            joints: references.iter().enumerate().map(joint).collect(),
            ..MeasuredLog::default()
        };
        Some(Signals::new(log, self.filters).unwrap_or_else(|_| self.log.clone()))
    }

    fn fitted(&self, one: &Taken) -> Fitted<'_> {
        let law = self.candidates[one.candidate].law.as_ref();
        Fitted { law, values: one.values.clone() }
    }

    /// What names and the others do in a motion; none if nothing is measured there.
    fn seen(&self, log: Signals) -> Option<Seen<'_>> {
        let data = Data::new(self.nominal, vec![log]);
        if data.rows() == 0 {
            return None;
        }
        let torques = data.model_torques(self.z);
        let all = self.names.iter().chain(&self.others);
        let laws: Vec<Fitted<'_>> = all.map(|one| self.fitted(one)).collect();
        let mut deviation = turning(&data, &torques, &laws);
        for stretch in &data.stretches {
            let floor = self.floor[stretch.equation];
            let rows = deviation[stretch.range()].iter_mut();
            rows.for_each(|row| *row = row.hypot(floor));
        }
        let rows_of = |one: &Fitted<'_>| {
            let mut rows = vec![0.0; data.rows()];
            data.response(one.law, &one.values, &torques).subtract_from(&mut rows);
            rows.into_iter().map(|row| -row).collect()
        };
        let names = laws[..self.names.len()].iter().map(rows_of).collect();
        Some(Seen { data, torques, deviation, names })
    }

    /// The least separation of what was found from another name.
    fn least(&self, seen: &Seen<'_>) -> f64 {
        let problem = Problem::new(&seen.data, &seen.deviation);
        let mut least = f64::INFINITY;
        for rival in 1..self.names.len() {
            for (truth, told) in [(0, rival), (rival, 0)] {
                let blocks = self.left(seen, &problem, seen.names[truth].clone(), told);
                least = least.min((blocks.iter().sum::<f64>() / ROWS_PER_SAMPLE).sqrt());
            }
        }
        least
    }

    /// Weighted squares of what a name leaves of rows, fitted with everything that may be off.
    fn left(
        &self,
        seen: &Seen<'_>,
        problem: &Problem<'_>,
        rows: Vec<f64>,
        name: usize,
    ) -> Vec<f64> {
        let Taken { candidate, values } = &self.names[name];
        let law = self.candidates[*candidate].law.as_ref();
        let mut fitted = [Fitted { law, values: values.clone() }];
        // As a diagnosis does: what the model states of itself is not exceeded without end.
        let found = within(&problem.of_rows(rows), &mut fitted, &seen.torques);
        block_costs(&seen.data, &found.residual, &seen.deviation)
    }

    /// The share of simulated logs in which the right name is told: what was found from all others,
    /// and each of these from it.
    fn power(&self, seen: &Seen<'_>, seed: u64) -> f64 {
        let problem = Problem::new(&seen.data, &seen.deviation);
        let mut random = Random::new(seed);
        let (mut right, mut all) = (0, 0);
        for truth in 0..self.names.len() {
            let against = if truth == 0 { 1..self.names.len() } else { 0..1 };
            for _ in 0..DRAWS {
                let mut rows = seen.names[truth].clone();
                self.add_noise(seen, &mut random, &mut rows);
                let own = self.left(seen, &problem, rows.clone(), truth);
                let is_told = against.clone().all(|other| {
                    let others = self.left(seen, &problem, rows.clone(), other);
                    paired(&others, &own) > DISTINCT
                });
                right += usize::from(is_told);
                all += 1;
            }
        }
        right as f64 / all.max(1) as f64
    }

    /// White noise as that of the logs, through the filter.
    fn add_noise(&self, seen: &Seen<'_>, random: &mut Random, rows: &mut [f64]) {
        let signals = &seen.data.signals[0];
        let gain = signals.noise_gain();
        for stretch in &seen.data.stretches {
            let deviation = self.floor[stretch.equation] / gain;
            let noise = signals.white_rows(|| deviation * random.normal());
            rows[stretch.range()].iter_mut().zip(noise).for_each(|(row, noise)| *row += noise);
        }
    }
}
