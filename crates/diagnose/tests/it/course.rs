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
    assert!(found.reasons.iter().any(|one| one.contains("has no name")), "{:?}", found.reasons);
}

/// Friction that is smaller in the held-out log is off by its error, and not refuted: half of it
/// has its name, and nearly none of it, for which that log does not ask, is not taken away. Any
/// other law is.
#[test]
fn held_out_logs_ask_for_all_but_friction() {
    let found = |share: f64, law: &dyn Fn([f64; 3]) -> f64| {
        let mut logs = 0;
        let (found, names) = with(&mut |t, at| {
            logs += i32::from(t == 0.0);
            if logs == 1 { law(at) } else { share * law(at) }
        });
        (found.effects.len(), names)
    };
    let friction = |[_, v, _]: [f64; 3]| 0.3 * v.signum();
    assert_eq!(found(0.5, &friction), (1, vec!["coulomb".to_owned()]));
    assert_eq!(found(0.03, &friction).0, 1);
    for share in [0.5, 0.03] {
        assert_eq!(found(share, &|[q, ..]| 3.0 * q).0, 0, "{share}");
    }
}

/// Friction that warms up by a quarter is friction.
#[test]
fn friction_that_changes_a_little_keeps_its_name() {
    let (found, names) = with(&mut |t, at| (1.0 - t / 60.0) * 0.6 * at[1].signum());
    assert!(
        names.iter().any(|name| name.contains("coulomb") || name.contains("cold")),
        "{names:?}"
    );
    assert!(found.effects.iter().all(|one| one.stands_for.is_none()), "{:?}", found.effects);
}

/// Friction that grows less than its velocity has a law of its own, but where it follows any law to
/// a fifth alone: then what is like it most is no better than what every drive has.
#[test]
fn friction_that_follows_no_law_has_the_names_of_what_every_drive_has() {
    for (by_chance, has_own_law) in [(0.0, true), (0.22, false)] {
        let (mut random, mut slow) = (Random::new(5), 0.0);
        let (found, mut names) = with(&mut |_, [_, v, _]| {
            // a share that keeps for 0.05 s
            slow += 0.04 * (-slow + 7.0 * random.normal());
            6.0 * (1.0 + by_chance * slow) * v.signum() * v.abs().powf(0.4)
        });
        names.sort();
        assert!(!names.is_empty(), "{:?}", found.reasons);
        assert_eq!(names != ["coulomb", "viscous"], has_own_law, "{names:?} {:?}", found.reasons);
    }
}

/// What Stribeck's law leaves where viscous friction is missing as well is that, and no fault of
/// the law.
#[test]
fn a_law_of_friction_is_held_against_all_that_every_drive_has() {
    let (found, mut names) =
        with(&mut |_, [_, v, _]| 0.8 * v + (0.6 + 0.6 * (-(v / 0.15).powi(2)).exp()) * v.signum());
    names.sort();
    assert_eq!(names, ["stribeck_friction", "viscous"], "{:?}", found.reasons);
}

/// Where the shape of a law is the one that a search begins with, logs tell it all the same: its
/// error is theirs, and not what was believed before.
#[test]
fn a_shape_that_was_guessed_is_as_sure_as_its_logs() {
    let (found, names) = with(&mut |_, [_, v, _]| 0.06 * (-(v / 0.16).powi(2)).exp() * v.signum());
    assert_eq!(names, ["stribeck"], "{:?}", found.reasons);
    let [height, rate] = &found.effects[0].parameters[..] else { panic!("{:?}", found.effects) };
    assert!(rate.std < 0.01 && (rate.value - 0.16).abs() < 3.0 * rate.std, "{rate:?}");
    assert!((height.value - 0.06).abs() < 3.0 * height.std, "{height:?}");
}

/// Cogging of another phase in the held-out log did not repeat, however well it would fit there.
#[test]
fn what_held_out_logs_have_otherwise_is_no_law() {
    let mut logs = 0.0;
    let (found, _) = with(&mut |t, [q, ..]| {
        logs += f64::from(u8::from(t == 0.0));
        0.3 * (30.0 * q + 1.2 * logs).sin()
    });
    assert!(found.effects.is_empty(), "{:?}", found.effects);
    assert_eq!(found.verdict, Verdict::Unexplained);
}

