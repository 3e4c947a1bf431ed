//! `denavit diagnose` as a user meets it.

use super::{Directory, run_in};
use std::fs;

const MODEL: &str = "tulip_leg_table34";

/// A log of the leg, made by the simulator, in a folder of its own.
fn leg(name: &str) -> (Directory, String) {
    let directory = Directory::new(name);
    let run = run_in(&directory.path, &["simulate", "tulip_leg_identification", "-o", "leg.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let text = fs::read_to_string(directory.path.join("leg.csv")).unwrap();
    (directory, text)
}

/// The log with `added(rate)` on the torque of a joint, whose rate is a difference of its
/// positions.
fn with_torque(log: &str, joint: &str, added: impl Fn(f64) -> f64) -> String {
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
        row[tau] += added(rate);
        lines.push(row.iter().map(f64::to_string).collect::<Vec<String>>().join(","));
    }
    lines.join("\n")
}

#[test]
fn a_drag_that_is_added_to_a_log_is_named_with_its_joint() {
    let (directory, log) = leg("diagnose_drag");
    let drag = 0.4;
    let dragged = with_torque(&log, "knee", |rate| drag * rate * rate.abs());
    fs::write(directory.path.join("drag.csv"), dragged).unwrap();
    let words = ["diagnose", MODEL, "--train", "drag.csv", "--validate", "drag.csv", "--json"];
    let run = run_in(&directory.path, &words);
    let json: serde_json::Value = serde_json::from_str(&run.stdout).expect(&run.stderr);
    let effect = &json["effects"][0];
    assert_eq!((&effect["effect"], &effect["at"]), (&"quadratic_drag".into(), &"knee".into()));
    let value = effect["parameters"].as_object().unwrap().values().next().unwrap();
    let found = value["value"].as_f64().unwrap();
    assert!((found - drag).abs() < 0.05 * drag, "{found}");
    assert_eq!(json["where"][0]["joint"], "knee");
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
        (&["tulip", "--train", "base.csv", "--validate", "base.csv"], "tulip"),
    ];
    for (words, said) in cases {
        let run = run_in(&directory.path, &[&["diagnose"], words].concat());
        assert_eq!(run.code, Some(2), "{words:?}: {}", run.stdout);
        assert!(run.stderr.contains(said) && run.stdout.is_empty(), "{words:?}: {}", run.stderr);
    }
}
