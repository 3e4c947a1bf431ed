//! Motion that repeats: its period, the mean of its laps, and the noise that laps show.

use crate::error::{Error, ErrorKind};
use crate::policy::laps::{COMPARED, DIGITS, FEWEST, LEFT_BY_LAP, MOVES, REPEATS, SETTLED};
use denavit_numerics::{quintic, short, variance};
use std::ops::Range;

/// Samples that a search for the period looks at, at most.
const SEARCHED: usize = 4000;

/// Times that a period is put right.
const ROUNDS: usize = 20;

/// Laps of a log. A period is hardly ever a whole number of samples: were it rounded, laps would
/// drift apart by up to half a sample each, and the seam of the mean lap would be a jump. A mean
/// lap therefore has its samples at a distance of its own, of which a lap holds a whole number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laps {
    /// The first sample of the first lap.
    pub start: usize,
    /// Samples of the log in a lap, with their fraction.
    pub period: f64,
    /// Samples of the mean lap.
    pub samples: usize,
    /// Number of laps.
    pub count: usize,
}

/// Samples on either side that a value between two samples is found from.
const REACH: usize = 3;

/// Places at which a motion is compared with itself a lag later: the range and the stride.
#[derive(Clone, Copy)]
struct Compared<'a> {
    /// Positions of the joints that move, with their variances.
    moving: &'a [(&'a [f64], f64)],
    start: usize,
    end: usize,
    stride: usize,
}

impl<'a> Compared<'a> {
    /// Places within a range, of which values between samples need some on either side.
    fn new(moving: &'a [(&'a [f64], f64)], span: Range<usize>, stride: usize) -> Self {
        let length = moving.first().map_or(0, |(q, _)| q.len());
        let (start, end) = (span.start.max(REACH), span.end.min(length.saturating_sub(REACH)));
        Self { moving, start, end, stride }
    }

    /// The places whose counterpart is between samples that there are.
    fn places(&self, lag: f64) -> impl Iterator<Item = usize> + use<> {
        let last = self.end.saturating_sub(lag.ceil() as usize);
        (self.start..last).step_by(self.stride)
    }

    /// The largest share of a joint's variance by which its position differs from itself a lag
    /// later.
    fn misfit(&self, lag: f64) -> f64 {
        let of_joint = |(q, variance): &(&[f64], f64)| {
            let (mut sum, mut count) = (0.0, 0);
            for k in self.places(lag) {
                sum += (quintic(q, k as f64 + lag) - q[k]).powi(2);
                count += 1;
            }
            sum / (2.0 * f64::from(count.max(1)) * variance)
        };
        self.moving.iter().map(of_joint).fold(0.0, f64::max)
    }

    /// The lag near a given one with which the motion fits itself best, by Gauss and Newton: at
    /// most a sample away.
    fn refined(&self, lag: f64) -> f64 {
        let mut best = lag;
        for _ in 0..ROUNDS {
            let (mut product, mut squares) = (0.0, 0.0);
            for (q, variance) in self.moving {
                for k in self.places(best) {
                    let place = k as f64 + best;
                    let miss = q[k] - quintic(q, place);
                    let at = place.floor() as usize;
                    let slope = q[at + 1] - q[at];
                    product += slope * miss / variance;
                    squares += slope * slope / variance;
                }
            }
            if squares <= 0.0 {
                return lag;
            }
            let next = (best + product / squares).clamp(lag - 1.0, lag + 1.0);
            let change = (next - best).abs();
            best = next;
            if change < SETTLED {
                break;
            }
        }
        if self.misfit(best) < self.misfit(lag) { best } else { lag }
    }
}

/// Positions of joints that move, with their variances between two samples.
fn moving(positions: &[Vec<f64>], span: Range<usize>) -> Vec<(&[f64], f64)> {
    let all = positions.iter().map(|q| (q.as_slice(), variance(&q[span.clone()])));
    let all: Vec<(&[f64], f64)> = all.collect();
    let most = all.iter().map(|(_, variance)| *variance).fold(0.0, f64::max);
    all.into_iter().filter(|(_, variance)| *variance > MOVES * most).collect()
}

