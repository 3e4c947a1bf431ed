//! A robot that stands on the ground: TUlip's step, with a spring in one knee that its model lacks.

use super::identified::walked;
use denavit::diagnose::{Filters, Request, candidates, diagnose};
use denavit::effect;
use denavit::measure::log::{ColumnMapping, LogFault, LogOf, MeasuredLog, read_log};
use denavit::numerics::Random;
use denavit::plants::regression::RegressionModel;
use denavit::regressor::functions::modelled;
use denavit::replay::Ground;
use denavit::shipped;

const STIFFNESS: f64 = 60.0;
const SLACK_BELOW_RAD: f64 = 0.9;

/// TUlip's file, with the spring or without.
fn tulip(has_spring: bool) -> String {
    let shipped = shipped::find("tulip").expect("shipped");
    let mut text: serde_json::Value = serde_json::from_str(shipped.text).expect("JSON");
    if has_spring {
        text["effects"] = serde_json::json!([{
            "effect": "one_sided_spring", "at": {"link": "left_knee"},
            "parameters": {"k": STIFFNESS, "q_0": SLACK_BELOW_RAD},
        }]);
    }
    text.to_string()
}

/// A step of the robot with the spring as instruments see it.
fn step(model: &RegressionModel, length_m: f64, seed: u64) -> MeasuredLog {
    let mut log = walked(model, length_m, &|_| Ok(tulip(true).into_bytes()));
    let mut random = Random::new(seed);
    let torques = log.joints.iter_mut().filter_map(|joint| joint.tau.as_mut());
    for tau in torques.flatten() {
        *tau += 0.05 * random.normal();
    }
    for force in log.contacts.iter_mut().flat_map(|(_, axes)| axes).flatten() {
        *force += 0.5 * random.normal();
    }
    for joint in &mut log.joints {
        joint.q.iter_mut().for_each(|q| *q += 5e-6 * random.normal());
        (joint.qd, joint.qdd) = (None, None);
    }
    log
}

/// TUlip's logs are looked at together with the wrench that the ground puts on its base.
#[test]
fn a_spring_in_the_knee_of_a_robot_that_steps_is_named() {
    let robot = denavit::model::read("tulip.json", tulip(false).as_bytes()).expect("a model");
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("a regression");
    let mut ground = Ground::under(&robot, &model).expect("a plant").expect("a floating base");
    let mut log = |length_m, seed| {
        let mut log = step(&model, length_m, seed);
        ground.load(&mut log);
        log
    };
    let (train, held_out) = (vec![log(0.1, 3)], vec![log(0.07, 4)]);
    let mut candidates = candidates(effect::catalogue(), &robot, &model);
    let tried =
        ["one_sided_spring", "one_sided_spring_below", "spring", "viscous", "payload_point"];
    candidates.retain(|one| tried.contains(&one.effect.as_str()));
    let request = Request {
        model: &model,
        springs: &[],
        train,
        held_out,
        candidates: &candidates,
        given: Vec::new(),
        aliases: None,
        experiment: None,
        moved: None,
        most_effects: 6,
        filters: Some(Filters { motion_hz: 30.0, torque_hz: 15.0 }),
    };
    let found = diagnose(request, &mut |_| true).unwrap_or_else(|error| panic!("{error}"));
    let names: Vec<String> =
        found.effects.iter().map(|one| candidates[one.candidate].name()).collect();
    assert_eq!(names, ["one_sided_spring at left_knee"]);
    let expected = [("k", STIFFNESS, 0.01 * STIFFNESS), ("q_0", SLACK_BELOW_RAD, 0.005)];
    for (own, (name, value, tolerance)) in found.effects[0].parameters.iter().zip(expected) {
        assert_eq!(own.name, name);
        assert!((own.value - value).abs() < tolerance, "{name}: {} for {value}", own.value);
    }
    let knee = model.joints.iter().position(|joint| joint.name == "left_knee").expect("a knee");
    let [before, after] =
        [&found.held_out.before, &found.held_out.after].map(|gap| gap.per_joint[knee]);
    assert!(after.expect("a torque") < 0.1 * before.expect("a torque"), "{before:?} {after:?}");
}

/// Without its forces the weight of a robot that floats would rest on nothing.
#[test]
fn a_log_of_a_floating_base_has_forces_of_all_contacts() {
    let robot = denavit::model::read("tulip.json", tulip(false).as_bytes()).expect("a model");
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("a regression");
    let contacts: Vec<String> =
        robot.contacts.values().map(|contact| contact.name.clone()).collect();
    let joints = model.joints.iter().map(|joint| format!("q_{}", joint.name));
    let axes = |name: &String| ["x", "y", "z"].map(|axis| format!("f_{name}_{axis}"));
    let forces: Vec<String> = contacts.iter().flat_map(axes).collect();
    let read = |forces: &[String], mapping: &str| {
        let names: Vec<String> = joints.clone().chain(forces.iter().cloned()).collect();
        let mut csv = format!("t,{}\n", names.join(","));
        for k in 0..200 {
            let t = 0.01 * f64::from(k);
            let value = |row: usize| format!(",{}", 0.1 * (t * (2.0 + row as f64)).sin());
            csv += &format!("{t}{}\n", (0..names.len()).map(value).collect::<String>());
        }
        let of = LogOf {
            model: &model.model,
            joints: &model.joints,
            contacts: &contacts,
            accepts_suspicious: true,
        };
        let mapping = ColumnMapping::from_json("map.json", mapping.as_bytes()).expect("a mapping");
        read_log("step.csv", csv.as_bytes(), of, &mapping)
            .map_err(|error| error.log_faults().expect("faults").faults.clone())
    };
    assert!(read(&forces, "{}").is_ok());
    let missing = LogFault::MissingForces { columns: forces[3..].to_vec() };
    assert_eq!(read(&forces[..3], "{}").unwrap_err(), [missing]);
    let never = forces[3..].iter().map(|name| format!("\"{name}\": null"));
    let mapping = format!("{{{}}}", never.collect::<Vec<_>>().join(","));
    assert!(read(&forces[..3], &mapping).is_ok());
    // What carries the weight cannot be left out as a whole.
    let all = forces.iter().map(|name| format!("\"{name}\": null"));
    let mapping = format!("{{{}}}", all.collect::<Vec<_>>().join(","));
    assert_eq!(read(&[], &mapping).unwrap_err(), [LogFault::MissingForces { columns: forces }]);
}
