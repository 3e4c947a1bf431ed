//! `denavit walk`: answers, exit codes, and what is refused.

use super::{Directory, Run, json, run_in};
use std::path::Path;

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
        (&["walk", "poincare", "no_such_gait"], "no shipped scenario"),
        (&["walk", "basin", GAIT, "--vary", "q_nose,q_base_pitch"], "q_nose"),
        (&["walk", "basin", GAIT, "--noise", "0"], "positive"),
        (&["walk", "push", GAIT, "--link", "nose"], "nose"),
        (&["walk", "zmp", "Cargo.toml", "--model", "planar_biped"], "Cargo.toml"),
    ] {
        let refused = run(words);
        assert_eq!(refused.code, Some(2), "{words:?}: {}", refused.stdout);
        assert!(refused.stderr.contains(said), "{words:?}: {}", refused.stderr);
    }
}
