//! What noise of the positions does to parameters, and what is said of it, on logs of the planar
//! arm made by hand.

use super::Directory;
use super::identify_told::{
    GOOD, Made, Motion, deviations, motions, round_positions, said, spread, write_arm, write_log,
};
use serde_json::Value;
use std::f64::consts::TAU;

/// A slow motion, whose slowest sine has this rate [rad/s], seen by encoders of 14 bits at 1 kHz.
fn write_slow(directory: &Directory, seed: u64, rate: f64) {
    let made = Made { step_s: 0.001, samples: 20_000, seed, ..GOOD };
    let mut rows = made.rows(&motions(seed, rate));
    round_positions(&mut rows, TAU / 16_384.0);
    write_log(directory, "slow.csv", &rows);
}

/// By default intervals hold: the filter becomes as low as it takes.
#[test]
fn steps_of_encoders_do_not_bias_bodies_in_slow_motion() {
    let directory = Directory::new("noise-slow");
    write_arm(&directory, None);
    let mut all = Vec::new();
    for seed in 1..=6 {
        write_slow(&directory, seed, 0.5);
        let (code, text) = said(&directory, &["--train", "slow.csv", "--json"]);
        assert_eq!(code, Some(0), "{text}");
        assert!(text.contains("noise of positions would bias parameters"), "{text}");
        assert!(!text.contains("Noise of the positions biases"), "{text}");
        all.extend(deviations(&text));
    }
    assert!((0.6..1.4).contains(&spread(&all)), "{}", spread(&all));
}

/// A log that is too short for a lower filter keeps no other log from it.
#[test]
fn each_log_has_the_filter_that_it_is_long_enough_for() {
    let directory = Directory::new("noise-lengths");
    write_arm(&directory, None);
    write_slow(&directory, 1, 0.5);
    let made = Made { step_s: 0.001, samples: 1500, seed: 2, ..GOOD };
    let mut rows = made.rows(&motions(2, 2.0));
    round_positions(&mut rows, TAU / 16_384.0);
    write_log(&directory, "short.csv", &rows);
    let (_, text) = said(&directory, &["--train", "short.csv", "slow.csv", "--json"]);
    let cutoff_hz = |log: &str| {
        let words = format!(
            "{log}: noise of positions would bias parameters or residuals: filtered below "
        );
        number_after(&text, &words)
    };
    // one line for all joints of a log
    assert!(text.contains("slow.csv: `q_link1`, `q_link2` have steps of 3.835e-4"), "{text}");
    // of 1.5 s more than ten periods are left of 12.5 Hz without the edges, and of less none
    assert!((12.5..=50.0).contains(&cutoff_hz("short.csv")), "{text}");
    assert!(cutoff_hz("slow.csv") < 20.0, "{text}");
}

/// The first joint is eight times slower than the second, under coarse encoders: behind the filter
/// of the other log, which is fine, noise would be all that is left of a log for validation, which
/// the parameters explain as they are.
#[test]
fn a_log_for_validation_has_the_filter_that_its_noise_asks_for() {
    let directory = Directory::new("noise-held-out");
    write_arm(&directory, None);
    let made = Made { step_s: 0.002, samples: 5000, ..GOOD };
    write_log(&directory, "fine.csv", &made.rows(&motions(9, 1.0)));
    for seed in 1..=6 {
        let ([slow, _], [_, fast]) = (motions(seed, 0.05), motions(seed, 0.4));
        let made = Made { step_s: 0.001, samples: 5000, seed, ..GOOD };
        let mut rows = made.rows(&[slow, fast]);
        round_positions(&mut rows, TAU / 4096.0);
        write_log(&directory, "coarse.csv", &rows);
        let words = ["--train", "fine.csv", "--validate", "coarse.csv", "--json"];
        let (code, text) = said(&directory, &words);
        assert_eq!(code, Some(0), "{seed}: {text}");
        let json: Value = serde_json::from_str(&text).expect("JSON");
        let left = json["residual"]["validate"].as_f64().expect("a share");
        assert!(left < 0.1, "{seed}: {left}");
    }
}

