//! Held-out logs over time, to be looked at: torques, and how the robot moved.

use super::data::{Data, Stretch};
use super::signals::Signals;

/// The torque of a joint, or what a spring passes on, in one log, through the filter: measured, and
/// what is left of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The log.
    pub file: String,
    /// The joint, or its spring.
    pub at: String,
    /// Times \[s\].
    pub t_s: Vec<f64>,
    /// What was measured [N m, N].
    pub measured: Vec<f64>,
    /// What the model leaves of it as it is given [N m, N].
    pub as_given: Vec<f64>,
    /// What the nominal model, re-estimated, leaves of it [N m, N].
    pub before: Vec<f64>,
    /// What the model with the effects leaves [N m, N].
    pub after: Vec<f64>,
}

/// The curves of all logs, joint by joint, from what is left in the rows by the model as it is
/// given, by the re-estimated one, and with the effects.
pub(super) fn curves(data: &Data<'_>, [as_given, before, after]: [&[f64]; 3]) -> Vec<Curve> {
    let of_stretch = |stretch: &Stretch| {
        let signals = &data.signals[stretch.log.0];
        let rows = stretch.range();
        Curve {
            file: signals.file.clone(),
            at: data.nominal.equation_name(stretch.equation),
            t_s: signals.at_rows(&signals.t),
            measured: data.torque[rows.clone()].to_vec(),
            as_given: as_given[rows.clone()].to_vec(),
            before: before[rows.clone()].to_vec(),
            after: after[rows].to_vec(),
        }
    };
    data.stretches.iter().map(of_stretch).collect()
}

/// Positions of all joints over the time of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedMotion {
    /// The log.
    pub file: String,
    /// Times \[s\].
    pub t_s: Vec<f64>,
    /// Positions, joint by joint [rad, m].
    pub q: Vec<Vec<f64>>,
}

/// The motions of all logs.
pub(super) fn logged(data: &Data<'_>) -> Vec<LoggedMotion> {
    let of = |signals: &Signals| LoggedMotion {
        file: signals.file.clone(),
        t_s: signals.at_rows(&signals.t),
        q: signals.q.iter().map(|q| signals.at_rows(q)).collect(),
    };
    data.signals.iter().map(of).collect()
}
