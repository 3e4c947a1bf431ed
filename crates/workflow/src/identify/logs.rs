//! Logs read, checked and conditioned as the options say.

use super::Work;
use super::clock::Clock;
use crate::error::{Cause, Error};
use crate::logs::LogSource;
use crate::observer::Reading;
use denavit_identify::estimate::Method;
use denavit_identify::leave_out_idle_motors;
use denavit_measure::ErrorKind;
use denavit_measure::condition::{Conditioned, Conditioning, Filter, Stretch};
use denavit_measure::log::{LogFault, LogFaults, LogRemark, MeasuredLog};
use denavit_measure::{JointIndex, Split};
use denavit_numerics::short;
use denavit_plants::regression::CoulombLaw;
use denavit_replay::{Ground, LONGEST_S, MotionLog, take_out, undo_logged_torques, undo_readings};

/// All logs of a run.
pub(super) struct Read {
    pub(super) train: Vec<Conditioned>,
    pub(super) validate: Vec<Conditioned>,
    pub(super) instruments: Vec<Conditioned>,
    /// The logs that are simulated again.
    pub(super) motions: Vec<MotionLog>,
    /// Whole logs for the estimate, where instruments are to be simulated.
    pub(super) whole: Vec<MotionLog>,
    /// What was found, by log: of those that are not for validation, and of those.
    remarks: Split<Vec<(String, LogRemark)>>,
    /// Deviation of each measured position [rad, m].
    pub(super) position_noise: Vec<f64>,
    /// How often the cutoff of the first log was halved.
    pub(super) halvings: u32,
}

/// All logs, with these halvings of their cutoffs.
pub(super) fn read(
    work: Work<'_>,
    halvings: &[u32],
    reading: &mut Reading<'_, '_>,
) -> Result<Read, Error> {
    let Work { logs, options, .. } = work;
    let (of_train, of_others) = halvings.split_at(logs.train.len().min(halvings.len()));
    let mut reader = Reader::new(work, reading)?;
    // Logs for validation are simulated again; with a controller, if there are none, the others.
    let controlled = options.controller.is_some();
    let needs_instruments =
        options.method == Method::Instrumental && options.instruments.is_empty();
    let simulates_train = controlled && (logs.held_out.is_empty() || needs_instruments);
    let longest_s = simulates_train.then_some(f64::INFINITY);
    let train = reader.kept(&logs.train, of_train, longest_s)?;
    let whole = reader.motions.take().unwrap_or_default();
    let mut numbered = train.iter().enumerate();
    let same = numbered.find_map(|(at, log)| {
        let before = train[..at].iter().find(|other| other.overlaps(log))?;
        Some([&before.file, &log.file].map(String::clone))
    });
    if let Some(same) = same {
        return Err(Cause::SameLogs(same).into());
    }
    let instruments = reader.kept(&options.instruments, &[], None)?;
    let is_measured =
        |one: &&Conditioned| train.iter().any(|log| log.q == one.q && log.torque == one.torque);
    if let Some(one) = instruments.iter().find(is_measured) {
        return Err(Cause::OwnInstruments(one.file.clone()).into());
    }
    let motions = if logs.held_out.is_empty() { whole.clone() } else { Vec::new() };
    let Reader { remarks, noise, .. } = reader;
    let (remarks, position_noise) = (Split { train: remarks, held_out: Vec::new() }, noise);
    let mut read = Read {
        train,
        validate: Vec::new(),
        instruments,
        motions,
        whole,
        remarks,
        position_noise,
        halvings: of_train.first().copied().unwrap_or(0),
    };
    read.held_out(work, of_others, reading)?;
    Ok(read)
}

impl Read {
    /// Reads the logs for validation, again perhaps, with these halvings of their cutoffs.
    pub(super) fn held_out(
        &mut self,
        work: Work<'_>,
        halvings: &[u32],
        reading: &mut Reading<'_, '_>,
    ) -> Result<(), Error> {
        let Work { logs, options, model, .. } = work;
        if logs.held_out.is_empty() {
            return Ok(());
        }
        self.validate.clear();
        let mut reader = Reader::new(work, reading)?;
        let is_fixed = model.joints.iter().all(|joint| !joint.is_base);
        let simulates = is_fixed || options.controller.is_some();
        let longest_s = simulates.then_some(LONGEST_S);
        self.validate = reader.kept(&logs.held_out, halvings, longest_s)?;
        self.motions = reader.motions.take().unwrap_or_default();
        for log in &self.validate {
            if let Some(same) = self.train.iter().find(|other| other.shares_a_part(log)) {
                let remark = LogRemark::SameAs { other: same.file.clone() };
                reader.remarks.push((log.file.clone(), remark));
            }
        }
        for (all, own) in self.position_noise.iter_mut().zip(reader.noise) {
            *all = all.max(own);
        }
        self.remarks.held_out = reader.remarks;
        Ok(())
    }

