//! A separating experiment for TUlip's leg behind springs: what a slow motion leaves ambiguous at a
//! motor is told along the motion that is computed for it, followed by the plant of the blind
//! battery.

use denavit_blind::conditions::{Disturbance, Recording};
use denavit_blind::experiment::{Control, Log, Sensors, measure, run};
use denavit_blind::hidden::{Hidden, Law, Shape};
use denavit_blind::nominal::Nominal;
use denavit_blind::plant::Plant;
use denavit_blind::random::Random;
use denavit_blind::reference::Reference;
use denavit_blind::robots::{Robot, robot};
use denavit_codegen::effect;
use denavit_codegen::regressor::functions::modelled;
use denavit_diagnose::{
    BeforeSprings, Candidate, Diagnosis, ExperimentOptions, Request, SearchOptions, Uncertainty,
    before_springs, candidates, diagnose, spring_candidates,
};
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_plants::regression::RegressionModel;
use serde_json::{Value, json};

const KNEE: usize = 3;
/// What brakes the motor of the knee [N m s/rad].
const VISCOUS: f64 = 0.8;

/// The leg without dry friction, so that nothing sticks in a slow motion.
fn leg() -> Robot {
    let mut leg = robot(5);
    leg.joints.iter_mut().for_each(|joint| joint.drive.coulomb = 0.0);
    leg
}

/// The leg as it really is.
fn truth(leg: &Robot) -> Plant {
    let (law, shape) = (Law::Viscous, Shape::default());
    let brake = Hidden { law, variant: 0, joint: KNEE, other: KNEE, size: VISCOUS, shape };
    Plant::new(leg, vec![brake])
}

/// The model file, with the limits that an experiment needs.
fn model(nominal: &Nominal) -> Value {
    let mut file = nominal.file();
    for (joint, link) in nominal.robot.joints.iter().zip(file["links"].as_array_mut().unwrap()) {
        let range = joint.range;
        link["limits"] = json!({
            "position": [range.middle - range.reach, range.middle + range.reach],
            "velocity": range.rate, "acceleration": 10.0 * range.rate,
        });
    }
    file
}

fn measured(log: &Log, leg: &Robot, resolution: f64) -> MeasuredLog {
    let joint = |(index, joint): (usize, &denavit_blind::robots::Joint)| {
        let gear = joint.drive.gear;
        let (tau, sprung) = (log.tau[index].clone(), joint.drive.spring.is_some());
        let motor = || log.motor[index].iter().map(|angle| gear * angle).collect();
        JointSignals {
            q: log.q[index].clone(),
            step: Some(resolution),
            motor: sprung.then(motor),
            motor_step: sprung.then_some(gear * resolution),
            motor_torque: sprung.then(|| tau.iter().map(|torque| torque / gear).collect()),
            tau: Some(tau),
            ..JointSignals::default()
        }
    };
    MeasuredLog {
        file: "made".to_owned(),
        step_s: log.step_s,
        joints: leg.joints.iter().enumerate().map(joint).collect(),
        ..MeasuredLog::default()
    }
}

