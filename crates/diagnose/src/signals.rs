//! Logs as the diagnosis looks at them: motion at the full rate, torques through one filter.
//!
//! Positions pass a wide zero-phase filter, so that they can be differentiated. Torques pass a
//! narrower one, and so does everything that is compared with them: columns of the regressor,
//! torques of effects. A law with a step at a reversal then has the same edge on both sides of the
//! equation, which is what tells a step from a slope.

use super::floor::{rms, white_noise};
use super::spectra::{cosine_lines, last_driven};
use super::standstill::{self, Rest};
use crate::policy::signals::{ENOUGH_ROWS, LEAST_RATE_HZ, LEAST_ROWS, ROWS_PER_PERIOD};
use denavit_evidence::policy;
use denavit_measure::JointIndex;
use denavit_measure::condition::{Butterworth, Laps, STENCIL, acceleration, rate};
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_numerics::{Random, between, cubic, derivative};
use std::ops::Range;
use std::rc::Rc;

/// The filters of a diagnosis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Filters {
    /// Cutoff of the filter of positions \[Hz\].
    pub motion_hz: f64,
    /// Cutoff of the filter of torques and of all that is compared with them \[Hz\].
    pub torque_hz: f64,
}

impl Filters {
    /// The filters for a cutoff of torques: positions have three times that.
    pub fn of_torques(torque_hz: f64) -> Self {
        Self { motion_hz: 3.0 * torque_hz, torque_hz }
    }
}

/// Order of one pass of both filters.
const ORDER: usize = 4;

/// Signals that pass a filter side by side.
const LANES: usize = 4;

/// A signal that motions share which differ in others.
pub(super) type Shared = Rc<Vec<f64>>;

/// Motion and torque of one log.
#[derive(Clone, Debug)]
pub struct Signals {
    /// The name of the log.
    pub file: String,
    /// Cutoff of the filter of torques \[Hz\].
    pub torque_hz: f64,
    /// Distance of samples of the log \[s\].
    pub log_step_s: f64,
    /// Distance of samples of the motion, which has more of them \[s\].
    pub step_s: f64,
    /// The time of each sample of the motion \[s\].
    pub t: Vec<f64>,
    /// Positions, filtered [rad, m], joint by joint.
    pub q: Vec<Shared>,
    /// Rates [rad/s, m/s].
    pub qd: Vec<Shared>,
    /// Accelerations [rad/s^2, m/s^2].
    pub qdd: Vec<Shared>,
    /// Position, rate and acceleration of the motor of a joint behind a spring, on the joint's
    /// side.
    pub motor: Vec<Option<[Shared; 3]>>,
    /// Where the drive of a joint rests.
    pub(super) rests: Vec<Vec<Rest>>,
    /// Torques of the rows, through the filter [N m, N]; none where none was measured.
    pub torque: Vec<Option<Vec<f64>>>,
    /// What the steps of the encoders are of the positions after their filter, drawn at random
    /// [rad, m]: joint by joint, as long as the positions.
    pub position_noise: Vec<Vec<f64>>,
    /// The same of the motors before springs; without entries where there is none.
    pub motor_noise: Vec<Vec<f64>>,
    /// Torques as they were measured, at the samples of the log.
    pub measured: Vec<Option<Vec<f64>>>,
    /// The deviation of white noise in them [N m, N].
    pub(super) torque_noise: Vec<f64>,
    /// Where the rows are among the samples of the motion.
    rows: Rows,
    filter: Butterworth,
    /// The laps of the motion, if it repeats.
    pub(super) laps: Option<Laps>,
}

/// Where rows and cells are: a cell is the time of a sample of the log, a row one in so many.
#[derive(Clone, Debug)]
struct Rows {
    range: Range<usize>,
    stride: usize,
    /// Samples of the motion in each cell.
    within: usize,
}

/// Samples of the motion to a sample of the log: odd, so that one of them is at its time.
fn samples_within(step_s: f64) -> usize {
    let asked = (LEAST_RATE_HZ * step_s).ceil() as usize;
    (asked / 2 * 2 + 1).min(9)
}

