//! Logs of unlike noise beside each other, and logs that are cut, stuck or too short, made by hand.

use super::Directory;
use super::identify_told::{
    GOOD, Made, Motion, deviations, motions, round_positions, said, spread, write_arm, write_log,
};
use serde_json::Value;
use std::f64::consts::TAU;

/// A log of so many seconds at 1 kHz under encoders of so many bits.
fn write(directory: &Directory, name: &str, seconds: f64, slowest: f64, bits: u32, seed: u64) {
    let made = Made { step_s: 0.001, samples: (1000.0 * seconds) as usize, seed, ..GOOD };
    let mut rows = made.rows(&motions(seed, slowest));
    round_positions(&mut rows, TAU / f64::from(1 << bits));
    write_log(directory, name, &rows);
}

fn errors(text: &str) -> Vec<f64> {
    let json: Value = serde_json::from_str(text).expect("JSON");
    let all = json["parameters"].as_array().expect("a list");
    all.iter().map(|one| one["std"].as_f64().expect("it is shown")).collect()
}

/// A second or three of a slow motion under a coarse encoder beside a good log: noise makes nearly
/// all of it, which is said; the estimate is as good as that of the good log alone, and no unit is
/// doubted.
#[test]
fn logs_of_little_but_noise_do_no_harm() {
    let directory = Directory::new("logs-noisy");
    write_arm(&directory, None);
    let mut all = Vec::new();
    for (seed, (seconds, bits)) in [(1, (1.0, 14)), (2, (3.0, 12)), (3, (1.0, 12))] {
        write(&directory, "good.csv", 20.0, 0.5, 14, seed);
        write(&directory, "noisy.csv", seconds, 0.2, bits, 10 + seed);
        let (code, alone) = said(&directory, &["--train", "good.csv", "--json"]);
        assert_eq!(code, Some(0), "{alone}");
        let (code, both) = said(&directory, &["--train", "good.csv", "noisy.csv", "--json"]);
        assert_eq!(code, Some(0), "{both}");
        for (alone, both) in errors(&alone).into_iter().zip(errors(&both)) {
            assert!(both < 1.7 * alone, "{alone} {both}");
        }
        assert!(both.contains("of what noisy.csv shows of the parameters by itself"), "{both}");
        assert!(!both.contains("of what good.csv shows"), "{both}");
        all.extend(deviations(&both));
    }
    assert!((0.6..1.5).contains(&spread(&all)), "{}", spread(&all));
}

/// A second log of torques forty times as noisy adds a 1600th of what the first one knows, one as
/// good makes errors smaller by the root of two.
#[test]
fn logs_count_by_the_noise_of_their_torques() {
    let directory = Directory::new("logs-torques");
    write_arm(&directory, None);
    let write = |name: &str, torque_noise: f64, seed: u64| {
        let made = Made { samples: 4000, torque_noise, seed, ..GOOD };
        write_log(&directory, name, &made.rows(&motions(seed, 0.628)));
    };
    write("good.csv", 0.05, 1);
    write("noisy.csv", 2.0, 2);
    write("other.csv", 0.05, 3);
    let mean = |logs: &[&str]| {
        let (code, text) = said(&directory, &[&["--train"][..], logs, &["--json"]].concat());
        assert_eq!(code, Some(0), "{text}");
        let worst = deviations(&text).iter().fold(0.0, |most: f64, [one, _]| most.max(one.abs()));
        assert!(worst < 4.5, "{text}");
        let errors = errors(&text);
        (errors.iter().map(|std| std.ln()).sum::<f64>() / errors.len() as f64).exp()
    };
    let alone = mean(&["good.csv"]);
    let [noisy, other] = ["noisy.csv", "other.csv"].map(|log| mean(&["good.csv", log]) / alone);
    assert!((0.9..1.05).contains(&noisy), "{noisy}");
    assert!((0.55..0.85).contains(&other), "{other}");
}

