//! Logs read, checked and conditioned as the options say.

use super::{Arguments, IdentifyFailure, MethodName};
use crate::cli::failure::Failure;
use crate::cli::files::read_file;
use crate::cli::logs::measured_log;
use clap::{Args, ValueEnum};
use denavit::identify::forward::{LONGEST_S, MotionLog};
use denavit::identify::{
    Ground, leave_out_idle_motors, take_out, undo_logged_torques, undo_readings,
};
use denavit::measure::condition::{Averaging, Conditioned, Conditioning, Derivatives, Filter};
use denavit::measure::log::{ColumnMapping, LogOf, LogRemark, MeasuredLog};
use denavit::model::Robot;
use denavit::plants::effect::AddedLaw;
use denavit::plants::regression::{CoulombLaw, RegressionModel};
use std::path::{Path, PathBuf};

/// How logs are conditioned.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(super) struct Conditions {
    /// Cutoff of the zero-phase Butterworth filter [Hz], with the order of one pass if it is not 4;
    /// or none. If nothing is said, a tenth of the rate of sampling, halved as long as noise of the
    /// positions biases parameters
    #[arg(long, value_name = "HZ[:ORDER]", value_parser = filter)]
    filter: Option<FilterChoice>,
    /// Leave one sample in so many; if nothing is said, as the filter allows and 1200 are left
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    decimate: Option<u32>,
    /// Average laps of this period [s], or of the one that is found
    #[arg(long, value_name = "PERIOD|found", value_parser = averaging)]
    average: Option<Averaging>,
    /// Where rates and accelerations come from
    #[arg(long, value_enum, default_value_t)]
    rates: Rates,
}

/// How often the cutoff of each log is halved, if none was given: of those for the estimate, and
/// behind them perhaps of those for validation.
pub(super) type Halvings = Vec<u32>;

/// Halvings of the cutoff, at most, and periods of it that all logs, each of them, or a lap, must
/// have more of.
const MOST_HALVINGS: u32 = 6;
const FEWEST_PERIODS: f64 = 40.0;
const FEWEST_OF_A_LOG: f64 = 10.0;
const FEWEST_OF_A_LAP: f64 = 20.0;

/// The filter if nothing is said: its order, and its cutoff over the rate of sampling.
const ORDER: usize = 4;
const TENTH: f64 = 0.1;

/// Samples that are left, if nothing is said: standard errors are found from parts of a log, of
/// which few say little.
const FEWEST_LEFT: f64 = 1200.0;

#[derive(Clone, Copy, Debug, PartialEq)]
enum FilterChoice {
    None,
    Some(Filter),
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Rates {
    /// Differences of the filtered positions
    #[default]
    Differences,
    /// The columns qd_ and qdd_ of the log
    Logged,
}

fn filter(text: &str) -> Result<FilterChoice, String> {
    if text == "none" {
        return Ok(FilterChoice::None);
    }
    let (cutoff, order) = text.split_once(':').unwrap_or((text, "4"));
    match (cutoff.parse::<f64>(), order.parse::<usize>()) {
        (Ok(cutoff_hz), Ok(order)) if cutoff_hz > 0.0 && (1..=10).contains(&order) => {
            Ok(FilterChoice::Some(Filter { order, cutoff_hz }))
        }
        _ => Err("a cutoff in Hz, with an order from 1 to 10 perhaps, as 100:4; or none".into()),
    }
}

fn averaging(text: &str) -> Result<Averaging, String> {
    match text.parse::<f64>() {
        _ if text == "found" => Ok(Averaging::Found),
        Ok(period) if period > 0.0 && period.is_finite() => Ok(Averaging::Period(period)),
        _ => Err("a period in seconds, or `found`".to_owned()),
    }
}

impl Conditions {
    /// A zero-phase filter of fourth order, all else as it is if nothing is said.
    pub(super) fn filtered(cutoff_hz: f64) -> Self {
        let filter = Some(FilterChoice::Some(Filter { order: ORDER, cutoff_hz }));
        Self { filter, ..Self::default() }
    }

    /// The filter of a log at this distance of samples \[s\].
    fn filter(&self, step_s: f64, halvings: u32) -> Option<Filter> {
        match self.filter {
            Some(FilterChoice::None) => None,
            Some(FilterChoice::Some(filter)) => Some(filter),
            None => Some(Filter { order: ORDER, cutoff_hz: cutoff(halvings) / step_s }),
        }
    }

