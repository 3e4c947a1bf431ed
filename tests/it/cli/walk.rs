//! `denavit walk`: answers, exit codes, and what is refused.

use super::{Directory, Run, command, json, run_in};
use std::path::Path;
use std::process::Stdio;

const GAIT: &str = "planar_biped_zmp_gait";

fn run(words: &[&str]) -> Run {
    run_in(Path::new(env!("CARGO_MANIFEST_DIR")), words)
}

#[test]
fn zmp_answers_with_the_keys_that_are_promised() {
    let found = json(&["walk", "zmp", GAIT, "--period", "0.002", "--json"]);
    for key in ["duration_s", "force_vs_momentum_max_m"] {
        assert!(found[key].is_number(), "{key}: {found}");
    }
    for point in ["exact", "cart_table"] {
        let margin = found[point]["margin_min_m"].as_f64().expect("a margin");
        assert!((0.03..0.04).contains(&margin), "{point}: {margin}");
        assert_eq!(found[point]["outside_share"], 0.0);
    }
    let shares = &found["shares"];
    let sum: f64 = ["flat", "toe", "double", "flight"]
        .iter()
        .map(|phase| shares[phase].as_f64().expect("a share"))
        .sum();
    assert!((sum - 1.0).abs() < 1e-12, "{shares}");
    assert_eq!(found["over"], "cycle");
}

#[test]
fn poincare_answers_with_the_keys_that_are_promised() {
    let found = json(&["walk", "poincare", "compass_gait", "--json"]);
    let multipliers = found["multipliers"].as_array().expect("multipliers");
    assert!(multipliers.iter().all(|one| one.as_array().is_some_and(|pair| pair.len() == 2)));
    assert!((found["largest"].as_f64().expect("a modulus") - 0.57995).abs() < 1e-4);
    assert!(found["dominant"][0]["coordinate"].is_string(), "{found}");
    assert!(found["fixed_point"]["q"]["first_leg"].is_number());
    assert!((found["period_s"].as_f64().expect("a period") - 0.73434639116).abs() < 1e-8);
}

/// A gait is designed first: walking primitives have nearly no multipliers.
#[test]
fn poincare_takes_gaits() {
    let words = ["walk", "poincare", "planar_biped_primitives", "--unchecked", "--returns", "1"];
    let found = json(&[&words[..], &["--json"]].concat());
    assert!(found["largest"].as_f64().expect("a modulus") < 0.01, "{found}");
    assert_eq!(found["cycle"], "step");
}

#[test]
fn a_log_is_judged_with_the_model_of_its_robot() {
    let directory = Directory::new("walk-log");
    let wrote = run_in(&directory.path, &["simulate", GAIT, "-o", "gait.csv"]);
    assert_eq!(wrote.code, Some(0), "{}", wrote.stderr);
    let words = ["walk", "zmp", "gait.csv", "--model", "planar_biped", "-o", "zmp.csv"];
    let judged = run_in(&directory.path, &words);
    assert_eq!(judged.code, Some(0), "{}", judged.stderr);
    assert!(judged.stdout.contains("over one run of 36.0000 s"), "{}", judged.stdout);
    let series = std::fs::read_to_string(directory.path.join("zmp.csv")).expect("a series");
    let columns = series.lines().find(|line| line.starts_with("t,")).expect("columns");
    for column in ["zmp_x", "zmp_margin", "cart_table_x", "fri_x", "capture_x", "support_low"] {
        assert!(columns.split(',').any(|known| known == column), "{column}");
    }
}

