//! The experiment of thesis 3.3.4 as a simulation: two stiff and three series elastic joints.

use denavit::identify::condition::{Conditioning, Filter};
use denavit::identify::two_stage::{FrictionSign, TwoStage, TwoStageError, two_stage};
use denavit::model;
use denavit::plants::PlantModel;
use denavit::plants::regression::RegressionModel;
use denavit::regressor::RegressorOptions;
use denavit::shipped;
use denavit::simulate::{Log, scenario};

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

fn experiment() -> (PlantModel, Log) {
    let shipped = shipped::find_scenario("tulip_leg_elastic_identification").expect("shipped");
    let load = |name: &str| {
        let found = shipped::find_referred(name).ok_or("no such file")?;
        Ok(found.text.as_bytes().to_vec())
    };
    let read = scenario::read(shipped.name, shipped.text.as_bytes(), &load);
    let mut scenario = read.unwrap_or_else(|error| panic!("{error}"));
    let run = scenario.run().unwrap_or_else(|error| panic!("{error}"));
    (scenario.plant.model().clone(), run.log)
}

fn how(cutoff_hz: f64, decimation: usize) -> Conditioning {
    let filter = Some(Filter { order: 4, cutoff_hz });
    Conditioning { filter, decimation, ..Conditioning::default() }
}

fn identified(
    plant: &PlantModel,
    log: &Log,
    sign: FrictionSign,
) -> Result<TwoStage, TwoStageError> {
    two_stage(plant, &regression(), log, [&how(100.0, 1), &how(40.0, 5)], sign)
}

#[test]
fn springs_friction_and_load_come_out() {
    let (plant, log) = experiment();
    let sharp = identified(&plant, &log, FrictionSign::Sign).expect("it moves");
    // the simulation's friction is a steep line below 0.01 rad/s of a joint with a gear of 100
    let smooth = identified(&plant, &log, FrictionSign::Tanh(1.0)).expect("it moves");
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
        let is_load = !parameter.name.starts_with('f');
        if is_load {
            let apart = (found.value - truth).abs() / found.std;
            assert!(apart < 5.0, "{}: {} for {truth}", parameter.name, found.value);
            inside += usize::from(apart < 2.0);
        }
    }
    assert!(inside >= 10, "{inside} of 14 base parameters within two standard errors");
}

#[test]
fn logs_without_a_column_or_with_uneven_times_are_refused() {
    let (plant, log) = experiment();
    let without = |name: &str| {
        let mut log = log.clone();
        let at = log.columns.iter().position(|column| column == name).expect("a column");
        log.columns[at].push_str("_lost");
        log
    };
    for name in ["motor_knee", "q_hip_z", "tau_hip_x", "tau_cmd_ankle_y"] {
        let error = identified(&plant, &without(name), FrictionSign::Sign).expect_err(name);
        assert_eq!(error, TwoStageError::MissingColumn(name.to_owned()));
    }
    let mut uneven = log.clone();
    let last = uneven.values.len() - uneven.columns.len();
    uneven.values[last] += 0.5;
    let error = identified(&plant, &uneven, FrictionSign::Sign).expect_err("a gap");
    assert_eq!(error, TwoStageError::UnevenTime);
}
