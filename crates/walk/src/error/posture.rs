//! Why there is no posture.

use std::fmt;

/// Why there is no posture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PostureError {
    /// There are more or fewer conditions than coordinates.
    Count {
        /// Number of conditions.
        conditions: usize,
        /// Number of coordinates.
        coordinates: usize,
    },
    /// The conditions cannot be met, or not from this start: the largest error left [m, rad].
    OutOfReach {
        /// The largest error of a condition.
        residual: f64,
    },
}

impl fmt::Display for PostureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count { conditions, coordinates } => {
                write!(f, "{conditions} conditions for {coordinates} coordinates")
            }
            Self::OutOfReach { residual } => {
                write!(f, "no posture meets the conditions; the best found misses by {residual:e}")
            }
        }
    }
}
