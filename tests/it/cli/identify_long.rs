//! `denavit identify --long` and `denavit long`: logs that are read piece by piece.

use super::{Directory, Run, run_in};
use serde_json::Value;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

const ROWS: usize = 300_000;

/// A pendulum of 2 kg, 0.3 m from its axis, with 0.05 kg m^2 about its centre of mass.
const MODEL: &str = r#"{
  "format": "denavit-model/1", "name": "pendulum", "convention": "standard",
  "gravity": [0, -9.81, 0],
  "links": [{"name": "swing", "joint": {"type": "revolute", "a": 0.5},
    "body": {"mass": 2, "com": [-0.2, 0, 0], "inertia": {"zz": 0.05}, "about": "com"}}]
}"#;

/// Its log for five minutes: two waves that never repeat together, and the torque of its equation.
fn pendulum(directory: &Directory) {
    let mut text = String::from("t,q_swing,tau_swing\n");
    for row in 0..ROWS {
        let t = 1e-3 * row as f64;
        let [mut q, mut qdd] = [0.0; 2];
        for (hz, size) in [(0.3713, 0.7), (0.9137, 0.3)] {
            let w = TAU * hz;
            q += size * (w * t).sin();
            qdd -= size * w * w * (w * t).sin();
        }
        let tau = (0.05 + 2.0 * 0.09) * qdd + 2.0 * 9.81 * 0.3 * f64::cos(q);
        writeln!(text, "{t:.3},{q:.12},{tau:.12}").expect("text grows");
    }
    fs::write(directory.path.join("log.csv"), text).expect("written");
    fs::write(directory.path.join("pendulum.json"), MODEL).expect("written");
}

const OPTIONS: [&str; 6] = ["pendulum.json", "--train", "log.csv", "--filter", "20", "--json"];

fn run(directory: &Directory, words: &[&str], more: &[&str]) -> Run {
    let all: Vec<&str> = words.iter().chain(&OPTIONS).chain(more).copied().collect();
    run_in(&directory.path, &all)
}

/// A plan for pieces that are in `ab.jsonl` and `c.jsonl`: refused with another head, with judges
/// that rows were not compared with, and if it claims more than its lists have.
fn plans_of_others(directory: &Directory, mut claimed: Value) {
    claimed["stretches"] = (1_u64 << 62).into();
    fs::write(directory.path.join("claimed.json"), claimed.to_string()).expect("written");
    let words = ["long", "condense", "--pieces", "0:1", "--plan", "claimed.json"];
    let refused = run(directory, &words, &[]);
    assert!(refused.stderr.contains("contradicts itself"), "{}", refused.stderr);
    let text = fs::read_to_string(directory.path.join("log.csv")).expect("written");
    let later: Vec<&str> = text.lines().take(1).chain(text.lines().skip(1000)).collect();
    fs::write(directory.path.join("other.csv"), later.join("\n")).expect("written");
    let more = ["--rows", "ab.jsonl", "c.jsonl", "--plan", "plan.json", "--head", "100000"];
    let words = ["long", "estimate", "pendulum.json", "--filter", "20", "--train"];
    for (log, judge, said) in [
        ("other.csv", &[][..], "another head"),
        ("log.csv", &["--validate", "other.csv"], "the plan is for"),
    ] {
        let words = [&words[..], &[log], judge, &more].concat();
        let other = run_in(&directory.path, &words);
        assert!(other.code == Some(2) && other.stderr.contains(said), "{}", other.stderr);
    }
}