    /// Which logs for validation say the same as one of the estimate: seen behind one filter for
    /// all.
    pub(super) fn same(&self) -> Vec<(String, LogRemark)> {
        let all = self.remarks.held_out.iter();
        all.filter(|(_, remark)| matches!(remark, LogRemark::SameAs { .. })).cloned().collect()
    }

    /// The logs for the estimate and for validation.
    pub(super) fn logs(&self) -> Vec<&Conditioned> {
        self.train.iter().chain(&self.validate).collect()
    }

    /// What was found, by log.
    pub(super) fn into_remarks(self) -> Vec<(String, LogRemark)> {
        let Split { train, held_out } = self.remarks;
        train.into_iter().chain(held_out).collect()
    }
}

pub(super) struct Reader<'a, 'r, 'w, 'o> {
    work: Work<'a>,
    reading: &'r mut Reading<'w, 'o>,
    ground: Option<Ground>,
    names: Vec<String>,
    remarks: Vec<(String, LogRemark)>,
    noise: Vec<f64>,
    /// Logs to be simulated again, if any are wanted.
    motions: Option<Vec<MotionLog>>,
}

impl<'a, 'r, 'w, 'o> Reader<'a, 'r, 'w, 'o> {
    pub(super) fn new(work: Work<'a>, reading: &'r mut Reading<'w, 'o>) -> Result<Self, Error> {
        let Work { robot, model, .. } = work;
        let ground = Ground::under(robot, model)
            .map_err(|error| Cause::Plant(model.model.clone(), error))?;
        Ok(Self {
            work,
            reading,
            ground,
            names: model.joints.iter().map(|joint| joint.name.clone()).collect(),
            remarks: Vec::new(),
            noise: vec![0.0; model.joints.len()],
            motions: None,
        })
    }

    /// Reads logs, whose cutoffs are halved so often, and keeps their motion for so long \[s\].
    fn kept(
        &mut self,
        sources: &[LogSource],
        halvings: &[u32],
        longest_s: Option<f64>,
    ) -> Result<Vec<Conditioned>, Error> {
        self.motions = longest_s.map(|_| Vec::new());
        let halvings = halvings.iter().copied().chain(std::iter::repeat(0));
        let all = sources.iter().zip(halvings);
        Error::of_any_log(all.map(|(source, own)| self.one(source, own, longest_s)))
    }

    fn one(
        &mut self,
        source: &LogSource,
        halvings: u32,
        longest_s: Option<f64>,
    ) -> Result<Conditioned, Error> {
        self.reading.next()?;
        let file = source.to_string();
        let Work { options, laws, model, .. } = self.work;
        let mut log = self.measured(source)?;
        let remarks = std::mem::take(&mut log.remarks);
        self.remarks.extend(remarks.into_iter().map(|remark| (file.clone(), remark)));
        let conditions = &options.conditions;
        let how = Conditioning {
            resolution: options.resolution,
            ..conditions.of(log.step_s, log.samples(), halvings)
        };
        if let (Some(Filter { cutoff_hz, .. }), 1..) = (how.filter, halvings) {
            let text = format!(
                "noise of positions would bias parameters or residuals: filtered below {} Hz \
                 (`conditions.filter` sets another)",
                short(cutoff_hz)
            );
            self.remarks.push((file.clone(), LogRemark::Other(text)));
        }
        if let (Some(motions), Some(longest_s)) = (&mut self.motions, longest_s) {
            let head = log.head((longest_s / log.step_s).min(1e15) as usize + 1);
            let motion = MotionLog::new(&head, &self.names, how.filter);
            let failed = |error| Cause::Condition(file.clone(), error);
            let mut motion = motion.map_err(failed)?;
            undo_logged_torques(&mut motion, model, laws);
            if let CoulombLaw::Tanh(width) = options.friction {
                motion.stiction_rate = width;
            }
            motions.push(motion);
        }
        let conditioned = Conditioned::new(log, &self.names, &how);
        let conditioned = conditioned.map_err(|error| Cause::Condition(file.clone(), error))?;
        self.note(&file, &conditioned);
        let (conditioned, idle) = self.without_known(conditioned);
        for joint in idle {
            let text = format!(
                "`{}` rests, and its torque does not follow the load that the motion of the others \
                 makes: a brake holds it, or stiction. Its torque was left out",
                self.names[joint.0]
            );
            self.remarks.push((file.clone(), LogRemark::Other(text)));
        }
        Ok(conditioned)
    }

