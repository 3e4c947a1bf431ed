//! Splines through given values.

use super::Setpoint;
use super::numbers::{check_finite, check_length, check_times};
use super::polynomial::horner;
use crate::error::Error;

/// What a cubic spline does at an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EndCondition {
    /// No acceleration.
    Natural,
    /// This rate.
    Rate(f64),
}

/// A polynomial of N coefficients for each interval between two knots; rests outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline<const N: usize> {
    times: Vec<f64>,
    values: Vec<f64>,
    /// For each interval the coefficients of powers of the time since its start.
    pieces: Vec<[f64; N]>,
}

/// Piecewise cubic through given values, rate and acceleration continuous inside.
pub type CubicSpline = Spline<4>;

/// Piecewise quintic with given values, rates and accelerations at its knots.
pub type QuinticSpline = Spline<6>;

impl<const N: usize> Spline<N> {
    pub(super) fn range(&self) -> [f64; 2] {
        [self.times[0], self.times[self.times.len() - 1]]
    }

    pub(super) fn at(&self, t_s: f64) -> Setpoint {
        let last = self.times.len() - 1;
        if t_s < self.times[0] {
            return Setpoint::resting(self.values[0]);
        }
        if t_s > self.times[last] {
            return Setpoint::resting(self.values[last]);
        }
        let i = (self.times.partition_point(|time| *time <= t_s) - 1).min(last - 1);
        horner(&self.pieces[i], t_s - self.times[i])
    }
}

impl CubicSpline {
    /// The spline through `values` at `times` \[s\] with conditions at its start and its end.
    pub fn new(times: Vec<f64>, values: Vec<f64>, ends: [EndCondition; 2]) -> Result<Self, Error> {
        check_times(&times)?;
        check_finite(&values)?;
        check_length(times.len(), values.len())?;
        for end in ends {
            if let EndCondition::Rate(rate) = end {
                check_finite(&[rate])?;
            }
        }
        let rates = knot_rates(&times, &values, ends);
        let pieces = (0..times.len() - 1).map(|i| {
            let h = times[i + 1] - times[i];
            let slope = (values[i + 1] - values[i]) / h;
            let (from, to) = (rates[i], rates[i + 1]);
            let second = (3.0 * slope - 2.0 * from - to) / h;
            let third = (from + to - 2.0 * slope) / (h * h);
            [values[i], from, second, third]
        });
        let pieces = pieces.collect();
        Ok(Self { times, values, pieces })
    }
}

impl QuinticSpline {
    /// The spline with these values, rates and accelerations at `times` \[s\].
    pub fn new(
        times: Vec<f64>,
        values: Vec<f64>,
        rates: &[f64],
        accelerations: &[f64],
    ) -> Result<Self, Error> {
        check_times(&times)?;
        for list in [&values[..], rates, accelerations] {
            check_finite(list)?;
            check_length(times.len(), list.len())?;
        }
        let pieces = (0..times.len() - 1).map(|i| {
            let h = times[i + 1] - times[i];
            let (v0, v1) = (rates[i] * h, rates[i + 1] * h);
            let (a0, a1) = (accelerations[i] * h * h, accelerations[i + 1] * h * h);
            let rise = values[i + 1] - values[i];
            // in the time since the start over h
            let third = 10.0 * rise - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1;
            let fourth = -15.0 * rise + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1;
            let fifth = 6.0 * rise - 3.0 * (v0 + v1) - 0.5 * (a0 - a1);
            let cube = h * h * h;
            [
                values[i],
                rates[i],
                0.5 * accelerations[i],
                third / cube,
                fourth / (cube * h),
                fifth / (cube * h * h),
            ]
        });
        let pieces = pieces.collect();
        Ok(Self { times, values, pieces })
    }
}

/// Rates at the knots that make the acceleration continuous: a tridiagonal system, by elimination.
fn knot_rates(times: &[f64], values: &[f64], ends: [EndCondition; 2]) -> Vec<f64> {
    let last = times.len() - 1;
    let step = |i: usize| times[i + 1] - times[i];
    let slope = |i: usize| (values[i + 1] - values[i]) / step(i);
    // rows: below, diagonal, above, right side
    let mut rows = vec![[0.0; 4]; last + 1];
    rows[0] = match ends[0] {
        EndCondition::Rate(rate) => [0.0, 1.0, 0.0, rate],
        EndCondition::Natural => [0.0, 2.0, 1.0, 3.0 * slope(0)],
    };
    rows[last] = match ends[1] {
        EndCondition::Rate(rate) => [0.0, 1.0, 0.0, rate],
        EndCondition::Natural => [1.0, 2.0, 0.0, 3.0 * slope(last - 1)],
    };
    for i in 1..last {
        let (before, after) = (1.0 / step(i - 1), 1.0 / step(i));
        let right = 3.0 * (slope(i - 1) * before + slope(i) * after);
        rows[i] = [before, 2.0 * (before + after), after, right];
    }
    for i in 1..=last {
        let factor = rows[i][0] / rows[i - 1][1];
        rows[i][1] -= factor * rows[i - 1][2];
        rows[i][3] -= factor * rows[i - 1][3];
    }
    let mut rates = vec![0.0; last + 1];
    rates[last] = rows[last][3] / rows[last][1];
    for i in (0..last).rev() {
        rates[i] = (rows[i][3] - rows[i][2] * rates[i + 1]) / rows[i][1];
    }
    rates
}
