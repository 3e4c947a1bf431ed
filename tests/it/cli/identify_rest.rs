//! Joints that rest, or whose position only seems to: of logs made by hand whose true parameters
//! are known.

use super::Directory;
use super::identify_told::{FRICTION, GOOD, Made, Motion, deviations, motions, round_positions};
use super::identify_told::{said, torques, write_arm, write_log};
use denavit::numerics::Random;
use serde_json::Value;
use std::f64::consts::TAU;

const STEP: f64 = TAU / 16384.0;

fn made(seed: u64, motions: &[Motion; 2]) -> Vec<[f64; 5]> {
    let made = Made { step_s: 0.002, samples: 5000, seed, ..GOOD };
    let mut rows = made.rows(motions);
    round_positions(&mut rows, STEP);
    rows
}

/// A motion in which the second joint is held.
fn held(seed: u64) -> [Motion; 2] {
    let [first, _] = motions(seed, 0.7);
    [first, Motion { about: 0.4, waves: Vec::new() }]
}

/// By how many standard errors what has one is off the truth, at most.
fn worst(text: &str) -> f64 {
    let json: Value = serde_json::from_str(text).expect("JSON");
    let of = |one: &Value| {
        let number = |key: &str| one[key].as_f64();
        Some((number("value")? - number("model_value")?).abs() / number("std")?)
    };
    json["parameters"].as_array().expect("a list").iter().filter_map(of).fold(0.0, f64::max)
}

