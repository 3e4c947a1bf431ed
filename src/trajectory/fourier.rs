//! Finite Fourier series.

use super::Setpoint;
use super::error::{TrajectoryError, check_finite, check_length};
use denavit_runtime::Scalar;

/// offset + sum over k = 1 .. of a_k sin(k w t) + b_k cos(k w t).
#[derive(Clone, Debug, PartialEq)]
pub struct Fourier {
    /// w [rad/s].
    frequency: f64,
    offset: f64,
    sines: Vec<f64>,
    cosines: Vec<f64>,
}

impl Fourier {
    /// The series of a base frequency [rad/s], an offset, and as many sines as cosines.
    pub fn new(
        frequency: f64,
        offset: f64,
        sines: Vec<f64>,
        cosines: Vec<f64>,
    ) -> Result<Self, TrajectoryError> {
        check_finite(&[frequency, offset])?;
        check_finite(&sines)?;
        check_finite(&cosines)?;
        check_length(sines.len(), cosines.len())?;
        if frequency <= 0.0 {
            return Err(TrajectoryError::NotPositive);
        }
        Ok(Self { frequency, offset, sines, cosines })
    }

    pub(super) fn at(&self, t_s: f64) -> Setpoint {
        let mut sum = Setpoint::resting(self.offset);
        for (k, (a, b)) in self.sines.iter().zip(&self.cosines).enumerate() {
            let w = (k + 1) as f64 * self.frequency;
            let (sine, cosine) = (w * t_s).sincos();
            let value = a * sine + b * cosine;
            sum.position += value;
            sum.rate += w * (a * cosine - b * sine);
            sum.acceleration -= w * w * value;
        }
        sum
    }
}
