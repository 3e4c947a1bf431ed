//! From what was measured to what is regressed: filtered, differentiated, decimated.
//!
//! Both sides of tau = Y(q, qd, qdd) phi go through the same filters. Positions and torques pass
//! one zero-phase low-pass filter, which makes derivatives possible; the torques and the columns
//! of Y then pass the same decimator, which is linear and so keeps the equation.

mod derivatives;
mod laps;
mod noise;
mod overlap;
mod pieces;
mod reversals;
mod stretch;

pub use denavit_numerics::{Butterworth, Decimator};
pub use laps::Laps;
pub use noise::Encoder;
pub use pieces::Piece;
pub use stretch::{Stretch, Stretches};

use super::log::{JointSignals, MeasuredLog};
use crate::error::{Error, ErrorKind};
use crate::{JointIndex, SampleIndex};
use std::ops::Range;

/// Where velocities and accelerations come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Derivatives {
    /// Central differences of sixth order of the filtered positions.
    #[default]
    Central,
    /// Those of the log.
    Logged,
}

/// A low-pass filter, applied forwards and backwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filter {
    /// Of one pass.
    pub order: usize,
    /// Where one pass halves the power \[Hz\].
    pub cutoff_hz: f64,
}

/// Which laps are averaged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Averaging {
    /// None.
    #[default]
    No,
    /// Laps of this period \[s\].
    Period(f64),
    /// Laps of the period that is found.
    Found,
}

/// How a log is conditioned.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conditioning {
    /// The filter of positions and torques; none leaves them as they are.
    pub filter: Option<Filter>,
    /// Where velocities and accelerations come from.
    pub derivatives: Derivatives,
    /// One sample in so many is left; 0 and 1 leave all.
    pub decimation: usize,
    /// Whether laps are averaged.
    pub averaging: Averaging,
    /// The step of encoders whose steps cannot be seen in the log [rad, m].
    pub resolution: Option<f64>,
}

/// What is regressed: motion and torque, sample by sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Conditioned {
    /// The name of the log.
    pub file: String,
    /// The time of sample 0 \[s\].
    pub start_s: f64,
    /// The distance of samples, before decimation \[s\].
    pub step_s: f64,
    /// Positions of every joint.
    pub q: Vec<Vec<f64>>,
    /// Rates and accelerations of every joint; none where they are differences of `q`.
    pub rates: Option<[Vec<Vec<f64>>; 2]>,
    /// Required torque of every joint; none where it was not measured.
    pub torque: Vec<Option<Vec<f64>>>,
    /// The samples that count: those at the edges depend on what was not measured.
    pub range: Range<usize>,
    /// One sample in so many is left.
    pub decimation: usize,
    /// The filter that positions and torques went through.
    pub filter: Option<Butterworth>,
    /// The laps that were found in the log.
    pub laps: Option<Laps>,
    /// Deviation of each measured position before the filter, from steps of its encoder or from
    /// what the log shows; 0 of a joint that rests [rad, m].
    pub position_noise: Vec<f64>,
    /// Encoders whose steps make this noise; none where it is white.
    pub encoders: Vec<Option<Encoder>>,
    /// Whether each joint moves no further than its noise: its position is taken for constant.
    pub resting: Vec<bool>,
}

/// Samples on either side that a derivative looks at.
pub const STENCIL: usize = 3;

