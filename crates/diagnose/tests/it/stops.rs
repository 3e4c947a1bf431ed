//! Stops: they act at few moments, and then by far more than noise.

use super::one_joint::{diagnosed, log};
use super::separate::{INERTIA, ROD, WEIGHT};
use denavit_diagnose::Verdict;
use std::f64::consts::TAU;

/// Three sines of which the first has this period.
fn waves(size: f64, period_s: f64, phase: f64) -> impl Fn(f64) -> [f64; 3] {
    move |t| {
        let mut all = [0.0; 3];
        for (k, share) in [(1.0, 1.0), (2.0, 0.5), (3.0, 0.3)] {
            let w = TAU * k / period_s;
            let (sine, cosine) = (w * t + k * phase).sin_cos();
            all[0] += size * share * sine;
            all[1] += size * share * w * cosine;
            all[2] -= size * share * w * w * sine;
        }
        all
    }
}

/// A stop at 0.5 rad of 300 N m/rad that hardens by a share of itself in 0.1 rad.
fn torque(harder: f64) -> impl Fn([f64; 3]) -> f64 {
    move |at| {
        let within = (at[0] - 0.5).max(0.0);
        let damping = if within > 0.0 { 3.0 * at[1] } else { 0.0 };
        let stop = 300.0 * within * (1.0 + harder * within / 0.1) + damping;
        INERTIA * at[2] + WEIGHT * at[0].cos() + stop
    }
}

/// All logs decide names: what held-out logs alone have act has a name, and the values that these
/// give it, which no other log has judged.
#[test]
fn a_stop_that_held_out_logs_alone_reach_has_a_name_and_is_not_judged() {
    let motions = [(0.3, 0.0), (0.5, 1.1)].map(|(size, phase)| waves(size, 5.0, phase));
    let logs = [1, 2].map(|seed| log(&motions[seed - 1], &torque(0.0), seed as u64, 0.02));
    let (found, candidates) = diagnosed(ROD, logs);
    let [one] = &found.effects[..] else { panic!("{:?}", found.reasons) };
    assert_eq!(candidates[one.candidate].effect, "hard_stop");
    let value = |name: &str| one.parameters.iter().find(|one| one.name == name).expect("one").value;
    assert!((value("q_s") - 0.5).abs() < 1e-3 && (value("k") / 300.0 - 1.0).abs() < 0.05);
    assert!(one.is_untrained && one.is_named);
    assert_eq!(found.verdict, Verdict::PartlyExplained);
    assert!(found.reasons[0].contains("held-out logs alone have hard_stop"), "{:?}", found.reasons);
}

/// A stop that is met once in each log acts at so few moments that nothing is known of its change:
/// it stands for nothing that fades.
#[test]
fn what_acts_once_in_a_log_stands_for_nothing_that_fades() {
    let motions = [(0.36, -1.3), (0.5, -1.8)].map(|(size, phase)| waves(size, 15.0, phase));
    let logs = [1, 2].map(|seed| log(&motions[seed - 1], &torque(0.1), seed as u64, 0.02));
    let (found, _) = diagnosed(ROD, logs);
    assert!(!found.effects.is_empty(), "{:?}", found.reasons);
    for one in &found.effects {
        assert_eq!(one.stands_for, None, "{:?}", found.reasons);
    }
}

/// A stop that hardens leaves most where it acts: its value is far less sure than that of one that
/// does not, which is as sure as noise has it.
#[test]
fn a_stop_is_as_sure_as_what_is_left_at_it() {
    let stiffness = |harder: f64| {
        let motions = [(0.5, 0.4), (0.5, 1.1)].map(|(size, phase)| waves(size, 5.0, phase));
        let logs = [1, 2].map(|seed| log(&motions[seed - 1], &torque(harder), seed as u64, 0.02));
        let (found, _) = diagnosed(ROD, logs);
        let [one] = &found.effects[..] else { panic!("{:?}", found.reasons) };
        one.parameters.iter().find(|one| one.name == "k").expect("a stiffness").clone()
    };
    let [plain, hardening] = [0.0, 0.02].map(stiffness);
    assert!((plain.value - 300.0).abs() < 3.0 * plain.std, "{plain:?}");
    assert!(hardening.std > 8.0 * plain.std, "{plain:?} {hardening:?}");
}
