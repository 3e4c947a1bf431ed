//! Bodies with almost flat feet and with contacts almost in a line: each was once a run that ended
//! otherwise than it should.

use super::{Directory, run_in};
use std::fs;
use std::path::Path;

/// Runs a scenario of the fixtures; whether it came to its end without a broken audit, and its log.
fn ends(name: &str, more: &[&str]) -> (bool, String) {
    let directory = Directory::new(name);
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/landings");
    for file in [format!("{name}.json"), format!("{name}.model.json")] {
        fs::copy(fixtures.join(&file), directory.path.join(&file)).expect("a fixture");
    }
    let file = format!("{name}.json");
    let run = run_in(&directory.path, &[&["simulate", &file, "-o", "log.csv"], more].concat());
    println!("{}{}", run.stdout, run.stderr);
    let log = fs::read_to_string(directory.path.join("log.csv")).unwrap_or_default();
    (run.code == Some(0), log)
}

/// Corners of a rocking block, with points between them that are set back by 1 mm.
#[test]
fn a_block_rocks_on_edges_that_are_set_back() {
    assert!(ends("recessed_edge", &[]).0);
}

/// Four points, three of them within 2 mm of a line.
#[test]
fn a_body_lands_on_points_nearly_in_a_line() {
    assert!(ends("nearly_in_line", &[]).0);
}

#[test]
fn a_landing_does_not_depend_on_the_log_period() {
    assert!(ends("log_period", &[]).0);
}

/// One corner of four is 1e-7 m higher.
#[test]
fn a_foot_that_is_not_quite_even_stands() {
    assert!(ends("uneven_foot", &[]).0);
}

/// Points between the corners begin 5e-7 m above the ground, the block tilted.
#[test]
fn a_start_keeps_its_tilt() {
    let (_, log) = ends("tilted_recess", &[]);
    let mut rows = log.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = rows.next().expect("a header").split(',').collect();
    let first: Vec<&str> = rows.next().expect("a row").split(',').collect();
    let pitch = names.iter().position(|name| *name == "q_base_pitch").expect("a pitch");
    let pitch: f64 = first[pitch].parse().expect("a number");
    assert!((pitch - 0.05).abs() < 1e-6, "{pitch}");
}

#[test]
fn a_sliding_landing_has_a_solution() {
    assert!(ends("sliding_landing", &[]).0);
}

#[test]
fn slipping_ends_without_adhesion() {
    assert!(ends("end_of_slip", &[]).0);
}

#[test]
fn a_higher_accuracy_comes_to_the_same_end() {
    assert!(ends("fine_accuracy", &[]).0);
}

#[test]
fn pivots_solve_what_sweeps_solve() {
    assert!(ends("pivots", &["--scheme", "time-stepping"]).0);
}

/// Of four points nearly in a line that slide, equally compliant ones would make one pull.
#[test]
fn points_that_slide_in_a_line_do_not_pull() {
    assert!(ends("sliding_in_line", &[]).0);
}

/// Two points of a body begin to slip, one after the other, more slowly than errors are.
#[test]
fn what_begins_to_slip_slips_on() {
    assert!(ends("slipping_begins", &[]).0);
}

/// Without friction, a point that parts is pushed on by the rebound of others.
#[test]
fn steps_with_restitution_make_no_energy() {
    assert!(ends("bounce", &["--scheme", "time-stepping"]).0);
}

/// One point slips with friction 1 until its normal force has no bound.
#[test]
fn a_jam_is_called_one() {
    let (_, log) = ends("jam", &[]);
    assert!(log.lines().any(|line| line == "# stop: painleve"), "{log}");
}