    /// What is done with a log of so many samples at this distance \[s\].
    pub(super) fn of(&self, step_s: f64, samples: usize, halvings: u32) -> Conditioning {
        let filter = self.filter(step_s, halvings);
        // The decimator passes up to 0.4 of what is left of the rate.
        let allowed = filter.map_or(1.0, |filter| 0.4 / (filter.cutoff_hz * step_s));
        // of laps one is left
        let samples = if self.average.is_some() { 0 } else { samples };
        let allowed = allowed.min(samples as f64 / FEWEST_LEFT);
        let decimation = self.decimate.map_or(allowed.max(1.0) as usize, |n| n as usize);
        Conditioning {
            filter,
            derivatives: match self.rates {
                Rates::Differences => Derivatives::Central,
                Rates::Logged => Derivatives::Logged,
            },
            decimation,
            averaging: self.average.unwrap_or_default(),
            resolution: None,
        }
    }
}

/// The cutoff in cycles per sample.
fn cutoff(halvings: u32) -> f64 {
    TENTH / f64::from(1 << halvings)
}

/// Periods of the cutoff in so many samples, whose edges are cut.
fn periods(samples: usize, halvings: u32) -> f64 {
    samples as f64 * cutoff(halvings) - 2.0 * ORDER as f64
}

impl Conditions {
    /// The same with half the cutoff of the logs that ask for it and are long enough; none if a
    /// filter was asked for, or logs, or one lap, are too short for it. How long laps are is known
    /// when they have been found.
    pub(super) fn lower(
        &self,
        logs: &[&Conditioned],
        (halvings, asking): (&[u32], &[bool]),
    ) -> Option<Halvings> {
        let samples = |log: &Conditioned| log.q.first().map_or(0, Vec::len);
        let is_long = |log: &Conditioned, halvings: u32| match (self.average, log.laps) {
            (None, _) => periods(samples(log), halvings) > FEWEST_OF_A_LOG,
            // a lap has no edges that are cut
            (_, Some(laps)) => laps.samples as f64 * cutoff(halvings) > FEWEST_OF_A_LAP,
            (_, None) => true,
        };
        let all = logs.iter().zip(halvings).zip(asking);
        let lower: Halvings = all
            .map(|((log, &now), asks)| {
                match *asks && now < MOST_HALVINGS && is_long(log, now + 1) {
                    true => now + 1,
                    false => now,
                }
            })
            .collect();
        let all = logs.iter().zip(&lower);
        let of_all: f64 = all.map(|(log, &halvings)| periods(samples(log), halvings)).sum();
        let are_long = self.average.is_some() || of_all > FEWEST_PERIODS;
        (self.filter.is_none() && are_long && lower != halvings).then_some(lower)
    }
}

/// All logs of a run.
pub(super) struct Read {
    pub(super) train: Vec<Conditioned>,
    pub(super) validate: Vec<Conditioned>,
    pub(super) instruments: Vec<Conditioned>,
    /// The logs that are simulated again.
    pub(super) motions: Vec<MotionLog>,
    /// Whole logs for the estimate, where instruments are to be simulated.
    pub(super) whole: Vec<MotionLog>,
    /// What was found, by log, of those that are not for validation, and of those.
    remarks: [Vec<(String, LogRemark)>; 2],
    /// Deviation of each measured position [rad, m].
    pub(super) position_noise: Vec<f64>,
}

/// What all logs of a run are read with.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) arguments: &'a Arguments,
    pub(super) robot: &'a Robot,
    /// Effects that the model has beside its equations.
    pub(super) laws: &'a [AddedLaw],
    pub(super) model: &'a RegressionModel,
}

