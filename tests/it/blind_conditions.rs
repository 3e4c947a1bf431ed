//! The blind battery's rows with conditions of real logs: what each changes, and nothing else.

use denavit_blind::battery::{report, reported};
use denavit_blind::case::Case;
use denavit_blind::conditions::{CONDITIONS, Condition, Disturbance};
use denavit_blind::design::{CONDITION_ROWS, CONDITIONS_FROM, Kind, plan};
use denavit_blind::generate::Generated;
use denavit_blind::hidden::Law;
use denavit_blind::random::Random;
use denavit_blind::score::{Answer, score};
use std::collections::BTreeSet;

/// The first case with nothing hidden in a small robot under a condition.
fn small(condition: Condition) -> Generated {
    let fits = |number: &u64| {
        let plan = plan(*number);
        plan.condition == Some(condition) && plan.kind == Kind::Nothing && plan.robot < 2
    };
    let mut numbers = (CONDITIONS_FROM..CONDITIONS_FROM + CONDITION_ROWS as u64).filter(fits);
    Case::new(numbers.next().expect("a small robot")).generate()
}

/// Root mean square of what is left of a signal after its mean.
fn spread(signal: &[f64]) -> f64 {
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let squares = signal.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
    (squares / signal.len() as f64).sqrt()
}

#[test]
fn every_condition_has_nothing_hidden_and_every_effect_has_a_condition() {
    let plans: Vec<_> = (CONDITIONS_FROM..).take(CONDITION_ROWS).map(plan).collect();
    for condition in CONDITIONS {
        let of = |kind: Kind| {
            let these = plans.iter().filter(move |plan| plan.condition == Some(condition));
            these.filter(move |plan| plan.kind == kind)
        };
        let expected = if condition == Condition::Together { 12 } else { 4 };
        let counts = [of(Kind::Nothing).count(), of(Kind::Single).count()];
        assert_eq!(counts, [expected; 2], "{condition:?}");
        let robots: BTreeSet<usize> = of(Kind::Nothing).map(|plan| plan.robot).collect();
        assert!(robots.len() >= 4, "{condition:?}");
        let strengths: BTreeSet<usize> = of(Kind::Single).map(|plan| plan.strength).collect();
        assert_eq!(strengths.len(), 3, "{condition:?}");
    }
    let laws: BTreeSet<Law> = plans.iter().flat_map(|plan| plan.laws.clone()).collect();
    assert_eq!(laws.len(), 38);
    let numbers: Vec<u64> = reported().collect();
    assert_eq!(numbers.len(), 551 + CONDITION_ROWS);
    assert!((0..CONDITIONS_FROM).step_by(97).all(|number| plan(number).condition.is_none()));
}

#[test]
fn stamps_scatter_as_the_case_says_and_rows_are_where_their_stamps_are() {
    let case = small(Condition::Jitter);
    let (log, jitter) = (&case.train, case.case.recording.jitter);
    assert!((0.01..=0.05).contains(&jitter));
    let off = log.t.iter().enumerate().map(|(row, t)| t / log.step_s - row as f64);
    let scatter = spread(&off.collect::<Vec<_>>());
    assert!((scatter / jitter - 1.0).abs() < 0.05, "{scatter}, {jitter}");
    // a row measured at its stamp is off the line between its neighbours by curvature alone
    let missed = |stamped: bool| -> f64 {
        let q = &log.q[0];
        let at = |row: usize| if stamped { log.t[row] } else { row as f64 * log.step_s };
        let off = (1..q.len() - 1).map(|row| {
            let part = (at(row) - at(row - 1)) / (at(row + 1) - at(row - 1));
            q[row] - q[row - 1] - part * (q[row + 1] - q[row - 1])
        });
        spread(&off.collect::<Vec<_>>())
    };
    assert!(missed(true) < 0.7 * missed(false), "{} {}", missed(true), missed(false));
}

#[test]
fn missing_rows_are_few_and_short() {
    let case = small(Condition::Dropped);
    let log = &case.train;
    let grid: Vec<usize> = log.t.iter().map(|t| (t / log.step_s).round() as usize).collect();
    let whole = (case.case.duration_s / log.step_s).round() as usize;
    let share = (whole - grid.len()) as f64 / whole as f64;
    assert!((0.3..3.0).contains(&(share / case.case.recording.dropped)), "{share}");
    let most = grid.windows(2).map(|pair| pair[1] - pair[0]).max();
    assert!((2..=4).contains(&most.expect("rows")));
}

