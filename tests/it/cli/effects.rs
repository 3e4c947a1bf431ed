//! Models with effects, from the command.

use super::errors::assert_says;
use super::{Directory, Run, run_in};
use denavit::shipped;
use std::fs;

/// A planar arm with a Stribeck friction and an effect of its own, in a folder beside it.
fn arm(directory: &Directory, more: &str) -> String {
    let text = shipped::find("planar_2r").expect("a model").text;
    let robot = denavit::model::read("planar_2r", text.as_bytes()).expect("a model");
    let name = robot.links.values().next().expect("a link").name.clone();
    let effects = format!(
        r#""effects": [{{"effect": "stribeck", "at": {{"link": "{name}"}},
        "parameters": {{"fs": 0.3, "vs": 0.05}}}}, {more}
        {{"effect": "bungee", "at": {{"link": "{name}"}}, "parameters": {{"k": 4}}}}], "links""#
    );
    let model = text.replacen("\"links\"", &effects, 1);
    fs::write(directory.path.join("arm.json"), model).expect("a file");
    fs::create_dir_all(directory.path.join("effects")).expect("a folder");
    let own = r#"{"format": "denavit-effect/1", "name": "bungee", "title": "bungee cord",
        "description": "d", "source": "s", "kind": "state", "at": "joint",
        "parameters": {"k": {"unit": "torque/position", "description": "stiffness",
            "nominal": 0, "bounds": [0, null]},
            "aging": {"unit": "s", "description": "time of aging", "bounds": [1, null],
            "start": [100]}},
        "states": {"x": {"unit": "position", "rate": "(q - x)/aging", "initial": "q"}},
        "torque": "k*(q - x)*(1 + t/aging)"}"#;
    fs::write(directory.path.join("effects/bungee.json"), own).expect("a file");
    name
}

fn done(directory: &Directory, arguments: &[&str]) -> String {
    let Run { code, stdout, stderr } = run_in(&directory.path, arguments);
    assert_eq!(code, Some(0), "{arguments:?}: {stderr}");
    stdout
}

