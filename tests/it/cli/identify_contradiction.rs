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

fn times_1_15(row: &mut [f64; 5]) {
    row[3..].iter_mut().for_each(|torque| *torque *= 1.15);
}

/// Factors that a text says torques are like, all of which must be 1.15.
fn assert_gains(text: &str) {
    let line = text.replace('\n', " ");
    for gain in line.split("as if it were ").skip(1) {
        let gain: f64 = gain.split(' ').next().and_then(|one| one.parse().ok()).expect(&line);
        assert!((gain - 1.15).abs() < 0.01, "{text}");
    }
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
        write(&directory, "odd.csv", 3 * seed + 1, &times_1_15);
        let (code, text) = said(&directory, &ALL);
        assert_eq!(code, Some(1), "{seed}: {text}");
        let json = text.replace('\n', " ");
        assert!(json.contains("odd.csv contradicts the other logs"), "{seed}: {text}");
        assert_eq!(json.matches("contradicts").count(), 1, "{seed}: {text}");
        assert_gains(&text);
        assert!(json.contains("Parameters are those of the others"), "{seed}: {text}");
        let spread = spread(&deviations(&text));
        assert!(spread < 2.0, "{seed}: {spread}");
        // an estimate of all rows alike follows all, and knows as well which one it is
        let (_, text) = said(&directory, &[&ALL[..], &["--method", "ols"]].concat());
        assert!(text.contains("odd.csv contradicts the other logs"), "{seed}: {text}");
        assert_eq!(text.matches("contradict").count(), 1, "{seed}: {text}");
        assert!(text.contains("Parameters are not those of the others alone"), "{seed}: {text}");
    }
}

/// The same beside noise of the torques that leaves as much: it is alike in no two parts of a log,
/// and a gain is. Without the gain nothing is told.
#[test]
fn a_log_of_another_gain_is_named_beside_as_much_noise() {
    let directory = Directory::new("contradiction-gain-noise");
    write_arm(&directory, None);
    let log = |name: &str, seed: u64, gain: f64| {
        let made = Made { step_s: 0.002, samples: 5000, torque_noise: 4.0, seed, ..GOOD };
        let mut rows = made.rows(&motions(seed, 0.7));
        rows.iter_mut().flat_map(|row| &mut row[3..]).for_each(|torque| *torque *= gain);
        write_log(&directory, name, &rows);
    };
    for seed in 1..=6 {
        log("one.csv", 3 * seed, 1.0);
        log("other.csv", 3 * seed + 2, 1.0);
        for gain in [1.0, 1.15] {
            log("odd.csv", 3 * seed + 1, gain);
            let (code, text) = said(&directory, &ALL);
            assert_eq!(code, Some(i32::from(gain > 1.0)), "{seed}: {text}");
            let json = text.replace('\n', " ");
            assert_eq!(json.contains("odd.csv contradicts the other logs"), gain > 1.0, "{text}");
            assert_eq!(json.matches("contradict").count(), usize::from(gain > 1.0), "{text}");
        }
    }
}

/// Logs by their seed, gain, steps and noise of the torques.
fn write_as(directory: &Directory, name: &str, made: Made, gain: f64, bits: i32) {
    let mut rows = made.rows(&motions(made.seed, 0.7));
    round_positions(&mut rows, TAU / 2.0_f64.powi(bits));
    rows.iter_mut().flat_map(|row| &mut row[3..]).for_each(|torque| *torque *= gain);
    write_log(directory, name, &rows);
}

/// A log whose encoders are so coarse, behind the filter that the others leave it, that noise of
/// its positions makes most of it: behind a lower one its gain is seen. Without it nothing is told.
#[test]
fn a_log_of_another_gain_is_named_beside_noise_of_its_positions() {
    let directory = Directory::new("contradiction-gain-steps");
    write_arm(&directory, None);
    for seed in 1..=6 {
        let fine = Made { step_s: 0.002, samples: 5000, torque_noise: 0.02, seed, ..GOOD };
        let steps = Made { step_s: 0.001, samples: 8000, seed: 3 * seed, ..fine };
        write_as(&directory, "one.csv", Made { seed: 3 * seed + 1, ..fine }, 1.0, 20);
        write_as(&directory, "other.csv", Made { seed: 3 * seed + 2, ..fine }, 1.0, 20);
        for gain in [1.0, 1.2] {
            write_as(&directory, "odd.csv", steps, gain, 12);
            let (code, text) = said(&directory, &ALL);
            assert_eq!(code, Some(i32::from(gain > 1.0)), "{seed}: {text}");
            let json = text.replace('\n', " ");
            assert_eq!(json.contains("odd.csv contradicts the other logs"), gain > 1.0, "{text}");
            assert_eq!(json.matches("contradict").count(), usize::from(gain > 1.0), "{text}");
        }
    }
}