/// A joint on its brake: the torque of its motor, which is off, says nothing of its load. With it
/// parameters of the last body were 0.
#[test]
fn a_motor_that_is_off_says_nothing() {
    let directory = Directory::new("rest-brake");
    write_arm(&directory, None);
    let offs = [(1, 0.0, 0.02), (2, 0.0, 0.02), (3, 0.7, 0.02), (4, 0.0, 0.0), (5, 0.7, 0.0)];
    for (seed, constant, noise) in offs {
        let mut rows = made(seed, &held(seed));
        let mut random = Random::new(seed);
        rows.iter_mut().for_each(|row| row[4] = constant + noise * random.normal());
        write_log(&directory, "brake.csv", &rows);
        let (code, text) = said(&directory, &["--train", "brake.csv", "--json"]);
        assert_eq!(code, Some(0), "{seed}: {text}");
        assert!(text.contains("`link2` rests, and its torque does not follow"), "{seed}: {text}");
        assert!(worst(&text) < 4.5, "{seed}: {text}");
    }
    // one that is held by its motor is none
    write_log(&directory, "held.csv", &made(6, &held(6)));
    let (code, text) = said(&directory, &["--train", "held.csv", "--json"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(!text.contains("does not follow") && worst(&text) < 4.5, "{text}");
}

/// A position that is stuck, in all of a log or from its middle on, is told with its time, alone
/// and beside a log that is good.
#[test]
fn a_position_that_is_stuck_is_told_with_its_time() {
    let directory = Directory::new("rest-stuck");
    write_arm(&directory, None);
    for seed in [1, 2, 3] {
        for from in [0, 2500] {
            let mut rows = made(seed, &motions(seed, 0.7));
            let stuck = rows[from][2];
            rows[from..].iter_mut().for_each(|row| row[2] = stuck);
            write_log(&directory, "stuck.csv", &rows);
            write_log(&directory, "good.csv", &made(seed + 10, &motions(seed + 10, 0.7)));
            for logs in [&["stuck.csv"][..], &["good.csv", "stuck.csv"]] {
                let words = [&["--train"], logs].concat();
                let (code, text) = said(&directory, &words);
                assert_eq!(code, Some(1), "{seed} {from} {logs:?}: {text}");
                let line = text.replace('\n', " ");
                let told = line.split("The torque of link2 is not explained").nth(1).expect(&text);
                assert!(logs.len() == 1 || told.contains("in stuck.csv"), "{text}");
                let mut words =
                    told.split("the joint rests, from ").nth(1).expect(&text).split(' ');
                let mut time = || words.next().and_then(|one| one.parse::<f64>().ok());
                let begins_s = time().expect(&text);
                let is_right =
                    begins_s > 0.002 * from as f64 && begins_s < 0.002 * from as f64 + 2.0;
                assert!(is_right, "{seed} {from} {logs:?}: {text}");
            }
        }
    }
}

/// Stiction holds a joint whose motor follows the load within Coulomb friction: beside a log in
/// which the joint moves that is neither late nor stuck.
#[test]
fn stiction_is_neither_a_delay_nor_a_stuck_position() {
    let directory = Directory::new("rest-stiction");
    write_arm(&directory, None);
    for seed in [1, 2, 3, 4] {
        let mut rows = made(seed, &held(seed));
        let mut motor = rows[0][4];
        for row in &mut rows {
            motor = motor.clamp(row[4] - 0.3, row[4] + 0.3);
            row[4] = motor;
        }
        write_log(&directory, "stick.csv", &rows);
        write_log(&directory, "good.csv", &made(seed + 10, &motions(seed + 10, 0.7)));
        let (code, text) = said(&directory, &["--train", "good.csv", "stick.csv", "--json"]);
        assert_eq!(code, Some(0), "{seed}: {text}");
        let worst = deviations(&text).iter().map(|one| one[0].abs()).fold(0.0, f64::max);
        assert!(worst < 4.5, "{seed}: {text}");
    }
}

/// Of a log for validation with an encoder of 10 bits noise of the positions is left: that is no
/// misfit.
#[test]
fn noise_of_a_log_for_validation_is_no_misfit() {
    let directory = Directory::new("rest-validation");
    write_arm(&directory, None);
    for seed in [1, 2, 3] {
        write_log(&directory, "good.csv", &made(seed, &motions(seed, 0.7)));
        let mut rows = made(seed + 10, &motions(seed + 10, 0.7));
        round_positions(&mut rows, TAU / 1024.0);
        write_log(&directory, "coarse.csv", &rows);
        let words = ["--train", "good.csv", "--validate", "coarse.csv", "--filter", "25"];
        let (_, text) = said(&directory, &words);
        assert!(text.contains("all "), "{text}");
        assert!(!text.contains("is not explained"), "{seed}: {text}");
    }
}

/// Of a log of which noise of the positions makes most, what is left while a joint is slower than
/// its encoder shows is that noise, which a short rest may find alike.
#[test]
fn noise_is_no_position_that_is_stuck() {
    let directory = Directory::new("rest-noise");
    write_arm(&directory, None);
    let is_accused = |seed: &u64| {
        let fine = Made { step_s: 0.004, samples: 3500, seed: *seed, ..GOOD };
        write_log(&directory, "fine.csv", &fine.rows(&motions(2 * seed, 0.7)));
        let coarse = Made { step_s: 0.001, samples: 6000, seed: seed + 40, ..GOOD };
        let mut rows = coarse.rows(&motions(2 * seed + 1, 0.2));
        round_positions(&mut rows, TAU / 1024.0);
        write_log(&directory, "coarse.csv", &rows);
        let (_, text) = said(&directory, &["--train", "fine.csv", "coarse.csv"]);
        assert!(text.contains("what coarse.csv shows"), "{seed}: {text}");
        text.contains("is not explained")
    };
    let accused: Vec<u64> = (1..=12).filter(is_accused).collect();
    assert_eq!(accused, [0_u64; 0]);
}

/// An arm that lies all but level, tilted another way than the model says and more: on that its
/// torques hardly depend on, no position is counted from a zero that is turns away.
#[test]
fn no_zero_is_turns_away() {
    let directory = Directory::new("rest-level");
    write_arm(&directory, None);
    let arm = std::fs::read_to_string(directory.path.join("arm.json")).expect("written");
    let mut arm: serde_json::Value = serde_json::from_str(&arm).expect("JSON");
    arm["gravity"] = serde_json::json!([0, -0.005, 0]);
    std::fs::write(directory.path.join("arm.json"), arm.to_string()).expect("written");
    for seed in 1..=8 {
        let made = Made { step_s: 0.002, samples: 10_000, torque_noise: 0.01, seed, ..GOOD };
        let mut both = motions(seed, 0.7);
        both.iter_mut().flat_map(|one| &mut one.waves).for_each(|wave| wave[0] *= 2.0);
        let mut rows = made.rows(&both);
        for [_, a, b, one, other] in &mut rows {
            // weights along the first axis of the plane and along the second
            let weight = |along: f64| 1.5 * 0.23 * along;
            let first = |along: f64| (2.0 * 0.28 + 1.5 * 0.5) * along;
            let (level, tilt) = (0.005 - 9.81, 0.05);
            *one += level * (first(a.cos()) + weight((*a + *b).cos()));
            *other += level * weight((*a + *b).cos());
            *one += tilt * (first(a.sin()) + weight((*a + *b).sin()));
            *other += tilt * weight((*a + *b).sin());
        }
        write_log(&directory, "level.csv", &rows);
        let (_, text) = said(&directory, &["--train", "level.csv"]);
        assert!(text.contains("residual"), "{text}");
        assert!(!text.contains("position of link"), "{seed}: {text}");
    }
}

/// Ten seconds in which one joint after the other moves about where it stands upright, while the
/// other rests and rubs against nothing: position, rate and acceleration are those of a cycloid.
fn one_after_the_other(seed: u64, [take_s, rest_s]: [f64; 2]) -> Vec<[f64; 5]> {
    let mut random = Random::new(seed);
    let turns = (10.0 / (take_s + rest_s)).ceil() as usize;
    let places: Vec<f64> = (0..turns + 2).map(|_| random.uniform() - 0.5).collect();
    let mut rows: Vec<[f64; 5]> = Vec::new();
    for k in 0..5000 {
        let t = 0.002 * f64::from(k);
        let turn = (t / (take_s + rest_s)) as usize;
        let share = ((t - turn as f64 * (take_s + rest_s)) / take_s).min(1.0);
        let (sine, cosine) = (TAU * share).sin_cos();
        let goes = [share - sine / TAU, (1.0 - cosine) / take_s, TAU * sine / take_s.powi(2)];
        let moves = |joint: usize| {
            // a joint goes on in every other turn, from where it came to in the one before the last
            let [from, to] = if turn % 2 == joint { [turn, turn + 2] } else { [turn + 1; 2] };
            let is_first = f64::from(u8::from(joint == 0));
            let way = if share < 1.0 { places[to] - places[from] } else { 0.0 };
            let about = is_first * TAU / 4.0 + if share < 1.0 { places[from] } else { places[to] };
            [about + way * goes[0], way * goes[1], way * goes[2]]
        };
        let both = [moves(0), moves(1)];
        let [one, other] = torques(both).map(|one| one + 0.02 * random.normal());
        rows.push([t, both[0][0], both[1][0], one, other]);
    }
    round_positions(&mut rows, STEP);
    rows
}

/// A good log for validation in which joints rest is none of another robot: friction at rest is not
/// what the sign of the filter's ringing makes of it.
#[test]
fn a_log_for_validation_of_joints_that_rest_is_not_accused() {
    let directory = Directory::new("rest-validation");
    write_arm(&directory, None);
    for (seed, times) in [(1, [0.6, 0.2]), (5, [0.7, 0.4]), (7, [0.4, 0.4]), (8, [0.6, 0.2])] {
        write_log(&directory, "one.csv", &made(seed, &motions(seed, 0.7)));
        write_log(&directory, "turns.csv", &one_after_the_other(seed, times));
        let (code, text) = said(&directory, &["--train", "one.csv", "--validate", "turns.csv"]);
        assert_eq!(code, Some(0), "{seed}: {text}");
    }
}

/// What friction does to the torque of a motor whose joint rests.
#[derive(Clone, Copy, Debug, PartialEq)]
enum AtRest {
    /// Nothing.
    Nothing,
    /// What it did before.
    Stays,
    /// It takes what changes of the load, as far as Coulomb friction goes.
    Holds,
}

/// Twenty-four seconds in which one joint moves for three, then the other one, each from where it
/// came to a halt.
fn in_turns(seed: u64, at_rest: AtRest) -> Vec<[f64; 5]> {
    let mut random = Random::new(seed);
    let motions = motions(seed, 1.5);
    let mut rows: Vec<[f64; 5]> = Vec::new();
    let (mut sign, mut motor) = ([1.0_f64; 2], [0.0_f64; 2]);
    for k in 0..12_000 {
        let t = 0.002 * f64::from(k);
        let turn = (t / 3.0) as usize;
        let share = t / 3.0 - turn as f64;
        // the time of a joint goes on in its turns alone
        let along = [0, 1].map(|joint: usize| {
            let before = 3.0 * ((turn + 1 - joint) / 2) as f64;
            let (sine, cosine) = (TAU * share).sin_cos();
            match turn % 2 == joint {
                true => [before + 3.0 * (share - sine / TAU), 1.0 - cosine, TAU / 3.0 * sine],
                false => [before, 0.0, 0.0],
            }
        });
        let both = [0, 1].map(|joint: usize| {
            let [s, rate, acceleration] = along[joint];
            let [q, v, a] = motions[joint].at(s);
            [q, v * rate, a * rate * rate + v * acceleration]
        });
        let mut all = torques(both);
        for joint in 0..2 {
            let coulomb = FRICTION[joint][1];
            if both[joint][1] != 0.0 {
                sign[joint] = both[joint][1].signum();
            } else if at_rest == AtRest::Stays {
                all[joint] += coulomb * sign[joint];
            } else if at_rest == AtRest::Holds {
                all[joint] = motor[joint].clamp(all[joint] - coulomb, all[joint] + coulomb);
            }
        }
        motor = all;
        let [one, other] = all.map(|one| one + 0.05 * random.normal());
        rows.push([t, both[0][0], both[1][0], one, other]);
    }
    round_positions(&mut rows, STEP);
    rows
}

/// Of joints that move in turns intervals hold, whatever friction does at rest: rows of rests are
/// left out.
#[test]
fn friction_at_rest_biases_nothing() {
    let directory = Directory::new("rest-turns");
    write_arm(&directory, None);
    for seed in [1, 2, 3] {
        for at_rest in [AtRest::Nothing, AtRest::Stays, AtRest::Holds] {
            write_log(&directory, "turns.csv", &in_turns(seed, at_rest));
            let (code, text) = said(&directory, &["--train", "turns.csv", "--json"]);
            assert_eq!(code, Some(0), "{seed} {at_rest:?}: {text}");
            assert!(worst(&text) < 4.5, "{seed} {at_rest:?}: {text}");
        }
    }
}