#[test]
fn numbers_are_printed_as_the_case_says() {
    let folder = std::env::temp_dir().join(format!("denavit-digits-{}", std::process::id()));
    for condition in [Condition::Printed, Condition::SinglePrecision, Condition::CoarseEncoder] {
        let case = small(condition);
        case.write_files(&folder).expect("files");
        let text = std::fs::read_to_string(folder.join("train.csv")).expect("a log");
        let cells = || text.lines().skip(1).flat_map(|line| line.split(',').skip(1));
        match condition {
            Condition::SinglePrecision => {
                let exact = |cell: &str| cell.parse::<f32>().expect("a number").to_string() == cell;
                assert!(cells().all(exact));
            }
            _ => assert!(cells().all(|cell| cell.split('.').nth(1).map(str::len) == Some(6))),
        }
        let bits = (std::f64::consts::TAU / case.case.sensors.resolution).log2();
        let is_coarse = condition == Condition::CoarseEncoder;
        assert!(if is_coarse { [16.0, 17.0, 18.0].contains(&bits) } else { bits > 18.0 }, "{bits}");
    }
    std::fs::remove_dir_all(&folder).expect("the folder was made");
}

#[test]
fn a_disturbance_has_its_size_and_band_and_no_column() {
    let mut disturbance = Disturbance::new(&[2.0], Random::new(1, "a run"));
    let mut torque = [0.0];
    let signal: Vec<f64> = (0..400_000)
        .map(|step| {
            disturbance.step(&mut torque, step == 0);
            torque[0]
        })
        .collect();
    assert!((spread(&signal) / 2.0 - 1.0).abs() < 0.05);
    // a lag of 8 Hz has forgotten all but 1/e after 1 / (2 pi 8) s: 80 steps of 0.25 ms
    let alike = signal.windows(81).map(|part| part[0] * part[80]).sum::<f64>();
    let alike = alike / signal.iter().map(|x| x * x).sum::<f64>();
    assert!((alike - (-1.0_f64).exp()).abs() < 0.05, "{alike}");
    let case = small(Condition::Disturbance);
    let plain = small(Condition::Dropped);
    assert!(plain.case.disturbance.is_empty());
    assert!(case.case.disturbance.iter().all(|size| *size > 0.0));
}

#[test]
fn a_models_own_friction_is_far_off_and_says_so() {
    let case = small(Condition::OwnFriction).case;
    for (joint, real) in case.nominal.robot.joints.iter().zip(&case.truth.joints) {
        let pairs =
            [(joint.drive.viscous, real.drive.viscous), (joint.drive.coulomb, real.drive.coulomb)];
        for (stated, real) in pairs {
            let error = (stated / real - 1.0).abs();
            assert!((0.2..=0.5).contains(&error), "{error}");
            // within two deviations of what is stated
            assert!((stated - real).abs() <= 2.0 * case.nominal.friction_std * stated);
        }
        let file = case.nominal.file();
        let entry = &file["drives"][joint.name]["coulomb"];
        let relative = entry["std"].as_f64().unwrap() / entry["value"].as_f64().unwrap();
        assert!((relative - 0.5).abs() < 1e-9);
    }
}

#[test]
fn rows_with_conditions_are_reported_beside_the_first() {
    let first = (0..1000).find(|number| {
        let plan = plan(*number);
        plan.kind == Kind::Nothing && plan.robot == 0
    });
    let first = Case::new(first.expect("a pendulum without an effect")).generate();
    let says = |case: &Generated, verdict: &str| {
        score(case, &Answer { verdict: verdict.to_owned(), ..Answer::default() })
    };
    let behind = small(Condition::Together);
    let scores = [says(&first, "nothing_missing"), says(&behind, "explained")];
    let text = report(&scores);
    let (first, behind) = text.split_once("## Conditions of real logs").expect("two parts");
    assert!(first.contains("| nothing hidden: false discoveries | 0 | 1 |"), "{first}");
    assert!(behind.contains("| nothing hidden: false discoveries | 1 | 1 |"), "{behind}");
    assert!(behind.contains("| Together | 0 of 0 | 0 of 0 | 1 of 1 | 0 of 1 |"), "{behind}");
    assert!(!report(&scores[..1]).contains("Conditions of real logs"));
}
