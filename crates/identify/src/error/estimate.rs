//! Why there is no estimate.

use denavit_measure::LogIndex;
use std::fmt;

/// Why there is no estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EstimateError {
    /// No torque was measured.
    NoTorque,
    /// All rows are left out.
    NothingLeft,
    /// Fewer rows than parameters: rows, parameters.
    TooFewRows(usize, usize),
    /// Logs too short for their filter: independent samples of all torques, parameters, and how
    /// many samples these need.
    TooShort(usize, usize, usize),
    /// Instruments that have other samples than the logs.
    Instruments,
    /// Instruments of another motion: their number, from 0, and the share of a joint's variance by
    /// which its positions differ, in percent.
    OtherMotion(LogIndex, usize),
    /// Weights that do not settle.
    NotSettled,
}

impl fmt::Display for EstimateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoTorque => write!(f, "no torque was measured"),
            Self::NothingLeft => write!(
                f,
                "no joint is ever as fast as `options.slow` says: nothing is left of the logs\n  \
                 hint: a lower rate, or `options.slow=biasing`, which is the default"
            ),
            Self::TooFewRows(rows, parameters) => {
                write!(f, "{rows} rows are too few for {parameters} parameters")
            }
            Self::TooShort(independent, parameters, needed) => write!(
                f,
                "the logs are too short: all torques have about {independent} samples that are \
                 independent of each other after the filter, and {parameters} parameters need \
                 {needed}\n  hint: more of the motion, or a higher cutoff (`conditions.filter`) \
                 if the log has little noise"
            ),
            Self::Instruments => write!(
                f,
                "instruments must be as many logs as there are for training, each with as many \
                 samples"
            ),
            Self::OtherMotion(number, percent) => write!(
                f,
                "instruments must be of the motion of their log, without its noise: in log {} \
                 positions of a joint differ by {percent} % of its variance",
                number.0 + 1
            ),
            Self::NotSettled => write!(f, "the weights do not settle"),
        }
    }
}
