//! `denavit identify` from a simulated log to a model that every command reads.

use super::{Directory, run_in};
use serde_json::Value;

fn simulated(directory: &Directory) {
    let run = run_in(&directory.path, &["simulate", "tulip_leg_tracking", "-o", "log.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

#[test]
fn a_simulated_log_gives_parameters_and_a_model() {
    let directory = Directory::new("identify");
    simulated(&directory);
    let words = [
        "identify",
        "tulip_leg",
        "--train",
        "log.csv",
        "--validate",
        "log.csv",
        "--filter",
        "20",
        "-o",
        "new.json",
        "--json",
    ];
    let run = run_in(&directory.path, &words);
    // the log that judges is the one of the estimate
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    let json: Value = serde_json::from_str(&run.stdout).expect("JSON");
    let parameters = json["parameters"].as_array().expect("a list");
    assert!(parameters.len() >= 14);
    for parameter in parameters {
        for key in ["name", "expression", "value", "unit"] {
            assert!(!parameter[key].is_null(), "{key}: {parameter}");
        }
        assert!(parameter["identifiable"].is_boolean());
    }
    for key in ["train", "validate", "per_joint"] {
        assert!(!json["residual"][key].is_null(), "{key}");
    }
    assert!(json["condition"].is_number());
    let again = run_in(&directory.path, &["inspect", "new.json"]);
    assert_eq!(again.code, Some(0), "{}", again.stderr);
    // The same input gives the same bytes, of which the model is none.
    let words: Vec<&str> =
        words.into_iter().filter(|word| !matches!(*word, "-o" | "new.json")).collect();
    let first = run_in(&directory.path, &words).stdout;
    assert_eq!(first, run_in(&directory.path, &words).stdout);
}

#[test]
fn what_is_wrong_is_said_and_exits_with_2() {
    let directory = Directory::new("identify_wrong");
    simulated(&directory);
    std::fs::write(directory.path.join("map.json"), r#"{"q_knie": "q_knee"}"#).expect("written");
    for (words, says) in [
        (vec!["identify", "puma560", "--train", "log.csv"], "is a log of `tulip_leg`"),
        (vec!["identify", "tulip_leg", "--train", "no.csv"], "no.csv"),
        (
            vec!["identify", "tulip_leg", "--train", "log.csv", "--columns", "map.json"],
            "did you mean `q_knee`?",
        ),
        (
            vec!["identify", "tulip_leg", "--train", "log.csv", "--filter", "9e9"],
            "at this sampling rate it must be below",
        ),
        (vec!["identify", "tulip_leg", "--train", "log.csv", "--average", "found"], "repeat"),
        (vec!["identify", "tulip_leg", "--train", "log.csv", "--keep", "mass"], "mass"),
    ] {
        let run = run_in(&directory.path, &words);
        assert_eq!(run.code, Some(2), "{words:?}: {}", run.stderr);
        assert!(run.stderr.contains(says), "{words:?}: {}", run.stderr);
        assert!(run.stdout.is_empty());
    }
}

#[test]
fn filters_and_outputs_that_cannot_be_are_refused() {
    let directory = Directory::new("identify-refused");
    simulated(&directory);
    for (more, expected) in [
        (&["--filter", "1e-9"][..], "301 rows: this filter cuts the edges off"),
        (&["--html", "out", "--svg", "out"], "two outputs would be this file"),
        (&["--html", "nowhere/page.html"], "no such file or directory"),
    ] {
        let words = [&["identify", "tulip_leg", "--train", "log.csv"], more].concat();
        let run = run_in(&directory.path, &words);
        assert_eq!(run.code, Some(2), "{more:?}");
        assert!(run.stderr.contains(expected), "{more:?}: {}", run.stderr);
    }
}

/// Steps of encoders are differentiated twice: below a high cutoff they drown the torque.
#[test]
fn noise_of_positions_that_biases_is_said() {
    let directory = Directory::new("identify-bias");
    let run = run_in(&directory.path, &["simulate", "tulip_leg_identification", "-o", "log.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    for (cutoff, is_said) in [("100", true), ("10", false)] {
        let words = ["identify", "tulip_leg_table34", "--train", "log.csv", "--filter", cutoff];
        let run = run_in(&directory.path, &words);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert_eq!(run.stdout.contains("biases parameters"), is_said, "{}", run.stdout);
        assert!(!run.stdout.contains("filtered below"), "{}", run.stdout);
    }
    // a filter that nobody asked for gets out of the way
    let run = run_in(&directory.path, &["identify", "tulip_leg_table34", "--train", "log.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(run.stdout.contains("filtered below"), "{}", run.stdout);
    assert!(!run.stdout.contains("biases parameters"), "{}", run.stdout);
}

/// The torque in a log is what the joint needs, Coulomb friction of its drive among it.
#[test]
fn friction_is_found_in_a_simulated_log() {
    let directory = Directory::new("identify-friction");
    simulated(&directory);
    let words = ["identify", "tulip_leg", "--train", "log.csv", "--filter", "20", "--json"];
    let run = run_in(&directory.path, &words);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let json: Value = serde_json::from_str(&run.stdout).expect("JSON");
    let parameters = json["parameters"].as_array().expect("a list");
    let hip = parameters.iter().find(|one| one["name"] == "fc_hip_x").expect("it is a parameter");
    let [value, truth] = ["value", "model_value"].map(|key| hip[key].as_f64().expect("a number"));
    // the simulated friction is a steep line about rest, where the regressor has a sign
    assert!((0.5 * truth..1.1 * truth).contains(&value), "{value} instead of {truth}");
}
