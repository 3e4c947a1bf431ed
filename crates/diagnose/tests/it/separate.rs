//! Experiments that separate names: two effects that short motions do not tell apart, and what is
//! found along the motions that are computed for them.

use super::one_joint::{diagnosed, diagnosed_while, log};
use denavit_codegen::effect::find;
use denavit_diagnose::{Alternative, Progress, Verdict};
use denavit_excite::{ExciteOptions, check_trajectory};
use denavit_plants::trajectory::Reference;
use denavit_simulate::scenario::read_trajectory;
use std::f64::consts::TAU;

/// Mass 2 kg at 0.3 m with 0.05 kg m^2 about its centre, horizontal at 0.
pub(super) const INERTIA: f64 = 0.05 + 2.0 * 0.09;
pub(super) const WEIGHT: f64 = 2.0 * 0.3 * 9.81;

pub(super) const ROD: &str = r#"{
  "format": "denavit-model/1", "name": "rod", "convention": "standard",
  "gravity": [0, -9.81, 0],
  "links": [{
    "name": "rod",
    "joint": {"type": "revolute", "theta": 0, "d": 0, "a": 0.5, "alpha": 0},
    "limits": {"position": [-1.4, 1.4], "velocity": 4, "acceleration": 20, "torque": [-30, 30]},
    "body": {"mass": {"value": 2, "std": 0.01}, "com": [{"value": -0.2, "std": 0.001}, 0, 0],
             "about": "com", "inertia": {"xx": 0.001, "yy": 0.05, "zz": {"value": 0.05,
             "std": 0.001}, "xy": 0, "xz": 0, "yz": 0}}
  }]
}"#;

/// A small motion about a posture, of three sines.
fn small(about: f64, size: f64, phase: f64) -> impl Fn(f64) -> [f64; 3] {
    move |t| {
        let mut all = [about, 0.0, 0.0];
        for (k, share) in [(1.0, 1.0), (2.0, 0.5), (3.0, 0.3)] {
            let w = TAU * k / 5.0;
            let (sine, cosine) = (w * t + k * phase).sin_cos();
            let size = size * share;
            all[0] += size * sine;
            all[1] += size * w * cosine;
            all[2] -= size * w * w * sine;
        }
        all
    }
}

/// What an experiment asks for, lap after lap, from a moment on.
fn along(reference: &Reference, lap_s: f64, from_s: f64) -> impl Fn(f64) -> [f64; 3] {
    move |t| {
        let at = reference.at((t + from_s) % lap_s);
        [at.position, at.rate, at.acceleration]
    }
}

/// The first logs: a small motion about a posture, and noise of the torque [rad, N m].
struct Experience {
    about: f64,
    size: f64,
    noise: f64,
}