/// All logs, with these halvings of their cutoffs.
pub(super) fn read(source: Source<'_>, halvings: &[u32]) -> Result<Read, Failure> {
    let Source { arguments, .. } = source;
    let (of_train, of_others) = halvings.split_at(arguments.train.len().min(halvings.len()));
    let mut reader = Reader::new(source)?;
    // Logs for validation are simulated again; with a controller, if there are none, the others.
    let controlled = arguments.controller.is_some();
    let needs_instruments = arguments.method == MethodName::Iv && arguments.instruments.is_empty();
    let simulates_train = controlled && (arguments.validate.is_empty() || needs_instruments);
    let longest_s = simulates_train.then_some(f64::INFINITY);
    let train = reader.kept((&arguments.train, of_train), longest_s)?;
    let whole = reader.motions.take().unwrap_or_default();
    let mut numbered = train.iter().enumerate();
    let same = numbered.find_map(|(at, log)| {
        let before = train[..at].iter().find(|other| other.overlaps(log))?;
        Some([&before.file, &log.file].map(String::clone))
    });
    if let Some(same) = same {
        return Err(IdentifyFailure::SameLogs(same).into());
    }
    let instruments = reader.kept((&arguments.instruments, &[]), None)?;
    let is_measured =
        |one: &&Conditioned| train.iter().any(|log| log.q == one.q && log.torque == one.torque);
    if let Some(one) = instruments.iter().find(is_measured) {
        return Err(IdentifyFailure::OwnInstruments(one.file.clone()).into());
    }
    let motions = if arguments.validate.is_empty() { whole.clone() } else { Vec::new() };
    let Reader { remarks, noise, .. } = reader;
    let (remarks, position_noise) = ([remarks, Vec::new()], noise);
    let validate = Vec::new();
    let mut read = Read { train, validate, instruments, motions, whole, remarks, position_noise };
    read.held_out(source, of_others)?;
    Ok(read)
}

impl Read {
    /// Reads the logs for validation, again perhaps, with these halvings of their cutoffs.
    pub(super) fn held_out(&mut self, source: Source<'_>, halvings: &[u32]) -> Result<(), Failure> {
        let Source { arguments, model, .. } = source;
        if arguments.validate.is_empty() {
            return Ok(());
        }
        self.validate.clear();
        let mut reader = Reader::new(source)?;
        let is_fixed = model.joints.iter().all(|joint| !joint.is_base);
        let simulates = is_fixed || arguments.controller.is_some();
        let longest_s = simulates.then_some(LONGEST_S);
        self.validate = reader.kept((&arguments.validate, halvings), longest_s)?;
        self.motions = reader.motions.take().unwrap_or_default();
        for log in &self.validate {
            if let Some(same) = self.train.iter().find(|other| other.overlaps(log)) {
                let remark = LogRemark::SameAs { other: same.file.clone() };
                reader.remarks.push((log.file.clone(), remark));
            }
        }
        for (all, own) in self.position_noise.iter_mut().zip(reader.noise) {
            *all = all.max(own);
        }
        self.remarks[1] = reader.remarks;
        Ok(())
    }

    /// The logs for the estimate and for validation.
    pub(super) fn logs(&self) -> Vec<&Conditioned> {
        self.train.iter().chain(&self.validate).collect()
    }

    /// What was found, by log.
    pub(super) fn into_remarks(self) -> Vec<(String, LogRemark)> {
        self.remarks.into_iter().flatten().collect()
    }
}

/// A log as it was measured, without a look at torques of motors behind springs.
pub(super) fn measured(
    arguments: &Arguments,
    robot: &Robot,
    model: &RegressionModel,
    path: &Path,
) -> Result<MeasuredLog, Failure> {
    let contacts: Vec<String> =
        robot.contacts.values().map(|contact| contact.name.clone()).collect();
    let of = LogOf {
        model: &model.model,
        joints: &model.joints,
        contacts: &contacts,
        accepts_suspicious: arguments.accept_suspicious,
    };
    let mapping = mapping(arguments)?;
    measured_log(path, of, (&mapping, arguments.accept_cut))
}

/// How columns are mapped.
pub(super) fn mapping(arguments: &Arguments) -> Result<ColumnMapping, Failure> {
    let Some(path) = &arguments.columns else { return Ok(ColumnMapping::default()) };
    let name = path.display().to_string();
    let read = ColumnMapping::from_json(&name, &read_file(path)?);
    Ok(read.map_err(IdentifyFailure::Mapping)?)
}

struct Reader<'a> {
    arguments: &'a Arguments,
    robot: &'a Robot,
    model: &'a RegressionModel,
    laws: &'a [AddedLaw],
    mapping: ColumnMapping,
    ground: Option<Ground>,
    contacts: Vec<String>,
    names: Vec<String>,
    remarks: Vec<(String, LogRemark)>,
    noise: Vec<f64>,
    /// Logs to be simulated again, if any are wanted.
    motions: Option<Vec<MotionLog>>,
}