/// What a scenario sets in place of its model's values is in the log; a log of another model is
/// refused with the place in its header.
#[test]
fn a_log_is_of_its_own_robot() {
    let directory = Directory::new("walk-log-model");
    let text = denavit::shipped::find_scenario(GAIT).expect("shipped").text;
    let moon = text.replacen("\"model\"", "\"parameters\": {\"g\": 3.7}, \"model\"", 1);
    let mut moon: serde_json::Value = serde_json::from_str(&moon).expect("JSON");
    moon["duration_s"] = 0.5.into();
    std::fs::write(directory.path.join("moon.json"), moon.to_string()).expect("written");
    let wrote = run_in(&directory.path, &["simulate", "moon.json", "-o", "moon.csv"]);
    assert_eq!(wrote.stderr, "", "{}", wrote.stdout);
    let log = std::fs::read_to_string(directory.path.join("moon.csv")).expect("a log");
    assert!(log.contains("\n# parameters: g=3.7\n"), "{log:.400}");
    let words = ["walk", "zmp", "moon.csv", "--model", "planar_biped"];
    let judged = run_in(&directory.path, &[&words[..], &["--json"]].concat());
    let found: serde_json::Value = serde_json::from_str(&judged.stdout).expect("JSON");
    let apart = found["force_vs_momentum_max_m"].as_f64().expect("a distance");
    // by 9.81 m/s^2 weight and forces do not agree
    assert!(apart < 1e-9, "{apart}");
    assert_eq!(found["scheme"], "event");
    let hash = log.lines().find(|line| line.starts_with("# model_hash: ")).expect("a hash");
    let other = log.replace(hash, "# model_hash: 0123456789abcdef");
    std::fs::write(directory.path.join("moon.csv"), &other).expect("written");
    let refused = run_in(&directory.path, &words);
    assert_eq!(refused.code, Some(2), "{}", refused.stdout);
    for part in ["moon.csv:4:1: ", "a log of another model", "hint: "] {
        assert!(refused.stderr.contains(part), "{part}: {}", refused.stderr);
    }
    let bare: String = log
        .lines()
        .filter(|line| !line.starts_with('#'))
        .fold(String::new(), |text, line| text + line + "\n");
    std::fs::write(directory.path.join("moon.csv"), bare).expect("written");
    assert_eq!(run_in(&directory.path, &words).code, Some(0));
}

/// By time stepping the forces of a row are means over it: their point is in what carried them.
#[test]
fn a_log_of_steps_is_judged_by_what_carried() {
    let directory = Directory::new("walk-log-steps");
    let wrote = run_in(&directory.path, &["simulate", "tulip_step", "-o", "step.csv"]);
    assert_eq!(wrote.code, Some(0), "{}", wrote.stderr);
    let words = ["walk", "zmp", "step.csv", "--model", "tulip", "--json"];
    let judged = run_in(&directory.path, &words);
    let found: serde_json::Value = serde_json::from_str(&judged.stdout).expect("JSON");
    assert!(found["exact"]["margin_min_m"].as_f64().expect("a margin") > -1e-7, "{found}");
    assert_eq!(found["scheme"], "time_stepping");
}

#[test]
fn a_table_without_rows_says_why() {
    let found = run(&["walk", "fri", "planar_biped_switched_off"]);
    assert!(found.stdout.contains("no foot ever stands alone"), "{}", found.stdout);
}

#[test]
fn a_robot_that_falls_is_answered_with_1() {
    let fell = run(&["walk", "zmp", "planar_biped_switched_off"]);
    assert_eq!(fell.code, Some(1), "{}", fell.stderr);
    assert!(fell.stdout.contains("fell"), "{}", fell.stdout);
}

