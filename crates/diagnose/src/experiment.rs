//! The separating experiment: a motion within the limits of the robot that tells names apart which
//! the logs do not.
//!
//! A log of each name is simulated along a motion, with the noise of the logs, and the names are
//! weighed in it as a diagnosis does: by the evidence of each, with everything that the model is
//! not sure of. The motion makes the least odds of a name that is there large; how often these are
//! what a name asks for is its power.

use super::candidate::Candidate;
use super::data::Data;
use super::error::{Error, ErrorKind};
use super::floor::rms;
use super::followed::Follower;
use super::hypothesis::Part;
use super::nominal::Nominal;
use super::search::Search;
use super::signals::{Filters, Signals};
use super::state::{Effects, Taken};
use super::weighing::{Placed, Weighing, add};
use denavit_codegen::model::Robot;
use denavit_codegen::regressor::functions::modelled;
use denavit_evidence::{Spectrum, policy};
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
    /// The least separation of two names: root of twice the log odds of the one that is there, in a
    /// simulated log; 0 where the other one has them.
    pub separation: f64,
    /// The same of the motion of the logs.
    pub separation_before: f64,
    /// The share of simulated logs in which the right name has the odds that a name asks for,
    /// against each other one.
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
    pub(super) names: Vec<Placed>,
    /// The other effects, which are there in any case.
    pub(super) others: Vec<Taken>,
}

/// The odds of a motion, its numbers, and the place of their space.
type Tried = (f64, Vec<f64>, usize);

/// A motion with what the names do there.
struct Seen<'s, 'a> {
    search: Search<'a>,
    data: &'s Data<'a>,
    names: Vec<Part>,
    floor: &'s [f64],
}

