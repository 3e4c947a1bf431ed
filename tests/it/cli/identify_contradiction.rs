//! Logs that contradict each other, of logs made by hand whose true parameters are known.

use super::Directory;
use super::identify_told::{GOOD, Made, deviations, motions, round_positions};
use super::identify_told::{said, spread, write_arm, write_log};
use std::f64::consts::TAU;

/// A log of ten seconds with encoders of 14 bits, its torques as they are changed.
fn write(directory: &Directory, name: &str, seed: u64, change: &dyn Fn(&mut [f64; 5])) {
    let made = Made { step_s: 0.002, samples: 5000, seed, ..GOOD };
    let mut rows = made.rows(&motions(seed, 0.7));
    round_positions(&mut rows, TAU / 16384.0);
    rows.iter_mut().for_each(change);
    write_log(directory, name, &rows);
}

const ALL: [&str; 5] = ["--train", "one.csv", "odd.csv", "other.csv", "--json"];

/// Of three logs one whose torques are 15 % too large is named, with that number, and what is found
/// is what the two others say.
#[test]
fn a_log_of_another_gain_is_named_and_not_followed() {
    let directory = Directory::new("contradiction-gain");
    write_arm(&directory, None);
    for seed in 1..=8 {
        write(&directory, "one.csv", 3 * seed, &|_| {});
        write(&directory, "other.csv", 3 * seed + 2, &|_| {});
        write(&directory, "odd.csv", 3 * seed + 1, &|row| {
            row[3..].iter_mut().for_each(|torque| *torque *= 1.15);
        });
        let (code, text) = said(&directory, &ALL);
        assert_eq!(code, Some(1), "{seed}: {text}");
        let json = text.replace('\n', " ");
        assert!(json.contains("odd.csv contradicts the other logs"), "{seed}: {text}");
        assert_eq!(json.matches("contradicts").count(), 1, "{seed}: {text}");
        for gain in json.split("as if it were ").skip(1) {
            let gain: f64 = gain.split(' ').next().and_then(|one| one.parse().ok()).expect(&json);
            assert!((gain - 1.15).abs() < 0.01, "{seed}: {text}");
        }
        assert!(json.contains("Parameters are those of the others"), "{seed}: {text}");
        let spread = spread(&deviations(&text));
        assert!(spread < 2.0, "{seed}: {spread}");
    }
}

/// An offset of one of two logs is told with its size, whichever is right; two that agree are not
/// doubted.
#[test]
fn of_two_logs_that_contradict_each_other_neither_is_believed() {
    let directory = Directory::new("contradiction-offset");
    write_arm(&directory, None);
    for seed in 1..=4 {
        write(&directory, "one.csv", 2 * seed, &|_| {});
        for offset in [0.0, 1.5] {
            write(&directory, "odd.csv", 2 * seed + 1, &|row| row[3] += offset);
            let (code, text) = said(&directory, &["--train", "one.csv", "odd.csv"]);
            let line = text.replace('\n', " ");
            assert_eq!(code, Some(i32::from(offset != 0.0)), "{seed}: {text}");
            assert_eq!(line.contains("which of them are right cannot be told"), offset != 0.0);
            if offset != 0.0 {
                let told = line.split("as if ").nth(1).and_then(|one| one.split(' ').next());
                let told: f64 = told.and_then(|one| one.parse().ok()).expect(&line);
                assert!((told.abs() / offset - 1.0).abs() < 0.2, "{seed}: {text}");
            }
        }
    }
}
