//! The experiment of thesis 3.3.4 as a simulation: two stiff and three series elastic joints.

use denavit::identify::condition::{Conditioning, Filter};
use denavit::identify::log::{ColumnMapping, LogOf, MeasuredLog, read_log};
use denavit::identify::two_stage::{TwoStage, TwoStageError, two_stage};
use denavit::model;
use denavit::plants::PlantModel;
use denavit::plants::regression::{CoulombLaw, RegressionModel};
use denavit::regressor::RegressorOptions;
use denavit::shipped;
use denavit::simulate::scenario;

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

fn identified(
    plant: &PlantModel,
    log: &MeasuredLog,
    law: CoulombLaw,
) -> Result<TwoStage, TwoStageError> {
    let mut model = regression();
    model.law = law;
    two_stage(plant, &model, log, [&how(100.0, 1), &how(40.0, 5)])
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
        for found in [spring, &sharp.springs[joint]] {
            assert!((found.stiffness.value / stiffness - 1.0).abs() < 0.01, "{found:?}");
        }
        assert!((spring.viscous.value / viscous - 1.0).abs() < 0.05, "{spring:?}");
        assert!((spring.coulomb.value / coulomb[joint] - 1.0).abs() < 0.02, "{spring:?}");
        assert!(spring.residual < sharp.springs[joint].residual, "the law that is true fits best");
    }
    let model = regression();
    let mut inside = 0;
    for (parameter, found) in model.listed.iter().zip(&smooth.listed) {
        let truth = parameter.value.expect("the model has values");
        let apart = (found.value - truth).abs() / found.std;
        println!("{}: {} for {truth}, {apart:.2} errors", parameter.name, found.value);
        assert!(apart < 5.0, "{}: {} for {truth}", parameter.name, found.value);
        inside += usize::from(apart < 2.0);
    }
    assert!(inside >= 14, "{inside} of 18 parameters of the load within two standard errors");
}

#[test]
fn logs_without_a_signal_are_refused() {
    let (plant, log) = experiment();
    let joint = |name: &str| plant.find_joint(name).expect("a joint");
    let refused = |column: &str, without: &dyn Fn(&mut MeasuredLog)| {
        let mut log = log.clone();
        without(&mut log);
        let error = identified(&plant, &log, CoulombLaw::Sign).expect_err(column);
        assert_eq!(error, TwoStageError::MissingColumn(column.to_owned()));
    };
    refused("motor_knee", &|log| log.joints[joint("knee")].motor = None);
    refused("tau_hip_x", &|log| log.joints[joint("hip_x")].tau = None);
    refused("tau_cmd_ankle_y", &|log| log.joints[joint("ankle_y")].motor_torque = None);
}