impl Rows {
    /// The rows of so many samples, of which the edges are cut off by the filter of positions.
    ///
    /// What is compared passes the filter of torques over the same samples, so that both sides have
    /// the same of what was before them. But noise is larger where it is mirrored, and motions
    /// begin and end at rest: a log with rows to spare leaves more out.
    fn new(
        samples: usize,
        edge: usize,
        filter: &Butterworth,
        stride: usize,
        within: usize,
    ) -> Result<Self, denavit_measure::Error> {
        let needed = 2 * (edge + filter.smear()) + LEAST_ROWS * stride;
        if samples < needed {
            return Err(denavit_measure::Error::too_short(samples, needed));
        }
        let spare = samples.saturating_sub(2 * (edge + ENOUGH_ROWS * stride)) / 2;
        let first = spare.clamp(filter.smear(), filter.settling());
        Ok(Self { range: first..samples - 2 * edge - first, stride, within })
    }
}

impl Signals {
    /// Filters a log.
    pub fn new(log: MeasuredLog, filters: Filters) -> Result<Self, denavit_measure::Error> {
        let MeasuredLog { file, start_s, step_s, joints, .. } = log;
        let filter_of = |cutoff_hz: f64| {
            // the filter of torques is the one that is chosen
            let limit_hz = 0.5 / step_s * filters.torque_hz / filters.motion_hz;
            let found = Butterworth::new(ORDER, cutoff_hz, step_s);
            found.ok_or_else(|| denavit_measure::Error::cutoff(filters.torque_hz, limit_hz))
        };
        let (wide, filter) = (filter_of(filters.motion_hz)?, filter_of(filters.torque_hz)?);
        let samples = joints.first().map_or(0, |joint| joint.q.len());
        let edge = STENCIL + wide.settling();
        let stride = ((ROWS_PER_PERIOD * filters.torque_hz * step_s).recip() as usize).max(1);
        let rows = Rows::new(samples, edge, &filter, stride, samples_within(step_s))?;
        let kept = edge..samples - edge;
        let within = rows.within;
        let fine = step_s / within as f64;
        // The cell of a sample is around it.
        let offset = 0.5 * (within - 1) as f64 * fine;
        let t = (0..kept.len() * within)
            .map(|k| start_s + step_s * kept.start as f64 + fine * k as f64 - offset)
            .collect();
        let ([q, qd, qdd], [position_noise, motor_noise]) =
            ([const { Vec::new() }; 3], [const { Vec::new() }; 2]);
        let (torque, measured, motor, rests) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut signals = Self {
            file,
            torque_hz: filters.torque_hz,
            log_step_s: step_s,
            step_s: fine,
            t,
            q,
            qd,
            qdd,
            motor,
            rests,
            position_noise,
            motor_noise,
            torque,
            measured,
            torque_noise: Vec::new(),
            rows,
            filter,
            laps: None,
        };
        let mut randoms = [Random::new(1), Random::new(2)];
        for joint in joints {
            // An encoder's error is anywhere within its step. Noise of angles counts as such where
            // it is larger, or all that is known.
            let of_noise = |angle: &Vec<f64>| 12.0_f64.sqrt() * white_noise(angle);
            let step = joint.step.unwrap_or(0.0).max(of_noise(&joint.q));
            let motor = joint.motor.as_ref();
            let motor_step = joint.motor_step.unwrap_or(0.0).max(motor.map_or(0.0, of_noise));
            let mut noise = |random: usize, samples: usize, step: f64| {
                let uniform = |_| step * (randoms[random].uniform() - 0.5);
                let mut noise: Vec<f64> = (0..samples).map(uniform).collect();
                wide.zero_phase(&mut noise);
                noise
            };
            signals.position_noise.push(noise(0, samples, step));
            let of_motor = if joint.motor.is_some() { samples } else { 0 };
            signals.motor_noise.push(noise(1, of_motor, motor_step));
            signals.push(joint, &wide, kept.clone());
        }
        let q: Vec<Vec<f64>> = signals.q.iter().map(|q| signals.cell_means(q)).collect();
        signals.laps = Laps::find(&q, step_s, 0..kept.len()).ok();
        Ok(signals)
    }

