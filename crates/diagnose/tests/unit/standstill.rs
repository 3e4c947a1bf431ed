//! Tests of what is private in `standstill.rs`.

use super::*;

const STEP: f64 = 2e-5;

fn read(position: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..400).map(|k| (position(0.002 * f64::from(k)) / STEP).round() * STEP).collect()
}

/// It is slowed down until 0.3 s, rests until 0.4 s, and is moved back.
fn back(t: f64) -> f64 {
    0.15 - (0.3 - t).max(0.0).powi(2) - 3.0 * (t - 0.4).max(0.0).powf(2.5)
}

/// It turns around at 1 s, stops at 2 s, and rests for 6 s: the filter blurs the last samples.
#[test]
fn a_long_rest_leaves_the_motion_before_it() {
    let t: Vec<f64> = (0..4000).map(|k| 0.002 * f64::from(k)).collect();
    let rate = |t: &f64| match t {
        t if *t < 1.99 => (std::f64::consts::PI * t).sin(),
        _ => 0.0,
    };
    let mut rates: Vec<f64> = t.iter().map(rate).collect();
    let seen = rates.clone();
    let (time_s, directions) = (2.0..8.0, [-1.0, 1.0]);
    let sides = vec![0.0; 2];
    let rest = Rest { time_s, directions, sides, needs: Vec::new(), leaves_s: 8.0, creep: 1e-6 };
    alternate(&mut rates, &t, &[rest]);
    assert_eq!(rates[..995], seen[..995]);
    assert!(rates[995..1000].iter().all(|rate| *rate == -1e-6));
    assert!(rates[1000..].iter().all(|rate| rate.abs() == 1e-6));
}

#[test]
fn a_drive_that_stops_rests_and_one_that_turns_around_does_not() {
    let [rest] = &rests(&read(back), STEP, [0.0, 0.002])[..] else { panic!("one rest") };
    assert!((rest.time_s.start - 0.3).abs() < 0.003 && (rest.time_s.end - 0.4).abs() < 0.003);
    assert!((rest.creep - STEP / 0.1).abs() < 0.1 * STEP / 0.1, "{rest:?}");
    assert_eq!(rest.directions, [1.0, -1.0]);
    assert_eq!(rests(&read(|t| 4.0 * (t - 0.4).powi(2)), STEP, [0.0, 0.002]), []);
    assert_eq!(rests(&read(|_| 0.2), STEP, [0.0, 0.002]), [], "it never moved");
}

#[test]
fn a_drive_rests_where_it_creeps_and_where_its_log_begins_and_ends() {
    let creeps = |t: f64| back(t) - 4.0 * STEP * ((t - 0.3) / 0.1).clamp(0.0, 1.0);
    let [rest] = &rests(&read(creeps), STEP, [0.0, 0.002])[..] else { panic!("one rest") };
    assert!((rest.time_s.start - 0.3).abs() < 0.02 && (rest.time_s.end - 0.4).abs() < 0.02);

    let begins = |t: f64| 3.0 * (t - 0.4).max(0.0).powf(2.5);
    let [rest] = &rests(&read(begins), STEP, [0.0, 0.002])[..] else { panic!("one rest") };
    assert!(rest.time_s.start == 0.0 && (rest.time_s.end - 0.4).abs() < 0.003, "{rest:?}");
    let rest = rest.clone().within(&(0.1..0.3)).expect("it rests there");
    assert_eq!((rest.time_s.clone(), rest.leaves_s), (0.1..0.3, 0.1));
    assert_eq!(rest.within(&(0.4..0.5)), None);
    let [rest] = &rests(&read(|t| begins(0.8 - t)), STEP, [0.0, 0.002])[..] else {
        panic!("one rest")
    };
    assert!((rest.time_s.start - 0.4).abs() < 0.005 && rest.time_s.end == 0.798, "{rest:?}");
    // slowly from reading to reading is no rest
    assert_eq!(rests(&read(|t| 1e-3 * t), STEP, [0.0, 0.002]), []);
}

/// A mass with friction that a controller moves back and forth, and that needs more than what
/// it slides with to leave where it rests: what its encoder reads every 2 ms, and its friction
/// in steps of 10 us.
fn controlled(mass: f64, hold: f64) -> (Vec<f64>, Vec<f64>) {
    let (mut position, mut rate, h) = (0.0_f64, 0.0_f64, 1e-5);
    let damping = 1.4 * (400.0 * mass).sqrt();
    let (mut read, mut frictions) = (Vec::new(), Vec::new());
    for k in 0..400_000 {
        let phase = 3.0 * h * f64::from(k);
        let ahead = 0.5 * phase.sin() - position;
        let push = 400.0 * ahead + damping * (1.5 * phase.cos() - rate);
        let side = if rate == 0.0 { push.signum() } else { rate.signum() };
        let friction = if rate == 0.0 && push.abs() <= hold { push } else { side };
        let next = rate + h * (push - friction) / mass;
        rate = if next * rate < 0.0 { 0.0 } else { next };
        position += h * rate;
        frictions.push(friction);
        if k % 200 == 0 {
            read.push((position / STEP).round() * STEP);
        }
    }
    (read, frictions)
}

#[test]
fn friction_at_rest_is_what_balances_up_to_that_of_sliding() {
    for (mass, hold) in [(0.02, 1.0), (0.1, 1.0), (0.02, 1.8), (0.1, 2.5)] {
        let (read, frictions) = controlled(mass, hold);
        let mut found = rests(&read, STEP, [0.0, 0.002]);
        assert!(found.len() >= 3, "{mass}: {}", found.len());
        let t: Vec<f64> = (0..40_000).map(|k| 1e-4 * f64::from(k)).collect();
        let truth = |t: f64| frictions[(t / 1e-5) as usize];
        for rest in &mut found {
            // What is measured every 2 ms of a mass that does not move is its friction.
            let samples = rest.samples(&t).skip(10).step_by(20);
            rest.settle(&samples.map(|k| [truth(t[k]), 1.0]).collect::<Vec<_>>());
        }
        let mut rates = vec![0.0; t.len()];
        alternate(&mut rates, &t, &found);
        for rest in &found {
            let Range { start, end } = rest.time_s;
            for part in [0.1, 0.3, 0.5, 0.7, 0.9] {
                let middle = start + (end - start) * part;
                let own = within(&t, &(middle - 0.004..middle + 0.004));
                let mean =
                    |of: &dyn Fn(usize) -> f64| own.clone().map(of).sum::<f64>() / own.len() as f64;
                let seen = mean(&|k| rates[k].signum());
                let needed = mean(&|k| truth(t[k]).clamp(-1.0, 1.0));
                assert!((seen - needed).abs() < 0.1, "{mass} {hold} {part}: {seen} {needed}");
            }
            // From then on it needs what it slides with, or more, and creeps by a step.
            let leaves = truth(rest.leaves_s + 0.002) * rest.directions[1];
            assert!(leaves > SLIDES - 0.05, "{mass} {hold}: {leaves}");
            let crept = rest.creep * (end - rest.leaves_s);
            assert!((crept - STEP).abs() < 1e-9 * STEP);
        }
    }
}
