//! A model held against a log: it moves by itself, and what it knows beside its equations is taken
//! out of what was measured.
//!
//! - [`MotionLog`]: a log as a simulation is compared with it
//! - [`closed_loop`]: under the controller that the robot had
//! - [`in_windows`]: driven by the measured torques, for short times from measured states: without
//!   a controller a motion that is simulated runs away from the one that was measured
//! - [`simulated_log`]: the log that a model would have given, to be used as instruments
//! - [`take_out`], [`undo_readings`], [`undo_logged_torques`]: effects that a model has beside its
//!   equations, taken out of logs
//! - [`add_contact_forces`], [`add_wrenches`]: what the ground, and pushes, do to each equation
//! - [`Error`]: why a model is not moved along a log
//!
//! Robots on a fixed base alone: what the ground does to others is not known from their logs.

mod closed_loop;
mod contact_forces;
mod error;
mod known_effects;
mod windows;

pub use closed_loop::{closed_loop, simulated_log};
pub use contact_forces::{Ground, add_contact_forces, add_wrenches};
pub use error::{Error, ErrorKind};
pub use known_effects::{take_out, undo_logged_torques, undo_readings};
pub use windows::{Windows, in_windows};

use denavit_measure::SampleIndex;
use denavit_measure::condition::{Butterworth, Conditioned, Conditioning, Filter};
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_numerics::{rms, short};
use denavit_plants::PlantModel;
use denavit_simulate::scenario::Controller;
use denavit_simulate::{
    DriveModelling, Log, Run, STICTION_RATE, Simulation, State, Stop, integrate::Accuracy,
    integrate::Method,
};
use std::ops::Range;

/// The longest motion that is compared \[s\]: what a run costs grows with it.
pub const LONGEST_S: f64 = 60.0;

/// A log as a simulation is compared with it: filtered, with rates.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionLog {
    /// The name of the log.
    pub file: String,
    /// The time of sample 0 \[s\].
    pub start_s: f64,
    /// The distance of samples \[s\].
    pub step_s: f64,
    /// Positions of every joint, filtered [rad, m].
    pub q: Vec<Vec<f64>>,
    /// Their rates; 0 outside `range` [rad/s, m/s].
    pub qd: Vec<Vec<f64>>,
    /// Required torques, filtered; none where they were not measured [N m, N]. Of a joint in
    /// `drives` it is the torque of the motor.
    pub torque: Vec<Option<Vec<f64>>>,
    /// References, as they were logged [rad, m].
    pub reference: Vec<Option<Vec<f64>>>,
    /// Angles of motors before springs, as they were logged \[rad\].
    pub motor: Vec<Option<Vec<f64>>>,
    /// Motion of motors before springs, filtered, on the side of their joints: windows move these
    /// drives by themselves, under the torques of the motors. One entry for each joint, or none at
    /// all where springs are taken to have passed on what was measured.
    pub drives: Vec<Option<DriveMotion>>,
    /// States of laws of the model at every sample, one column for each; none if they begin as if
    /// joints had rested.
    pub law_states: Vec<Vec<f64>>,
    /// The samples that the filter leaves.
    pub range: Range<usize>,
    /// Below this rate Coulomb friction is a steep line where the log is simulated [rad/s, m/s].
    pub stiction_rate: f64,
    filter: Option<Butterworth>,
}

/// How a motor before a series spring moves, on the side of its joint.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveMotion {
    /// How far it has turned [rad, m].
    pub angle: Vec<f64>,
    /// Its rate; 0 outside the range of the log [rad/s, m/s].
    pub rate: Vec<f64>,
}

impl MotionLog {
    /// Filters a log. `names` are those of its joints.
    pub fn new(
        log: &MeasuredLog,
        names: &[String],
        filter: Option<Filter>,
    ) -> Result<Self, denavit_measure::Error> {
        let how = Conditioning { filter, ..Conditioning::default() };
        let kept = |joint: &JointSignals| {
            let (q, tau) = (joint.q.clone(), joint.tau.clone());
            JointSignals { q, tau, ..JointSignals::default() }
        };
        let measured = MeasuredLog {
            file: log.file.clone(),
            start_s: log.start_s,
            step_s: log.step_s,
            joints: log.joints.iter().map(kept).collect(),
            ..MeasuredLog::default()
        };
        let conditioned = Conditioned::new(measured, names, &how)?;
        let range = conditioned.range.clone();
        let mut motion = Vec::new();
        conditioned.motion(range.clone(), &mut motion);
        let n = log.joints.len();
        let rates = |joint: usize| {
            let mut rates = vec![0.0; log.samples()];
            rates[range.clone()].copy_from_slice(&motion[n + joint]);
            rates
        };
        Ok(Self {
            qd: (0..n).map(rates).collect(),
            file: conditioned.file,
            start_s: log.start_s,
            step_s: log.step_s,
            q: conditioned.q,
            torque: conditioned.torque,
            reference: log.joints.iter().map(|joint| joint.reference.clone()).collect(),
            motor: log.joints.iter().map(|joint| joint.motor.clone()).collect(),
            drives: Vec::new(),
            law_states: Vec::new(),
            range,
            stiction_rate: STICTION_RATE,
            filter: conditioned.filter,
        })
    }

