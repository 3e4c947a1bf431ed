//! Models that have effects already, in every command that makes something of logs or columns.

use super::diagnose::{MODEL, leg, with_torque};
use super::errors::assert_says;
use super::{Directory, run_in};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const DRAG: f64 = 0.4;

fn drag(factor: f64) -> impl Fn(f64, f64) -> f64 {
    move |_, rate| factor * rate * rate.abs()
}

fn answer(directory: &Directory, words: &[&str]) -> Value {
    let run = run_in(&directory.path, words);
    serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{words:?}: {}", run.stderr))
}

/// The leg with effects, as a file.
fn with_effects(directory: &Directory, effects: &Value) {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(MODEL);
    let text = fs::read_to_string(shipped.with_extension("json")).unwrap();
    let mut model: Value = serde_json::from_str(&text).unwrap();
    model["effects"] = effects.clone();
    fs::write(directory.path.join("leg.json"), model.to_string()).unwrap();
}

#[test]
fn a_second_effect_is_found_after_the_first() {
    let (directory, log) = leg("given_second");
    let log = with_torque(&log, "knee", drag(DRAG));
    let log = with_torque(&log, "hip_y", drag(0.5 * DRAG));
    fs::write(directory.path.join("drag.csv"), log).unwrap();
    let logs = ["--train", "drag.csv", "--validate", "drag.csv", "--json", "--most", "1"];
    let words = [&["diagnose", MODEL], &logs[..], &["--out", "first"]].concat();
    let first = answer(&directory, &words);
    assert_eq!(first["effects"][0]["effect"], "quadratic_drag");
    let [here, there] = match first["effects"][0]["at"].as_str() {
        Some("knee") => [("knee", DRAG), ("hip_y", 0.5 * DRAG)],
        _ => [("hip_y", 0.5 * DRAG), ("knee", DRAG)],
    };
    let words = [&["diagnose", "first/model.json"], &logs[..], &["--out", "second"]].concat();
    let second = answer(&directory, &words);
    let near = |value: &Value, truth: f64| {
        let value = value["parameters"]["c"]["value"].as_f64().unwrap();
        assert!((value - truth).abs() < 0.05 * truth, "{value} {truth}");
    };
    assert_eq!(second["effects"].as_array().unwrap().len(), 1, "{second}");
    let found = &second["effects"][0];
    assert_eq!((&found["effect"], &found["at"]), (&"quadratic_drag".into(), &json!(there.0)));
    near(found, there.1);
    let given = &second["given"][0];
    assert_eq!((&given["at"], &given["treatment"]), (&json!(here.0), &"estimated".into()));
    near(given, here.1);
    // The gap goes on from where the first left it.
    let [after, before] = [(&first, "after"), (&second, "before")]
        .map(|(json, when)| json["gap"]["validate"][when].as_f64().unwrap());
    assert!((after / before - 1.0).abs() < 0.05, "{after} {before}");
    // The model has both, the first with its new value.
    let text = fs::read_to_string(directory.path.join("second/model.json")).unwrap();
    let model: Value = serde_json::from_str(&text).unwrap();
    let effects = model["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 2);
    let [written, told] = [&effects[0], given].map(|one| one["parameters"]["c"]["value"].as_f64());
    assert!((written.unwrap() - told.unwrap()).abs() < 1e-9);
    // With both nothing is missing.
    let words = [&["diagnose", "second/model.json"], &logs[..]].concat();
    let third = answer(&directory, &words);
    assert_eq!((&third["effects"], &third["verdict"]), (&json!([]), &"nothing_missing".into()));
}

/// Parameters with their errors.
fn identified(directory: &Directory, model: &str, log: &str) -> Vec<[f64; 2]> {
    let words = ["identify", model, "--train", log, "--filter", "20", "--json"];
    let json = answer(directory, &words);
    let of = |one: &Value| [&one["value"], &one["std"]].map(|one| one.as_f64().unwrap_or(0.0));
    json["parameters"].as_array().unwrap().iter().map(of).collect()
}

/// By how many of their errors parameters differ, at most.
fn apart(all: &[[f64; 2]], others: &[[f64; 2]]) -> f64 {
    assert_eq!(all.len(), others.len());
    let both = all.iter().zip(others).filter(|([_, std], _)| *std > 0.0);
    both.map(|([a, std], [b, _])| (a - b).abs() / std).fold(0.0, f64::max)
}

#[test]
fn identification_takes_effects_of_the_model_out_of_logs() {
    let (directory, clean) = leg("given_identify");
    let path = |name: &str| directory.path.join(name);
    fs::write(path("drag.csv"), with_torque(&clean, "knee", drag(DRAG))).unwrap();
    let truth = identified(&directory, MODEL, "leg.csv");
    assert!(apart(&truth, &identified(&directory, MODEL, "drag.csv")) > 5.0, "drag is felt");
    with_effects(
        &directory,
        &json!([{"effect": "quadratic_drag", "at": {"link": "knee"}, "parameters": {"c": DRAG}}]),
    );
    let dragged = apart(&truth, &identified(&directory, "leg.json", "drag.csv"));
    assert!(dragged < 0.5, "{dragged}");
    // What is logged a tenth too large.
    let (comments, table): (Vec<&str>, Vec<&str>) =
        clean.lines().partition(|line| line.starts_with('#'));
    let column = table[0].split(',').position(|name| name == "tau_knee").unwrap();
    let scaled = table[1..].iter().map(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        cells[column] = (1.1 * cells[column].parse::<f64>().unwrap()).to_string();
        cells.join(",")
    });
    let lines: Vec<String> =
        comments.iter().chain(&table[..1]).map(|line| (*line).to_owned()).chain(scaled).collect();
    fs::write(path("gain.csv"), lines.join("\n") + "\n").unwrap();
    with_effects(
        &directory,
        &json!([{"effect": "torque_gain", "at": {"link": "knee"}, "parameters": {"g": 0.1}}]),
    );
    let undone = apart(&truth, &identified(&directory, "leg.json", "gain.csv"));
    assert!(undone < 1e-6, "{undone}");
}