    /// A log as it was measured, without what is known of its readings and loads.
    fn measured(&mut self, source: &LogSource) -> Result<MeasuredLog, Error> {
        let Work { logs, robot, laws, model, .. } = self.work;
        let mut log = logs.measured(source, robot, model)?;
        let required = log.require_joint_torques(&model.joints, logs.accepts_suspicious);
        required.map_err(|faults| Cause::Logs(vec![faults]))?;
        undo_readings(&mut log, laws);
        if self.ground.is_none() && !log.wrenches.is_empty() {
            let around = Ground::around(robot, model);
            let failed = |error| Cause::Plant(model.model.clone(), error);
            self.ground = Some(around.map_err(failed)?);
        }
        if let Some(ground) = &mut self.ground {
            ground.load(&mut log);
        }
        Ok(log)
    }

    /// A stretch of a long log, conditioned as a part of the whole; none where nothing moves.
    pub(super) fn stretch(
        &mut self,
        source: &LogSource,
        stretch: &Stretch,
        clock: Clock,
        how: &Conditioning,
    ) -> Result<Option<Conditioned>, Error> {
        self.reading.next()?;
        let faults = |faults: Vec<LogFault>| LogFaults { file: source.to_string(), faults };
        let mut log = match self.measured(source) {
            Err(error) if error.is_of_rest() => return Ok(None),
            log => log?,
        };
        if log.samples() != stretch.read.len() {
            let why =
                format!("{} rows stand where the plan has {}", log.samples(), stretch.read.len());
            return Err(Cause::Long(source.to_string(), why).into());
        }
        let wrong = clock.set(&mut log, stretch.read.start);
        if !wrong.is_empty() {
            return Err(Cause::Logs(vec![faults(wrong).into()]).into());
        }
        match Conditioned::new(log, &self.names, how) {
            Ok(log) => Ok(Some(self.without_known(log.of_stretch(stretch)).0)),
            Err(error) if error.kind() == ErrorKind::NothingMoves => Ok(None),
            Err(error) => Err(Cause::Condition(source.to_string(), error).into()),
        }
    }

    /// A log for validation, conditioned as the stretches of a long log are; none if it is too
    /// short for that.
    pub(super) fn as_stretch(
        &mut self,
        source: &LogSource,
        how: &Conditioning,
    ) -> Result<Option<Conditioned>, Error> {
        let log = self.measured(source)?;
        let log = Conditioned::new(log, &self.names, how).ok();
        Ok(log.map(|log| self.without_known(log).0))
    }

    /// A conditioned log without laws that are known and torques of idle motors, and their joints.
    fn without_known(&self, mut log: Conditioned) -> (Conditioned, Vec<JointIndex>) {
        let Work { laws, model, .. } = self.work;
        take_out(&mut log, model, laws);
        let idle = leave_out_idle_motors(model, &mut log);
        (log, idle)
    }

    /// What a conditioned log says of noise, rest and laps.
    fn note(&mut self, file: &str, log: &Conditioned) {
        for (all, own) in self.noise.iter_mut().zip(&log.position_noise) {
            *all = all.max(*own);
        }
        for (joint, name) in self.names.iter().enumerate().filter(|(at, _)| log.resting[*at]) {
            let remark = (file.to_owned(), LogRemark::Resting { joint: name.clone() });
            if !(self.work.model.joints[joint].is_base || self.remarks.contains(&remark)) {
                self.remarks.push(remark);
            }
        }
        if let Some(laps) = &log.laps {
            let period_s = laps.samples as f64 * log.step_s;
            let text = format!("{} laps of {period_s:.6} s are replaced by their mean", laps.count);
            self.remarks.push((file.to_owned(), LogRemark::Other(text)));
        }
    }
}