/// Three stretches, of which the first is the head's: the closed form's values, and the same bytes
/// from pieces that were condensed apart.
/// Pieces of logs of equal length, condensed by the same plan: one that is another log from the
/// middle of piece 1 on, and one that is another log from its beginning. And numbers of pieces that
/// were changed.
fn pieces_of_others(directory: &Directory) {
    let text = fs::read_to_string(directory.path.join("log.csv")).expect("written");
    let piece = |from: usize, pieces: &str| {
        let other = Directory::new(&format!("identify_long_from_{from}"));
        let mut changed = String::new();
        for (row, line) in text.lines().enumerate() {
            let (rest, torque) = line.rsplit_once(',').expect("columns");
            let other = torque.parse::<f64>().ok().filter(|_| row > from);
            let torque = other.map_or(torque.to_owned(), |torque| format!("{:.12}", 1.1 * torque));
            writeln!(changed, "{rest},{torque}").expect("text grows");
        }
        fs::write(other.path.join("log.csv"), changed).expect("written");
        fs::write(other.path.join("pendulum.json"), MODEL).expect("written");
        let plan = directory.path.join("plan.json");
        let plan = ["--plan", plan.to_str().expect("text")];
        let condensed = run(&other, &["long", "condense", "--pieces", pieces], &plan);
        assert_eq!(condensed.code, Some(0), "{}", condensed.stderr);
        condensed.stdout
    };
    let own = |name: &str| fs::read_to_string(directory.path.join(name)).expect("written");
    let [ab, c] = ["ab.jsonl", "c.jsonl"].map(own);
    let more = ["--head", "100000", "--plan", "plan.json", "--rows", "other.jsonl"];
    for (rows, said) in [
        (format!("{ab}{}", piece(150_000, "2:3")), "piece 2 was condensed from another log than"),
        (format!("{}{c}", piece(0, "0:2")), "piece 0 was condensed from another log than the head"),
        (format!("{ab}{}", c.replacen("e-", "e-2", 1)), "other.jsonl:3: has other numbers"),
        (format!("{ab}{}", c.replacen("\"samples\":", "\"samples\":1", 1)), "has other numbers"),
    ] {
        fs::write(directory.path.join("other.jsonl"), rows).expect("written");
        let refused = run(directory, &["long", "estimate"], &more);
        let is_told = refused.code == Some(2) && refused.stderr.contains(said);
        assert!(is_told, "{said}: {}{}", refused.stdout, refused.stderr);
    }
}

#[test]
fn pieces_give_the_values_of_the_closed_form_and_the_bytes_of_one_process() {
    let directory = Directory::new("identify_long");
    pendulum(&directory);
    let head = ["--head", "100000"];
    let together = run(&directory, &["identify", "--long"], &head);
    assert_eq!(together.code, Some(0), "{}", together.stderr);
    let found: Value = serde_json::from_str(&together.stdout).expect("JSON");
    // edges are cut, and one sample in twenty is left
    let samples = found["samples"].as_u64().expect("a count");
    assert!((14_000..15_000).contains(&samples), "{samples}");
    let parameters = found["parameters"].as_array().expect("a list");
    // about the link's own frame, 0.5 m from the axis: m - 4 Izz, mx + 2 Izz, my
    let izz = 0.05 + 2.0 * 0.04;
    for (parameter, expected) in parameters.iter().zip([2.0 - 4.0 * izz, -0.4 + 2.0 * izz, 0.0]) {
        let value = parameter["value"].as_f64().expect("a number");
        assert!((value - expected).abs() < 1e-4, "{parameter}");
    }

    let plan = run(&directory, &["long", "plan"], &head);
    assert_eq!(plan.code, Some(0), "{}", plan.stderr);
    fs::write(directory.path.join("plan.json"), &plan.stdout).expect("written");
    let plan: Value = serde_json::from_str(&plan.stdout).expect("JSON");
    assert_eq!(plan["pieces"], 3);
    let of_plan = ["--plan", "plan.json"];
    let mut rows = String::new();
    for (piece, name) in [("2:3", "c.jsonl"), ("0:2", "ab.jsonl")] {
        let condensed = run(&directory, &["long", "condense", "--pieces", piece], &of_plan);
        assert_eq!(condensed.code, Some(0), "{}", condensed.stderr);
        fs::write(directory.path.join(name), &condensed.stdout).expect("written");
        rows.insert_str(0, &condensed.stdout);
    }
    let estimate = |rows: &[&str]| {
        let more: Vec<&str> =
            head.iter().chain(&of_plan).chain(&["--rows"]).chain(rows).copied().collect();
        run(&directory, &["long", "estimate"], &more)
    };
    let apart = estimate(&["ab.jsonl", "c.jsonl"]);
    assert_eq!(apart.stdout, together.stdout, "{}", apart.stderr);
    let (code, said) = (Some(2), "piece 0 is not there");
    let turned = estimate(&["c.jsonl", "ab.jsonl"]);
    assert!(turned.code == code && turned.stderr.contains(said), "{}", turned.stderr);
    let few = estimate(&["ab.jsonl"]);
    assert!(few.code == code && few.stderr.contains("piece 2 of 3"), "{}", few.stderr);
    fs::write(directory.path.join("cut.jsonl"), &rows[..rows.len() / 2]).expect("written");
    let cut = estimate(&["cut.jsonl"]);
    assert!(cut.code == code && cut.stderr.contains("cut.jsonl:"), "{}", cut.stderr);
    pieces_of_others(&directory);
    plans_of_others(&directory, plan);
    // a plan for other rows
    let mut words = vec!["long", "condense", "--pieces", "0:1", "--skip-slow", "off"];
    words.extend(of_plan);
    let other = run(&directory, &words, &[]);
    assert!(other.code == code && other.stderr.contains("the plan is for"), "{}", other.stderr);
}

