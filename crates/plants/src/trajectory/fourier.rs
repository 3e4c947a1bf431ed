//! Finite Fourier series.

use super::Setpoint;
use super::numbers::{check_finite, check_length};
use crate::error::{Cause, Error};
use denavit_runtime::Scalar;

/// offset + sum over k = 1 .. of a_k sin(w_k t) + b_k cos(w_k t): thesis 3.10 with one offset,
/// which is all that can be told apart, and phases as sines with cosines.
#[derive(Clone, Debug, PartialEq)]
pub struct Fourier {
    /// w_k [rad/s].
    frequencies: Vec<f64>,
    offset: f64,
    sines: Vec<f64>,
    cosines: Vec<f64>,
}

impl Fourier {
    /// The series of the multiples w, 2 w, .. of a base frequency [rad/s], an offset, and as many
    /// sines as cosines.
    pub fn new(
        frequency: f64,
        offset: f64,
        sines: Vec<f64>,
        cosines: Vec<f64>,
    ) -> Result<Self, Error> {
        check_finite(&[frequency])?;
        let multiple = |k: usize| (k + 1) as f64 * frequency;
        if frequency <= 0.0 {
            return Err(Cause::NotPositive.into());
        }
        Self::with_frequencies((0..sines.len()).map(multiple).collect(), offset, sines, cosines)
    }

    /// The series of any frequencies [rad/s], each with its sine and its cosine.
    pub fn with_frequencies(
        frequencies: Vec<f64>,
        offset: f64,
        sines: Vec<f64>,
        cosines: Vec<f64>,
    ) -> Result<Self, Error> {
        check_finite(&[offset])?;
        for list in [&frequencies, &sines, &cosines] {
            check_finite(list)?;
            check_length(frequencies.len(), list.len())?;
        }
        if frequencies.iter().any(|frequency| *frequency <= 0.0) {
            return Err(Cause::NotPositive.into());
        }
        Ok(Self { frequencies, offset, sines, cosines })
    }

    /// The time after which it repeats itself \[s\]: none where the frequencies are no multiples of
    /// the lowest.
    pub(super) fn period_s(&self) -> Option<f64> {
        let Some(lowest) = self.frequencies.iter().copied().reduce(f64::min) else {
            return Some(0.0);
        };
        let is_multiple = |w: &f64| (w / lowest - (w / lowest).round()).abs() < 1e-9;
        self.frequencies.iter().all(is_multiple).then_some(std::f64::consts::TAU / lowest)
    }

    pub(super) fn at(&self, t_s: f64) -> Setpoint {
        let mut sum = Setpoint::resting(self.offset);
        for ((&w, a), b) in self.frequencies.iter().zip(&self.sines).zip(&self.cosines) {
            let (sine, cosine) = (w * t_s).sincos();
            let value = a * sine + b * cosine;
            sum.position += value;
            sum.rate += w * (a * cosine - b * sine);
            sum.acceleration -= w * w * value;
        }
        sum
    }
}
