//! Both sides of a gear: what is simulated and what is identified agree on one.

use super::{Directory, run_in};
use denavit::shipped;
use serde_json::{Value, json};

/// The planar arm with a gear of 50 and friction, whose file says where its logs have torques.
fn geared(side: &str) -> String {
    let shipped = shipped::find("planar_2r").expect("shipped");
    let mut model: Value = serde_json::from_str(shipped.text).expect("JSON");
    model["torque_side"] = side.into();
    model["drives"] = json!({
        "link1": {"gear_ratio": 50, "viscous": 2e-4, "rotor_inertia": 1e-5},
        "link2": {"gear_ratio": -20, "viscous": 1e-3},
    });
    model.to_string()
}

fn scenario(model: &str) -> String {
    let joint = |rate: f64, sines: [f64; 2]| {
        json!({"kp": 400, "kd": 40, "reference": {"fourier": {
            "frequency_rad_s": rate, "sines": sines, "cosines": [0.0, 0.1], "offset": 0.0}}})
    };
    json!({
        "format": "denavit-scenario/1",
        "name": "geared",
        "model": model,
        "duration_s": 6,
        "initial": {"on_reference": true},
        "drives": "model",
        "control": {"joints": {
            "link1": joint(1.7, [0.5, 0.2]), "link2": joint(2.3, [0.6, -0.3])}},
        "log_period_s": 0.002,
    })
    .to_string()
}

/// A log as the robot's own instruments would write it: motor torques, and nothing said of sides.
fn foreign(log: &str) -> String {
    let mut lines = log.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().expect("names of columns").split(',').collect();
    let mut text = names.join(",") + "\n";
    for line in lines {
        let cells = line.split(',').zip(&names).map(|(cell, name)| match *name {
            "tau_link1" => (cell.parse::<f64>().expect("a number") / 50.0).to_string(),
            "tau_link2" => (cell.parse::<f64>().expect("a number") / -20.0).to_string(),
            _ => cell.to_owned(),
        });
        text += &(cells.collect::<Vec<_>>().join(",") + "\n");
    }
    text
}

#[test]
fn logs_of_either_side_give_the_parameters_of_the_model() {
    let directory = Directory::new("gears");
    let write = |name: &str, text: &str| {
        std::fs::write(directory.path.join(name), text).expect("written");
    };
    for side in ["joint", "motor"] {
        write(&format!("{side}.json"), &geared(side));
        write(&format!("{side}_scenario.json"), &scenario(&format!("{side}.json")));
        let log = format!("{side}.csv");
        let words = ["simulate", &format!("{side}_scenario.json"), "-o", &log];
        let run = run_in(&directory.path, &words);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let text = std::fs::read_to_string(directory.path.join(&log)).expect("a log");
        assert!(text.contains("# torque_side: joint\n"), "{side}");
        write("foreign.csv", &foreign(&text));
    }
    for (model, log) in
        [("joint.json", "joint.csv"), ("motor.json", "motor.csv"), ("motor.json", "foreign.csv")]
    {
        let words = ["identify", model, "--train", log, "--filter", "20", "--json"];
        let run = run_in(&directory.path, &words);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let found: Value = serde_json::from_str(&run.stdout).expect("JSON");
        let parameters = found["parameters"].as_array().expect("a list");
        assert!(parameters.len() >= 5, "{parameters:?}");
        for one in parameters {
            let [value, truth] =
                ["value", "model_value"].map(|key| one[key].as_f64().expect("a number"));
            assert!((value - truth).abs() < 1e-3 * truth.abs().max(0.05), "{model} {log} {one}");
        }
        let said = found["remarks"].to_string().contains("multiplied by the gear ratios");
        assert_eq!(said, log == "foreign.csv", "{}", found["remarks"]);
    }
}