impl Conditioned {
    /// Conditions a log. It is consumed, since nothing of it is held twice: 16 bytes a joint and
    /// sample.
    pub fn new(log: MeasuredLog, names: &[String], how: &Conditioning) -> Result<Self, Error> {
        let MeasuredLog { file, start_s, step_s, joints, .. } = log;
        let filter = how.filter.map(|filter| lawful(filter, step_s)).transpose()?;
        let samples = joints.first().map_or(0, |joint| joint.q.len());
        let logged = how.derivatives == Derivatives::Logged;
        let mut edge = if logged { 0 } else { STENCIL };
        edge += filter.as_ref().map_or(0, Butterworth::settling);
        let decimation = how.decimation.max(1);
        // before anything of the size of a decimator is made
        if decimation >= samples {
            return Err(Error::too_short(samples, decimation + 1));
        }
        let reach = Decimator::reach_of(decimation);
        let needed = 2 * (edge + reach) + 8 * decimation;
        if samples < needed {
            return Err(Error::too_short(samples, needed));
        }
        let mut found = Self {
            file,
            start_s,
            step_s,
            range: edge..samples - edge,
            decimation,
            ..Self::default()
        };
        let mut rates = [Vec::new(), Vec::new()];
        let of_joint = |joint: &JointSignals| noise::position_noise(joint, how.resolution);
        (found.position_noise, found.encoders) = joints.iter().map(of_joint).unzip();
        for (joint, name) in joints.into_iter().zip(names) {
            let JointSignals { mut q, qd, qdd, mut tau, .. } = joint;
            if let Some(filter) = &filter {
                filter.zero_phase(&mut q);
                if let Some(tau) = &mut tau {
                    filter.zero_phase(tau);
                }
            }
            if logged {
                let no_rates = || {
                    let text = format!("`qd_{name}` and `qdd_{name}` are not both in the log");
                    Error::new(ErrorKind::Derivatives, text)
                };
                for (column, all) in [qd, qdd].into_iter().zip(&mut rates) {
                    let mut column = column.ok_or_else(no_rates)?;
                    if let Some(filter) = &filter {
                        filter.zero_phase(&mut column);
                    }
                    all.push(column);
                }
            }
            found.q.push(q);
            found.torque.push(tau);
        }
        found.rates = logged.then_some(rates);
        found.filter = filter;
        found.rest();
        if !found.resting.contains(&false) {
            let text = "no joint moves further than its noise\n  hint: noise is that of the steps \
                        of its encoder: `options.resolution` in rad or m, if it was given";
            return Err(Error::new(ErrorKind::NothingMoves, text));
        }
        found.compare_rates(names)?;
        found.average(how.averaging)?;
        Ok(found)
    }

    /// Replaces laps by their mean: everything once.
    fn average(&mut self, averaging: Averaging) -> Result<(), Error> {
        // values between samples need some on either side
        let samples = self.q.first().map_or(0, Vec::len);
        let span = self.range.start.max(STENCIL)..self.range.end.min(samples - STENCIL);
        let laps = match averaging {
            Averaging::No => return Ok(()),
            Averaging::Period(period_s) => Laps::given(&self.q, period_s, self.step_s, span)?,
            Averaging::Found => Laps::find(&self.q, self.step_s, span)?,
        };
        // A lap goes on as it began, so that its edges can be filtered and differentiated.
        let edge = STENCIL + self.filter.as_ref().map_or(0, Butterworth::settling);
        let wrap = edge + Decimator::reach_of(self.decimation);
        let around = |mean: &[f64]| -> Vec<f64> {
            let n = mean.len();
            (0..n + 2 * wrap).map(|k| mean[(k + n * wrap.div_ceil(n) - wrap) % n]).collect()
        };
        let rates = self.rates.iter_mut().flatten().flatten();
        let torques = self.torque.iter_mut().flatten();
        for column in self.q.iter_mut().chain(rates).chain(torques) {
            *column = around(&laps.mean(column));
        }
        self.start_s += laps.start as f64 * self.step_s;
        // the filter's cutoff, in samples, is as good as the same
        self.step_s *= laps.distance();
        self.start_s -= wrap as f64 * self.step_s;
        self.range = edge..laps.samples + 2 * wrap - edge;
        self.laps = Some(laps);
        Ok(())
    }