    /// Filters a log of which the angles and torques of motors before springs stand on the side of
    /// their joints: these drives move by themselves. `zeros` are for each joint what its motor
    /// reads more than the joint where the spring is relaxed [rad, m].
    pub fn with_drives(
        log: &MeasuredLog,
        names: &[String],
        filter: Option<Filter>,
        zeros: &[f64],
    ) -> Result<Self, denavit_measure::Error> {
        let mut motion = Self::new(log, names, filter)?;
        // Motors in place of their joints, through the same filter.
        let mut turned = log.clone();
        for joint in &mut turned.joints {
            if let Some(angle) = joint.motor.take() {
                joint.q = angle;
            }
        }
        let turned = Self::new(&turned, names, filter)?;
        let of = |(joint, own): (usize, &JointSignals)| {
            own.motor.as_ref()?;
            let angle = turned.q[joint].iter().map(|angle| angle - zeros[joint]).collect();
            Some(DriveMotion { angle, rate: turned.qd[joint].clone() })
        };
        motion.drives = log.joints.iter().enumerate().map(of).collect();
        Ok(motion)
    }

    /// The time of a sample \[s\].
    pub fn time_s(&self, sample: SampleIndex) -> f64 {
        self.start_s + self.step_s * sample.0 as f64
    }

    fn samples(&self) -> usize {
        self.q.first().map_or(0, Vec::len)
    }

    /// The state at a sample; motors as they move or were logged, or with the elongation of springs
    /// that the torque makes, and turning with their joints.
    fn state(&self, model: &PlantModel, sample: SampleIndex, has_motors: bool) -> State {
        let SampleIndex(sample) = sample;
        let at = sample.clamp(self.range.start, self.range.end - 1);
        let mut state = State {
            t_s: self.time_s(SampleIndex(sample)),
            q: self.q.iter().map(|q| q[sample]).collect(),
            qd: self.qd.iter().map(|qd| qd[at]).collect(),
            laws: self.law_states.iter().map(|state| state[sample]).collect(),
            ..State::default()
        };
        for (index, joint) in model.joints.iter().enumerate().filter(|_| has_motors) {
            let Some(drive) = joint.drive.filter(|drive| drive.rotor_inertia > 0.0) else {
                continue;
            };
            let Some(spring) = drive.series_elastic else { continue };
            let ratio = drive.gear_ratio / spring.motor_radius;
            if let Some(moved) = self.drives.get(index).and_then(Option::as_ref) {
                state.motor.push(ratio * spring.load_radius * moved.angle[sample]);
                state.motor_rate.push(ratio * spring.load_radius * moved.rate[at]);
                continue;
            }
            let torque = self.torque[index].as_ref().map_or(0.0, |torque| torque[sample]);
            let stretched = torque / (spring.stiffness * spring.load_radius);
            let taut = ratio * (stretched + spring.load_radius * state.q[index]);
            let logged = self.motor[index].as_ref().map(|motor| motor[sample]);
            state.motor.push(logged.unwrap_or(taut));
            state.motor_rate.push(ratio * spring.load_radius * state.qd[index]);
        }
        state
    }
}

/// How a motion was simulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ForwardKind {
    /// Under a controller.
    ClosedLoop,
    /// From measured states, under measured torques.
    Windows {
        /// How many.
        count: usize,
        /// The length of each \[s\].
        length_s: f64,
    },
}

/// One signal of a joint, simulated and measured, sample by sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Compared {
    /// As it was measured.
    pub measured: Vec<f64>,
    /// As it was simulated.
    pub simulated: Vec<f64>,
    /// Root of the mean square of what there is to predict.
    pub size: f64,
    /// Root of the mean square of the difference.
    pub rms: f64,
    /// That over the size of the signal: 1 is as wrong as a simulation in which nothing happens.
    pub relative: f64,
}

impl Compared {
    /// Compares; `size` is the root of the mean square of what there is to predict.
    fn new(measured: Vec<f64>, simulated: Vec<f64>, size: f64) -> Self {
        let rms = rms(measured.iter().zip(&simulated).map(|(a, b)| b - a));
        let relative = if size > 0.0 { rms / size } else { 0.0 };
        Self { measured, simulated, size, rms, relative }
    }

