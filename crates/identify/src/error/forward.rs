//! Why a log is not simulated again.

use denavit_numerics::short;
use denavit_simulate::Stop;
use std::fmt;

/// Why a log is not simulated again.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ForwardError {
    /// The robot does not stand on a fixed base.
    FloatingBase,
    /// A joint that is controlled has no reference, neither of the controller's nor of the log's.
    NoReference(String),
    /// The reference of a joint has empty cells, or times that do not increase.
    BadReference(String),
    /// The torque of a joint was not measured.
    NoTorque(String),
    /// The log is shorter than a window; holds the length of a window \[s\].
    TooShort(f64),
    /// The run does not begin.
    Start(denavit_simulate::Error),
    /// The run broke off.
    Stopped {
        /// When \[s\].
        t_s: f64,
        /// Why.
        stop: Stop,
    },
}

impl fmt::Display for ForwardError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FloatingBase => {
                write!(f, "only robots on a fixed base are simulated against their logs")
            }
            Self::NoReference(joint) => write!(
                f,
                "`{joint}` is controlled and follows nothing\n  hint: give it a `reference`, or \
                 the log a column `ref_{joint}`"
            ),
            Self::BadReference(joint) => write!(f, "`ref_{joint}` is no motion to follow"),
            Self::NoTorque(joint) => write!(
                f,
                "the torque of `{joint}` was not measured\n  hint: `options.controller` simulates \
                 without"
            ),
            Self::TooShort(length_s) => {
                write!(f, "the log is shorter than a window of {} s", short(*length_s))
            }
            Self::Start(error) => write!(f, "{error}"),
            Self::Stopped { t_s, stop } => {
                write!(f, "the simulation broke off at {t_s:.3} s: {stop}")
            }
        }
    }
}