impl Ambiguity<'_> {
    /// Looks for an experiment.
    pub(super) fn separate(&self, robot: &Robot, seed: u64) -> Result<Experiment, Error> {
        let none = |why: &str| Error::new(ErrorKind::NoExperiment, why);
        let nominal = self.nominal;
        let is_lost = |joint: &usize| {
            self.log.motor[*joint].is_some()
                && nominal.spring_equation(JointIndex(*joint)).is_none()
        };
        if let Some(joint) = (0..nominal.model.joints.len()).find(is_lost) {
            return Err(none(&nominal.lacks_stiffness(JointIndex(joint))));
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
        let mut spaces = spaces.map_err(|error| Error::of(ErrorKind::NoExperiment, error))?;
        let found = self.best(&mut spaces, seed);
        let (odds, x, space) =
            found.ok_or_else(|| none("even at rest a limit of the robot is exceeded"))?;
        let separation = separation_of(odds);
        let feasible = &spaces[space];
        let references = feasible.references(&x);
        let power =
            self.log_of(&references).and_then(|log| self.seen(log, |seen| seen.power(seed)));
        let why = "the odds reach 100 to 1 in no log of the best one that was tried";
        let power = power.filter(|power| *power > 0.0).ok_or_else(|| none(why))?;
        let rivals: Vec<usize> = self.names[1..].iter().map(|one| one.candidate).collect();
        let before = self.seen(self.log.clone(), |seen| seen.least(seed));
        let separation_before = separation_of(before.unwrap_or(0.0));
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

    /// The motion of the largest odds of names that are there, with its space: the best of some at
    /// random, moved at random as long as that makes it better.
    fn best(&self, spaces: &mut [Feasible], seed: u64) -> Option<Tried> {
        let mut best: Option<Tried> = None;
        let offer = |best: &mut Option<Tried>, feasible: &Feasible, x: Vec<f64>, space: usize| {
            let value = self.value(feasible, &x, seed);
            let most = best.as_ref().map_or(f64::NEG_INFINITY, |(most, ..)| *most);
            let is_best = value.is_finite() && value > most;
            if is_best {
                *best = Some((value, x, space));
            }
            is_best
        };
        for start in 0..STARTS {
            let space = start % spaces.len();
            if let Some(x) = spaces[space].random(start) {
                offer(&mut best, &spaces[space], x, space);
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
            let Some(moved) = spaces[space].within(moved) else { continue };
            let is_best = offer(&mut best, &spaces[space], moved, space);
            reach = if is_best { f64::min(1.0, 1.3 * reach) } else { 0.85 * reach };
        }
        best
    }

    fn value(&self, feasible: &Feasible, x: &[f64], seed: u64) -> f64 {
        let log = self.log_of(&feasible.references(x));
        let least = log.and_then(|log| self.seen(log, |seen| seen.least(seed)));
        least.unwrap_or(f64::NEG_INFINITY)
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
            let taken: Vec<Taken> =
                self.names[..1].iter().map(taken).chain(self.others.iter().cloned()).collect();
            let effects = Effects { candidates: self.candidates, taken: &taken };
            let follower = Follower { nominal: self.nominal, z: self.z, effects, log: self.log };
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

    /// What is asked of names in a motion; none if nothing is measured there.
    fn seen<T>(&self, log: Signals, asked: impl FnOnce(&mut Seen<'_, '_>) -> T) -> Option<T> {
        let mut data = Data::new(self.nominal, vec![log], self.z);
        if data.rows() == 0 {
            return None;
        }
        // What is measured there is what the model says: that tells the level of noise.
        let effects = Effects { candidates: self.candidates, taken: &[] };
        let torques = data.model_torques(self.z, effects).swap_remove(0).total;
        for stretch in data.stretches.clone() {
            if stretch.equation == stretch.joint.0 {
                let computed = data.signals[0].rows_of(&torques[stretch.equation]);
                data.torque[stretch.range()].copy_from_slice(&computed);
            }
        }
        let weighing = Weighing::new(vec![&data], effects, [self.z, self.z], &self.others);
        let names = self.names.iter().map(|one| weighing.part(one)).collect();
        let search = Search::new(weighing, [self.candidates.len(), 0], Vec::new(), &mut |_| true);
        Some(asked(&mut Seen { search, data: &data, names, floor: self.floor }))
    }
}

impl Seen<'_, '_> {
    /// The least log odds of a name in a simulated log of it: of what was found against all others,
    /// or of one of these against it.
    fn odds(&mut self, truth: usize, random: &mut Random) -> f64 {
        let mut log = self.noise(random);
        add(&mut log, &self.names[truth].terms.known, 1.0);
        self.search.weighing.base = self.search.weighing.base.clone().of(log);
        let posterior =
            |name: usize| self.search.settled(vec![self.names[name].clone()], None).posterior;
        let others = if truth == 0 { 1..self.names.len() } else { 0..1 };
        posterior(truth) - others.map(posterior).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The least of these odds in one log of each name.
    fn least(&mut self, seed: u64) -> f64 {
        let odds = (0..self.names.len()).map(|truth| self.odds(truth, &mut Random::new(seed)));
        odds.fold(f64::INFINITY, f64::min)
    }

    /// The share of simulated logs in which the right name is told: what was found from all others,
    /// and each of these from it.
    fn power(&mut self, seed: u64) -> f64 {
        let mut random = Random::new(seed);
        let logs = DRAWS * self.names.len();
        let told = (0..logs).filter(|log| self.odds(log / DRAWS, &mut random) > policy::NAMED);
        told.count() as f64 / logs as f64
    }

    /// White noise as that of the logs, through the filter.
    fn noise(&self, random: &mut Random) -> Spectrum {
        let signals = &self.data.signals[0];
        let gain = signals.noise_gain();
        let mut rows = Vec::with_capacity(self.data.rows());
        for stretch in &self.data.stretches {
            let deviation = self.floor[stretch.equation] / gain;
            rows.extend(signals.white_rows(|| deviation * random.normal()));
        }
        self.search.weighing.spectra.of_rows(&[self.data], &[&rows], f64::INFINITY)
    }
}

/// The separation that log odds are: of these, normal errors of so many deviations.
fn separation_of(log_odds: f64) -> f64 {
    (2.0 * log_odds.max(0.0)).sqrt()
}

/// A name with its values.
fn taken(one: &Placed) -> Taken {
    Taken { candidate: one.candidate, values: one.values.clone() }
}
