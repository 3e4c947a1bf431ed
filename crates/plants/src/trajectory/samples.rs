//! Samples as they were taken.

use super::Setpoint;
use super::numbers::{check_finite, check_length, check_times};
use crate::error::Error;

/// What is between two samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    /// The earlier one, until the later: what a sampled controller does.
    Hold,
    /// The line from one to the other.
    Line,
}

/// Values at times, held or joined by lines; the ends rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    times: Vec<f64>,
    values: Vec<f64>,
    between: Between,
}

impl Samples {
    /// The samples `values` at `times` \[s\], which increase; at least two.
    pub fn new(times: Vec<f64>, values: Vec<f64>, between: Between) -> Result<Self, Error> {
        check_times(&times)?;
        check_finite(&values)?;
        check_length(times.len(), values.len())?;
        Ok(Self { times, values, between })
    }

    pub(super) fn at(&self, t_s: f64) -> Setpoint {
        let next = self.times.partition_point(|time| *time <= t_s);
        if next == 0 || next == self.times.len() || self.between == Between::Hold {
            return Setpoint::resting(self.values[next.saturating_sub(1)]);
        }
        let (t0, t1) = (self.times[next - 1], self.times[next]);
        let rate = (self.values[next] - self.values[next - 1]) / (t1 - t0);
        let position = self.values[next - 1] + rate * (t_s - t0);
        Setpoint { position, rate, acceleration: 0.0 }
    }

    pub(super) fn next_break(&self, t_s: f64) -> Option<f64> {
        self.times.get(self.times.partition_point(|time| *time <= t_s)).copied()
    }
}
