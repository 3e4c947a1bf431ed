//! Logs of ROS 2: the same answers as from CSV, files that are cut, the walk from URDF and bag to
//! a verdict.

use super::{Directory, Run, run_in};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A folder with an arm, its URDF without friction, and scenarios of the arm as it is.
fn with_arm(name: &str) -> Directory {
    let directory = Directory::new(name);
    let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/bag");
    for file in ["arm.urdf", "arm_in_the_room.urdf", "train.json", "validate.json"] {
        fs::copy(files.join(file), directory.path.join(file)).expect("a copy");
    }
    directory
}

fn run(directory: &Directory, line: &str) -> Run {
    let words: Vec<&str> = line.split_whitespace().collect();
    run_in(&directory.path, &words)
}

fn done(directory: &Directory, line: &str) -> String {
    let run = run(directory, line);
    assert_eq!(run.code, Some(0), "{line}: {}{}", run.stdout, run.stderr);
    run.stdout
}

fn values(text: &str) -> Vec<f64> {
    let json: Value = serde_json::from_str(text).expect("JSON");
    let all = json["parameters"].as_array().expect("a list");
    all.iter().filter_map(|one| one["value"].as_f64()).collect()
}

/// Nobody is given CSV under the name of another format.
#[test]
fn a_run_is_not_written_as_what_it_is_not() {
    let directory = with_arm("other");
    for file in ["run.parquet", "run.db3", "run.ARROW"] {
        let run = run(&directory, &format!("simulate train.json -o {file}"));
        assert_eq!(run.code, Some(2), "{}", run.stdout);
        assert!(run.stderr.contains("runs are CSV or MCAP"), "{}", run.stderr);
        assert!(!directory.path.join(file).exists());
    }
}

/// A folder of a bag around a file.
fn bag(directory: &Directory, file: &str) {
    let folder = directory.path.join("bag");
    fs::create_dir(&folder).expect("made");
    fs::copy(directory.path.join(file), folder.join("bag_0.mcap")).expect("a copy");
    let metadata = "rosbag2_bagfile_information:\n  version: 9\n  storage_identifier: mcap\n  \
                    relative_file_paths:\n    - bag_0.mcap\n  compression_mode: \"\"\n";
    fs::write(folder.join("metadata.yaml"), metadata).expect("written");
}

/// What judges a walk, and what a reference follows, may be messages: the same answers as of CSV.
#[test]
fn walks_and_references_do_not_depend_on_the_format_of_the_log() {
    let directory = with_arm("walked");
    for file in ["gait.csv", "gait.mcap"] {
        done(&directory, &format!("simulate planar_biped_limit_cycle_gait -o {file}"));
    }
    bag(&directory, "gait.mcap");
    let judged = |log: &str| {
        let said = done(&directory, &format!("walk zmp {log} --model planar_biped"));
        said.replace(log, "LOG")
    };
    let expected = judged("gait.csv");
    assert!(expected.contains("least margin"), "{expected}");
    assert_eq!(judged("gait.mcap"), expected);
    assert_eq!(judged("bag"), expected);

    for file in ["train.csv", "train.mcap"] {
        done(&directory, &format!("simulate train.json -o {file}"));
    }
    let text = |log: &str| {
        format!(
            r#"{{"format": "denavit-scenario/1", "model": "arm.urdf", "duration_s": 0.2,
 "control": {{"joints": {{"shoulder": {{"kp": 400, "kd": 30,
   "reference": {{"log": {{"file": "{log}", "column": "q_shoulder"}}}}}}}}}}}}"#
        )
    };
    let mut runs: Vec<Vec<f64>> = Vec::new();
    for log in ["train.csv", "train.mcap"] {
        fs::write(directory.path.join("follow.json"), text(log)).expect("written");
        done(&directory, "simulate follow.json -o run.csv");
        let run = fs::read_to_string(directory.path.join("run.csv")).expect("a run");
        let rows = run.lines().filter(|line| line.starts_with("0."));
        let numbers = rows.flat_map(|row| row.split(',').map(|cell| cell.parse().expect("a cell")));
        runs.push(numbers.collect::<Vec<f64>>());
    }
    // times of messages are whole nanoseconds
    let pairs = || runs[0].iter().zip(&runs[1]);
    assert!(runs[0].len() > 100 && runs[0].len() == runs[1].len());
    assert!(pairs().all(|(one, other)| (one - other).abs() < 1e-5 * (1.0 + one.abs())));
    fs::write(directory.path.join("cut.mcap"), b"\x89MCAP0\r\n").expect("written");
    fs::write(directory.path.join("follow.json"), text("cut.mcap")).expect("written");
    let refused = run(&directory, "simulate follow.json");
    assert_eq!(refused.code, Some(2), "{}", refused.stderr);
    assert!(refused.stderr.contains("cut.mcap"), "{}", refused.stderr);
}

