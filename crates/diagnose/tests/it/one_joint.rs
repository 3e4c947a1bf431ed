//! Robots of one joint, by hand: their torques in closed form along any motion, and their
//! diagnosis.

use denavit_codegen::alias::ExactAliases;
use denavit_codegen::effect;
use denavit_codegen::regressor::functions::modelled;
use denavit_diagnose::{Candidate, Diagnosis, Moved, Progress, Request, candidates, diagnose};
use denavit_measure::Split;
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_numerics::Random;
use denavit_plants::regression::RegressionModel;

pub(super) const STEP_S: f64 = 0.002;

/// Position, rate and acceleration.
pub(super) type Motion<'m> = &'m dyn Fn(f64) -> [f64; 3];

/// A log along a motion, with noise of the torque and steps of the encoder.
pub(super) fn log(
    motion: Motion<'_>,
    torque: &dyn Fn([f64; 3]) -> f64,
    seed: u64,
    noise: f64,
) -> MeasuredLog {
    let mut random = Random::new(seed);
    let step = 1.0 / 100_000.0;
    let (mut q, mut tau) = (Vec::new(), Vec::new());
    for k in 0..7500 {
        let at = motion(STEP_S * f64::from(k));
        q.push((at[0] / step).round() * step);
        tau.push(torque(at) + noise * random.normal());
    }
    MeasuredLog {
        file: format!("made {seed}"),
        step_s: STEP_S,
        joints: vec![JointSignals {
            q,
            tau: Some(tau),
            step: Some(step),
            ..JointSignals::default()
        }],
        ..MeasuredLog::default()
    }
}

/// What a model lacks by two logs, with names of candidates.
pub(super) fn diagnosed(source: &str, logs: [MeasuredLog; 2]) -> (Diagnosis, Vec<Candidate>) {
    diagnosed_while(source, logs, &mut |_| true)
}

/// The same as long as `watch` says so.
pub(super) fn diagnosed_while(
    source: &str,
    [train, held_out]: [MeasuredLog; 2],
    watch: &mut dyn FnMut(&Progress) -> bool,
) -> (Diagnosis, Vec<Candidate>) {
    let robot = denavit_codegen::model::read("by hand", source.as_bytes()).expect("a model");
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("parameters");
    let all = candidates(effect::catalogue(), &robot, &model);
    let aliases = ExactAliases::new(&robot, effect::catalogue());
    let logs = Split { train: vec![train.clone()], held_out: vec![held_out.clone()] };
    let moved = Moved { source, effects: effect::catalogue(), numbers: &[], logs };
    let request = Request {
        model: &model,
        springs: &[],
        train: vec![train],
        held_out: vec![held_out],
        candidates: &all,
        given: Vec::new(),
        aliases: aliases.as_ref(),
        experiment: Some((&robot, 1)),
        moved: Some(&moved),
        most_effects: 6,
        filters: None,
    };
    let found = diagnose(request, watch).expect("a diagnosis");
    (found, all)
}