    fn push(&mut self, joint: JointSignals, wide: &Butterworth, kept: Range<usize>) {
        let JointSignals { mut q, tau, motor, step, motor_step, .. } = joint;
        let h = self.log_step_s;
        let within = self.rows.within;
        let (drive, step) = motor.as_ref().map_or((&q, step), |motor| (motor, motor_step));
        // The time of the first sample of the log, in whose cell the motion begins.
        let start_s = self.t[within / 2] - h * kept.start as f64;
        let rests = step.map_or_else(Vec::new, |step| standstill::rests(drive, step, [start_s, h]));
        let whole_s = self.t[0]..self.t[self.t.len() - 1];
        self.rests.push(rests.into_iter().filter_map(|rest| rest.within(&whole_s)).collect());
        wide.zero_phase(&mut q);
        let fine = |signal: Vec<f64>| between(&signal, within);
        let rates = |q: &[f64]| fine(kept.clone().map(|k| rate(q, k) / h).collect());
        let accelerations =
            |q: &[f64]| fine(kept.clone().map(|k| acceleration(q, k) / (h * h)).collect());
        self.qd.push(Rc::new(rates(&q)));
        self.qdd.push(Rc::new(accelerations(&q)));
        self.motor.push(motor.map(|mut motor| {
            wide.zero_phase(&mut motor);
            let (rates, accelerations) = (rates(&motor), accelerations(&motor));
            [fine(motor[kept.clone()].to_vec()), rates, accelerations].map(Rc::new)
        }));
        self.q.push(Rc::new(fine(q[kept.clone()].to_vec())));
        self.rest(JointIndex(self.rests.len() - 1));
        let measured = tau.map(|tau| tau[kept].to_vec());
        let rows = measured.clone().map(|tau| self.row_samples(&self.filtered(tau)));
        self.torque.push(rows);
        self.torque_noise.push(measured.as_ref().map_or(0.0, |tau| white_noise(tau)));
        self.measured.push(measured);
    }

    /// Rate and acceleration of a joint's drive, on the joint's side.
    pub(super) fn drive_mut(&mut self, joint: JointIndex) -> [&mut Vec<f64>; 2] {
        match &mut self.motor[joint.0] {
            Some([_, rates, accelerations]) => [rates, accelerations],
            None => [&mut self.qd[joint.0], &mut self.qdd[joint.0]],
        }
        .map(Rc::make_mut)
    }

    /// The motion with another error of its encoders.
    pub fn disturbed(&self) -> Self {
        let mut other = self.clone();
        let cells = self.samples() / self.rows.within;
        let h = self.log_step_s;
        let added = |noise: &[f64]| {
            let edge = (noise.len() - cells) / 2;
            let of = |of: &dyn Fn(usize) -> f64| {
                between(&(edge..edge + cells).map(of).collect::<Vec<f64>>(), self.rows.within)
            };
            let rates = of(&|k| rate(noise, k) / h);
            [of(&|k| noise[k]), rates, of(&|k| acceleration(noise, k) / (h * h))]
        };
        for (joint, noise) in self.position_noise.iter().enumerate() {
            let [position, rates, accelerations] = added(noise);
            add(&mut other.q[joint], &position);
            add(&mut other.qd[joint], &rates);
            add(&mut other.qdd[joint], &accelerations);
            let motor = other.motor[joint].iter_mut().flatten();
            let noise = Some(&self.motor_noise[joint]).filter(|noise| !noise.is_empty());
            let noise = noise.into_iter().flat_map(|noise| added(noise));
            motor.zip(noise).for_each(|(signal, noise)| add(signal, &noise));
            other.rest(JointIndex(joint));
        }
        other
    }

    /// Gives a joint other positions, with the rates and accelerations that the difference adds.
    pub fn move_joint(&mut self, joint: JointIndex, positions: &[f64]) {
        let cells: Vec<f64> =
            positions.iter().zip(self.q[joint.0].iter()).map(|(a, b)| a - b).collect();
        let cells = self.cell_means(&cells);
        let [rates, accelerations] = self.derivatives(&cells);
        add(&mut self.qd[joint.0], &rates);
        add(&mut self.qdd[joint.0], &accelerations);
        self.q[joint.0] = Rc::new(positions.to_vec());
        self.rest(joint);
    }