/// What is hidden is ambiguous in a small motion, with this rival among others; the experiment says
/// with which power it tells them apart, and does.
fn is_separated(
    hidden: impl Fn([f64; 3]) -> f64,
    name: &str,
    rival: &str,
    Experience { about, size, noise }: Experience,
) {
    let torque = |at: [f64; 3]| INERTIA * at[2] + WEIGHT * at[0].cos() + hidden(at);
    let logs = [(0.0, 1), (1.1, 2)]
        .map(|(phase, seed)| log(&small(about, size, phase), &torque, seed, noise));
    let (found, candidates) = diagnosed(ROD, logs);
    let [one] = &found.effects[..] else { panic!("{:?}", found.reasons) };
    let mut names = vec![candidates[one.candidate].effect.as_str()];
    names.extend(one.alternatives.iter().map(|one| candidates[one.candidate].effect.as_str()));
    assert!(names.contains(&name) && names.contains(&rival), "{names:?}");
    let experiment = one.experiment.as_ref().expect("asked for").as_ref().expect("limits");
    // against three rivals at once, of which one may be nearly the same
    assert!(experiment.power > 0.6, "{}", experiment.power);
    assert!(experiment.separation > 3.0 * experiment.separation_before, "{experiment:?}");
    let reference = &experiment.references[0];
    let lap_s = experiment.duration_s;
    // As a file, and by the one that checks trajectories.
    let bytes = serde_json::to_vec(&experiment.file).expect("JSON");
    let load = |_: &str| unreachable!("it refers to no log");
    let written = read_trajectory("experiment", &bytes, &load).expect("a trajectory");
    let robot = denavit_codegen::model::read("by hand", ROD.as_bytes()).expect("a model");
    let (check, _) = check_trajectory(&robot, &ExciteOptions::default(), &written).expect("limits");
    assert!(check.is_feasible(), "{check:?}");
    let logs = [(0.0, 3), (3.7, 4)]
        .map(|(from_s, seed)| log(&along(reference, lap_s, from_s), &torque, seed, noise));
    let (found, candidates) = diagnosed(ROD, logs);
    let [one] = &found.effects[..] else { panic!("{:?}", found.reasons) };
    assert_eq!(candidates[one.candidate].effect, name);
    let left: Vec<&str> =
        one.alternatives.iter().map(|one| candidates[one.candidate].effect.as_str()).collect();
    assert!(!left.contains(&rival), "{left:?}");
    assert_eq!(found.verdict, Verdict::Explained, "{left:?}");
}

#[test]
fn friction_is_told_from_friction_of_a_load_that_hardly_changes() {
    let logs = Experience { about: 0.0, size: 0.02, noise: 0.02 };
    is_separated(|[_, rate, _]| 2.0 * rate, "viscous", "load_viscous", logs);
}

/// What a finer form has more is nothing that these logs ask for: it is no rival of the plain name,
/// whose odds are those against others.
#[test]
fn finer_forms_of_a_law_are_no_rivals_of_it() {
    let torque = |at: [f64; 3]| INERTIA * at[2] + WEIGHT * at[0].cos() + 0.5 * at[1].signum();
    let logs = [(0.0, 1), (1.1, 2)]
        .map(|(phase, seed)| log(&small(0.0, 0.02, phase), &torque, seed, 0.05));
    let (found, candidates) = diagnosed(ROD, logs);
    let [one] = &found.effects[..] else { panic!("{:?}", found.reasons) };
    let name = |one: &Alternative| candidates[one.candidate].effect.as_str();
    let [finer, others] =
        [&one.finer, &one.alternatives].map(|all| all.iter().map(name).collect::<Vec<&str>>());
    assert_eq!(candidates[one.candidate].effect, "coulomb");
    assert!(finer.contains(&"asymmetric_coulomb"), "{finer:?}");
    for one in others {
        assert!(!find(one).expect("shipped").refines.contains(&"coulomb".to_owned()), "{one}");
    }
    assert_eq!(found.verdict, Verdict::Explained, "{:?}", found.reasons);
}

/// A search that is stopped has looked for no rivals, so that nothing is to be told apart.
#[test]
fn a_search_that_is_stopped_has_no_rivals() {
    let torque = |at: [f64; 3]| INERTIA * at[2] + WEIGHT * at[0].cos() + 0.5 * at[1].signum();
    let logs = [(0.0, 1), (1.1, 2)]
        .map(|(phase, seed)| log(&small(0.0, 0.02, phase), &torque, seed, 0.05));
    let mut watch =
        |progress: &Progress| !matches!(progress, Progress::Found(found) if !found.is_empty());
    let (found, _) = diagnosed_while(ROD, logs, &mut watch);
    let [one] = &found.effects[..] else { panic!("{:?}", found.reasons) };
    assert!(one.alternatives.is_empty() && one.finer.is_empty() && one.experiment.is_none());
    assert_eq!(found.verdict, Verdict::CannotTell);
}

#[test]
fn an_offset_is_told_from_a_wrong_zero_where_gravity_hardly_changes() {
    let logs = Experience { about: 0.9, size: 0.008, noise: 0.1 };
    is_separated(|_| 0.3, "torque_offset", "joint_zero", logs);
}