#[test]
fn commands_about_columns_say_what_becomes_of_effects() {
    let directory = Directory::new("given_columns");
    with_effects(
        &directory,
        &json!([
            {"effect": "quadratic_drag", "at": {"link": "knee"}, "parameters": {"c": 0.4}},
            {"effect": "payload_point", "at": {"link": "ankle_y"},
             "parameters": {"mass": 0.5, "cx": 0.1, "cy": 0, "cz": 0}}
        ]),
    );
    let excite = ["--harmonics", "2", "--starts", "1", "--evaluations", "5"];
    for command in [&["base"][..], &["decompose", "--terms", "gravity"], &["excite"]] {
        let mut words = vec![command[0], "leg.json"];
        words.extend(&command[1..]);
        if command[0] == "excite" {
            words.extend(excite);
        }
        let run = run_in(&directory.path, &words);
        let said = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_says(&said, &["effect `quadratic_drag` at knee: left out", "`payload_point`"]);
        assert_says(&said, &["part of what is known"]);
        let json = answer(&directory, &[&words[..], &["--json"]].concat());
        let treatments: Vec<&Value> =
            json["effects"].as_array().unwrap().iter().map(|one| &one["treatment"]).collect();
        assert_eq!(treatments, ["known", "left_out"], "{words:?}");
    }
    // Bodies that are known change no rank, and a certificate holds for the model as it is.
    let words = ["base", "leg.json", "--certificate", "proof.json", "--json"];
    let rank = |json: Value| json["rank"].as_u64().unwrap();
    assert_eq!(
        rank(answer(&directory, &words)),
        rank(answer(&directory, &["base", MODEL, "--json"]))
    );
    let run = run_in(&directory.path, &["verify", "proof.json", "leg.json"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
}

#[test]
fn laws_without_values_and_commands_without_a_place_for_them_are_refused() {
    let (directory, _) = leg("given_refused");
    with_effects(&directory, &json!([{"effect": "quadratic_drag", "at": {"link": "knee"}}]));
    let words = ["diagnose", "leg.json", "--train", "leg.csv", "--validate", "leg.csv"];
    let run = run_in(&directory.path, &words);
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    assert_says(&run.stderr, &["`quadratic_drag` at knee has no value for `c`", "hint: "]);
    with_effects(
        &directory,
        &json!([{"effect": "quadratic_drag", "at": {"link": "knee"}, "parameters": {"c": 0.4}}]),
    );
    let words = ["identify", "leg.json", "--train", "leg.csv", "--two-stage"];
    let run = run_in(&directory.path, &words);
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    assert_says(&run.stderr, &["no place for the effect `quadratic_drag`", "hint: "]);
}
