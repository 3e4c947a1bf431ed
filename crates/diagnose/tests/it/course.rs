//! Laws that hold at all times, and a force that is like one of them for a while.

use super::motion::{SLED, motion};
use super::one_joint::{STEP_S, diagnosed, log};
use denavit_diagnose::{Diagnosis, Verdict};
use denavit_measure::log::MeasuredLog;
use denavit_numerics::Random;
use std::f64::consts::TAU;

const MASS: f64 = 2.0;

/// What is missing where the drive also gives `more`, of time, position and velocity.
fn with(more: &mut dyn FnMut(f64, [f64; 3]) -> f64) -> (Diagnosis, Vec<String>) {
    let mut made = |phase: f64, seed: u64| -> MeasuredLog {
        let motion = motion(phase);
        let mut log = log(&motion, &|at| MASS * at[2], seed, 0.02);
        for (k, torque) in log.joints[0].tau.iter_mut().flatten().enumerate() {
            let t = STEP_S * k as f64;
            *torque += more(t, motion(t));
        }
        log
    };
    let (found, candidates) = diagnosed(SLED, [made(0.0, 1), made(0.8, 2)]);
    let named = found.effects.iter().filter(|one| one.is_named);
    let names = named.map(|one| candidates[one.candidate].effect.clone()).collect();
    (found, names)
}

/// The same force is a spring if it stays, and only near to one if it fades.
#[test]
fn a_spring_that_fades_is_no_spring() {
    let (found, names) = with(&mut |_, at| 20.0 * at[0]);
    assert_eq!(names, ["spring"], "{:?}", found.reasons);
    let (found, names) = with(&mut |t, at| 20.0 * (-t / 5.0).exp() * at[0]);
    assert_eq!(names, [""; 0], "{:?}", found.effects);
    assert_eq!(found.verdict, Verdict::Unexplained);
    // exp(-t/5) over 15 s, as a line: 1.5 times its mean to either side
    let change = found.effects.iter().filter_map(|one| one.change_in_time).fold(0.0, f64::max);
    assert!((0.8..2.0).contains(&change), "{change}");
    assert!(found.reasons.iter().any(|one| one.contains("only near")), "{:?}", found.reasons);
}

/// Friction that warms up by a quarter is friction.
#[test]
fn friction_that_changes_a_little_keeps_its_name() {
    let (found, names) = with(&mut |t, at| (1.0 - t / 60.0) * 0.6 * at[1].signum());
    assert!(
        names.iter().any(|name| name.contains("coulomb") || name.contains("cold")),
        "{names:?}"
    );
    assert!(found.effects.iter().all(|one| one.change_in_time.is_none()), "{:?}", found.effects);
}

/// A force that no channel records, half as large as the friction beside it, takes the name of
/// friction away from nobody, and is told.
#[test]
fn friction_has_its_name_beside_a_disturbance() {
    let mut random = Random::new(5);
    let (mut slow, friction) = (0.0, 1.0);
    let (found, names) = with(&mut |_, at| {
        // noise below 3 Hz
        slow += STEP_S * TAU * 3.0 * (0.5 * 7.3 * random.normal() - slow);
        friction * at[1].signum() + slow
    });
    assert_eq!(names, ["coulomb"], "{:?}", found.reasons);
    assert_eq!(found.verdict, Verdict::PartlyExplained, "{:?}", found.reasons);
    assert!(found.structures.is_empty(), "{:?}", found.structures);
}