    /// Rates and accelerations of what is at the log's samples, at those of the motion; at the
    /// ends, which the rows leave out, none.
    pub(super) fn derivatives(&self, signal: &[f64]) -> [Vec<f64>; 2] {
        let (h, count) = (self.log_step_s, signal.len());
        let inner = STENCIL..count.saturating_sub(STENCIL);
        let of = |value: &dyn Fn(usize) -> f64| {
            let all = (0..count).map(|k| if inner.contains(&k) { value(k) } else { 0.0 });
            between(&all.collect::<Vec<f64>>(), self.rows.within)
        };
        [of(&|k| rate(signal, k) / h), of(&|k| acceleration(signal, k) / (h * h))]
    }

    /// The motion at a few of its samples, of which there are no rows.
    pub(super) fn at(&self, samples: &[usize]) -> Self {
        let at = |signal: &Vec<f64>| samples.iter().map(|&k| signal[k]).collect::<Vec<f64>>();
        let shared = |signal: &Shared| Rc::new(at(signal));
        let all = |signals: &[Shared]| signals.iter().map(shared).collect();
        let of_motor = |m: &Option<[Shared; 3]>| m.as_ref().map(|m| m.each_ref().map(shared));
        Self {
            t: at(&self.t),
            q: all(&self.q),
            qd: all(&self.qd),
            qdd: all(&self.qdd),
            motor: self.motor.iter().map(of_motor).collect(),
            ..self.clone()
        }
    }

    /// Rate and acceleration of a joint's drive, on the joint's side: those of the joint, unless a
    /// spring is between them.
    pub fn of_drive(&self, joint: JointIndex) -> [&Vec<f64>; 2] {
        match &self.motor[joint.0] {
            Some([_, rates, accelerations]) => [rates, accelerations],
            None => [&self.qd[joint.0], &self.qdd[joint.0]],
        }
    }

