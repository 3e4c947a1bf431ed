//! The experiment of thesis 3.3.4 as a simulation: two stiff and three series elastic joints.

use denavit_codegen::model;
use denavit_codegen::regressor::RegressorOptions;
use denavit_elastic::{TwoStage, TwoStageOptions, two_stage};
use denavit_identify::estimate::SlowRows;
use denavit_identify::{Error, ErrorKind};
use denavit_measure::condition::{Conditioning, Filter};
use denavit_measure::log::{ColumnMapping, LogOf, MeasuredLog, read_log};
use denavit_plants::PlantModel;
use denavit_plants::regression::{CoulombLaw, RegressionModel};
use denavit_plants::shipped;
use denavit_simulate::scenario;

/// The leg with the weight on its foot that the scenario has.
fn regression() -> RegressionModel {
    let shipped = shipped::find("tulip_leg").expect("a shipped model");
    let mut weighted: serde_json::Value = serde_json::from_str(shipped.text).expect("JSON");
    for (unknown, value) in [("m6", 2.367), ("c6x", -0.08)] {
        weighted["unknowns"][unknown]["value"] = value.into();
    }
    let robot = model::read(shipped.name, weighted.to_string().as_bytes()).expect("sound");
    let with =
        RegressorOptions { friction: true, only_modelled: true, ..RegressorOptions::default() };
    RegressionModel::new(&robot, with, &[]).expect("a regression model")
}

fn experiment() -> (PlantModel, MeasuredLog) {
    let shipped = shipped::find_scenario("tulip_leg_elastic_identification").expect("shipped");
    let load = |name: &str| {
        let found = shipped::find_referred(name).ok_or("no such file")?;
        Ok(found.text.as_bytes().to_vec())
    };
    let read = scenario::read(shipped.name, shipped.text.as_bytes(), &load);
    let mut scenario = read.unwrap_or_else(|error| panic!("{error}"));
    let run = scenario.run().unwrap_or_else(|error| panic!("{error}"));
    let model = regression();
    let of = LogOf {
        model: &model.model,
        joints: &model.joints,
        contacts: &[],
        // springs let the joints swing beyond the limits of the trajectory
        accepts_suspicious: true,
    };
    let csv = run.log.to_csv();
    let log = read_log("log.csv", csv.as_bytes(), of, &ColumnMapping::default());
    (scenario.plant.model().clone(), log.unwrap_or_else(|faults| panic!("{faults}")))
}

fn how(cutoff_hz: f64, decimation: usize) -> Conditioning {
    let filter = Some(Filter { order: 4, cutoff_hz });
    Conditioning { filter, decimation, ..Conditioning::default() }
}

fn identified(plant: &PlantModel, log: &MeasuredLog, law: CoulombLaw) -> Result<TwoStage, Error> {
    let mut model = regression();
    model.law = law;
    let slow = SlowRows::default();
    let options = TwoStageOptions { of_springs: how(100.0, 1), of_load: how(100.0, 10), slow };
    two_stage(plant, &model, log, &options)
}

#[test]
fn springs_friction_and_load_come_out() {
    let (plant, log) = experiment();
    let sharp = identified(&plant, &log, CoulombLaw::Sign).expect("it moves");
    // the simulation's friction is a steep line below 0.01 rad/s of a joint
    let smooth = identified(&plant, &log, CoulombLaw::Tanh(0.01)).expect("it moves");
    // table 3.5
    let printed = [(83008.0, 0.00008), (59966.0, 0.00008), (51394.0, 0.00004)];
    let coulomb = [0.00456, 0.00268, 0.01178];
    for (joint, (stiffness, viscous)) in printed.into_iter().enumerate() {
        let spring = &smooth.springs[joint];
        // the sign finds as much, since motors near their reversals do not count
        for found in [spring, &sharp.springs[joint]] {
            assert!((found.stiffness.value / stiffness - 1.0).abs() < 0.01, "{found:?}");
            assert!((found.viscous.value / viscous - 1.0).abs() < 0.01, "{found:?}");
            assert!((found.coulomb.value / coulomb[joint] - 1.0).abs() < 0.005, "{found:?}");
        }
    }
    let model = regression();
    for listed in [&smooth.listed, &sharp.listed] {
        let mut inside = 0;
        for (parameter, found) in model.listed.iter().zip(listed) {
            let truth = parameter.value.expect("the model has values");
            let apart = (found.value - truth).abs() / found.std;
            assert!(apart < 3.5, "{}: {} for {truth}", parameter.name, found.value);
            inside += usize::from(apart < 2.0);
        }
        assert!(inside >= 16, "{inside} of 18 parameters of the load within two standard errors");
    }
}

