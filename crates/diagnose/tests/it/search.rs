//! The search alone: laws by hand, hidden in motion that is given.

use super::laws::{Handwritten, Sample, kinds};
use denavit_codegen::effect::Occurrence;
use denavit_codegen::regressor::{RegressorOptions, Unknowns};
use denavit_diagnose::{Candidate, Gap, Gaps, Nominal, Request, diagnose, share_closed};
use denavit_measure::JointIndex;
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_numerics::Random;
use denavit_plants::regression::RegressionModel;
use std::f64::consts::TAU;

const STEP_S: f64 = 0.002;

pub(super) fn puma() -> RegressionModel {
    puma_of(true)
}

/// The arm with its drives or with rigid bodies alone.
fn puma_of(has_drives: bool) -> RegressionModel {
    let robot = super::robot("puma560");
    let options = RegressorOptions {
        friction: has_drives,
        rotor: has_drives,
        offset: false,
        only_modelled: true,
        unknowns: Unknowns::default(),
    };
    RegressionModel::new(&robot, options, &[]).expect("a regression")
}

/// A log of periodic motion, whose torques are those of the rows with phi, and more.
fn log(
    model: &RegressionModel,
    seed: u64,
    samples: usize,
    phi: &[f64],
    hidden: impl Fn(usize, Sample) -> f64,
) -> MeasuredLog {
    let mut random = Random::new(seed);
    let n = model.joints.len();
    let waves: Vec<Vec<[f64; 3]>> = (0..n)
        .map(|_| {
            (1..=5)
                .map(|k| {
                    let w = TAU * f64::from(k) / 5.0;
                    [0.5 / f64::from(k) * random.normal(), w, TAU * random.uniform()]
                })
                .collect()
        })
        .collect();
    let mut motion = vec![Vec::new(); 3 * n];
    for k in 0..samples {
        let t = STEP_S * k as f64;
        for (joint, waves) in waves.iter().enumerate() {
            let sum = |f: &dyn Fn(&[f64; 3]) -> f64| waves.iter().map(f).sum::<f64>();
            motion[joint].push(sum(&|[a, w, p]| a * (w * t + p).sin()));
            motion[n + joint].push(sum(&|[a, w, p]| a * w * (w * t + p).cos()));
            motion[2 * n + joint].push(sum(&|[a, w, p]| -a * w * w * (w * t + p).sin()));
        }
    }
    let columns: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
    let mut rows = denavit_plants::regression::RegressionRows::default();
    model.evaluator().evaluate(&columns, &mut rows).expect("columns");
    let mut joints = Vec::new();
    for joint in 0..n {
        let own: Vec<f64> = model.pattern()[joint].iter().map(|&place| phi[place]).collect();
        let mut torque = vec![0.0; samples];
        rows.torque(joint, &own, &mut torque);
        let noise = 0.01 * denavit_numerics::rms(&torque);
        for (k, torque) in torque.iter_mut().enumerate() {
            let at = |part: usize| motion[part * n + joint][k];
            let load = *torque;
            let sample = Sample { q: at(0), qd: at(1), qdd: at(2), load, load_rate: 0.0 };
            *torque += hidden(joint, sample) + noise * random.normal();
        }
        let q = motion[joint].iter().map(|q| (q * 20_000.0).round() / 20_000.0).collect();
        joints.push(JointSignals {
            q,
            tau: Some(torque),
            step: Some(1.0 / 20_000.0),
            ..JointSignals::default()
        });
    }
    MeasuredLog { file: "made".to_owned(), step_s: STEP_S, joints, ..MeasuredLog::default() }
}

pub(super) fn puma_log(model: &RegressionModel, phi: &[f64]) -> MeasuredLog {
    log(model, 3, 3000, phi, |_, _| 0.0)
}

fn candidates(model: &RegressionModel) -> Vec<Candidate> {
    let mut all = Vec::new();
    for (joint, described) in model.joints.iter().enumerate() {
        for (name, parameters, at) in kinds() {
            all.push(Candidate {
                effect: name.to_owned(),
                title: name.to_owned(),
                at: described.name.clone(),
                joint: Some(JointIndex(joint)),
                is_behind_spring: false,
                is_body: false,
                occurrence: match name {
                    "viscous" | "coulomb" | "offset" | "rotor_inertia" => Occurrence::Standard,
                    "smoothed_coulomb" => Occurrence::Uncommon,
                    _ => Occurrence::Common,
                },
                refines: Vec::new(),
                law: Box::new(Handwritten {
                    parameters,
                    joint,
                    follows_accelerations: ["rotor_inertia", "torque_gain", "delay"]
                        .contains(&name),
                    at,
                }),
            });
        }
    }
    all
}