/// What the model has no value of is named where its own torques cannot be compared.
#[test]
fn why_nothing_is_known_from_before_is_said() {
    let directory = Directory::new("noise-before");
    write_arm(&directory, None);
    write_slow(&directory, 1, 0.5);
    let words = ["--train", "slow.csv", "--with", "friction,offset"];
    let (_, text) = said(&directory, &words);
    let line = text.replace('\n', " ");
    assert!(line.contains("not known, since the model has no value of off_link1"), "{text}");
}

/// A joint that creeps in one direction, slower than the steps of its encoder say: the sign of its
/// rate there is that of noise, and alone would determine its friction, to be 0.
#[test]
fn a_joint_that_creeps_has_no_sign() {
    let directory = Directory::new("noise-creep");
    write_arm(&directory, None);
    let made = Made { step_s: 0.001, samples: 20_000, ..GOOD };
    let mut worst = [0.0_f64; 2];
    for phase in [2.6, 4.15, 5.9] {
        let forth = vec![[50.0, 0.001, 0.0], [0.0995, 0.5, phase]];
        let [_, other] = motions(3, 0.8);
        let mut rows = made.rows(&[Motion { about: 0.0, waves: forth }, other]);
        round_positions(&mut rows, TAU / 16_384.0);
        write_log(&directory, "creep.csv", &rows);
        for (worst, skip) in worst.iter_mut().zip(["biasing", "off"]) {
            let words = ["--train", "creep.csv", "--skip-slow", skip, "--json"];
            let (_, text) = said(&directory, &words);
            let all = deviations(&text);
            *worst = all.iter().fold(*worst, |most, [one, _]| most.max(one.abs()));
        }
    }
    let [by_default, with_all] = worst;
    assert!(by_default < 4.0 && with_all > 10.0, "{by_default} {with_all}");
}

