//! Criteria of balance against walking.md section 6, whose figures another simulator made, and
//! against each other: forces and momentum, foot rotation indicator and zero moment point.

use super::{assert_near, scenario};
use denavit_simulate::{Log, LogFault, LogFile, Push, Shove, Simulation, simulate};
use denavit_walk::balance::{
    Course, Criterion, Grid, Over, course_of_log, course_of_scenario, course_on_grid,
};

fn cycle(name: &str) -> Course {
    let course = course_of_scenario(&mut scenario(name), 5e-4, false).unwrap();
    assert_eq!(course.over, Over::Cycle);
    assert!(course.forces_against_momentum_m() < 1e-9, "{}", course.forces_against_momentum_m());
    assert!(course.still_foot_apart_m().unwrap() < 1e-9);
    course
}

#[test]
fn the_zmp_gait_keeps_its_margins() {
    let course = cycle("planar_biped_zmp_gait");
    let margins = |criterion| course.margins(criterion).unwrap();
    assert_near(margins(Criterion::ZeroMoment).least_m, 34.38e-3, 1e-5);
    assert_near(margins(Criterion::CartTable).least_m, 32.7e-3, 1e-4);
    assert!(margins(Criterion::Capture).least_m >= 42e-3);
    let shares = course.shares();
    assert_near(shares.flat, 0.63, 5e-3);
    assert_near(shares.double, 0.37, 5e-3);
    assert_near(shares.one_point, 0.0, 0.0);
    let momenta = course.instants.iter().map(|instant| instant.angular_momentum[1]);
    assert_near(momenta.clone().fold(f64::INFINITY, f64::min), -0.114, 1e-3);
    assert_near(momenta.fold(f64::NEG_INFINITY, f64::max), 0.166, 1e-3);
}

#[test]
fn the_limit_cycle_meets_no_static_criterion() {
    let course = cycle("planar_biped_limit_cycle_gait");
    let margins = |criterion| course.margins(criterion).unwrap();
    assert_near(margins(Criterion::CartTable).outside, 0.384, 2e-3);
    assert_near(margins(Criterion::Capture).least_m, -0.232, 1e-3);
    assert_near(margins(Criterion::Capture).outside, 1.0, 0.0);
    // in reality the ground's forces have their point where feet are
    assert!(margins(Criterion::ZeroMoment).least_m > -1e-9);
    // a share is known to an instant at either end
    let instant = 5e-4 / 0.45;
    assert_near(course.shares().one_point, 0.192, 5e-4 + 2.0 * instant);
    // the foot turns about its toe: by then the indicator is outside
    let turning = course.instants.iter().filter(|instant| {
        let share = (instant.t_s / 0.45).fract();
        (0.74..0.90).contains(&share)
    });
    let mut count = 0;
    for instant in turning {
        assert!(Criterion::FootRotation.margin(instant).unwrap() < 0.0, "{}", instant.t_s);
        count += 1;
    }
    assert!(count > 100);
    let momenta = course.instants.iter().map(|instant| instant.angular_momentum[1]);
    assert_near(momenta.clone().fold(f64::INFINITY, f64::min), -1.176, 2e-3);
    assert_near(momenta.fold(f64::NEG_INFINITY, f64::max), 1.052, 2e-3);
}

/// Accelerations of a log are in its torques and forces, too.
#[test]
fn a_log_says_what_its_run_did() {
    let mut scenario = scenario("planar_biped_zmp_gait");
    scenario.simulation.end_s = 2.4;
    let own = course_of_scenario(&mut scenario, 1e-2, true).unwrap();
    let log = without_accelerations(&own);
    let read = course_of_log(scenario.plant.as_mut(), &log).unwrap();
    assert_eq!(read.instants.len(), own.instants.len());
    for (here, there) in read.instants.iter().zip(&own.instants) {
        assert_near(here.zero_moment_point_m[0], there.zero_moment_point_m[0], 1e-8);
        assert_eq!(here.phase, there.phase);
    }
}

/// The log of a course's run as `simulate` writes it.
fn without_accelerations(course: &Course) -> LogFile {
    let mut log = course.run.clone().unwrap().log;
    let kept: Vec<usize> =
        (0..log.columns.len()).filter(|c| !log.columns[*c].starts_with("qdd_")).collect();
    log.values =
        log.rows().flat_map(|row| kept.iter().map(|c| row[*c]).collect::<Vec<_>>()).collect();
    log.columns = kept.iter().map(|c| log.columns[*c].clone()).collect();
    LogFile::of("run.csv", log)
}