impl Laps {
    /// Laps of a given period, with which the positions must repeat. What it lacks in digits is
    /// found, as long as that is less than a sample in a lap.
    ///
    /// # Errors
    /// A period of too few samples, of one lap, or with which the positions do not repeat.
    pub fn given(
        positions: &[Vec<f64>],
        period_s: f64,
        step_s: f64,
        span: Range<usize>,
    ) -> Result<Self, Error> {
        let period = period_s / step_s;
        let laps = Self::of_period(period, step_s, span.clone())?;
        let moving = moving(positions, span.clone());
        let stride = span.len().div_ceil(SEARCHED).max(1);
        let compared = Compared::new(&moving, span.clone(), stride);
        // the best one may be further away than what digits leave open
        let away = compared.refined(laps.period) - laps.period;
        let period = refined(&compared, laps.period, laps.count);
        let misfit = compared.misfit(period);
        match misfit < REPEATS {
            true if away.abs() >= DIGITS => {
                let how = if away > 0.0 { "longer" } else { "shorter" };
                let why =
                    format!("the motion repeats with a period that is {how} by a sample or more");
                Err(not_repeated(period_s, &why))
            }
            true => Self::of_period(period, step_s, span),
            false => {
                let percent = 100.0 * misfit;
                let why = format!("they differ by {percent:.0} % of the variance of a joint");
                Err(not_repeated(period_s, &why))
            }
        }
    }

    /// Laps of a period in samples from sample `start` on.
    fn of_period(period: f64, step_s: f64, span: Range<usize>) -> Result<Self, Error> {
        let [period_s, step] = [period * step_s, step_s].map(short);
        if !(period >= FEWEST && period.is_finite()) {
            return Err(refused(format!(
                "a period of {period_s} s has too few samples of {step} s for a lap"
            )));
        }
        match (span.len() as f64 / period + 1e-9).floor() as usize {
            count @ 2.. => {
                Ok(Self { start: span.start, period, samples: period.round() as usize, count })
            }
            _ => Err(refused(format!("the log has no two whole laps of {period_s} s"))),
        }
    }

    /// The shortest period with which all joints repeat, found by comparing the positions with
    /// themselves.
    pub fn find(positions: &[Vec<f64>], step_s: f64, span: Range<usize>) -> Result<Self, Error> {
        let samples = span.len();
        let stride = samples.div_ceil(SEARCHED).max(1);
        let moving = moving(positions, span.clone());
        if moving.is_empty() {
            return Err(no_period());
        }
        let compared = Compared::new(&moving, span.clone(), stride);
        // From the first lag at which the motion has become another one.
        let lags = (1..samples / 2 / stride).map(|lag| lag * stride);
        let mut left = false;
        let mut best: Option<(usize, f64)> = None;
        for lag in lags {
            let here = compared.misfit(lag as f64);
            left |= here > LEFT_BY_LAP;
            if left && here < REPEATS && best.is_none_or(|(_, least)| here < least) {
                best = Some((lag, here));
            } else if best.is_some_and(|(found, _)| lag > found + found / 10) {
                break;
            }
        }
        let (near, _) = best.ok_or_else(no_period)?;
        let nearby = near.saturating_sub(2 * stride).max(1)..=near + 2 * stride;
        let lag = nearby
            .filter(|&lag| 2 * lag <= samples)
            .map(|lag| (lag, compared.misfit(lag as f64)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map_or(near, |(lag, _)| lag);
        let count = samples / lag;
        let period = refined(&compared, lag as f64, count);
        Self::of_period(period, step_s, span)
    }

    /// The distance of the mean lap's samples, in those of the log.
    pub fn distance(&self) -> f64 {
        self.period / self.samples as f64
    }

    /// The mean lap of a signal, which must have three more samples on either side.
    pub fn mean(&self, signal: &[f64]) -> Vec<f64> {
        let Self { start, period, samples, count } = *self;
        let distance = self.distance();
        let at = |lap: usize, k: usize| {
            let place = start as f64 + lap as f64 * period + k as f64 * distance;
            // what is whole but for rounding needs no neighbours
            let near = place.round();
            let place = if (place - near).abs() < 1e-6 { near } else { place };
            quintic(signal, place)
        };
        (0..samples).map(|k| (0..count).map(|lap| at(lap, k)).sum::<f64>() / count as f64).collect()
    }
}

/// Laps that are not averaged.
fn refused(text: impl Into<String>) -> Error {
    Error::new(ErrorKind::Laps, text)
}

fn no_period() -> Error {
    refused("the motion does not repeat\n  hint: give its period, or do not average")
}

fn not_repeated(period_s: f64, why: &str) -> Error {
    refused(format!(
        "laps of {} s do not repeat: {why}\n  hint: `found` looks for the period; or do not \
         average",
        short(period_s)
    ))
}

/// A period to more digits: over two laps, four and so on what it lacks adds up.
fn refined(compared: &Compared<'_>, period: f64, count: usize) -> f64 {
    let mut period = period;
    let mut laps = 1;
    while laps < count.max(2) {
        let lag = period * laps as f64;
        if lag + (4 * REACH) as f64 > COMPARED * (compared.end - compared.start) as f64 {
            break;
        }
        period = compared.refined(lag) / laps as f64;
        laps *= 2;
    }
    period
}