/// Noise that makes most of the columns says nothing of units and joints, but is said itself.
#[test]
fn noise_is_no_other_reading() {
    let directory = Directory::new("noise-whole");
    write_arm(&directory, None);
    write_slow(&directory, 1, 0.5);
    for filter in ["none", "400"] {
        let (code, text) = said(&directory, &["--train", "slow.csv", "--filter", filter]);
        assert_eq!(code, Some(1), "{filter}: {text}");
        let line = text.replace('\n', " ");
        assert!(line.contains("How far they are off is not known"), "{filter}: {text}");
        assert!(!line.contains("seems to be"), "{filter}: {text}");
    }
    // a second of a slow motion hardly shows inertia, whatever the filter
    let made = Made { step_s: 0.001, samples: 1000, seed: 2, ..GOOD };
    let mut rows = made.rows(&motions(2, 0.3));
    round_positions(&mut rows, TAU / 16_384.0);
    write_log(&directory, "short.csv", &rows);
    let (code, text) = said(&directory, &["--train", "short.csv"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.replace('\n', " ").contains("How far they are off is not known"), "{text}");
    // what is shown well is no noise
    let (code, text) = said(&directory, &["--train", "slow.csv"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(!text.contains("is not known"), "{text}");
}

/// Where noise makes nearly all of the columns of inertia their parameters vanish: the estimate
/// does not say how much it lost.
#[test]
fn bodies_that_noise_hides_whole_are_not_lost() {
    let directory = Directory::new("noise-very-slow");
    write_arm(&directory, None);
    let mut all = Vec::new();
    for seed in 1..=6 {
        write_slow(&directory, seed, 0.1);
        let (_, text) = said(&directory, &["--train", "slow.csv", "--json"]);
        all.extend(deviations(&text));
    }
    assert!((0.6..1.5).contains(&spread(&all)), "{}", spread(&all));
}

/// With a filter of one's own the bias is said, as large as it is: in the mean of some logs
/// estimates are as far off the truth as the answer says of each.
#[test]
fn the_bias_that_is_said_is_that_of_the_estimates() {
    let directory = Directory::new("noise-said");
    write_arm(&directory, None);
    let seeds = 6;
    let mut means: Vec<[f64; 2]> = Vec::new();
    for seed in 1..=seeds {
        write_slow(&directory, seed, 0.5);
        let words = ["--train", "slow.csv", "--filter", "50", "--json"];
        let (code, text) = said(&directory, &words);
        assert_eq!(code, Some(0), "{text}");
        assert!(text.contains("Noise of the positions biases parameters"), "{text}");
        let own = deviations(&text);
        means.resize(own.len(), [0.0; 2]);
        for (mean, own) in means.iter_mut().flatten().zip(own.into_iter().flatten()) {
            *mean += own / seeds as f64;
        }
    }
    let biased: Vec<&[f64; 2]> = means.iter().filter(|[_, said]| said.abs() > 0.25).collect();
    assert!(biased.len() >= 4, "{means:?}");
    for [found, said] in biased {
        assert!((0.65..1.5).contains(&(found / said)), "{found} {said}: {means:?}");
    }
}

/// What a constant does to the torques is less than their noise, and it moves parameters by many of
/// their errors: the zero of a position, the offset of a torque.
#[test]
fn constants_below_the_noise_are_told_with_their_size() {
    let directory = Directory::new("noise-constants");
    write_arm(&directory, None);
    let made = Made { step_s: 0.002, samples: 10_000, torque_noise: 0.1, seed: 3, ..GOOD };
    let cases = [
        ([0.0; 4], "", 0.0),
        ([0.02, 0.0, 0.0, 0.0], "the position of link1 seems to be ", 0.02),
        ([0.0, 0.0, 0.0, -0.2], "the torque of link2 seems to be ", 0.2),
    ];
    for (constants, expected, size) in cases {
        let mut rows = made.rows(&motions(3, 1.0));
        for row in &mut rows {
            row[1..].iter_mut().zip(constants).for_each(|(value, constant)| *value += constant);
        }
        round_positions(&mut rows, TAU / 16_384.0);
        write_log(&directory, "constant.csv", &rows);
        let (code, text) = said(&directory, &["--train", "constant.csv"]);
        let line = text.replace('\n', " ");
        if expected.is_empty() {
            assert_eq!(code, Some(0), "{text}");
            assert!(!line.contains("seems to be"), "{text}");
            continue;
        }
        assert_eq!(code, Some(1), "{text}");
        assert!((number_after(&line, expected) / size - 1.0).abs() < 0.2, "{text}");
        assert!(line.contains("of its standard errors large"), "{text}");
        assert_eq!(line.contains("--with friction,offset"), size == 0.2, "{text}");
    }
}

/// The number that follows some words.
fn number_after(line: &str, words: &str) -> f64 {
    let rest = line.split_once(words).expect(words).1;
    let word = rest.split(' ').next().expect("there is a word");
    word.parse().expect("a number")
}

/// Of three logs to estimate from the one whose last joint counts from another zero is told by its
/// name: by the others, since the nominal parameters are off, and its body could turn instead.
#[test]
fn one_misread_log_among_others_is_named() {
    let directory = Directory::new("noise-odd-log");
    write_arm(&directory, None);
    let path = directory.path.join("arm.json");
    let mut arm: Value =
        serde_json::from_slice(&std::fs::read(&path).expect("written")).expect("JSON");
    for link in arm["links"].as_array_mut().expect("a list") {
        let body = &mut link["body"];
        let heavier = |value: &mut Value| *value = (1.4 * value.as_f64().expect("a number")).into();
        heavier(&mut body["mass"]);
        body["inertia"].as_object_mut().expect("entries").values_mut().for_each(heavier);
    }
    std::fs::write(&path, arm.to_string()).expect("written");
    let rows = |seed: u64| Made { samples: 4000, seed, ..GOOD }.rows(&motions(seed, 0.628));
    for (name, seed) in [("one.csv", 1), ("two.csv", 2)] {
        write_log(&directory, name, &rows(seed));
    }
    for zero in [0.0, 0.1] {
        let mut odd = rows(3);
        odd.iter_mut().for_each(|row| row[2] += zero);
        write_log(&directory, "odd.csv", &odd);
        let words = ["--train", "one.csv", "odd.csv", "two.csv"];
        let (code, text) = said(&directory, &words);
        assert_eq!(code, Some(i32::from(zero != 0.0)), "{text}");
        if zero != 0.0 {
            let line = text.replace('\n', " ");
            let found = number_after(&line, "odd.csv: the position of link2 seems to be ");
            assert!((found / zero - 1.0).abs() < 0.05, "{text}");
            assert!(line.contains("the values that the other logs give"), "{text}");
        }
    }
}