impl<'a> Reader<'a> {
    fn new(source: Source<'a>) -> Result<Self, Failure> {
        let Source { arguments, robot, laws, model } = source;
        let ground = Ground::under(robot, model)
            .map_err(|error| IdentifyFailure::Plant(model.model.clone(), error))?;
        Ok(Self {
            arguments,
            robot,
            model,
            laws,
            mapping: mapping(arguments)?,
            ground,
            contacts: robot.contacts.values().map(|contact| contact.name.clone()).collect(),
            names: model.joints.iter().map(|joint| joint.name.clone()).collect(),
            remarks: Vec::new(),
            noise: vec![0.0; model.joints.len()],
            motions: None,
        })
    }

    /// Reads logs, whose cutoffs are halved so often, and keeps their motion for so long \[s\].
    fn kept(
        &mut self,
        (paths, halvings): (&[PathBuf], &[u32]),
        longest_s: Option<f64>,
    ) -> Result<Vec<Conditioned>, Failure> {
        self.motions = longest_s.map(|_| Vec::new());
        let halvings = halvings.iter().copied().chain(std::iter::repeat(0));
        let all = paths.iter().zip(halvings);
        Failure::of_any_log(all.map(|(path, own)| self.one((path, own), longest_s)))
    }

    fn one(
        &mut self,
        (path, halvings): (&Path, u32),
        longest_s: Option<f64>,
    ) -> Result<Conditioned, Failure> {
        let file = path.display().to_string();
        let of = LogOf {
            model: &self.model.model,
            joints: &self.model.joints,
            contacts: &self.contacts,
            accepts_suspicious: self.arguments.accept_suspicious,
        };
        let mut log = measured_log(path, of, (&self.mapping, self.arguments.accept_cut))?;
        log.require_joint_torques(of).map_err(IdentifyFailure::from)?;
        undo_readings(&mut log, self.laws);
        if self.ground.is_none() && !log.wrenches.is_empty() {
            let around = Ground::around(self.robot, self.model);
            let failed = |error| IdentifyFailure::Plant(self.model.model.clone(), error);
            self.ground = Some(around.map_err(failed)?);
        }
        if let Some(ground) = &mut self.ground {
            ground.load(&mut log);
        }
        let remarks = std::mem::take(&mut log.remarks);
        self.remarks.extend(remarks.into_iter().map(|remark| (file.clone(), remark)));
        let conditions = &self.arguments.conditions;
        let how = Conditioning {
            resolution: self.arguments.resolution,
            ..conditions.of(log.step_s, log.samples(), halvings)
        };
        if let (Some(Filter { cutoff_hz, .. }), 1..) = (how.filter, halvings) {
            self.remarks.push((file.clone(), LogRemark::LoweredFilter { cutoff_hz }));
        }
        if let (Some(motions), Some(longest_s)) = (&mut self.motions, longest_s) {
            let head = log.head((longest_s / log.step_s).min(1e15) as usize + 1);
            let motion = MotionLog::new(&head, &self.names, how.filter);
            let failed = |error| IdentifyFailure::Condition(file.clone(), error);
            let mut motion = motion.map_err(failed)?;
            undo_logged_torques(&mut motion, self.model, self.laws);
            if let CoulombLaw::Tanh(width) = self.arguments.friction {
                motion.stiction_rate = width;
            }
            motions.push(motion);
        }
        let conditioned = Conditioned::new(log, &self.names, &how);
        let mut conditioned =
            conditioned.map_err(|error| IdentifyFailure::Condition(file.clone(), error))?;
        take_out(&mut conditioned, self.model, self.laws);
        self.note(&file, &conditioned);
        for joint in leave_out_idle_motors(self.model, &mut conditioned) {
            self.remarks.push((file.clone(), LogRemark::Idle { joint: self.names[joint].clone() }));
        }
        Ok(conditioned)
    }

    /// What a conditioned log says of noise, rest and laps.
    fn note(&mut self, file: &str, log: &Conditioned) {
        for (all, own) in self.noise.iter_mut().zip(&log.position_noise) {
            *all = all.max(*own);
        }
        for (joint, name) in self.names.iter().enumerate().filter(|(at, _)| log.resting[*at]) {
            let remark = (file.to_owned(), LogRemark::Resting { joint: name.clone() });
            if !(self.model.joints[joint].is_base || self.remarks.contains(&remark)) {
                self.remarks.push(remark);
            }
        }
        if let Some(laps) = &log.laps {
            let period_s = laps.samples as f64 * log.step_s;
            let remark = LogRemark::Averaged { laps: laps.count, period_s };
            self.remarks.push((file.to_owned(), remark));
        }
    }
}