/// A log for validation that was cut out of the rest, its clock begun anew: told once, by the
/// stretch that it is in.
#[test]
fn a_part_of_the_rest_does_not_judge() {
    let directory = Directory::new("identify_long_part");
    pendulum(&directory);
    let log = fs::read_to_string(directory.path.join("log.csv")).expect("written");
    let mut part = String::from("t,q_swing,tau_swing\n");
    for (row, line) in log.lines().skip(150_000).take(60_000).enumerate() {
        let (_, numbers) = line.split_once(',').expect("columns");
        writeln!(part, "{:.3},{numbers}", 1e-3 * row as f64).expect("text grows");
    }
    fs::write(directory.path.join("part.csv"), part).expect("written");
    let more = ["--head", "100000", "--validate", "part.csv"];
    let judged = run(&directory, &["identify", "--long"], &more);
    assert_eq!(judged.code, Some(1), "{}", judged.stderr);
    let found: Value = serde_json::from_str(&judged.stdout).expect("JSON");
    let remarks = found["remarks"].as_array().expect("a list");
    let told = |one: &&Value| one.as_str().is_some_and(|one| one.contains("says the same as"));
    let told: Vec<&Value> = remarks.iter().filter(told).collect();
    let [Value::String(told)] = told[..] else { panic!("{remarks:?}") };
    assert!(told.starts_with("part.csv: says the same as log.csv from row 1"), "{told}");
}

/// A log no longer than its head is identified as any log is.
#[test]
fn a_short_log_is_identified_as_any_log_is() {
    let directory = Directory::new("identify_long_short");
    let run = run_in(&directory.path, &["simulate", "tulip_leg_tracking", "-o", "log.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let words = ["identify", "tulip_leg", "--train", "log.csv", "--json"];
    let usual = run_in(&directory.path, &words);
    let long = run_in(&directory.path, &[&words[..], &["--long"]].concat());
    assert_eq!(usual.stdout, long.stdout, "{}", long.stderr);
}

#[test]
fn what_is_not_read_piece_by_piece_is_said() {
    let directory = Directory::new("identify_long_wrong");
    for file in ["log.csv", "log.mcap"] {
        let run = run_in(&directory.path, &["simulate", "tulip_leg_tracking", "-o", file]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
    }
    fs::write(directory.path.join("plan.json"), "{}").expect("written");
    let long = ["identify", "tulip_leg", "--long", "--head", "1000", "--train"];
    let condense = "long condense tulip_leg --train log.csv --plan plan.json --pieces";
    let condense: Vec<&str> = condense.split(' ').collect();
    for (words, says) in [
        ([&long[..], &["log.csv", "--method", "huber"]].concat(), "least squares alone"),
        ([&long[..], &["log.csv", "--average", "2"]].concat(), "laps are averaged"),
        ([&long[..], &["log.csv", "log.csv"]].concat(), "one log is read piece by piece"),
        ([&long[..], &["log.mcap"]].concat(), "hint: write them as a table"),
        ([&long[..], &["no.csv"]].concat(), "no.csv"),
        ([&condense[..], &["0:1"]].concat(), "plan.json: no plan"),
        ([&condense[..], &["1:1"]].concat(), "the first below the second"),
    ] {
        let run = run_in(&directory.path, &words);
        assert_eq!(run.code, Some(2), "{words:?}: {}", run.stderr);
        assert!(run.stderr.contains(says), "{words:?}: {}", run.stderr);
    }
}
