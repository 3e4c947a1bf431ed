//! Why there is no cycle, or no analysis of one.

use denavit_simulate::Stop;
use std::fmt;

/// Why there is no cycle, or no analysis of one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum CycleError {
    /// The run does not begin.
    Start(denavit_simulate::Error),
    /// It ended before the cycle did, at this time \[s\].
    Stopped(Stop, f64),
    /// The event of the section did not happen in time; holds the time \[s\].
    NoEvent(f64),
    /// States of motors or laws are not recorded at events: a section of the clock is needed.
    HiddenStates,
    /// Newton's method does not find one; holds the least residual.
    NotFound(f64),
    /// The cycle has no first-order changes.
    Variation(denavit_simulate::Error),
    /// A reference does not repeat itself; holds the joint's name.
    NotPeriodic(String),
    /// The swing foot does not strike in time \[s\].
    NoStrike(f64),
    /// The scenario pushes the robot.
    Pushed,
    /// A section of the clock of a controller that has none.
    NoClock,
    /// The multipliers do not converge.
    Multipliers,
}

impl fmt::Display for CycleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start(error) => write!(f, "{error}"),
            Self::Stopped(stop, t_s) => write!(f, "at {t_s:.6} s the run {stop}"),
            Self::NoEvent(t_s) => write!(f, "within {t_s} s the event of the section is not met"),
            Self::HiddenStates => {
                write!(f, "events do not record the states of motors and of effects")
            }
            Self::NotFound(residual) => {
                write!(f, "no cycle was found: what comes nearest misses itself by {residual:.1e}")
            }
            Self::Variation(error) => write!(f, "{error}"),
            Self::NotPeriodic(joint) => {
                write!(f, "the reference of `{joint}` does not repeat itself: there is no cycle")
            }
            Self::NoStrike(t_s) => write!(f, "no foot strikes the ground within {t_s} s"),
            Self::Pushed => write!(f, "pushes come once: with them there is no cycle"),
            Self::NoClock => write!(f, "the controller has no clock, and so no phase"),
            Self::Multipliers => write!(f, "the multipliers do not converge"),
        }
    }
}
