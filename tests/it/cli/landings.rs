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

/// Where the body is in the last row: x, y, yaw \[m, m, rad\].
fn last_pose(name: &str, more: &[&str]) -> [f64; 3] {
    let (_, log) = ends(name, more);
    let mut rows = log.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = rows.next().expect("a header").split(',').collect();
    let last: Vec<&str> = rows.next_back().expect("a row").split(',').collect();
    ["q_base_x", "q_base_y", "q_base_yaw"].map(|wanted| {
        let place = names.iter().position(|name| *name == wanted).expect("a column");
        last[place].parse().expect("a number")
    })
}

fn are_near(left: [f64; 3], right: [f64; 3], tolerance: f64) -> bool {
    left.iter().zip(right).all(|(a, b)| (a - b).abs() <= tolerance)
}

/// Eight points on a circle; mass so high that the sole loses points while it slides and turns.
#[test]
fn a_tall_sole_does_not_depend_on_the_order_of_its_points() {
    let [one, other] = ["tall_sole", "tall_sole_permuted"].map(|name| last_pose(name, &[]));
    assert!(are_near(one, other, 1e-5), "{one:?} {other:?}");
}

#[test]
fn a_sole_that_loses_points_does_not_depend_on_the_log_period() {
    let [one, other] = ["losing_points", "losing_points_logged"].map(|name| last_pose(name, &[]));
    assert!(are_near(one, other, 1e-6), "{one:?} {other:?}");
}

/// The event-driven scheme, and an integration of the flat body with loads on a plane, end at
/// x = 0.631074, y = 0.006168.
#[test]
fn shorter_steps_of_a_sliding_sole_converge() {
    let pose = last_pose("sole_by_steps", &["--step", "1e-4"]);
    assert!(are_near(pose, [0.631_074, 0.006_168, -0.760_676], 2e-5), "{pose:?}");
}

/// The sole tips while it slides, and lands again.
#[test]
fn seven_points_slide_to_their_end() {
    assert!(ends("seven_points", &[]).0);
}

/// A tumbling body whose points roll over the ground one after the other.
#[test]
fn eight_points_land_and_slide_to_rest() {
    assert!(ends("eight_points", &[]).0);
}

/// Where equally compliant points find no loads, the state alone must decide too, and be told.
#[test]
fn least_loads_are_told_and_do_not_depend_on_order() {
    let [one, other] = ["least_loads", "least_loads_permuted"].map(|name| last_pose(name, &[]));
    assert!(are_near(one, other, 1e-6), "{one:?} {other:?}");
    let (_, log) = ends("least_loads", &[]);
    assert!(log.lines().any(|line| line.starts_with("# note: ")), "{log}");
    let (_, log) = ends("tall_sole", &[]);
    assert!(!log.lines().any(|line| line.starts_with("# note: ")));
}

/// Three points in a line hit at once: none may be left out for rounding.
#[test]
fn a_landing_on_an_edge_does_not_depend_on_the_log_period() {
    let [one, other] =
        ["landing_on_an_edge", "landing_on_an_edge_logged"].map(|name| last_pose(name, &[]));
    assert!(are_near(one, other, 1e-7), "{one:?} {other:?}");
}

/// Two distributions of the load would be taken in turns, by ever shorter steps.
#[test]
fn a_sole_with_two_loads_keeps_one() {
    assert!(ends("two_loads", &[]).0);
}

#[test]
fn a_landing_without_a_speed_of_rest_is_no_bounce() {
    assert!(ends("no_rest_speed", &[]).0);
}

/// The last row is off the end by rounding, and asks for no step to it.
#[test]
fn no_step_is_as_short_as_rounding() {
    assert!(ends("uneven_end", &[]).0);
}

/// Two of seven points are 1.5e-8 m up where the sole lands; control of drift lays the sole flat.
#[test]
fn points_that_come_down_late_are_closed() {
    let (ended, log) = ends("hardly_tilted", &[]);
    let mut rows = log.lines().filter(|line| !line.starts_with('#'));
    let mut names = rows.next().expect("a header").split(',');
    let place = names.position(|name| name == "contact_modes").expect("a column");
    let modes: Vec<&str> = rows.map(|row| row.split(',').nth(place).expect("modes")).collect();
    // 2 slips, 0 is open
    assert!(ended && modes.contains(&"2220022"), "{modes:?}");
    assert!(!modes[modes.len() / 2].contains('0'), "{modes:?}");
}
