//! How the robot moved while held-out logs were measured, to be looked at.

use super::data::Data;

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
    let of = |signals: &super::Signals| LoggedMotion {
        file: signals.file.clone(),
        t_s: signals.at_rows(&signals.t),
        q: signals.q.iter().map(|q| signals.at_rows(q)).collect(),
    };
    data.signals.iter().map(of).collect()
}
