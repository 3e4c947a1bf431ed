//! Bezier polynomials.

use super::Setpoint;
use super::numbers::{check_finite, check_times};
use crate::error::{Cause, Error};

/// The Bezier polynomial of control values over a time range.
#[derive(Clone, Debug, PartialEq)]
pub struct Bezier {
    times: [f64; 2],
    controls: Vec<f64>,
}

impl Bezier {
    /// Start and end \[s\], and at least one control value.
    pub fn new(times: [f64; 2], controls: Vec<f64>) -> Result<Self, Error> {
        check_times(&times)?;
        check_finite(&controls)?;
        match controls.len() {
            0 => Err(Cause::TooFew { needed: 1, found: 0 }.into()),
            _ => Ok(Self { times, controls }),
        }
    }

    pub(super) fn range(&self) -> [f64; 2] {
        self.times
    }

    pub(super) fn at(&self, t_s: f64) -> Setpoint {
        let [t0, t1] = self.times;
        if t_s < t0 || t_s > t1 {
            let at = if t_s < t0 { 0 } else { self.controls.len() - 1 };
            return Setpoint::resting(self.controls[at]);
        }
        let duration = t1 - t0;
        let s = (t_s - t0) / duration;
        let slopes = differences(&self.controls);
        let curvatures = differences(&slopes);
        Setpoint {
            position: de_casteljau(&self.controls, s),
            rate: de_casteljau(&slopes, s) / duration,
            acceleration: de_casteljau(&curvatures, s) / (duration * duration),
        }
    }
}

/// Control values of the derivative: the degree times the differences.
fn differences(controls: &[f64]) -> Vec<f64> {
    let degree = controls.len().saturating_sub(1) as f64;
    controls.windows(2).map(|pair| degree * (pair[1] - pair[0])).collect()
}

fn de_casteljau(controls: &[f64], s: f64) -> f64 {
    let mut values = controls.to_vec();
    for last in (1..values.len()).rev() {
        for i in 0..last {
            values[i] += s * (values[i + 1] - values[i]);
        }
    }
    values.first().copied().unwrap_or(0.0)
}