#[test]
fn equations_show_the_effects_by_name() {
    let directory = Directory::new("derive_effects");
    let name = arm(&directory, "");
    let shown = done(&directory, &["derive", "arm.json", "--latex", "arm.tex"]);
    assert_says(&shown, &["added effects", "Stribeck friction", "bungee cord", "exp("]);
    assert_says(&shown, &[&format!("fs_stribeck_{name}"), &format!("d/dt x_bungee_{name}")]);
    let tex = fs::read_to_string(directory.path.join("arm.tex")).expect("a file");
    assert_says(&tex, &["Added effects", "Stribeck friction at", "Bungee cord at"]);
    let json = done(&directory, &["derive", "arm.json", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["effects"][0]["effect"], "stribeck");
    assert_eq!(json["effects"][1]["joint"], name.as_str());
    let Run { code, stderr, .. } =
        run_in(&directory.path, &["derive", "arm.json", "--method", "tmt"]);
    assert_eq!(code, Some(2));
    assert_says(&stderr, &["`stribeck`", "hint: "]);
}

#[test]
fn emitted_code_has_arguments_for_time_and_states() {
    let directory = Directory::new("emit_effects");
    let name = arm(&directory, "");
    done(&directory, &["emit", "arm.json", "-o", "arm.rs"]);
    let code = fs::read_to_string(directory.path.join("arm.rs")).expect("a file");
    assert_says(&code, &["t: S,", "states: &[S; 1],", "pub fn state_rates", "feature `libm`"]);
    assert_says(&code, &["pub fn forward_dynamics", &format!("pub k_bungee_{name}: S")]);
    let counted = done(&directory, &["count", "arm.json", "--effects", "effects"]);
    assert_says(&counted, &["state_rates"]);
}

#[test]
fn what_a_law_of_loads_leaves_out_is_said() {
    let directory = Directory::new("emit_capstan");
    let text = shipped::find("planar_2r").expect("a model").text;
    let robot = denavit::model::read("planar_2r", text.as_bytes()).expect("a model");
    let name = &robot.links.values().next().expect("a link").name;
    let capstan = format!(
        r#"{{"effect": "capstan", "at": {{"link": "{name}"}}, "parameters": {{"mu_theta": 1}}}},"#
    );
    arm(&directory, &capstan);
    let shown = done(&directory, &["emit", "arm.json", "-o", "arm.rs"]);
    assert_says(&shown, &["left out", "forward dynamics", "`capstan`"]);
    let code = fs::read_to_string(directory.path.join("arm.rs")).expect("a file");
    assert!(code.contains("pub fn inverse_dynamics") && !code.contains("pub fn forward_dynamics"));
}

#[test]
fn folders_that_are_none_and_effects_at_fault_are_refused() {
    let directory = Directory::new("own_effects");
    arm(&directory, "");
    fs::create_dir_all(directory.path.join("empty")).expect("a folder");
    for (folder, why) in [
        ("nowhere", "no such file or directory"),
        ("arm.json", "not a directory"),
        ("empty", "no effect is in it"),
    ] {
        let arguments = ["derive", "arm.json", "--effects", folder];
        let Run { code, stderr, .. } = run_in(&directory.path, &arguments);
        assert_eq!(code, Some(2), "{folder}");
        assert_says(&stderr, &[folder, why]);
    }
    let place = directory.path.join("effects/bungee.json");
    let own = fs::read_to_string(&place).expect("a file").replacen("\"unit\"", "\"units\"", 1);
    fs::write(&place, own).expect("a file");
    let Run { code, stderr, .. } = run_in(&directory.path, &["derive", "arm.json"]);
    assert_eq!(code, Some(2));
    assert_says(&stderr, &["bungee.json", "/parameters/k/units", "did you mean `unit`?"]);
}

/// The last row of a run of one second that falls from rest.
fn last_row(directory: &Directory, model: &str, scheme: &str) -> Vec<f64> {
    let scenario = format!(
        r#"{{"format": "denavit-scenario/1", "model": "{model}", "duration_s": 1,
        "initial": {{"q": {{"link1": 0.4}}}}}}"#
    );
    fs::write(directory.path.join("fall.json"), scenario).expect("a file");
    let arguments = ["simulate", "fall.json", "--scheme", scheme, "-o", "log.csv"];
    done(directory, &arguments);
    let log = fs::read_to_string(directory.path.join("log.csv")).expect("a log");
    let rows: Vec<&str> = log.lines().filter(|line| !line.starts_with('#')).collect();
    let place = |name: &str| {
        let columns = rows[0].split(',').position(|column| column == name);
        columns.expect("a column")
    };
    let last: Vec<&str> = rows[rows.len() - 1].split(',').collect();
    let names = ["t", "q_link1", "q_link2", "qd_link1", "qd_link2"];
    names.iter().map(|name| last[place(name)].parse().expect("a number")).collect()
}

#[test]
fn a_simulation_has_the_laws_of_rates() {
    let directory = Directory::new("simulate_effects");
    let text = shipped::find("planar_2r").expect("a model").text;
    let with = |name: &str, more: &str| {
        let model = text.replacen("\"links\"", &format!("{more}, \"links\""), 1);
        fs::write(directory.path.join(name), model).expect("a file");
    };
    with(
        "effect.json",
        r#""effects": [{"effect": "viscous", "at": {"link": "link1"}, "parameters": {"fv": 0.6}},
        {"effect": "coulomb", "at": {"link": "link1"}, "parameters": {"fc": 0.2}}]"#,
    );
    with("drive.json", r#""drives": {"link1": {"viscous": 0.6, "coulomb": 0.2}}"#);
    let [effect, plain] =
        ["effect.json", "planar_2r"].map(|name| last_row(&directory, name, "event"));
    assert!((effect[1] - plain[1]).abs() > 1e-3, "friction is felt");
    let stepped = last_row(&directory, "effect.json", "time-stepping");
    assert!((effect[1] - stepped[1]).abs() < 1e-2, "{} is not {}", stepped[1], effect[1]);
    // drives as the model has them rub as the effects do
    let scenario = r#"{"format": "denavit-scenario/1", "model": "drive.json", "duration_s": 1,
        "drives": "model", "initial": {"q": {"link1": 0.4}}}"#;
    fs::write(directory.path.join("drive_fall.json"), scenario).expect("a file");
    done(&directory, &["simulate", "drive_fall.json", "-o", "drive.csv"]);
    let log = fs::read_to_string(directory.path.join("drive.csv")).expect("a log");
    let rows: Vec<&str> = log.lines().filter(|line| !line.starts_with('#')).collect();
    let column = rows[0].split(',').position(|name| name == "q_link1").expect("a column");
    let drive: f64 =
        rows[rows.len() - 1].split(',').nth(column).expect("a value").parse().expect("q");
    assert!((effect[1] - drive).abs() < 1e-5, "{} is not {drive}", effect[1]);
}

