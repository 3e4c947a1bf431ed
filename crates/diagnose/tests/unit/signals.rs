//! Tests of what is private in `signals.rs`.

use super::*;
use std::f64::consts::TAU;

#[test]
fn a_delay_that_is_undone_leaves_the_torque_before_it() {
    let (step_s, delay_s, rate) = (0.002, 0.0173, TAU * 1.3);
    let q: Vec<f64> = (0..6000).map(|k| (rate * step_s * f64::from(k)).sin()).collect();
    let late = (0..6000).map(|k| (rate * (step_s * f64::from(k) - delay_s)).sin());
    let joint = JointSignals { tau: Some(late.collect()), q, ..JointSignals::default() };
    let (file, joints) = ("made".to_owned(), vec![joint]);
    let log = MeasuredLog { file, step_s, joints, ..MeasuredLog::default() };
    let signals =
        Signals::new(log, Filters { motion_hz: 25.0, torque_hz: 12.5 }).expect("long enough");
    let [added, slope] = signals.undelayed_within(JointIndex(0), delay_s).expect("measured");
    let [q, added, slope] = [&signals.q[0], &added, &slope].map(|all| signals.at_rows(all));
    let t = signals.at_rows(&signals.t);
    for (k, t) in t.iter().enumerate() {
        let late = (rate * (t - delay_s)).sin();
        assert!((late - added[k] - q[k]).abs() < 2e-5, "{t}: {} {}", late - added[k], q[k]);
        assert!((slope[k] - rate * (rate * t).cos()).abs() < 2e-3 * rate, "{t}");
    }
}