    /// How far the motor of a joint behind a spring is ahead of it, and the rate of that.
    pub fn deflection(&self, joint: JointIndex) -> Option<[Vec<f64>; 2]> {
        let [position, rates, _] = self.motor[joint.0].as_ref()?;
        let less = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| a - b).collect();
        Some([less((position, &self.q[joint.0])), less((rates, &self.qd[joint.0]))])
    }

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.q.len()
    }

    /// Number of samples of the motion.
    pub fn samples(&self) -> usize {
        self.t.len()
    }

    /// Number of rows of a joint.
    pub fn rows(&self) -> usize {
        self.rows.range.len().div_ceil(self.rows.stride)
    }

    /// Whether the log is long enough to leave out all that its ends may be wrong in.
    pub(super) fn has_rows_to_spare(&self) -> bool {
        self.rows.range.start == self.filter.settling()
    }

    /// The frequency up to which references drive the motion \[Hz\].
    pub(super) fn driven_hz(&self) -> f64 {
        let lines = |rate: &Shared| cosine_lines(&self.at_rows(rate));
        let all: Vec<Vec<f64>> = self.qd.iter().map(lines).collect();
        let line_hz = 0.5 / (self.rows() as f64 * self.row_step_s());
        let of_joint = |lines: &Vec<f64>| line_hz * last_driven(lines) as f64;
        policy::DRIVEN_REACH * all.iter().map(of_joint).fold(0.0, f64::max)
    }

    /// What an encoder's noise is of an acceleration (root mean square) [rad/s^2, m/s^2].
    pub(super) fn acceleration_noise(&self, joint: JointIndex) -> f64 {
        let noise = &self.position_noise[joint.0];
        let inner = STENCIL..noise.len().saturating_sub(STENCIL);
        let all: Vec<f64> = inner.map(|k| acceleration(noise, k)).collect();
        rms(&all) / (self.log_step_s * self.log_step_s)
    }

    /// How long the filter of positions rings beside an impact \[s\].
    pub(super) fn ringing_s(&self) -> f64 {
        Filters::of_torques(self.torque_hz).motion_hz.recip()
    }

    /// The time between rows \[s\].
    pub fn row_step_s(&self) -> f64 {
        self.log_step_s * self.rows.stride as f64
    }

    /// What a signal of the motion's samples is in the rows: filtered, and fewer.
    pub fn rows_of(&self, signal: &[f64]) -> Vec<f64> {
        self.all_rows_of(&[signal]).swap_remove(0)
    }

    /// The same of many signals, which takes less time than each alone.
    pub(super) fn all_rows_of(&self, signals: &[&[f64]]) -> Vec<Vec<f64>> {
        let mut found = vec![vec![0.0; self.rows()]; signals.len()];
        // A law that is off has many columns of nothing.
        let acts = |signal: &[f64]| signal.iter().any(|sample| *sample != 0.0);
        let acting: Vec<usize> = (0..signals.len()).filter(|&at| acts(signals[at])).collect();
        for places in acting.chunks(LANES) {
            let mut lanes = vec![[0.0; LANES]; self.samples() / self.rows.within];
            for (lane, &at) in places.iter().enumerate() {
                let means = self.cell_means(signals[at]);
                lanes.iter_mut().zip(means).for_each(|(lanes, mean)| lanes[lane] = mean);
            }
            self.filter.zero_phase_lanes(&mut lanes);
            let rows = lanes[self.rows.range.clone()].iter().step_by(self.rows.stride);
            for (row, lanes) in rows.enumerate() {
                places.iter().zip(lanes).for_each(|(&at, sample)| found[at][row] = *sample);
            }
        }
        found
    }

    /// White noise at the log's samples, through the filter, in the rows.
    pub(super) fn white_rows(&self, mut draw: impl FnMut() -> f64) -> Vec<f64> {
        let noise = (0..self.samples() / self.rows.within).map(|_| draw()).collect();
        self.row_samples(&self.filtered(noise))
    }

    /// A signal of the log's samples through the filter of torques.
    pub fn filtered(&self, mut signal: Vec<f64>) -> Vec<f64> {
        self.filter.zero_phase(&mut signal);
        signal
    }

    /// The torque of a joint as it was measured, at the samples of the motion.
    pub(super) fn measured_within(&self, joint: JointIndex) -> Option<Vec<f64>> {
        Some(self.in_cells(self.measured.get(joint.0)?.as_ref()?))
    }

    /// What the measured torque of a joint has more than before a delay \[s\], and the rate of the
    /// torque without it, at the samples of the motion; none where none was measured.
    pub(super) fn undelayed_within(
        &self,
        joint: JointIndex,
        delay_s: f64,
    ) -> Option<[Vec<f64>; 2]> {
        let measured = self.measured.get(joint.0)?.as_ref()?;
        let (late, last) = (delay_s / self.log_step_s, measured.len() as f64 - 1.0);
        let at = |k: f64| {
            let place = (k + late).clamp(0.0, last);
            let from = place.floor() as isize;
            let ends = |offset: isize| measured[(from + offset).clamp(0, last as isize) as usize];
            cubic([-1, 0, 1, 2].map(ends), place - from as f64)
        };
        let ahead: Vec<f64> = (0..measured.len()).map(|k| at(k as f64)).collect();
        let added = measured.iter().zip(&ahead).map(|(late, ahead)| late - ahead).collect();
        let rate = derivative(&ahead, self.log_step_s);
        Some([added, rate].map(|signal: Vec<f64>| self.in_cells(&signal)))
    }

    /// A signal of the log's samples at those of the motion, each in its cell.
    fn in_cells(&self, signal: &[f64]) -> Vec<f64> {
        let cell = |value: &f64| std::iter::repeat_n(*value, self.rows.within);
        signal.iter().flat_map(cell).collect()
    }

    /// The mean of a signal of the motion in each cell.
    pub fn cell_means(&self, signal: &[f64]) -> Vec<f64> {
        let within = self.rows.within;
        signal.chunks_exact(within).map(|cell| cell.iter().sum::<f64>() / within as f64).collect()
    }

    /// A signal of the motion at the rows, as it is.
    pub fn at_rows(&self, signal: &[f64]) -> Vec<f64> {
        self.row_samples(&self.cell_means(signal))
    }

    fn row_samples(&self, signal: &[f64]) -> Vec<f64> {
        signal[self.rows.range.clone()].iter().copied().step_by(self.rows.stride).collect()
    }

    /// The share of the deviation of white noise that passes the filter.
    pub fn noise_gain(&self) -> f64 {
        let impulse = self.filter.zero_phase_impulse(2 * self.filter.settling());
        impulse.iter().map(|x| x * x).sum::<f64>().sqrt()
    }
}

fn add(signal: &mut Shared, other: &[f64]) {
    Rc::make_mut(signal).iter_mut().zip(other).for_each(|(sum, other)| *sum += other);
}

#[cfg(test)]
#[path = "../tests/unit/signals.rs"]
mod tests;