/// Each log has the filter that its own noise asks for: that of a fine encoder is not lowered for
/// that of a coarse one.
#[test]
fn filters_are_lowered_log_by_log() {
    let directory = Directory::new("logs-filters");
    write_arm(&directory, None);
    write(&directory, "coarse.csv", 20.0, 0.5, 13, 1);
    write(&directory, "fine.csv", 20.0, 0.5, 22, 2);
    let (code, text) = said(&directory, &["--train", "coarse.csv", "fine.csv", "--json"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("coarse.csv: noise of positions would bias parameters"), "{text}");
    assert!(!text.contains("fine.csv: noise of positions would bias parameters"), "{text}");
}

/// A position that is stuck while its joint moves leaves torques that no joint at rest has: where
/// any parameter is off by five errors, that is said.
#[test]
fn a_position_that_is_stuck_is_told() {
    let directory = Directory::new("logs-stuck");
    write_arm(&directory, None);
    for (seed, joint) in [(3, 1), (3, 2), (4, 1), (4, 2), (5, 1), (5, 2)] {
        let mut rows = Made { samples: 4000, ..GOOD }.rows(&motions(seed, 0.628));
        let stuck = rows[0][joint];
        rows.iter_mut().for_each(|row| row[joint] = stuck);
        write_log(&directory, "stuck.csv", &rows);
        let (code, text) = said(&directory, &["--train", "stuck.csv", "--json"]);
        let json: Value = serde_json::from_str(&text).expect("JSON");
        let off = |one: &Value| {
            let number = |key: &str| one[key].as_f64();
            Some((number("value")? - number("model_value")?).abs() / number("std")?)
        };
        let all = json["parameters"].as_array().expect("a list");
        let worst = all.iter().filter_map(off).fold(0.0, f64::max);
        assert!(worst < 5.0 || code == Some(1), "{seed} {joint}: {text}");
        let told = format!("The torque of link{joint} is not explained");
        assert_eq!(text.contains(&told), code == Some(1), "{seed} {joint}: {text}");
        assert!(joint == 1 || text.contains("may be stuck"), "{seed} {joint}: {text}");
    }
    // a joint that is held is none of these
    let [first, _] = motions(3, 0.628);
    let held = Motion { about: 0.4, waves: Vec::new() };
    let rows = Made { samples: 4000, ..GOOD }.rows(&[first, held]);
    write_log(&directory, "held.csv", &rows);
    let (code, text) = said(&directory, &["--train", "held.csv"]);
    assert_eq!(code, Some(0), "{text}");
}

/// A file that ends within a number says so; what is left of the number is none.
#[test]
fn a_last_line_without_end_is_left_out() {
    let directory = Directory::new("logs-cut");
    write_arm(&directory, None);
    write_log(&directory, "whole.csv", &GOOD.rows(&motions(4, 0.628)));
    let path = directory.path.join("whole.csv");
    let text = std::fs::read_to_string(path).expect("written");
    for cut in [1, 5, 20] {
        std::fs::write(directory.path.join("cut.csv"), &text[..text.len() - cut]).expect("written");
        let (code, text) = said(&directory, &["--train", "cut.csv", "--json"]);
        assert_eq!(code, Some(0), "{text}");
        assert!(text.contains("cut.csv: line 2001, the last one, has no end"), "{text}");
    }
}

/// What asks for nothing that can be is answered with what it asks for.
#[test]
fn options_that_leave_nothing_are_named() {
    let directory = Directory::new("logs-options");
    write_arm(&directory, None);
    write(&directory, "log.csv", 10.0, 0.6, 14, 5);
    let (code, text) = said(&directory, &["--train", "log.csv", "--skip-slow", "50"]);
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("as fast as --skip-slow asks"), "{text}");
    for step in ["0", "100", "nan"] {
        let (code, text) = said(&directory, &["--train", "log.csv", "--resolution", step]);
        assert_eq!(code, Some(2), "{text}");
        assert!(text.contains("a step above 0"), "{text}");
    }
    // half a second: nothing is said of a joint of which thousands of percent are left
    write(&directory, "short.csv", 0.5, 0.6, 14, 6);
    let (code, text) = said(&directory, &["--train", "short.csv"]);
    assert_eq!(code, Some(1), "{text}");
    let line = text.replace('\n', " ");
    assert!(line.contains("The logs are too short for it"), "{text}");
    assert!(!line.contains("is not explained"), "{text}");
}

/// Steps of encoders as large as the motion, and rates that no joint has, are refused with what to
/// do about it.
#[test]
fn numbers_that_nothing_can_be_are_refused() {
    let directory = Directory::new("logs-numbers");
    write_arm(&directory, None);
    write_log(&directory, "log.csv", &GOOD.rows(&motions(1, 0.7)));
    for (option, says) in [
        ("--resolution=1", "no joint moves further than its noise"),
        ("--resolution=1", "--resolution in rad or m"),
        ("--resolution=0", "a step above 0 and up to 1 rad or m"),
        ("--resolution=1.1", "a step above 0 and up to 1 rad or m"),
        ("--skip-slow=1e9", "a velocity from 1e-9 to 1000 rad/s or m/s"),
        ("--skip-slow=900", "--skip-slow"),
    ] {
        let (code, text) = said(&directory, &["--train", "log.csv", option]);
        assert_eq!(code, Some(2), "{option}: {text}");
        assert!(text.contains(says), "{option}: {text}");
    }
}
