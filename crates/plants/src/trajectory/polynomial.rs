//! Polynomials in time.

use super::Setpoint;
use super::numbers::check_finite;
use crate::error::{Cause, Error};

/// sum of c_k t^k.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial {
    coefficients: Vec<f64>,
}

impl Polynomial {
    /// Coefficients from the constant one upwards.
    pub fn new(coefficients: Vec<f64>) -> Result<Self, Error> {
        check_finite(&coefficients)?;
        match coefficients.len() {
            0 => Err(Cause::TooFew { needed: 1, found: 0 }.into()),
            _ => Ok(Self { coefficients }),
        }
    }

    pub(super) fn at(&self, t_s: f64) -> Setpoint {
        horner(&self.coefficients, t_s)
    }
}

/// A polynomial and two derivatives; the second of Horner's sums is half the second derivative.
pub(super) fn horner(coefficients: &[f64], x: f64) -> Setpoint {
    let [mut value, mut first, mut half_second] = [0.0; 3];
    for coefficient in coefficients.iter().rev() {
        half_second = half_second * x + first;
        first = first * x + value;
        value = value * x + coefficient;
    }
    Setpoint { position: value, rate: first, acceleration: 2.0 * half_second }
}
