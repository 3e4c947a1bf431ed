//! Why there is no course of balance.

use denavit_simulate::LogFaults;
use std::fmt;

/// Why there is no course.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum BalanceError {
    /// A log is wrong.
    Log(LogFaults),
    /// A course would have more instants than are kept; holds how many, and how many are kept.
    TooMany(f64, u32),
    /// The robot has no contact points, or its base is fixed: no point of the ground tells of it.
    NotWalking,
    /// The run does not begin.
    Start(denavit_simulate::Error),
    /// The mass matrix is singular at this time \[s\].
    Singular(f64),
}

impl fmt::Display for BalanceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Log(faults) => write!(f, "{faults}"),
            Self::TooMany(count, most) => write!(
                f,
                "{count:.0} instants, where at most {most} are kept\n  hint: a longer \
                 period: `options.period_s`"
            ),
            Self::NotWalking => {
                write!(f, "only robots with a floating base and contact points can fall")
            }
            Self::Start(error) => write!(f, "{error}"),
            Self::Singular(t_s) => write!(f, "at {t_s} s the mass matrix is singular"),
        }
    }
}
