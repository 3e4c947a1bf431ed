//! `denavit simulate`: its answers, and what it says of scenarios that cannot be run.

use super::{Directory, Run, json, run_in};
use std::fs;

/// A scenario of the planar arm of two joints, with more entries.
fn arm(entries: &str) -> String {
    format!(
        r#"{{"format": "denavit-scenario/1", "model": "planar_2r", "duration_s": 1,
{entries}}}"#
    )
}

fn simulate(directory: &Directory, text: &str, more: &[&str]) -> Run {
    fs::write(directory.path.join("bad.json"), text).expect("a file");
    run_in(&directory.path, &[&["simulate", "bad.json"], more].concat())
}

/// The message for a scenario that must be refused, and of which nothing may be left behind.
#[track_caller]
fn refused(text: &str, parts: &[&str]) {
    refused_beside(&[], text, parts);
}

#[track_caller]
fn refused_beside(files: &[(&str, &str)], text: &str, parts: &[&str]) {
    for scheme in ["event", "time-stepping"] {
        let directory = Directory::new("bad-scenario");
        for (name, content) in files {
            fs::write(directory.path.join(name), content).expect("a file");
        }
        let run = simulate(&directory, text, &["--scheme", scheme, "-o", "log.csv"]);
        assert_eq!(run.code, Some(2), "{text}: {}{}", run.stdout, run.stderr);
        assert!(run.stdout.is_empty() && !run.stderr.contains("panicked"), "{}", run.stderr);
        for part in parts.iter().chain(&["bad.json:", "hint: "]) {
            assert!(run.stderr.contains(part), "no `{part}` in:\n{}", run.stderr);
        }
        assert_eq!(directory.files().len(), files.len() + 1, "nothing is left behind");
    }
}

#[test]
fn a_start_below_the_ground_is_refused() {
    let text = r#"{"format": "denavit-scenario/1", "model": "planar_biped", "duration_s": 1,
 "initial": {"q": {"base_z": 0.3}}}"#;
    refused(text, &["bad.json:2:13: /initial: ", "below the ground", "`on_ground`"]);
}

#[test]
fn unknown_joints_and_columns_are_guessed() {
    let text = arm(r#" "initial": {"q": {"lnk1": 1}}"#);
    refused(&text, &["/initial/q/lnk1: no joint is called `lnk1`", "`link1` is meant"]);
    let text = arm(r#" "control": {"joints": {"link1": {"reference": {"log": {"file": "run.csv",
   "column": "q_lnk1"}}}}}"#);
    let parts = ["bad.json:3:14: ", "/reference/log/column: the log has no column", "`q_link1`"];
    refused_beside(&[("run.csv", "t,q_link1\n0,1\n1,2\n")], &text, &parts);
}