/// The names that are found where `hidden` is in the data, and the share of a joint's gap that is
/// closed.
fn found(
    hidden: impl Fn(usize, Sample) -> f64,
    seed: u64,
    joint: usize,
) -> (Vec<String>, Option<f64>) {
    found_beside(&puma(), hidden, seed, joint)
}

/// The same beside a model of the arm.
fn found_beside(
    model: &RegressionModel,
    hidden: impl Fn(usize, Sample) -> f64,
    seed: u64,
    joint: usize,
) -> (Vec<String>, Option<f64>) {
    let nominal = Nominal::new(model);
    let mut random = Random::new(seed);
    let truth: Vec<f64> = (0..nominal.len()).map(|_| random.normal().clamp(-0.9, 2.0)).collect();
    let phi = nominal.phi(&truth);
    let made = |seed| vec![log(model, seed, 7500, &phi.axes, &hidden)];
    let candidates = candidates(model);
    let request = Request {
        model,
        springs: &[],
        train: made(seed + 1),
        held_out: made(seed + 2),
        candidates: &candidates,
        given: Vec::new(),
        aliases: None,
        experiment: None,
        moved: None,
        most_effects: 16,
        filters: None,
    };
    let found = diagnose(request, &mut |_| true).expect("a diagnosis");
    for step in &found.steps {
        eprintln!("{} {step:?}", candidates[step.added].name());
    }
    let names = found.effects.iter().map(|one| candidates[one.candidate].name()).collect();
    let Gaps { before, after, floor, .. } = found.held_out;
    let at = |gap: &Gap| gap.per_joint[joint].expect("measured");
    (names, share_closed(at(&before), at(&after), at(&floor)))
}

#[test]
fn a_hidden_law_is_named() {
    let (names, share) = found(
        |joint, s| {
            if joint == 2 { 1.5 * (-(s.qd / 0.2).powi(2)).exp() * s.qd.signum() } else { 0.0 }
        },
        7,
        2,
    );
    assert_eq!(names, ["stribeck at elbow"]);
    assert!(share.is_some_and(|share| share > 0.9), "{share:?}");
}

#[test]
fn nothing_is_found_where_nothing_is_hidden() {
    let (names, _) = found(|_, _| 0.0, 21, 2);
    assert_eq!(names, [""; 0]);
}

#[test]
fn two_laws_are_named() {
    let (mut names, share) = found(
        |joint, s| match joint {
            2 => 1.5 * (-(s.qd / 0.2).powi(2)).exp() * s.qd.signum(),
            4 => 0.8 * s.qd * s.qd.abs(),
            _ => 0.0,
        },
        40,
        4,
    );
    names.sort();
    assert_eq!(names, ["quadratic_drag at wrist_pitch", "stribeck at elbow"]);
    assert!(share.is_some_and(|share| share > 0.9), "{share:?}");
}

/// A rigid model lacks all friction, of which each joint's hides that of the others. A law that is
/// rounded a little at one joint is named so where nothing but noise is left beside it; and as what
/// it nearly is where something is left that no law explains.
#[test]
fn friction_of_all_drives_is_found_together_and_has_its_plain_names() {
    let size = [10.0, 20.0, 8.0, 0.6, 0.5, 0.3];
    let model = puma_of(false);
    for (unnamed, rounded) in [(0.0, "smoothed_coulomb"), (2.0, "coulomb")] {
        let hidden = |joint: usize, s: Sample| {
            let is_rounded = joint == 1;
            let dry = if is_rounded { (s.qd / 0.08).tanh() } else { s.qd.signum() };
            let more = if is_rounded { unnamed * (9.0 * s.q).sin() } else { 0.0 };
            size[joint] * (0.5 * s.qd + 0.25 * dry) + more
        };
        let (mut names, share) = found_beside(&model, hidden, 71, 1);
        names.sort();
        let names_of = |joint: usize| {
            let dry = if joint == 1 { rounded } else { "coulomb" };
            [dry, "viscous"].map(|name| format!("{name} at {}", model.joints[joint].name))
        };
        let mut expected: Vec<String> = (0..6).flat_map(names_of).collect();
        expected.sort();
        assert_eq!(names, expected);
        assert!(share.is_some_and(|share| share > 0.85), "{share:?}");
    }
}
