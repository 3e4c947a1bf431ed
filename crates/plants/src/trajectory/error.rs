//! Why numbers do not make a reference.

use std::fmt;

/// Why numbers do not make a reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrajectoryError {
    /// Fewer values than the kind needs.
    TooFew {
        /// How many it needs.
        needed: usize,
        /// How many are given.
        found: usize,
    },
    /// Lists that belong together have different lengths.
    LengthMismatch {
        /// The length of the first.
        expected: usize,
        /// The length of the other.
        found: usize,
    },
    /// A time is not after the one before it; holds its index.
    NotIncreasing(usize),
    /// A number is not finite.
    NotFinite,
    /// A frequency or a duration is not positive.
    NotPositive,
}

impl fmt::Display for TrajectoryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew { needed, found } => {
                write!(f, "the reference needs {needed} values, {found} are given")
            }
            Self::LengthMismatch { expected, found } => {
                write!(f, "lists that belong together have {expected} and {found} values")
            }
            Self::NotIncreasing(index) => {
                write!(f, "time number {} is not after the one before it", index + 1)
            }
            Self::NotFinite => write!(f, "a number of the reference is not finite"),
            Self::NotPositive => write!(f, "a frequency or duration is not positive"),
        }
    }
}

impl std::error::Error for TrajectoryError {}

/// Times that increase, all numbers finite, at least two.
pub(super) fn check_times(times: &[f64]) -> Result<(), TrajectoryError> {
    check_finite(times)?;
    if times.len() < 2 {
        return Err(TrajectoryError::TooFew { needed: 2, found: times.len() });
    }
    match times.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(index) => Err(TrajectoryError::NotIncreasing(index + 1)),
        None => Ok(()),
    }
}

pub(super) fn check_finite(values: &[f64]) -> Result<(), TrajectoryError> {
    let finite = values.iter().all(|value| value.is_finite());
    if finite { Ok(()) } else { Err(TrajectoryError::NotFinite) }
}

pub(super) fn check_length(expected: usize, found: usize) -> Result<(), TrajectoryError> {
    if expected == found {
        Ok(())
    } else {
        Err(TrajectoryError::LengthMismatch { expected, found })
    }
}
