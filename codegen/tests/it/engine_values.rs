//! Numbers of an independent rigid-body engine: tests/oracles/engine_values.json.

use crate::robots::repository;
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::function::FunctionName::{self, *};
use denavit_codegen::model::{self, Robot};
use denavit_codegen::program::{Evaluator, constant_values, lower, prelude_values};
use serde_json::{Value, json};

const FUNCTIONS: [FunctionName; 5] =
    [InverseDynamics, MassMatrix, GravityVector, Bias, CoriolisMatrix];

/// The largest difference allowed, relative to the largest entry.
const TOLERANCE: f64 = 1e-12;

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(entries) => entries.iter().flat_map(numbers).collect(),
        _ => vec![value.as_f64().unwrap()],
    }
}

/// A model of one of the engine's robots. Some of the random inertias are those of no body: the
/// check finds which, and they are then accepted by name.
fn model_of(robot: &Value) -> Robot {
    let mut file = file_of(robot);
    if let Err(error) = model::read("engine", file.to_string().as_bytes()) {
        for fault in &error.faults {
            let body = fault.pointer.split("/inertia").next().unwrap();
            let body = file.pointer_mut(body).unwrap_or_else(|| panic!("{error}"));
            body["accept_triangle_violation"] = json!("random numbers");
        }
    }
    model::read("engine", file.to_string().as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

/// The model file.
fn file_of(robot: &Value) -> Value {
    let quarter = |turns: &Value| format!("{turns}*pi/2");
    let rows = robot["dh"].as_array().unwrap().iter();
    let bodies = robot["links"].as_array().unwrap();
    let links: Vec<Value> = rows
        .zip(bodies)
        .enumerate()
        .map(|(index, (row, body))| {
            let tensor = &body["inertia_com"];
            json!({
                "name": format!("link{}", index + 1),
                "joint": {
                    "type": if row["type"] == "R" { "revolute" } else { "prismatic" },
                    "a": row["a"],
                    "alpha": quarter(&row["alpha_quarter_turns"]),
                    "d": row["d"],
                    "theta": quarter(&row["theta_offset_quarter_turns"]),
                },
                "body": {
                    "mass": body["mass"],
                    "com": body["com"],
                    "inertia": {
                        "xx": tensor[0][0], "yy": tensor[1][1], "zz": tensor[2][2],
                        "xy": tensor[0][1], "xz": tensor[0][2], "yz": tensor[1][2],
                    },
                    "about": "com",
                },
            })
        })
        .collect();
    json!({
        "format": "denavit-model/1",
        "name": format!("robot_{}", robot["name"].as_str().unwrap().to_lowercase()),
        "description": "A robot of the engine's numbers.",
        "source": "tests/oracles/engine_values.json",
        "convention": "standard",
        "gravity": robot["gravity"],
        "links": links,
    })
}

fn check(flavour: Flavour) {
    let path = repository().join("tests/oracles/engine_values.json");
    let oracle: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let mut compared = 0;
    for robot in oracle.as_array().unwrap() {
        let model = model_of(robot);
        let derivation = derive(&model, flavour, &FUNCTIONS).unwrap();
        let program = lower(&derivation.dag, &derivation.functions).unwrap();
        let defaults: Vec<_> = program
            .parameters
            .iter()
            .map(|parameter| {
                let id = model.find_parameter(parameter).unwrap();
                model.parameters[id].default.unwrap()
            })
            .collect();
        let parameters = constant_values(&model.dag, &defaults);
        let prelude = prelude_values(&program, &parameters).unwrap();
        for sample in robot["samples"].as_array().unwrap() {
            let argument = |name: &str| numbers(&sample[name]);
            let (q, qd, qdd) = (argument("q"), argument("qd"), argument("qdd"));
            for (routine, key) in program.routines.iter().zip(["tau", "D", "G", "h", "C"]) {
                let mut evaluator = Evaluator::<f64>::new(routine, &prelude);
                let mut ours = vec![0.0; evaluator.outputs()];
                let all: [&[f64]; 3] = [&q, &qd, &qdd];
                evaluator.evaluate(&all[..routine.arguments.len()], &mut ours).unwrap();
                let theirs = numbers(&sample[key]);
                let scale = theirs.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
                for (ours, theirs) in ours.iter().zip(&theirs) {
                    let error = (ours - theirs).abs();
                    let name = &robot["name"];
                    assert!(error <= TOLERANCE * scale, "{name} {key}: {ours} {theirs}");
                    compared += 1;
                }
            }
        }
    }
    assert_eq!(compared, 3 * [2, 6, 6, 4, 7, 6].iter().map(|n| 3 * n + 2 * n * n).sum::<usize>());
}

#[test]
fn tunable_programs_give_the_engines_numbers() {
    check(Flavour::Tunable);
}

#[test]
fn programs_without_zeros_give_the_engines_numbers() {
    check(Flavour::Sparse);
}

#[test]
fn baked_programs_give_the_engines_numbers() {
    check(Flavour::Baked);
}
