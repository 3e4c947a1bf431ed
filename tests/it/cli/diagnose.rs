//! `denavit diagnose` as a user meets it.

use super::{Directory, command, run_in};
use serde_json::Value;
use std::fs;
use std::path::Path;

pub(super) const MODEL: &str = "tulip_leg_table34";

/// A log of the leg, made by the simulator, in a folder of its own.
pub(super) fn leg(name: &str) -> (Directory, String) {
    let directory = Directory::new(name);
    let run = run_in(&directory.path, &["simulate", "tulip_leg_identification", "-o", "leg.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let text = fs::read_to_string(directory.path.join("leg.csv")).unwrap();
    (directory, text)
}

/// The log with `added(q, rate)` on the torque of a joint, whose rate is a difference of its
/// positions.
pub(super) fn with_torque(log: &str, joint: &str, added: impl Fn(f64, f64) -> f64) -> String {
    let (comments, table): (Vec<&str>, Vec<&str>) =
        log.lines().partition(|line| line.starts_with('#'));
    let names: Vec<&str> = table[0].split(',').collect();
    let column = |name: &str| names.iter().position(|known| *known == name).unwrap();
    let (q, tau) = (column(&format!("q_{joint}")), column(&format!("tau_{joint}")));
    let rows: Vec<Vec<f64>> = table[1..]
        .iter()
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let mut lines: Vec<String> = comments.iter().map(|line| (*line).to_owned()).collect();
    lines.push(table[0].to_owned());
    // Over 20 rows, so that steps of the encoder do not count.
    let reach = 10;
    for (k, row) in rows.iter().enumerate() {
        let [from, to] = [k.saturating_sub(reach), (k + reach).min(rows.len() - 1)];
        let rate = (rows[to][q] - rows[from][q]) / (rows[to][0] - rows[from][0]);
        let mut row = row.clone();
        row[tau] += added(row[q], rate);
        lines.push(row.iter().map(f64::to_string).collect::<Vec<String>>().join(","));
    }
    lines.join("\n")
}

#[test]
fn a_drag_that_is_added_to_a_log_is_named_with_its_joint() {
    let (directory, log) = leg("diagnose_drag");
    let drag = 0.4;
    let dragged = with_torque(&log, "knee", |_, rate| drag * rate * rate.abs());
    fs::write(directory.path.join("drag.csv"), dragged).unwrap();
    let words = ["diagnose", MODEL, "--train", "drag.csv", "--validate", "drag.csv", "--json"];
    let words = [&words[..], &["--out", "found"]].concat();
    let run = run_in(&directory.path, &words);
    let json: Value = serde_json::from_str(&run.stdout).expect(&run.stderr);
    let effect = &json["effects"][0];
    assert_eq!((&effect["effect"], &effect["at"]), (&"quadratic_drag".into(), &"knee".into()));
    let value = effect["parameters"].as_object().unwrap().values().next().unwrap();
    let found = value["value"].as_f64().unwrap();
    assert!((found - drag).abs() < 0.05 * drag, "{found}");
    assert_eq!(json["where"][0]["joint"], "knee");
    // One log for both: nothing is held out, and that is said.
    assert!(json["reasons"].to_string().contains("nothing is held out"), "{}", json["reasons"]);
    // The model with the effect moves as the leg did.
    let gap = |when: &str| json["simulation_gap"]["validate"][when].as_f64().expect("a gap");
    assert!(gap("after") < 0.3 * gap("before"), "{}", json["simulation_gap"]);
    let effect = json["effects"][0]["parameters"]["c"].clone();
    the_model_has_the_effect(&directory, &effect);
    the_model_is_used(&directory);
    the_page_tells_it(&directory);

    // From standard input, and again: the same bytes.
    let first =
        ["model.json", "report.html"].map(|name| read(&directory, &format!("found/{name}")));
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(MODEL);
    let input = fs::File::open(shipped.with_extension("json")).unwrap();
    let mut words = words;
    words[1] = "-";
    let output = command(&directory.path).args(&words).stdin(input).output().unwrap();
    assert_eq!(output.stdout, run.stdout.as_bytes());
    let second =
        ["model.json", "report.html"].map(|name| read(&directory, &format!("found/{name}")));
    assert!(first == second);
}

fn read(directory: &Directory, name: &str) -> String {
    fs::read_to_string(directory.path.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// But for the effect the file is the one that was given, line by line.
fn the_model_has_the_effect(directory: &Directory, c: &Value) {
    let text = read(directory, "found/model.json");
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(MODEL);
    let shipped = fs::read_to_string(shipped.with_extension("json")).unwrap();
    let is_kept = |line: &&str| text.contains(line.trim_end_matches([',', '\r']));
    assert_eq!(shipped.lines().find(|line| !is_kept(line)), None);
    let model: Value = serde_json::from_str(&text).unwrap();
    let effects = model["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1);
    assert_eq!(effects[0]["effect"], "quadratic_drag");
    assert_eq!(effects[0]["at"], serde_json::json!({"link": "knee"}));
    for part in ["value", "std"] {
        let [written, told] = [&effects[0]["parameters"]["c"], c].map(|one| one[part].as_f64());
        let (written, told) = (written.unwrap(), told.unwrap());
        assert!(told > 0.0 && (written - told).abs() < 1e-9 * told, "{part}: {written} {told}");
    }
}

/// Equations, code and simulation have the term.
fn the_model_is_used(directory: &Directory) {
    let derived = |model: &str, file: &str| {
        let run = run_in(&directory.path, &["derive", model, "--latex", file]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        read(directory, file)
    };
    let [with, without] =
        [("found/model.json", "with.tex"), (MODEL, "without.tex")].map(|(a, b)| derived(a, b));
    assert!(with.contains("quadratic") && !without.contains("quadratic"), "{with}");
    let run = run_in(&directory.path, &["emit", "found/model.json", "-o", "leg.rs"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(read(directory, "leg.rs").contains("c_quadratic_drag_knee"));
    let path = "models/scenarios/tulip_leg_identification.json";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let mut scenario: Value = serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
    scenario["duration_s"] = 1.into();
    let torque = |model: &str| {
        let mut scenario = scenario.clone();
        scenario["model"] = model.into();
        fs::write(directory.path.join("scenario.json"), scenario.to_string()).unwrap();
        let run = run_in(&directory.path, &["simulate", "scenario.json", "-o", "again.csv"]);
        assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
        read(directory, "again.csv").lines().last().map(str::to_owned)
    };
    assert_ne!(torque("found/model.json"), torque(MODEL));
}

/// One page with a verdict, pictures and the new term, that loads nothing.
fn the_page_tells_it(directory: &Directory) {
    let page = read(directory, "found/report.html");
    let said = [
        "What the model lacks is named",
        "quadratic drag at knee",
        "<svg",
        "<math",
        "knee, drag.csv",
        "of it remains",
        "Simulation mismatch",
        "Round 1",
        "Its odds are",
        "N·m·s²",
    ];
    for words in said {
        assert!(page.contains(words), "{words}");
    }
    let without_names = page.replace("http://www.w3.org/", "");
    assert!(!without_names.contains("://"), "the page loads something");
}

#[test]
fn where_nothing_is_found_no_model_is_written_and_numbers_stay_short() {
    let (directory, _) = leg("diagnose_nothing");
    let words =
        ["diagnose", MODEL, "--train", "leg.csv", "--validate", "leg.csv", "--out", "found"];
    let run = run_in(&directory.path, &words);
    // One log for both judges nothing.
    assert_eq!(run.code, Some(1), "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.contains("leg.csv says the same as leg.csv"), "{}", run.stdout);
    assert!(run.stdout.contains("no model.json"), "{}", run.stdout);
    assert!(!directory.path.join("found/model.json").exists());
    assert!(read(&directory, "found/report.html").contains("Nothing is missing"));
    let longest = run.stdout.split_whitespace().map(|word| word.chars().count()).max();
    assert!(longest.unwrap() < 60, "{}", run.stdout);
}

#[test]
fn what_cannot_be_diagnosed_is_said_and_exits_with_2() {
    let (directory, log) = leg("diagnose_bad");
    let mute: Vec<String> = log.lines().map(|line| line.replace("tau_", "load_")).collect();
    fs::write(directory.path.join("mute.csv"), mute.join("\n")).unwrap();
    let short: Vec<&str> = log.lines().take(400).collect();
    fs::write(directory.path.join("short.csv"), short.join("\n")).unwrap();
    fs::write(directory.path.join("base.csv"), "t,q_a,tau_a\n0,0,0\n").unwrap();
    let cases: [(&[&str], &str); 5] = [
        (
            &[MODEL, "--train", "mute.csv", "--validate", "leg.csv"],
            "mute.csv: no joint has a torque",
        ),
        (&[MODEL, "--train", "leg.csv", "--validate", "short.csv"], "short.csv: "),
        (&[MODEL, "--train", "nothing.csv", "--validate", "leg.csv"], "nothing.csv"),
        (
            &[MODEL, "--train", "leg.csv", "--validate", "leg.csv", "--effects", "nowhere"],
            "nowhere",
        ),
        (&["tulip", "--train", "base.csv", "--validate", "base.csv"], "forces of contacts"),
    ];
    for (words, said) in cases {
        let run = run_in(&directory.path, &[&["diagnose"], words].concat());
        assert_eq!(run.code, Some(2), "{words:?}: {}", run.stdout);
        assert!(run.stderr.contains(said) && run.stdout.is_empty(), "{words:?}: {}", run.stderr);
    }
}

/// All logs that cannot be read are named at once, and no empty folder is left.
#[test]
fn every_wrong_log_is_named_and_nothing_is_left_behind() {
    let directory = Directory::new("diagnose_wrong_logs");
    fs::write(directory.path.join("a.csv"), "").unwrap();
    fs::write(directory.path.join("b.csv"), "t,q_knee\n0,1\n").unwrap();
    let words = ["diagnose", MODEL, "--train", "a.csv", "--validate", "b.csv"];
    let run = run_in(&directory.path, &[&words[..], &["--out", "new/found"]].concat());
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    let named = ["a.csv: no line with the names", "hint: a log begins with", "b.csv: "];
    assert!(named.iter().all(|text| run.stderr.contains(text)), "{}", run.stderr);
    assert!(!directory.path.join("new").exists());
}

/// A folder has the files of one answer: the model of another one goes with it.
#[test]
fn a_folder_that_is_used_again_has_no_model_of_the_answer_before() {
    let (directory, log) = leg("diagnose_again");
    let dragged = with_torque(&log, "knee", |_, rate| 0.4 * rate * rate.abs());
    fs::write(directory.path.join("drag.csv"), dragged).unwrap();
    let diagnosed = |log: &str| {
        let words = ["diagnose", MODEL, "--train", log, "--validate", log, "--out", "found"];
        let run = run_in(&directory.path, &words);
        assert_eq!(run.code, Some(1), "{}", run.stderr);
        directory.path.join("found/model.json").exists()
    };
    assert!(diagnosed("drag.csv"));
    fs::write(directory.path.join("found/notes.json"), "{}").unwrap();
    assert!(!diagnosed("leg.csv"));
    assert!(directory.path.join("found/notes.json").exists());
}

#[test]
fn a_log_that_is_searched_twice_is_refused() {
    let (directory, log) = leg("diagnose_twice");
    fs::write(directory.path.join("again.csv"), log).unwrap();
    let words = ["diagnose", MODEL, "--train", "leg.csv", "again.csv", "--validate", "leg.csv"];
    let run = run_in(&directory.path, &words);
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    assert!(run.stderr.contains("again.csv says the same as leg.csv"), "{}", run.stderr);
}

/// A stop that is reached once in each log leaves much for a moment: that is no chance.
#[test]
fn what_one_moment_shows_is_named() {
    let (directory, log) = leg("diagnose_likely");
    let stopped = with_torque(&log, "knee", |q, _| 20.0 * (q - 2.2825).max(0.0));
    let time = |line: &&str| line.split(',').next().and_then(|cell| cell.parse::<f64>().ok());
    let is_within = |line: &&str| time(line).is_none_or(|t| (3.0..8.0).contains(&t));
    let part: Vec<&str> = stopped.lines().filter(is_within).collect();
    fs::write(directory.path.join("part.csv"), part.join("\n")).unwrap();
    fs::write(directory.path.join("whole.csv"), stopped).unwrap();
    let words = ["diagnose", MODEL, "--train", "whole.csv", "--validate", "part.csv", "--json"];
    let run = run_in(&directory.path, &words);
    let said: Value = serde_json::from_str(&run.stdout).expect(&run.stderr);
    let named = said["effects"][0]["effect"].as_str();
    let stops = ["one_sided_spring", "hard_stop"];
    assert!(named.is_some_and(|named| stops.contains(&named)), "{said}");
    assert_eq!(said["effects"][0]["at"], "knee");
}