/// An offset is as sure as the mean of so many samples of noise.
#[test]
fn an_offset_is_as_sure_as_its_logs() {
    let (found, names) = with(&mut |_, _| 0.1);
    assert_eq!(names, ["torque_offset"], "{:?}", found.reasons);
    let own = &found.effects[0].parameters[0];
    let expected = 0.02 / 7500.0_f64.sqrt();
    assert!((0.5..2.5).contains(&(own.std / expected)), "{} {expected}", own.std);
    assert!((own.value - 0.1).abs() < 4.0 * own.std, "{} {}", own.value, own.std);
}

/// A force that no sensor makes, however even its spectrum is, leaves open whether a spring is one.
#[test]
fn a_law_is_held_against_all_that_is_no_noise() {
    for (force, is_named) in [(0.02, true), (0.5, false)] {
        let (mut random, mut smooth) = (Random::new(9), [0.0; 2]);
        let (found, names) = with(&mut |_, [q, ..]| {
            let share = STEP_S * TAU * 20.0;
            smooth[0] += share * (3.0 * random.normal() - smooth[0]);
            smooth[1] += share * (smooth[0] - smooth[1]);
            4.0 * q + force * smooth[1]
        });
        let has = found.effects.iter().any(|one| one.size > 0.1);
        assert!(has, "{:?}", found.reasons);
        let expected: &[&str] = if is_named { &["spring"] } else { &[] };
        assert_eq!(names, expected, "{:?}", found.reasons);
        // why it has no name is said, with what is left and where
        let is_said = found.reasons.iter().any(|one| {
            one.contains("only near to what is missing: a residual of") && one.contains("sled")
        });
        assert_eq!(is_said, !is_named, "{:?}", found.reasons);
    }
}

/// A held-out log whose torque is 0 throughout judges nothing, and breaks nothing.
#[test]
fn a_held_out_torque_of_nothing_is_no_panic() {
    let made = log(&motion(0.0), &|at| MASS * at[2] + 4.0 * at[0], 1, 0.02);
    let nothing = log(&motion(0.8), &|_| 0.0, 2, 0.0);
    let (found, _) = diagnosed(SLED, [made, nothing]);
    let is_sure = matches!(found.verdict, Verdict::Explained | Verdict::NothingMissing);
    assert!(!is_sure, "{:?} {:?}", found.verdict, found.reasons);
    // of a torque of nothing no share can be explained
    assert!(found.effects.iter().all(|one| one.share == 0.0), "{:?}", found.effects);
}

/// What a log says of Coulomb friction through an encoder of so large steps, beside a force below
/// 3 Hz that no channel records: the names, and what is left over what friction does.
fn friction(size: f64, step: f64, force: f64) -> (Vec<String>, f64) {
    let made = |phase: f64, seed: u64| -> MeasuredLog {
        let mut log = log(&motion(phase), &|at| MASS * at[2] + size * at[1].signum(), seed, 0.02);
        let (mut random, mut slow) = (Random::new(seed + 7), 0.0);
        let joint = &mut log.joints[0];
        joint.q.iter_mut().for_each(|q| *q = (*q / step).round() * step);
        joint.step = Some(step);
        for torque in joint.tau.iter_mut().flatten() {
            slow += STEP_S * TAU * 3.0 * (7.3 * random.normal() - slow);
            *torque += force * slow;
        }
        log
    };
    let (found, candidates) = diagnosed(SLED, [made(0.0, 1), made(0.8, 2)]);
    let named = found.effects.iter().filter(|one| one.is_named);
    let names = named.map(|one| candidates[one.candidate].effect.clone()).collect();
    let most = found.effects.iter().map(|one| one.size).fold(0.0, f64::max);
    (names, found.leftovers[0].share / most)
}

/// An encoder of few steps makes noise that is strong where the motion is: friction has its name
/// beside it. As large a force that no sensor makes leaves open what is there.
#[test]
fn friction_has_its_name_beside_noise_of_its_sensors() {
    let (names, left) = friction(0.2, 1e-3, 0.0);
    assert!(names == ["coulomb"] && left > 0.35, "{names:?} {left}");
    let (names, left) = friction(0.07, 1e-5, 0.5);
    assert!(names.is_empty() && left > 0.35, "{names:?} {left}");
}