#[test]
fn what_cannot_be_judged_is_refused() {
    for (words, said) in [
        (&["walk", "zmp", "tulip_leg_tracking"][..], "floating base"),
        (&["walk", "poincare", "tulip_leg_tracking"], "does not repeat"),
        (&["walk", "poincare", GAIT, "--section", "1.5"], "share of the cycle"),
        (&["walk", "poincare", "planar_biped_start_stop"], "does not repeat"),
        (&["walk", "poincare", "no_such_gait"], "no shipped scenario"),
        (&["walk", "basin", GAIT, "--vary", "q_nose,q_base_pitch"], "q_nose"),
        (&["walk", "basin", GAIT, "--noise", "0"], "not from 0.000000001 to 100 rad/s"),
        (&["walk", "push", GAIT, "--link", "nose"], "nose"),
        (&["walk", "capturability", GAIT, "--step-time", "0"], "not from 0.001 to 100 s"),
        (&["walk", "capturability", GAIT, "--height", "nan"], "not from 0.001 to 1000 m"),
        (&["walk", "capturability", "tulip_standing"], "planar robots with two legs"),
        (&["walk", "capture-steps", GAIT], "capture_step"),
        (
            &["walk", "capture-steps", "planar_biped_capture_step", "--most", "0"],
            "not from 0.000001",
        ),
        (&["walk", "zmp", "Cargo.toml", "--model", "planar_biped"], "Cargo.toml"),
        (&["walk", "zmp", "log.csv"], "--model MODEL"),
        (&["walk", "poincare", "planar_biped_pushed"], "pushes come once"),
        (&["walk", "poincare", "planar_biped_inverted_pendulum"], "does not repeat"),
        (&["simulate", "models/gaits/tulip_walk.json"], "a gait is designed first"),
    ] {
        let refused = run(words);
        assert_eq!(refused.code, Some(2), "{words:?}: {}", refused.stdout);
        assert!(refused.stderr.contains(said), "{words:?}: {}", refused.stderr);
    }
}

#[test]
fn capturability_answers_with_the_reach_of_each_number_of_steps() {
    let words =
        ["walk", "capturability", "planar_biped_capture_step", "--capture", "0.2", "--json"];
    let found = json(&words);
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    // the recursion of the pendulum, by hand
    let decay = (-number(&found["omega_per_s"]) * number(&found["step_s"])).exp();
    let (toe, longest) = (number(&found["toe_m"]), number(&found["longest_step_m"][1]));
    let mut reach = toe;
    for row in found["reach"].as_array().expect("rows") {
        assert!((number(&row["forward_m"]) - reach).abs() < 1e-12, "{row}");
        reach = toe + (longest + reach - toe) * decay;
    }
    let limit = toe + longest * decay / (1.0 - decay);
    assert!((number(&found["limit"]["forward_m"]) - limit).abs() < 1e-12, "{found}");
    assert_eq!(found["capture"]["steps"], 1);
    assert!(found["capture"]["region_m"][0].is_number(), "{found}");
    let falls = json(&["walk", "capturability", GAIT, "--capture", "-0.9", "--json"]);
    assert!(falls["capture"]["steps"].is_null(), "{falls}");
}

#[test]
fn capture_steps_compares_predicted_and_made_steps() {
    let name = "planar_biped_capture_step";
    let found = json(&["walk", "capture-steps", name, "--impulses", "-6,14,28", "--json"]);
    let pushes = found["pushes"].as_array().expect("pushes");
    let steps: Vec<_> = pushes.iter().map(|push| push["predicted_steps"].as_u64()).collect();
    assert_eq!(steps, [Some(0), Some(1), None]);
    assert_eq!(pushes[1]["steps"], 1);
    assert_eq!(pushes[1]["outcome"], "stands");
    assert_eq!(pushes[2]["outcome"], "fell");
    assert_eq!(found["agree"], 3);
}

#[test]
fn a_gait_has_a_page_with_the_figures_of_the_thesis() {
    let directory = Directory::new("walk_page");
    let answer = run_in(&directory.path, &["walk", "page", GAIT, "-o", "gait.html"]);
    assert_eq!(answer.code, Some(0), "{}", answer.stderr);
    let page = std::fs::read_to_string(directory.path.join("gait.html")).expect("a page");
    assert_eq!(page.matches("<svg").count(), 7, "joints, run, three points, returns, circle");
    for figure in ["figures 4.2", "figures 4.3", "figure 4.7", "figure 4.8", "figure 4.9"] {
        assert!(page.contains(figure), "{figure}");
    }
    assert!(page.contains("-0.211688"), "the largest multiplier");
    let refused = run_in(&directory.path, &["walk", "page", "cradle", "-o", "cradle.html"]);
    assert_eq!(refused.code, Some(2), "{}", refused.stdout);
    assert_eq!(directory.files(), ["gait.html"]);
}