#[test]
fn logs_without_a_signal_are_refused() {
    let (plant, log) = experiment();
    let joint = |name: &str| plant.find_joint(name).expect("a joint");
    let refused = |column: &str, without: &dyn Fn(&mut MeasuredLog)| {
        let mut log = log.clone();
        without(&mut log);
        let error = identified(&plant, &log, CoulombLaw::Sign).expect_err(column);
        assert_eq!(error.kind(), ErrorKind::MissingColumn);
        assert_eq!(error.column().as_deref(), Some(column));
    };
    refused("motor_knee", &|log| log.joints[joint("knee")].motor = None);
    refused("tau_hip_x", &|log| log.joints[joint("hip_x")].tau = None);
    refused("tau_cmd_ankle_y", &|log| log.joints[joint("ankle_y")].motor_torque = None);
}

/// Columns that are not what they are taken for have a hint that mends them; an encoder whose zero
/// is elsewhere has none, and changes nothing but that zero.
#[test]
fn motors_are_checked_against_their_joints() {
    let (plant, log) = experiment();
    let knee = plant.find_joint("knee").expect("a joint");
    let sound = identified(&plant, &log, CoulombLaw::Tanh(0.01)).expect("it moves");
    let with = |angle: &dyn Fn(f64) -> f64, torque: f64| {
        let mut log = log.clone();
        let own = &mut log.joints[knee];
        own.motor.iter_mut().flatten().for_each(|value| *value = angle(*value));
        own.motor_torque.iter_mut().flatten().for_each(|value| *value *= torque);
        identified(&plant, &log, CoulombLaw::Tanh(0.01))
    };
    let drive = plant.joints[knee].drive.expect("a drive");
    let spring = drive.series_elastic.expect("a spring");
    let turns = drive.gear_ratio * spring.load_radius / spring.motor_radius;
    for factor in [-1.0, 1.0 / turns, 1.0_f64.to_radians().recip()] {
        let error = with(&|angle| factor * angle, 1.0).expect_err("another angle");
        assert_eq!(error.kind(), ErrorKind::Contradicting);
        assert_eq!(error.column().as_deref(), Some("motor_knee"));
        let scale = error.scale().expect("a known mistake");
        assert!((scale * factor - 1.0).abs() < 1e-9, "{factor}: {scale}");
    }
    for factor in [-1.0, turns, 1.0 / turns] {
        let error = with(&|angle| angle, factor).expect_err("another torque");
        assert_eq!(error.kind(), ErrorKind::Contradicting);
        assert_eq!(error.column().as_deref(), Some("tau_cmd_knee"));
        let scale = error.scale().expect("a known mistake");
        assert!((scale * factor - 1.0).abs() < 1e-9, "{factor}: {scale}");
    }
    let moved = with(&|angle| angle + 10.0, 1.0).expect("only its zero is another");
    let place = sound.springs.iter().position(|one| one.joint == "knee").expect("a spring");
    let [a, b] = [&sound, &moved].map(|both| &both.springs[place]);
    assert!((b.stiffness.value / a.stiffness.value - 1.0).abs() < 1e-6);
    assert!((b.motor_zero.value - a.motor_zero.value - 10.0).abs() < 1e-6, "{b:?}");
    for (a, b) in sound.listed.iter().zip(&moved.listed) {
        assert!((a.value - b.value).abs() < 1e-3 * a.std, "{a:?} {b:?}");
    }
}

#[test]
fn a_spring_that_is_not_seen_is_refused() {
    let (plant, mut log) = experiment();
    let knee = plant.find_joint("knee").expect("a joint");
    let drive = plant.joints[knee].drive.expect("a drive");
    let spring = drive.series_elastic.expect("a spring");
    let turns = drive.gear_ratio * spring.load_radius / spring.motor_radius;
    // a motor angle that was made from the joint's, and what no torque makes
    let made = log.joints[knee].q.iter().enumerate();
    let made = made.map(|(k, q)| turns * (q + 0.02 * (0.0017 * k as f64).sin()));
    log.joints[knee].motor = Some(made.collect());
    let error = identified(&plant, &log, CoulombLaw::Sign).expect_err("no spring");
    assert_eq!(error.kind(), ErrorKind::NotExcited, "{error}");
    assert!(error.to_string().contains("no spring is seen"), "{error}");
}