/// One log that is far more precise than two others pulls the estimate to its own gain: it is
/// the one that is named, and that parameters are its own is said.
#[test]
fn a_precise_log_of_another_gain_does_not_accuse_the_others() {
    let directory = Directory::new("contradiction-precise");
    write_arm(&directory, None);
    for seed in 1..=6 {
        let noisy = Made { step_s: 0.002, samples: 3500, torque_noise: 0.5, seed, ..GOOD };
        let precise = Made { samples: 5000, torque_noise: 0.01, seed: 3 * seed, ..noisy };
        write_as(&directory, "one.csv", Made { seed: 3 * seed + 1, ..noisy }, 1.0, 16);
        write_as(&directory, "other.csv", Made { seed: 3 * seed + 2, ..noisy }, 1.0, 16);
        write_as(&directory, "odd.csv", precise, 1.2, 18);
        let (code, text) = said(&directory, &ALL);
        assert_eq!(code, Some(1), "{seed}: {text}");
        let json = text.replace('\n', " ");
        assert!(json.contains("odd.csv contradicts the other logs"), "{seed}: {text}");
        assert_eq!(json.matches("contradict").count(), 1, "{seed}: {text}");
        let is_followed = spread(&deviations(&text)) > 3.0;
        let is_said = json.contains("not those of the others alone");
        assert!(is_said || !is_followed, "{seed}: {text}");
    }
}

/// The same of a log for validation alone.
#[test]
fn a_log_for_validation_of_another_gain_is_told() {
    let directory = Directory::new("contradiction-held-out");
    write_arm(&directory, None);
    for seed in 1..=6 {
        write(&directory, "one.csv", 2 * seed, &|_| {});
        write(&directory, "same.csv", 2 * seed + 1, &|_| {});
        write(&directory, "odd.csv", 2 * seed + 1, &times_1_15);
        for (name, is_odd) in [("same.csv", false), ("odd.csv", true)] {
            let (code, text) = said(&directory, &["--train", "one.csv", "--validate", name]);
            assert_eq!(code, Some(i32::from(is_odd)), "{seed}: {text}");
            assert_eq!(text.contains("odd.csv and the logs for the estimate contradict"), is_odd);
            assert_gains(&text);
        }
    }
}

/// A constant in the torque of the last joint, in which no other one shows: no parameters of a
/// log's own explain it either, so that it is asked for beside them.
#[test]
fn a_constant_in_a_log_for_validation_is_told_with_its_size() {
    let directory = Directory::new("contradiction-constant");
    write_arm(&directory, None);
    let wide = |name: &str, seed: u64, offset: f64| {
        let mut both = motions(seed, 0.7);
        both.iter_mut().flat_map(|one| &mut one.waves).for_each(|wave| wave[0] *= 3.0);
        let mut rows = Made { step_s: 0.002, samples: 5000, seed, ..GOOD }.rows(&both);
        rows.iter_mut().for_each(|row| row[4] += offset);
        write_log(&directory, name, &rows);
    };
    for seed in 1..=4 {
        wide("one.csv", 2 * seed, 0.0);
        for offset in [-0.4, 0.4, 0.8] {
            wide("odd.csv", 2 * seed + 1, offset);
            let (code, text) = said(&directory, &["--train", "one.csv", "--validate", "odd.csv"]);
            let line = text.replace('\n', " ");
            assert_eq!(code, Some(1), "{seed} {offset}: {text}");
            let told = line
                .split("residual of link2 is")
                .nth(1)
                .and_then(|one| one.split("as if ").nth(1));
            let told = told.and_then(|one| one.split(' ').next()?.parse().ok());
            let told: f64 = told.expect(&line);
            assert!((told / offset - 1.0).abs() < 0.05, "{seed} {offset}: {text}");
        }
    }
}

/// A ripple of the torque that no parameters make, and of which half a period of the filter's
/// cutoff later nothing is alike: only how much is left tells it. White noise of the same size is
/// none.
#[test]
fn a_ripple_that_a_log_for_validation_alone_shows_is_said() {
    let directory = Directory::new("contradiction-ripple");
    write_arm(&directory, None);
    for seed in 1..=4 {
        write(&directory, "one.csv", 2 * seed, &|_| {});
        for ripple in [0.0, 1.2] {
            write(&directory, "odd.csv", 2 * seed + 1, &|row| {
                row[4] += ripple * (25.0 * row[2]).sin()
            });
            let (code, text) = said(&directory, &["--train", "one.csv", "--validate", "odd.csv"]);
            assert_eq!(code, Some(i32::from(ripple > 0.0)), "{seed}: {text}");
            let line = text.replace('\n', " ");
            let is_said = line.contains("The torque of link2 is not explained");
            assert_eq!(is_said && line.contains("% of it in odd.csv"), ripple > 0.0, "{text}");
            assert!(!line.contains("link1 is not explained"), "{seed}: {text}");
        }
        let noisy = Made { step_s: 0.002, samples: 5000, torque_noise: 3.0, seed: 9, ..GOOD };
        write_as(&directory, "odd.csv", noisy, 1.0, 14);
        let (code, text) = said(&directory, &["--train", "one.csv", "--validate", "odd.csv"]);
        assert_eq!(code, Some(0), "{seed}: {text}");
    }
}

