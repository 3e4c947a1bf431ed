//! Signals of a log as a diagnosis looks at them.

use denavit_diagnose::{Filters, Signals};
use denavit_measure::log::{JointSignals, MeasuredLog};
use std::f64::consts::TAU;

/// A torque that a signal of the motion explains whole, seen from both sides: rows of the log
/// and of the motion.
#[test]
fn rows_of_log_and_motion_agree() {
    let step_s = 0.002;
    let at = |k: usize| (TAU * 1.3 * step_s * k as f64).sin();
    let q: Vec<f64> = (0..6000).map(at).collect();
    let joint = JointSignals { tau: Some(q.clone()), q, ..JointSignals::default() };
    let (file, joints) = ("made".to_owned(), vec![joint]);
    let log = MeasuredLog { file, step_s, joints, ..MeasuredLog::default() };
    let signals =
        Signals::new(log, Filters { motion_hz: 25.0, torque_hz: 12.5 }).expect("long enough");
    let measured = signals.torque[0].as_ref().expect("measured");
    let rows = signals.rows_of(&signals.q[0]);
    assert_eq!(rows.len(), measured.len());
    for (a, b) in measured.iter().zip(&rows) {
        assert!((a - b).abs() < 1e-4, "{a} {b}");
    }
    let rate = TAU * 1.3;
    let steepest = signals.qd[0].iter().fold(0.0_f64, |most, qd| most.max(qd.abs()));
    assert!((steepest - rate).abs() < 1e-3 * rate, "{steepest} {rate}");
}