#[test]
fn parameters_do_not_depend_on_the_format_of_the_log() {
    let directory = with_arm("formats");
    done(&directory, "simulate train.json -o train.csv");
    done(&directory, "simulate train.json -o train.mcap");
    bag(&directory, "train.mcap");
    let map = r#"{"q_{joint}": "/joint_states/{joint}/position", "tau_{joint}":
        {"column": "/joint_states/{joint}/effort", "scale": 1}}"#;
    fs::write(directory.path.join("map.json"), map).expect("written");
    let identify = |logs: &str| {
        let line = format!("identify arm.urdf --train {logs} --with friction --json");
        values(&done(&directory, &line))
    };
    let expected = identify("train.csv");
    assert!(expected.len() >= 6, "{expected:?}");
    for logs in ["train.mcap", "bag", "bag --columns map.json"] {
        let found = identify(logs);
        assert_eq!(found.len(), expected.len(), "{logs}");
        for (found, expected) in found.iter().zip(&expected) {
            // times of messages are whole nanoseconds
            assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{logs}: {found}");
        }
    }
}

#[test]
fn a_cut_log_offers_what_is_whole() {
    let directory = with_arm("cut");
    done(&directory, "simulate train.json -o train.mcap");
    let path = directory.path.join("train.mcap");
    let bytes = fs::read(&path).expect("a file");
    fs::write(&path, &bytes[..bytes.len() * 3 / 4]).expect("written");
    let cut = run(&directory, "identify arm.urdf --train train.mcap --with friction");
    assert_eq!(cut.code, Some(2));
    assert!(cut.stderr.contains("train.mcap: message "), "{}", cut.stderr);
    assert!(cut.stderr.contains("before are whole: --accept-cut reads them"), "{}", cut.stderr);
    let line = "identify arm.urdf --train train.mcap --with friction --accept-cut";
    let taken = run(&directory, line);
    assert_eq!(taken.code, Some(0), "{}", taken.stderr);
    assert!(taken.stdout.contains("damaged from message"), "{}", taken.stdout);
}

#[test]
fn what_a_bag_does_not_have_is_named() {
    let directory = with_arm("lacking");
    done(&directory, "simulate train.json -o train.mcap");
    let of_leg = run(&directory, "identify tulip_leg_table34 --train train.mcap");
    assert_eq!(of_leg.code, Some(2));
    assert!(of_leg.stderr.contains("is a log of `arm`"), "{}", of_leg.stderr);
    assert!(of_leg.stderr.contains("there is no column `q_knee`"), "{}", of_leg.stderr);
    assert!(of_leg.stderr.contains("does not have: shoulder, elbow_1"), "{}", of_leg.stderr);
    fs::write(directory.path.join("map.json"), r#"{"q_{joint}": "/joints/{joint}/position"}"#)
        .expect("written");
    let line = "identify arm.urdf --train train.mcap --columns map.json";
    let mapped = run(&directory, line);
    assert_eq!(mapped.code, Some(2));
    let hint = "the log has `/joint_states/shoulder/position`";
    assert!(mapped.stderr.contains(hint), "{}", mapped.stderr);
    fs::write(directory.path.join("metadata.yaml"), "").expect("written");
    let folder = run(&directory, "identify arm.urdf --train .");
    assert_eq!(folder.code, Some(2));
    assert!(folder.stderr.contains("metadata.yaml names no files"), "{}", folder.stderr);
}

/// The commands of the page, on an arm and bags that are made here.
#[test]
fn the_page_leads_from_urdf_and_bag_to_a_verdict() {
    let directory = with_arm("verdict");
    for name in ["train", "validate"] {
        done(&directory, &format!("simulate {name}.json -o {name}.mcap"));
    }
    // what the user of the page does not have
    for file in ["arm_in_the_room.urdf", "train.json", "validate.json"] {
        fs::remove_file(directory.path.join(file)).expect("removed");
    }
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide/from-your-urdf.md");
    let page = fs::read_to_string(page).expect("the page");
    let (_, part) = page.split_once("## From URDF and bag to a verdict").expect("the part");
    let part = part.split("\n## ").next().unwrap_or_default();
    let commands: Vec<&str> =
        part.lines().filter_map(|line| line.strip_prefix("    denavit ")).collect();
    assert!(commands.len() >= 3, "{commands:?}");
    for command in commands {
        done(&directory, command);
    }
    let found = fs::read_to_string(directory.path.join("found/diagnosis.json")).expect("a file");
    let found: Value = serde_json::from_str(&found).expect("JSON");
    assert_eq!(found["verdict"], "explained", "{found}");
    let effects = found["effects"].as_array().expect("a list");
    let names: Vec<String> =
        effects.iter().map(|one| format!("{} {}", one["effect"], one["at"])).collect();
    assert!(names.iter().any(|name| name.contains("coulomb")), "{names:?}");
    assert!(names.iter().all(|name| name.contains("shoulder")), "{names:?}");
}

/// What this build does not read is refused with the line that installs what does.
#[cfg(not(any(feature = "sqlite", feature = "parquet")))]
#[test]
fn formats_whose_feature_is_off_name_it() {
    let directory = with_arm("features");
    let files: [(&str, &[u8], &str); 3] = [
        ("a.db3", b"SQLite format 3\0....", "SQLite, which this build does not read"),
        ("a.parquet", b"PAR1....", "Parquet, which this build does not read"),
        ("a.csv", b"ARROW1\0\0....", "Arrow, which this build does not read"),
    ];
    for (name, bytes, told) in files {
        fs::write(directory.path.join(name), bytes).expect("written");
        let run = run(&directory, &format!("identify arm.urdf --train {name}"));
        assert_eq!(run.code, Some(2));
        assert!(run.stderr.contains(told), "{}", run.stderr);
        assert!(
            run.stderr.contains("cargo install --locked --path . --features "),
            "{}",
            run.stderr
        );
    }
}