    /// What torques and columns pass alike. Of motion near its cutoff the first filter leaves less
    /// than the torque that it goes with, where that is not linear in it: products of rates,
    /// functions of positions. Below half of it they agree to less than a percent.
    pub fn decimator(&self) -> Decimator {
        let edge = self.filter.as_ref().map_or(0.5, |filter| 0.5 * filter.cutoff());
        Decimator::new(self.decimation, edge)
    }

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.q.len()
    }

    /// Samples that are left after decimation.
    pub fn samples(&self) -> usize {
        let reach = Decimator::reach_of(self.decimation);
        let inner = self.range.len().saturating_sub(2 * reach);
        inner.div_ceil(self.decimation)
    }

    /// Samples that are left and independent of each other: as many as the band that filter and
    /// decimator pass has of white noise, about 1.4 in a period of the cutoff.
    pub fn independent(&self) -> f64 {
        (self.noise_gains()[0][0] * self.range.len() as f64).min(self.samples() as f64)
    }

    /// Periods of the filter's cutoff; pairs of samples without a filter.
    pub fn periods(&self) -> f64 {
        self.range.len() as f64 * self.filter.as_ref().map_or(0.5, Butterworth::cutoff)
    }

    /// The time of a sample that is left \[s\].
    pub fn time_s(&self, sample: SampleIndex) -> f64 {
        self.start_s + self.step_s * self.first_place(sample) as f64
    }

    /// q, qd and qdd of every joint at samples of the log, 3 n columns; `range` must lie within
    /// [`Conditioned::range`].
    pub fn motion(&self, range: Range<usize>, columns: &mut Vec<Vec<f64>>) {
        let n = self.joints();
        columns.resize(3 * n, Vec::new());
        for (place, column) in columns.iter_mut().enumerate() {
            column.clear();
            column.extend(range.clone().map(|at| self.moved(JointIndex(place % n), place / n, at)));
        }
    }

    /// The position of a joint (order 0), its rate or its acceleration at a place within
    /// [`Conditioned::range`].
    pub fn moved(&self, joint: JointIndex, order: usize, place: usize) -> f64 {
        let q = &self.q[joint.0];
        match (order, &self.rates) {
            (0, _) => q[place],
            (_, Some(rates)) => rates[order - 1][joint.0][place],
            (1, None) => rate(q, place) / self.step_s,
            (_, None) => acceleration(q, place) / (self.step_s * self.step_s),
        }
    }

    /// q, qd and qdd at so many samples that are left, from `first` on.
    pub fn motion_at(&self, first: SampleIndex, samples: usize, columns: &mut Vec<Vec<f64>>) {
        let from = self.first_place(first);
        self.motion(from..from + (samples - 1) * self.decimation + 1, columns);
        if self.decimation > 1 {
            for column in columns {
                *column = column.iter().copied().step_by(self.decimation).collect();
            }
        }
    }

    /// Where a sample that is left stands among all.
    fn first_place(&self, sample: SampleIndex) -> usize {
        self.range.start + Decimator::reach_of(self.decimation) + sample.0 * self.decimation
    }

    /// Where so many samples that are left stand among all, from `first` on.
    pub fn places(
        &self,
        first: SampleIndex,
        samples: usize,
    ) -> impl Iterator<Item = usize> + Clone {
        let from = self.first_place(first);
        let decimation = self.decimation;
        (0..samples).map(move |sample| from + sample * decimation)
    }

    /// The covariance of position, rate and acceleration that white noise of variance 1 of the
    /// measured position makes, after both filters.
    pub fn noise_gains(&self) -> [[f64; 3]; 3] {
        self.gains_after(&self.decimator())
    }

    /// The same after the filter alone.
    pub fn filter_gains(&self) -> [[f64; 3]; 3] {
        self.gains_after(&Decimator::new(1, 0.5))
    }

    fn gains_after(&self, decimator: &Decimator) -> [[f64; 3]; 3] {
        let settling = self.filter.as_ref().map_or(0, Butterworth::settling);
        // without a filter the differences alone reach a stencil beyond each sample of the impulse
        let margin = (2 * settling + decimator.reach() + STENCIL).max(2 * STENCIL);
        let mut impulse = vec![0.0; 2 * margin + 1 + 2 * decimator.reach()];
        let middle = impulse.len() / 2;
        impulse[middle] = 1.0;
        if let Some(filter) = &self.filter {
            filter.zero_phase(&mut impulse);
        }
        let mut smooth = vec![0.0; impulse.len() - 2 * decimator.reach()];
        decimator.smooth(&impulse, &mut smooth);
        let h = self.step_s;
        let mut gains = [[0.0; 3]; 3];
        for k in STENCIL..smooth.len() - STENCIL {
            let q = [smooth[k], rate(&smooth, k) / h, acceleration(&smooth, k) / (h * h)];
            for (row, gains) in gains.iter_mut().enumerate() {
                for (column, gain) in gains.iter_mut().enumerate() {
                    *gain += q[row] * q[column];
                }
            }
        }
        gains
    }
}

fn lawful(filter: Filter, step_s: f64) -> Result<Butterworth, Error> {
    let Filter { order, cutoff_hz } = filter;
    let limit_hz = 0.5 / step_s;
    let found = Butterworth::new(order, cutoff_hz, step_s);
    found.ok_or_else(|| Error::cutoff(cutoff_hz, limit_hz))
}

/// The first difference of sixth order, per sample.
pub fn rate(q: &[f64], k: usize) -> f64 {
    let odd = |d: usize| q[k + d] - q[k - d];
    (45.0 * odd(1) - 9.0 * odd(2) + odd(3)) / 60.0
}

/// The second difference of sixth order, per sample squared.
pub fn acceleration(q: &[f64], k: usize) -> f64 {
    let even = |d: usize| q[k + d] - q[k] + (q[k - d] - q[k]);
    (270.0 * even(1) - 27.0 * even(2) + 2.0 * even(3)) / 180.0
}