#[test]
fn numbers_that_nobody_means_are_refused() {
    let capture = "planar_biped_capture_step";
    for (words, said) in [
        (&["walk", "push", GAIT, "--after", "1e9"][..], "not from 0.001 to 1000 s"),
        (&["walk", "push", GAIT, "--most", "1e308"], "not from 0.000001 to 1000000 N s"),
        (&["walk", "push", "cradle"], "floating base"),
        (&["walk", "capture-steps", capture, "--impulses", "1e308"], "N s"),
        (&["walk", "capturability", capture, "--height", "1e308"], "not from 0.001 to 1000 m"),
        (&["walk", "basin", GAIT, "--reach", "1e308,1"], "not from 0 to 100"),
        (&["walk", "basin", GAIT, "--vary", "q_base_x,q_base_x"], "`q_base_x` twice"),
    ] {
        let run = run(words);
        assert_eq!(run.code, Some(2), "{words:?}: {}", run.stdout);
        assert!(run.stderr.contains(said), "{words:?}: {}", run.stderr);
    }
}

/// The kind of the gait says so before anything is designed, and nothing is written.
#[test]
fn a_limit_cycle_has_no_trajectory_of_its_own() {
    let directory = Directory::new("walk_trajectory");
    let words = ["walk", "design", "planar_biped_limit_cycle", "-o", "a.json", "--trajectory"];
    let run = run_in(&directory.path, &[&words[..], &["b.json"]].concat());
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    assert!(run.stderr.contains("references alone do not walk a limit cycle"), "{}", run.stderr);
    assert!(directory.files().is_empty());
}

/// Workers open a scenario each; standard input can be read once.
#[test]
fn scenarios_and_gaits_may_come_from_standard_input() {
    let directory = Directory::new("walk-stdin");
    let cycle = directory.path.join("gait.json");
    let shipped = denavit::shipped::find_scenario("planar_biped_limit_cycle_gait").unwrap();
    std::fs::write(&cycle, shipped.text).unwrap();
    let gait = directory.path.join("primitives.json");
    let primitives = denavit::shipped::find_gait("planar_biped_primitives").unwrap();
    std::fs::write(&gait, primitives.text).unwrap();
    for (file, words) in [
        (&cycle, &["walk", "basin", "-", "--grid", "2", "--steps", "1", "--json"][..]),
        (&cycle, &["walk", "push", "-", "--times", "1", "--after", "0.5", "--json"]),
        (&cycle, &["walk", "compare", "-", "--json"]),
        (&gait, &["walk", "poincare", "-", "--unchecked", "--returns", "1", "--json"]),
    ] {
        let piped = command(&directory.path)
            .args(words)
            .stdin(Stdio::from(std::fs::File::open(file).unwrap()))
            .output()
            .unwrap();
        let piped = Run::of(piped);
        let path = file.display().to_string();
        let by_path: Vec<&str> =
            words.iter().map(|word| if *word == "-" { &path } else { *word }).collect();
        let named = run_in(&directory.path, &by_path);
        assert_eq!(piped.code, Some(0), "{words:?}: {}", piped.stderr);
        assert_eq!(piped.stdout, named.stdout, "{words:?}");
    }
}

/// Without `bodies_that_must_not_touch` a robot lies on the ground and has not fallen.
#[test]
fn where_nothing_counts_as_a_fall_the_answer_says_so() {
    let words = ["walk", "push", "compass_gait", "--times", "1", "--after", "0.2"];
    let found = run(&[&words[..], &["--resolution", "1"]].concat());
    assert!(found.stdout.contains("nothing counts as a fall"), "{}", found.stdout);
    assert!(found.stdout.contains("to 1.00 N s"), "{}", found.stdout);
    assert_eq!(json(&[&words[..], &["--json"]].concat())["falls_are_seen"], false);
}
