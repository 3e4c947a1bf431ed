//! Columns that are other ones than they are taken for, asked for where the model as it is given is
//! nothing like the torques of some joint: an effect that stood for that would be named wrongly.

use super::data::Data;
use super::gap::Gap;
use super::signals::{Shared, Signals};
use crate::policy::columns::AT_REST;
use denavit_evidence::policy::{LEFT_OF_EXPLAINED, NOTHING_LIKE};
use denavit_identify::doubt::{MisreadColumns, misread_columns};
use denavit_measure::condition::Conditioned;
use denavit_numerics::least_and_most;

/// The columns that are surely misread; none where the residual is small at every joint.
pub(super) fn misread(data: &Data<'_>, residual: &[f64]) -> Vec<MisreadColumns> {
    let gap = Gap::new(data, residual, &|_| 1.0);
    if gap.per_joint.iter().flatten().all(|share| *share < NOTHING_LIKE) {
        return Vec::new();
    }
    let logs: Vec<Conditioned> = data.signals.iter().map(conditioned).collect();
    let logs: Vec<&Conditioned> = logs.iter().collect();
    let mut found = misread_columns(data.nominal.model, &logs, None);
    found.retain(|one| one.is_sure && explains(one));
    found
}

/// Whether a reading leaves little beside what it explains, as is asked of an effect that is named:
/// by an estimate, or by the nominal parameters, since an estimate adapts to a unit. What leaves as
/// much, like a stop that was hit, is told from a misread column by no odds between readings.
fn explains(reading: &MisreadColumns) -> bool {
    let both = [Some(reading.left_by_estimate), reading.left_by_model];
    both.into_iter().flatten().any(|[as_is, as_meant]| {
        let explained = (as_is * as_is - as_meant * as_meant).max(0.0).sqrt();
        as_meant <= LEFT_OF_EXPLAINED * explained
    })
}

/// The motion and torques of a log's rows, as the search for misread columns takes them.
fn conditioned(signals: &Signals) -> Conditioned {
    let rows =
        |all: &[Shared]| -> Vec<Vec<f64>> { all.iter().map(|one| signals.rows_of(one)).collect() };
    let q = rows(&signals.q);
    let rests = |q: &Vec<f64>| {
        let [low, high] = least_and_most(q);
        high - low < AT_REST
    };
    Conditioned {
        file: signals.file.clone(),
        start_s: signals.t[0],
        step_s: signals.row_step_s(),
        rates: Some([rows(&signals.qd), rows(&signals.qdd)]),
        torque: signals.torque.clone(),
        range: 0..q[0].len(),
        decimation: 1,
        position_noise: vec![0.0; q.len()],
        resting: q.iter().map(rests).collect(),
        q,
        ..Conditioned::default()
    }
}