/// Where forces push, the ground's force acts where it balances them, too: Newton and Euler for the
/// whole robot. Two pushes overlap, one off the frame's origin on a link that moves.
#[test]
fn pushes_are_part_of_the_zero_moment_point() {
    let mut scenario = scenario("planar_biped_zmp_gait");
    scenario.simulation.end_s = 1.3;
    let links = scenario.plant.model().links.clone();
    let push = |link: &str, position: [f64; 3], at_s: f64, force: [f64; 3]| {
        let link = links.iter().position(|known| known == link).unwrap();
        let point = denavit_plants::PointModel { name: String::new(), link, position };
        Push { point, at_s, shove: Shove::Force(force, 0.1) }
    };
    scenario.simulation.pushes = vec![
        push("base_pitch", [0.3, 0.1, 0.0], 1.0, [20.0, 0.0, -30.0]),
        push("left_knee", [0.1, 0.05, 0.0], 1.05, [5.0, 0.0, 7.0]),
    ];
    let own = course_of_scenario(&mut scenario, 1e-3, true).unwrap();
    assert!(own.forces_against_momentum_m() < 1e-9, "{}", own.forces_against_momentum_m());
    let file = without_accelerations(&own);
    // the force itself, and its moment about the frame's origin, of a place in the plane
    let during = file.log.rows().position(|row| row[0] > 1.02).unwrap();
    let entry = |name: &str| file.log.column(name).unwrap()[during];
    assert_eq!(["fx", "fy", "fz"].map(|a| entry(&format!("w_base_pitch_{a}"))), [20.0, 0.0, -30.0]);
    assert_eq!(entry("w_left_knee_fx"), 0.0);
    let lever = entry("w_base_pitch_my").abs() / 20.0_f64.hypot(30.0);
    assert!(lever <= 0.3_f64.hypot(0.1) + 1e-12, "{lever}");
    let read = course_of_log(scenario.plant.as_mut(), &file).unwrap();
    assert!(read.forces_against_momentum_m() < 1e-9, "{}", read.forces_against_momentum_m());
    assert_eq!(read.instants.len(), own.instants.len());
    for (here, there) in read.instants.iter().zip(&own.instants) {
        assert_near(here.zero_moment_point_m[0], there.zero_moment_point_m[0], 1e-9);
        assert_near(here.center_of_mass[2][0], there.center_of_mass[2][0], 1e-6);
        // an indicator of the foot alone would leave the push out
        let is_pushed = (1.0..1.15).contains(&here.t_s);
        assert!(!is_pushed || here.foot_rotation_m.is_none(), "{}", here.t_s);
    }
}

/// A contact that carried force in a row is in the row's polygon, whatever its digit says of the
/// row's end; a row without forces is left out.
#[test]
fn what_carried_in_a_row_supports_in_it() {
    let mut scenario = scenario("planar_biped_zmp_gait");
    scenario.simulation.end_s = 0.2;
    let own = course_of_scenario(&mut scenario, 1e-2, true).unwrap();
    let mut file = without_accelerations(&own);
    let column = |log: &Log, name: &str| log.columns.iter().position(|c| c == name).unwrap();
    let (width, modes) = (file.log.columns.len(), column(&file.log, "contact_modes"));
    file.log.values[5 * width + modes] = 0.0;
    for (place, name) in file.log.columns.clone().iter().enumerate() {
        if name.starts_with("f_") {
            file.log.values[place] = f64::NAN;
        }
    }
    let read = course_of_log(scenario.plant.as_mut(), &file).unwrap();
    assert_eq!(read.instants.len(), own.instants.len() - 1);
    assert_eq!(read.instants[0].t_s, own.instants[1].t_s);
    let margin = Criterion::ZeroMoment.margin(&read.instants[4]).unwrap();
    assert!(margin > 0.0, "{margin}");
}

