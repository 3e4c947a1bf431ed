//! What noise of the positions does to parameters, and what is said of it, on logs of the planar
//! arm made by hand.

use super::Directory;
use super::identify_told::{
    GOOD, Made, deviations, motions, round_positions, said, spread, write_arm, write_log,
};
use std::f64::consts::TAU;

/// A slow motion seen by encoders of 14 bits at 1 kHz.
fn write_slow(directory: &Directory, seed: u64) {
    let made = Made { step_s: 0.001, samples: 20_000, seed, ..GOOD };
    let mut rows = made.rows(&motions(seed, 0.5));
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
        write_slow(&directory, seed);
        let (code, text) = said(&directory, &["--train", "slow.csv", "--json"]);
        assert_eq!(code, Some(0), "{text}");
        assert!(text.contains("noise of positions would bias parameters"), "{text}");
        assert!(!text.contains("Noise of the positions biases"), "{text}");
        all.extend(deviations(&text));
    }
    assert!((0.6..1.4).contains(&spread(&all)), "{}", spread(&all));
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
        write_slow(&directory, seed);
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
    let biased: Vec<&[f64; 2]> = means.iter().filter(|[_, said]| said.abs() > 1.5).collect();
    assert!(biased.len() >= 4, "{means:?}");
    for [found, said] in biased {
        assert!((0.65..1.5).contains(&(found / said)), "{found} {said}: {means:?}");
    }
}