/// The diagnosis of two motions.
fn diagnosed(references: [&Reference; 2]) -> (Diagnosis, Vec<Candidate>) {
    let leg = leg();
    let nominal =
        Nominal { robot: leg.clone(), relative_std: 0.01, friction_std: 0.01, coriolis: true };
    let control =
        Control { steps: 4, loop_rate: 40.0, damping: 0.9, gravity: true, friction: false };
    let resolution = 1e-5;
    let noise = vec![0.03; leg.joints.len()];
    let sensors =
        Sensors { steps: 8, resolution, encoder_noise: 0.0, torque_noise: noise, rate_noise: None };
    let logs = [("one", references[0]), ("other", references[1])].map(|(seed, reference)| {
        let mut calm = Disturbance::new(&[], Random::new(1, "calm"));
        let run = run(&truth(&leg), &nominal, &control, reference, 15.0, &mut calm);
        let (run, whole) = (run.expect("it follows"), Recording::default());
        let mut times = Random::new(1, "times");
        let log = measure(&run, &sensors, &[], &mut Random::new(1, seed), &whole, &mut times);
        measured(&log, &leg, resolution)
    });
    let file = model(&nominal).to_string();
    let robot = denavit_codegen::model::read("leg", file.as_bytes()).expect("a model");
    let regression = |robot| RegressionModel::new(robot, modelled(robot), &[]).expect("parameters");
    let joints = regression(&robot).joints;
    let [mut train, mut held_out] = logs.map(|log| vec![log]);
    let before = before_springs(&robot, &joints, &mut [&mut train, &mut held_out]);
    let BeforeSprings { robot, springs } = before.expect("the logs have the motors");
    let model = regression(&robot);
    let mut all = candidates(effect::catalogue(), &robot, &model);
    all.append(&mut spring_candidates(effect::catalogue(), &springs, &model));
    let options = ExperimentOptions { starts: 3, steps: 4, draws: 5, ..Default::default() };
    let request = Request {
        model: &model,
        springs: &springs,
        train,
        held_out,
        candidates: &all,
        given: Vec::new(),
        aliases: None,
        experiment: Some((&robot, options)),
        moved: None,
        uncertainty: Uncertainty::default(),
        options: SearchOptions::default(),
        filters: None,
    };
    let found = diagnose(request, &mut |_| true).expect("logs that say something");
    (found, all)
}

/// What an experiment asks for, begun later in its lap.
fn along(file: &Value, leg: &Robot, later: f64) -> Reference {
    let list = |value: &Value| -> Vec<f64> {
        value.as_array().unwrap().iter().map(|entry| entry.as_f64().unwrap()).collect()
    };
    let of = |joint: &denavit_blind::robots::Joint| {
        let own = &file["joints"][joint.name]["fourier"];
        let (sines, cosines) = (list(&own["sines"]), list(&own["cosines"]));
        let waves = sines.into_iter().zip(cosines).enumerate();
        let wave = |(order, (sine, cosine)): (usize, (f64, f64))| {
            [sine.hypot(cosine), cosine.atan2(sine) + (order + 1) as f64 * later]
        };
        (own["offset"].as_f64().unwrap(), waves.map(wave).collect())
    };
    Reference::of_waves(file["duration_s"].as_f64().unwrap(), leg.joints.iter().map(of))
}

fn names(found: &Diagnosis, all: &[Candidate]) -> Vec<String> {
    let [one] = &found.effects[..] else { panic!("{:?}", found.reasons) };
    let others = one.alternatives.iter().map(|other| other.candidate);
    std::iter::once(one.candidate).chain(others).map(|one| all[one].name()).collect()
}

#[test]
fn friction_of_a_motor_behind_a_spring_is_told_along_the_motion_that_is_computed_for_it() {
    let (right, rival) = ("viscous at knee", "shear_thinning at knee");
    let leg = leg();
    let slow = |lap_s: f64, reach: f64, seed: u64| {
        Reference::draw(&leg, lap_s, [reach, reach], &mut Random::new(seed, "slow"))
    };
    let (found, all) = diagnosed([&slow(4.0, 0.06, 1), &slow(3.5, 0.05, 2)]);
    let said = names(&found, &all);
    assert!(said.iter().any(|one| one == right) && said.iter().any(|one| one == rival), "{said:?}");
    let experiment = found.effects[0].experiment.as_ref().expect("asked for");
    let experiment = experiment.as_ref().expect("the leg has limits");
    let separations = [experiment.separation, experiment.separation_before];
    // against three rivals at once, of which one may be nearly the same
    assert!(experiment.power > 0.6, "{}", experiment.power);
    assert!(separations[0] > 3.0 * separations[1], "{separations:?}");
    let motions = [0.0, 2.3].map(|later| along(&experiment.file, &leg, later));
    let (found, all) = diagnosed(motions.each_ref());
    let said = names(&found, &all);
    assert_eq!(said[0], right, "{said:?}");
    assert!(!said.iter().any(|one| one == rival), "{said:?}");
}