/// Parameters that the logs for the estimate show badly, or not at all, may be anything: the first
/// joint hardly moves there, and the model's values are far off.
#[test]
fn a_log_for_validation_may_show_what_those_for_the_estimate_do_not() {
    let directory = Directory::new("contradiction-unshown");
    write_arm(&directory, None);
    let arm = std::fs::read_to_string(directory.path.join("arm.json")).expect("written");
    let heavy = arm.replace("\"yy\":0.04,\"zz\":0.04", "\"yy\":0.4,\"zz\":0.4");
    assert_ne!(heavy, arm);
    std::fs::write(directory.path.join("arm.json"), heavy).expect("written");
    for seed in 1..=6 {
        let [mut still, second] = motions(seed, 0.7);
        still.waves.iter_mut().for_each(|wave| wave[0] *= if seed % 2 == 0 { 0.0 } else { 0.01 });
        let made = Made { step_s: 0.002, samples: 5000, seed, ..GOOD };
        write_log(&directory, "one.csv", &made.rows(&[still, second]));
        write(&directory, "other.csv", seed + 9, &|_| {});
        let (_, text) = said(&directory, &["--train", "one.csv", "--validate", "other.csv"]);
        assert!(text.contains("validate"), "{seed}: {text}");
        assert!(!text.contains("contradict"), "{seed}: {text}");
    }
}

/// Noise of coarse encoders behind a filter that others leave too high is no contradiction:
/// parameters of a log's own follow it, by their bias.
#[test]
fn noise_of_a_log_beside_others_contradicts_nothing() {
    let directory = Directory::new("contradiction-noise");
    write_arm(&directory, None);
    let log = |name: &str, (seed, slowest): (u64, f64), made: Made, bits: i32| {
        let mut rows = made.rows(&motions(seed, slowest));
        round_positions(&mut rows, TAU / 2.0_f64.powi(bits));
        write_log(&directory, name, &rows);
    };
    for seed in [5, 6, 7, 8, 48, 50] {
        let fine = Made { step_s: 0.004, samples: 3500, torque_noise: 0.3, seed, ..GOOD };
        log("fine.csv", (2 * seed, 0.4), fine, 20);
        let steps = Made { step_s: 0.001, samples: 5000, torque_noise: 0.01, ..GOOD };
        log("steps.csv", (2 * seed + 1, 0.2), Made { seed: seed + 40, ..steps }, 12);
        for words in
            [["fine.csv", "steps.csv"].as_slice(), &["fine.csv", "--validate", "steps.csv"]]
        {
            let (_, text) = said(&directory, &[&["--train"], words].concat());
            assert!(text.contains("residual"), "{seed}: {text}");
            assert!(!text.contains("contradict"), "{seed}: {text}");
        }
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
            assert_eq!(line.contains("which of them are right is not known"), offset != 0.0);
            if offset != 0.0 {
                // the other log may be told as another gain, in which an offset hides
                let told = line.split("odd.csv and the other").nth(1).expect(&line);
                let told = told.split("as if ").nth(1).and_then(|one| one.split(' ').next());
                let told: f64 = told.and_then(|one| one.parse().ok()).expect(&line);
                assert!((told.abs() / offset - 1.0).abs() < 0.2, "{seed}: {text}");
            }
        }
    }
}

/// A log without torques determines nothing, and contradicts nothing.
#[test]
fn a_log_for_validation_without_torques_is_compared_with_nothing() {
    let directory = Directory::new("contradiction-torqueless");
    write_arm(&directory, None);
    write(&directory, "one.csv", 1, &|_| {});
    write(&directory, "other.csv", 2, &|_| {});
    let path = directory.path.join("other.csv");
    let text = std::fs::read_to_string(&path).expect("a log");
    let positions = |line: &str| line.split(',').take(3).collect::<Vec<_>>().join(",");
    let without: Vec<String> = text.lines().map(positions).collect();
    std::fs::write(path, without.join("\n")).expect("a file");
    let (code, text) = said(&directory, &["--train", "one.csv", "--validate", "other.csv"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(!text.contains("contradict"), "{text}");
}
