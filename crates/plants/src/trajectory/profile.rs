//! From rest to rest.

use super::Setpoint;
use super::numbers::{check_finite, check_times};
use crate::error::Error;
use denavit_runtime::Scalar;
use std::f64::consts::TAU;

/// From one position to another, the velocity proportional to 1 - cos: velocity and acceleration
/// are 0 at both ends.
#[derive(Clone, Debug, PartialEq)]
pub struct CosineProfile {
    times: [f64; 2],
    positions: [f64; 2],
}

impl CosineProfile {
    /// Start and end, times \[s\] and positions.
    pub fn new(times: [f64; 2], positions: [f64; 2]) -> Result<Self, Error> {
        check_times(&times)?;
        check_finite(&positions)?;
        Ok(Self { times, positions })
    }

    pub(super) fn range(&self) -> [f64; 2] {
        self.times
    }

    pub(super) fn at(&self, t_s: f64) -> Setpoint {
        let ([t0, t1], [from, to]) = (self.times, self.positions);
        if t_s <= t0 || t_s >= t1 {
            return Setpoint::resting(if t_s <= t0 { from } else { to });
        }
        let (duration, distance) = (t1 - t0, to - from);
        let s = (t_s - t0) / duration;
        let (sine, cosine) = (TAU * s).sincos();
        Setpoint {
            position: from + distance * (s - sine / TAU),
            rate: distance / duration * (1.0 - cosine),
            acceleration: distance / (duration * duration) * TAU * sine,
        }
    }
}
