//! A step of friction that an effect adds is a steep line of the run's own width.

use super::assert_near;
use denavit_codegen::effect::read_model;
use denavit_plants::LoadedPlant;
use denavit_simulate::integrate::{Accuracy, Method};
use denavit_simulate::time_stepping::{Stepping, simulate_by_steps};
use denavit_simulate::{Control, DriveModelling, Simulation, State, simulate};
use serde_json::json;

const MASS: f64 = 2.0;
const COULOMB: f64 = 0.3;

fn sled() -> LoadedPlant {
    let file = json!({
        "format": "denavit-model/1", "name": "sled", "convention": "standard",
        "gravity": [0, -9.81, 0],
        "links": [{
            "name": "sled",
            "joint": {"type": "prismatic", "theta": 0, "d": 0, "a": 0, "alpha": 0},
            "body": {"mass": MASS, "com": [0, 0, 0], "about": "com",
                     "inertia": {"xx": 1, "yy": 1, "zz": 1, "xy": 0, "xz": 0, "yz": 0}}
        }],
        "effects": [{"effect": "coulomb", "at": {"link": "sled"}, "parameters": {"fc": COULOMB}}],
    });
    let robot = read_model("sled", file.to_string().as_bytes(), &[]).expect("a model");
    LoadedPlant::new(&robot, &[]).expect("a plant")
}

/// m v' = -F tanh(v / r) has sinh(v / r) = sinh(v0 / r) exp(-F t / (m r)).
#[test]
fn an_effect_brakes_as_steeply_as_the_scenario_says() {
    let (v0, end_s) = (0.05_f64, 0.3_f64);
    for width in [0.01_f64, 0.02, 0.1] {
        let growth: f64 = (v0 / width).sinh() * (-COULOMB * end_s / (MASS * width)).exp();
        let expected = width * growth.asinh();
        let accuracy = Accuracy { relative: 1e-11, absolute: 1e-12, max_step_s: 0.01 };
        let how = Simulation {
            end_s,
            drives: DriveModelling::Model,
            stiction_rate: width,
            method: Method::DormandPrince(accuracy),
            ..Simulation::default()
        };
        let initial = State { qd: vec![v0], ..State::resting(vec![0.0]) };
        let control = Control::passive(1);
        let run = simulate(&mut sled(), &control, &initial, &how).expect("it begins");
        assert_near(run.end.qd[0], expected, 1e-9);
        let stepping = Stepping { step_s: 1e-5, ..Stepping::default() };
        let run = simulate_by_steps(&mut sled(), &control, &initial, &how, &stepping);
        assert_near(run.expect("it begins").end.qd[0], expected, 1e-5);
    }
}
