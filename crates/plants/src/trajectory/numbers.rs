//! Why numbers do not make a reference.

use crate::error::{Cause, Error};

/// Times that increase, all numbers finite, at least two.
pub(super) fn check_times(times: &[f64]) -> Result<(), Error> {
    check_finite(times)?;
    if times.len() < 2 {
        return Err(Cause::TooFew { needed: 2, found: times.len() }.into());
    }
    match times.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(index) => Err(Cause::NotIncreasing(index + 1).into()),
        None => Ok(()),
    }
}

pub(super) fn check_finite(values: &[f64]) -> Result<(), Error> {
    let finite = values.iter().all(|value| value.is_finite());
    if finite { Ok(()) } else { Err(Cause::NoNumber.into()) }
}

pub(super) fn check_length(expected: usize, found: usize) -> Result<(), Error> {
    if expected == found { Ok(()) } else { Err(Cause::LengthMismatch { expected, found }.into()) }
}