    /// Appends the same signal of another log.
    fn append(&mut self, mut other: Self) {
        let lengths = [self.measured.len() as f64, other.measured.len() as f64];
        let both = |a: f64, b: f64| {
            let all = lengths[0] * a * a + lengths[1] * b * b;
            (all / (lengths[0] + lengths[1]).max(1.0)).sqrt()
        };
        (self.size, self.rms) = (both(self.size, other.size), both(self.rms, other.rms));
        self.relative = if self.size > 0.0 { self.rms / self.size } else { 0.0 };
        self.measured.append(&mut other.measured);
        self.simulated.append(&mut other.simulated);
    }

    /// Simulated less measured.
    pub fn residual(&self) -> impl Iterator<Item = f64> + '_ {
        self.simulated.iter().zip(&self.measured).map(|(simulated, measured)| simulated - measured)
    }
}

/// A joint, simulated and measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForwardJoint {
    /// The joint.
    pub name: String,
    /// Positions [rad, m].
    pub position: Compared,
    /// Rates [rad/s, m/s].
    pub rate: Compared,
    /// Required torques [N m, N]; none where they were not measured, or were what was given.
    pub torque: Option<Compared>,
}

/// A log, simulated again.
#[derive(Clone, Debug, PartialEq)]
pub struct Forward {
    /// The log; the first of several.
    pub file: String,
    /// How.
    pub kind: ForwardKind,
    /// The time of each sample that is compared \[s\].
    pub t_s: Vec<f64>,
    /// The joints that moved, in the order of the model.
    pub joints: Vec<ForwardJoint>,
}

impl Forward {
    /// Appends another log, of the same joints in the same order: times go on from there.
    pub fn append(&mut self, mut other: Self) {
        if let (ForwardKind::Windows { count, .. }, ForwardKind::Windows { count: more, .. }) =
            (&mut self.kind, other.kind)
        {
            *count += more;
        }
        self.t_s.append(&mut other.t_s);
        for joint in other.joints {
            let Some(own) = self.joints.iter_mut().find(|own| own.name == joint.name) else {
                self.joints.push(joint);
                continue;
            };
            own.position.append(joint.position);
            own.rate.append(joint.rate);
            match (&mut own.torque, joint.torque) {
                (Some(own), Some(torque)) => own.append(torque),
                (own, _) => *own = None,
            }
        }
    }

    /// The simulation gap: sqrt(mean over joints of (rms error of position / its size)^2).
    pub fn relative(&self) -> f64 {
        rms(self.joints.iter().map(|joint| joint.position.relative))
    }
}

/// Names of the joints of a plant on a fixed base.
fn names(model: &PlantModel) -> Result<Vec<&str>, Error> {
    match model.joints.iter().all(|joint| joint.drivable) {
        true => Ok(model.joints.iter().map(|joint| joint.name.as_str()).collect()),
        false => {
            let text = "only robots on a fixed base are simulated against their logs";
            Err(Error::new(ErrorKind::Unsuitable, text))
        }
    }
}

/// The log is shorter than a window of this length.
fn too_short(length_s: f64) -> Error {
    let text = format!("the log is shorter than a window of {} s", short(length_s));
    Error::new(ErrorKind::TooShort, text)
}

/// Why a run did not reach its end; none if it did.
fn broken_off(run: &Run) -> Result<(), Error> {
    if run.stop == Stop::End {
        return Ok(());
    }
    let text = format!("the simulation broke off at {:.3} s: {}", run.end.t_s, run.stop);
    Err(Error::new(ErrorKind::BrokeOff, text))
}

/// How accurately a log is simulated again: far below what a log knows.
const ACCURACY: Accuracy = Accuracy { relative: 1e-6, absolute: 1e-8, max_step_s: 0.02 };

/// How a log is simulated again: rows at its samples.
fn simulation(drives: DriveModelling, end_s: f64, log: &MotionLog) -> Simulation {
    Simulation {
        end_s,
        drives,
        method: Method::DormandPrince(ACCURACY),
        log_period_s: log.step_s,
        stiction_rate: log.stiction_rate,
        ..Simulation::default()
    }
}

/// So many rows of a column of a run; `prefix` is that of the column.
fn column(log: &Log, prefix: &str, joint: &str, rows: usize) -> Vec<f64> {
    let mut values = log.column(&format!("{prefix}_{joint}")).unwrap_or_default();
    // a last row that rounding kept out of the run
    values.resize(rows, values.last().copied().unwrap_or(0.0));
    values
}