#[test]
fn all_faults_of_a_log_are_told_with_their_places() {
    let mut scenario = scenario("planar_biped_zmp_gait");
    scenario.simulation.end_s = 0.2;
    let own = course_of_scenario(&mut scenario, 1e-2, true).unwrap();
    let file = without_accelerations(&own);
    let plant = scenario.plant.as_mut();
    let width = file.log.columns.len();
    let place = |name: &str| file.log.columns.iter().position(|c| c == name).unwrap();
    let mut wrong = file.clone();
    let modes = place("contact_modes");
    let force = format!("f_{}_z", plant.model().contacts[0].name);
    for (row, column, value) in [
        (2, place("q_right_knee"), f64::NAN),
        (2, place("qd_base_x"), f64::NAN),
        (3, modes, -1.0),
        (4, modes, 1.5),
        (5, modes, 9999.0),
        (6, modes, 1e30),
        (7, place(&force), f64::NAN),
        (8, place("tau_left_hip"), f64::NAN),
    ] {
        wrong.log.values[row * width + column] = value;
    }
    let error = course_of_log(plant, &wrong).expect_err("a log");
    let faults = error.log_faults().expect("faults of the log");
    // below the one line of names, rows begin in line 2
    let lines: Vec<usize> = faults.told().iter().map(|fault| fault.line).collect();
    assert_eq!(lines, [4, 4, 5, 6, 7, 8, 9, 10]);
    assert_eq!(faults.told()[0].cell, place("q_right_knee") + 1);
    assert_eq!(faults.told()[6].cause, LogFault::EmptyForce(force));
    let columns = ["t", "q_base_x"].map(str::to_owned).to_vec();
    let short = LogFile::of("a.csv", Log { header: Vec::new(), columns, values: vec![0.0; 2] });
    let error = course_of_log(plant, &short).expect_err("a log");
    let faults = error.log_faults().expect("faults of the log");
    let model = plant.model();
    let needed = 2 * model.joints.len() + 3 * model.contacts.len();
    assert_eq!((faults.count(), faults.told()[0].line), (needed - 1, 1));
}

/// 1000 s at 0.5 ms are 2 000 000 instants: refused where they were asked for, else fewer are made.
#[test]
fn more_instants_than_are_kept_are_refused() {
    let mut scenario = scenario("planar_biped_zmp_gait");
    scenario.simulation.end_s = 1000.0;
    let asked = course_on_grid(&mut scenario, Grid::Every(5e-4), true);
    let error = asked.unwrap_err();
    assert_eq!(error.kind(), denavit_walk::ErrorKind::Options);
    assert!(error.to_string().starts_with("2000000 instants, where"), "{error}");
    assert!(error.to_string().contains("options.period_s"), "{error}");
    scenario.simulation.end_s = 0.2;
    let few = course_on_grid(&mut scenario, Grid::From(1e-2), true).unwrap();
    assert_eq!(few.period_s, Some(1e-2));
    assert_eq!(few.scheme.as_deref(), Some("event"));
}

/// An impulse P on what nothing holds changes its momentum by P and its angular momentum by
/// (r - c) x P; a force does so over its time.
#[test]
fn a_push_changes_momentum_by_its_impulse() {
    let mut scenario = scenario("planar_biped_zmp_gait");
    let plant = scenario.plant.as_mut();
    let mut start = scenario.initial.clone();
    start.q[0] += 1.0;
    start.qd.fill(0.0);
    let model = plant.model().clone();
    let link = model.links.iter().position(|link| link == "base_pitch").unwrap();
    let point =
        denavit_plants::PointModel { name: "shoulder".to_owned(), link, position: [0.3, 0.0, 0.0] };
    for shove in [Shove::Impulse([2.0, 0.0, -1.0]), Shove::Force([2e4, 0.0, -1e4], 1e-4)] {
        let pushes = vec![Push { point: point.clone(), at_s: 0.1, shove }];
        let simulation = Simulation { end_s: 0.1002, pushes, ..scenario.simulation.clone() };
        let control = denavit_simulate::Control::passive(model.joints.len());
        let run = simulate(plant, &control, &start, &simulation).unwrap();
        let [before, after] = [&start, &run.end].map(|state| plant.momentum(&state.q, &state.qd));
        assert_near(after[0] - before[0], 2.0, 1e-9);
        let fall = -model.mass_kg * 9.81 * 0.1002;
        assert_near(after[2] - before[2], fall - 1.0, 1e-7);
        let mut transforms = vec![0.0; 12 * model.links.len()];
        plant.link_transforms(&run.end.q, &mut transforms);
        let mut place = [0.0; 3];
        denavit_plants::point_positions(std::slice::from_ref(&point), &transforms, &mut place);
        let center = plant.center_of_mass(&run.end.q);
        let arm = [place[0] - center[0], place[2] - center[2]];
        let turn = arm[1] * 2.0 + arm[0];
        // the arm turns a little while the force lasts
        assert_near(after[4] - before[4], turn, 2e-4);
        assert!(run.audit.energy_j < 1e-6, "{:?}", run.audit);
    }
}