/// A slider of 2 kg without gravity, with a bristle and a cable, that slides on at 0.3 m/s.
fn slider(directory: &Directory, more: &str) {
    let model = format!(
        r#"{{"format": "denavit-model/1", "name": "slider", "convention": "standard",
        "gravity": [0, 0, 0], {more}
        "effects": [
            {{"effect": "dahl", "at": {{"link": "cart"}},
                "parameters": {{"fc": 0.5, "slip": 0.01}}}},
            {{"effect": "capstan", "at": {{"link": "cart"}}, "parameters": {{"mu_theta": 0.4}}}},
            {{"effect": "torque_drift", "at": {{"link": "cart"}}, "parameters": {{"c": 0.3}}}}],
        "links": [{{"name": "cart", "joint": {{"type": "prismatic"}}, "body": {{"mass": 2}}}}]}}"#
    );
    fs::write(directory.path.join("slider.json"), model).expect("a file");
    let scenario = r#"{"format": "denavit-scenario/1", "model": "slider.json", "duration_s": 0.5,
        "initial": {"qd": {"cart": 0.3}}}"#;
    fs::write(directory.path.join("slide.json"), scenario).expect("a file");
}

#[test]
fn a_simulation_follows_states_loads_and_time() {
    let directory = Directory::new("simulate_states");
    slider(&directory, "");
    done(&directory, &["simulate", "slide.json", "-o", "log.csv"]);
    let log = fs::read_to_string(directory.path.join("log.csv")).expect("a log");
    let rows: Vec<&str> = log.lines().filter(|line| !line.starts_with('#')).collect();
    let column = rows[0].split(',').position(|name| name == "qd_cart").expect("a column");
    let last = rows[rows.len() - 1].split(',').nth(column).expect("a value");
    let found: f64 = last.parse().expect("a number");
    // 2 a exp(0.4 sign(v) sign(a)) + 0.5 z + 0.3 t = 0, z' = (v - |v| z)/0.01, by small steps
    let rates = |t: f64, [v, z]: [f64; 2]| {
        let driving = -(0.5 * z + 0.3 * t);
        let steep = (v / 0.01).tanh();
        let a = driving / 2.0 * (-0.4 * steep * driving.signum()).exp();
        [a, (v - v.abs() * z) / 0.01]
    };
    let (mut y, h) = ([0.3, 0.0], 1e-5);
    for step in 0..50_000 {
        let t = f64::from(step) * h;
        let moved = |k: [f64; 2], part: f64| [y[0] + part * h * k[0], y[1] + part * h * k[1]];
        let k1 = rates(t, y);
        let k2 = rates(t + h / 2.0, moved(k1, 0.5));
        let k3 = rates(t + h / 2.0, moved(k2, 0.5));
        let k4 = rates(t + h, moved(k3, 1.0));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    assert!(y[0] < 0.25, "it is braked: {}", y[0]);
    assert!((found - y[0]).abs() < 1e-6, "{found} is not {}", y[0]);
}

#[test]
fn a_simulation_says_which_effects_it_does_not_follow() {
    let directory = Directory::new("simulate_refused");
    slider(&directory, "");
    let steps = ["simulate", "slide.json", "--scheme", "time-stepping", "-o", "log.csv"];
    let Run { code, stderr, .. } = run_in(&directory.path, &steps);
    assert_eq!(code, Some(2));
    assert_says(&stderr, &["only the event-driven scheme"]);
    let contacts = r#""contacts": [{"name": "toe", "link": "cart", "position": [0, 0, 0.1]}],"#;
    slider(&directory, contacts);
    let Run { code, stderr, .. } =
        run_in(&directory.path, &["simulate", "slide.json", "-o", "log.csv"]);
    assert_eq!(code, Some(2));
    assert_says(&stderr, &["`capstan`", "the load", "hint: "]);
}