#[test]
fn impossible_references_are_refused() {
    let reference = |text: &str| {
        arm(&format!(r#" "control": {{"joints": {{"link1": {{"reference": {text}}}}}}}"#))
    };
    for (text, said) in [
        (r#"{"cubic": {"times": [0, 1, 1], "values": [1, 2, 3]}}"#, "time number 3 is not after"),
        (r#"{"cosine": {"times": [0, 1], "values": [1]}}"#, "expected 2 values, found 1"),
        (r#"{"bezier": {"times": [0, 1], "values": []}}"#, "needs 1 values, 0 are given"),
        (r#"{"quintic": {"times": [0, 1], "values": [1, 2, 3]}}"#, "have 2 and 3 values"),
        (r#"{"fourier": {"frequency_rad_s": -1, "sines": [], "cosines": []}}"#, "be from 1e-6 to"),
    ] {
        let text = reference(text);
        refused(&text, &["bad.json:2:", "/control/joints/link1/reference/", said]);
    }
}

#[test]
fn parts_without_mass_are_refused() {
    let text = r#"{"format": "denavit-scenario/1", "model": "ball", "duration_s": 1,
 "parameters": {"m_base_pitch": 0}, "initial": {"q": {"base_z": 1}}}"#;
    refused(text, &["/model: the mass matrix is singular at `base_", "mass and inertia"]);
}

#[test]
fn torques_that_are_no_numbers_are_refused() {
    let text = arm(r#" "control": {"joints": {"link2": {"kp": 1e9, "reference": 1e300}}}"#);
    refused(
        &text,
        &["bad.json:2:", "/control/joints/link2: the torque on `link2` is not a finite"],
    );
    // of a log
    let text =
        arm(r#" "control": {"joints": {"link2": {"feed_forward": {"log": {"file": "tau.csv",
   "column": "tau_link2"}}}}}"#);
    for (log, said) in [
        ("t,tau_link2\n0,1\n1,NaN\n", "tau.csv:3:2: `NaN` is not a finite number"),
        ("t,tau_link2\n0,1\n1,\n", "the column `tau_link2` has no number in line 3"),
        ("t,tau_link2\n0,1\n1\n", "tau.csv:3:1: 1 cells, where there are 2 columns"),
        ("t,tau_link2\n0,1\n0,1\n", "tau.csv:3:1: the time is not after"),
        ("time,tau_link2\n0,1\n", "tau.csv:1:1: no column `t`"),
        ("", "tau.csv:1:1: no line with the names of columns"),
        ("t,tau_link2\n0,1\n5e-12,2\n", "the rows of the log are 5e-12 s apart"),
    ] {
        refused_beside(&[("tau.csv", log)], &text, &[said]);
    }
    // later on
    let text = arm(r#" "control": {"joints": {"link2": {"feed_forward":
   {"polynomial": [0, 1e300, 1e308, 1e308, 1e308, 1e308]}}}}, "initial": {"t_s": 0}"#)
    .replace("\"duration_s\": 1", "\"duration_s\": 100");
    for scheme in ["event", "time-stepping"] {
        let directory = Directory::new("late-nan");
        let run = simulate(&directory, &text, &["--scheme", scheme, "--json"]);
        assert_eq!(run.code, Some(1), "{}{}", run.stdout, run.stderr);
        let found: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
        assert!(found["end_s"].as_f64().expect("a number") < 100.0, "{found}");
    }
}

/// Whatever a scenario asks for, a run ends: rows, steps and events are counted.
#[test]
fn no_run_goes_on_without_end() {
    let text = arm(r#" "log_period_s": 1e-9"#);
    refused(&text, &["/log_period_s: the log would have more than 1000000 rows"]);
    for integrator in [r#""method": "runge_kutta", "step_s": 1e-9"#, r#""max_step_s": 1e-9"#] {
        let text = format!(
            r#" "integrator": {{{integrator}}},
 "time_stepping": {{"step_s": 1e-9}}"#
        );
        refused(
            &arm(&text),
            &["steps this short take ", "0e9 evaluations", "hint: take longer steps"],
        );
    }
    let limited = arm(r#" "limits": {"evaluations": 2000}, "control": {"period_s": 1e-8}"#);
    for scheme in ["event", "time-stepping"] {
        let directory = Directory::new("endless");
        let run = simulate(&directory, &limited, &["--scheme", scheme, "--json"]);
        assert_eq!(run.code, Some(1), "{}{}", run.stdout, run.stderr);
        assert!(run.stdout.contains("\"evaluation_limit\""), "{}", run.stdout);
    }
}

/// Numbers that no run would end with are refused, each with its range.
#[test]
fn numbers_beyond_their_range_are_refused() {
    for (entries, pointer) in [
        (r#" "initial": {"t_s": 1e300}"#, "/initial/t_s"),
        (r#" "time_stepping": {"sweeps": 1e12}"#, "/time_stepping/sweeps"),
        (r#" "time_stepping": {"sweeps": 0}"#, "/time_stepping/sweeps"),
        (r#" "time_stepping": {"response_m_s": 1e-300}"#, "/time_stepping/response_m_s"),
        (r#" "time_stepping": {"facets": 0}"#, "/time_stepping/facets"),
        (r#" "time_stepping": {"step_s": 1e-300}"#, "/time_stepping/step_s"),
        (r#" "time_stepping": {"step_s": 10}"#, "/time_stepping/step_s"),
        (r#" "control": {"period_s": 1e-300}"#, "/control/period_s"),
        (r#" "log_period_s": 1e-300"#, "/log_period_s"),
        (r#" "integrator": {"max_step_s": 1e-300}"#, "/integrator/max_step_s"),
    ] {
        refused(&arm(entries), &["bad.json:2:", &format!("{pointer}: the number must be from ")]);
    }
    let gait = |entries: &str| {
        format!(
            r#"{{"format": "denavit-scenario/1", "model": "tulip", "duration_s": 1,
 "gait": {{"divergent_component": {{"step_length_m": 0.1, "step_s": 0.8,
 "center_of_mass_height_m": 0.65, {entries}}}}}}}"#
        )
    };
    refused(&gait(r#""interval_s": 1e-12"#), &["/interval_s: the number must be from 0.001 to 1"]);
    refused(
        &gait(r#""standing_s": [1, 1e9]"#),
        &["/standing_s/1: the number must be from 0.001 to"],
    );
    refused(
        &gait(r#""interval_s": 0.001, "standing_s": [99, 1]"#),
        &["/gait/divergent_component: the plan would have more than 20000 knots"],
    );
    let steps = |entries: &str, more: &str| {
        format!(
            r#"{{"format": "denavit-scenario/1", "model": "planar_biped", "duration_s": 1,
 "gait": {{"capture_step": {{{entries}}}}}{more}}}"#
        )
    };
    let height = r#""center_of_mass_height_m": 0.57"#;
    refused(&steps("", ""), &["bad.json:2:", "center_of_mass_height_m"]);
    refused(&steps(r#""center_of_mass_height_m": 2"#, ""), &["/gait/capture_step", "`start`"]);
    let margin = format!(r#"{height}, "margin_m": 0.2"#);
    refused(&steps(&margin, ""), &["/gait/capture_step", "margin of 200.0 mm"]);
    let period = format!(r#"{height}, "period_s": 0"#);
    refused(&steps(&period, ""), &["/gait/capture_step/period_s: the number must be from"]);
    let own = r#", "control": {"joints": {"left_knee": {"kp": 1, "reference": 0.1}}}"#;
    refused(&steps(height, own), &["/gait", "`left_knee` is planned during the run"]);
    let both = format!(r#"{height}}}, "divergent_component": {{"#);
    refused(&steps(&both, ""), &["one kind of gait, not two"]);
}

/// What cannot be written is said before the run, not after it.
#[test]
fn outputs_are_checked_before_the_run() {
    let directory = Directory::new("outputs");
    let long = arm(r#" "limits": {"evaluations": 100}"#);
    for (more, said) in [
        (&["-o", "nowhere/a.csv"][..], "nowhere/a.csv: cannot be written"),
        (&["-o", "."], ".: cannot be written"),
        (&["-o", "a.csv", "--svg", "./a.csv"], "a.csv: two outputs would be this file"),
        (&["--svg", "a.svg", "--window", "0.5,3"], "--window: the run is from 0 to 1 s"),
    ] {
        let run = simulate(&directory, &long, more);
        assert_eq!(run.code, Some(2), "{more:?}: {}", run.stdout);
        assert!(run.stderr.contains(said) && run.stderr.contains("hint: "), "{}", run.stderr);
        assert_eq!(directory.files(), ["bad.json"]);
    }
}

#[test]
fn unknown_scenarios_and_models_are_guessed() {
    let directory = Directory::new("names");
    for (name, said) in [
        ("bouncing_bal", "`bouncing_ball` is a shipped scenario"),
        ("qqqqqqqqq", "or one of bouncing_ball, compass_gait, cradle, "),
    ] {
        let run = run_in(&directory.path, &["simulate", name]);
        assert_eq!(run.code, Some(2), "{}", run.stdout);
        assert!(run.stderr.contains(said), "{}", run.stderr);
    }
    let run = simulate(&directory, &arm("\"seed\": 0").replace("planar_2r", "planar_2q"), &[]);
    let said = "/model: planar_2q: cannot be read: no such file or directory (`planar_2r` is";
    assert!(run.code == Some(2) && run.stderr.contains(said), "{}", run.stderr);
    assert!(!run.stderr.contains("os error"), "{}", run.stderr);
}

#[test]
fn what_a_scheme_cannot_do_is_said() {
    let directory = Directory::new("scheme");
    let text = r#"{"format": "denavit-scenario/1", "model": "ball", "duration_s": 1,
 "initial": {"q": {"base_z": 1}}, "contact": {"restitution": 0.5},
 "time_stepping": {"method": "anitescu"}}"#;
    let run = simulate(&directory, text, &["--scheme", "time-stepping"]);
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    let said = "bad.json:2:62: /contact/restitution: restitution: Anitescu's scheme";
    assert!(run.stderr.contains(said) && run.stderr.contains("hint: "), "{}", run.stderr);
    assert_eq!(simulate(&directory, text, &["--scheme", "event"]).code, Some(0));
}

/// Both schemes give the same summary and the same columns; the flag goes before the file.
#[test]
fn the_schemes_write_the_same_log() {
    let directory = Directory::new("schemes");
    let mut columns = Vec::new();
    for scheme in ["event", "time-stepping"] {
        let arguments =
            ["simulate", "rocking_block", "--scheme", scheme, "-o", "log.csv", "--svg", "run.svg"];
        let run = run_in(&directory.path, &arguments);
        assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
        let log = fs::read_to_string(directory.path.join("log.csv")).expect("a log");
        let word = scheme.replace('-', "_");
        assert!(log.contains(&format!("# scheme: {word}\n")), "{log}");
        assert!(log.contains("# stop: end\n") && log.contains("# audit_energy_j: "), "{log}");
        columns.push(log.lines().find(|line| line.starts_with("t,")).map(str::to_owned));
        let svg = fs::read_to_string(directory.path.join("run.svg")).expect("a picture");
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        assert!(!svg.contains("NaN") && svg.contains(">normal force of the ground<"));
    }
    assert_eq!(columns[0], columns[1]);
    assert!(columns[0].is_some());
    let [event, steps] = ["event", "time-stepping"]
        .map(|scheme| json(&["simulate", "rocking_block", "--scheme", scheme, "--json"]));
    assert_eq!(event["scheme"], "event");
    assert_eq!(steps["scheme"], "time_stepping");
    let keys = |value: &serde_json::Value| {
        value["audit"].as_object().expect("audits").keys().cloned().collect::<Vec<_>>()
    };
    assert_eq!(keys(&event), keys(&steps));
}

#[test]
fn a_step_is_not_passed_over() {
    let directory = Directory::new("step");
    let run = run_in(&directory.path, &["simulate", "bouncing_ball", "--step", "0.01"]);
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    assert!(run.stderr.contains("--step: ") && run.stderr.contains("hint: "), "{}", run.stderr);
    let arguments = ["simulate", "cradle", "--scheme", "time-stepping", "--step", "0.01", "--json"];
    let run = run_in(&directory.path, &arguments);
    let found: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    // the log has rows every 0.01 s: as many steps
    assert_eq!(found["steps"], 100, "{found}");
}

#[test]
fn a_log_that_is_followed_is_not_replaced() {
    let directory = Directory::new("log-kept");
    let log = "t,q\n0,0\n1,1\n";
    fs::write(directory.path.join("run.csv"), log).expect("a file");
    let text = arm(r#" "control": {"joints": {"link1": {"reference": {"log": {"file": "run.csv",
   "column": "q"}}}}}"#);
    let run = simulate(&directory, &text, &["-o", "run.csv"]);
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    assert!(run.stderr.contains("would be replaced"), "{}", run.stderr);
    assert_eq!(fs::read_to_string(directory.path.join("run.csv")).expect("a file"), log);
}

/// A robot that touches nothing has no figures of contacts, neither printed nor in its log.
#[test]
fn figures_of_contacts_are_those_of_robots_with_contacts() {
    let directory = Directory::new("figures");
    for (scenario, touches) in [("double_pendulum", false), ("rocking_block", true)] {
        let run = run_in(&directory.path, &["simulate", scenario, "-o", "log.csv"]);
        assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
        assert!(run.stdout.contains("energy balance [J]"), "{}", run.stdout);
        assert_eq!(run.stdout.contains("penetration [m]"), touches, "{}", run.stdout);
        assert_eq!(run.stdout.contains("forces against momentum"), touches, "{}", run.stdout);
        let log = fs::read_to_string(directory.path.join("log.csv")).expect("a log");
        assert!(log.contains("# audit_energy_j: "), "{log}");
        assert_eq!(log.contains("# audit_adhesion_n: "), touches, "{log}");
    }
}

#[cfg(not(feature = "png"))]
#[test]
fn a_build_without_png_says_how_to_get_one_before_it_runs() {
    let directory = Directory::new("png");
    let run = simulate(&directory, &arm(""), &["--png", "a.png", "--at", "0.5"]);
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    assert!(run.stderr.contains("--features png"), "{}", run.stderr);
    assert!(!directory.files().contains(&"a.png".to_owned()));
}
