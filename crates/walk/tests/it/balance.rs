//! Criteria of balance against walking.md section 6, whose figures another simulator made, and
//! against each other: forces and momentum, foot rotation indicator and zero moment point.

use super::{assert_near, scenario};
use denavit_simulate::{Push, Shove, Simulation, simulate};
use denavit_walk::balance::{Course, Criterion, Over, course_of_log, course_of_scenario};

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
    let mut log = own.run.clone().unwrap().log;
    let kept: Vec<usize> =
        (0..log.columns.len()).filter(|c| !log.columns[*c].starts_with("qdd_")).collect();
    log.values =
        log.rows().flat_map(|row| kept.iter().map(|c| row[*c]).collect::<Vec<_>>()).collect();
    log.columns = kept.iter().map(|c| log.columns[*c].clone()).collect();
    let read = course_of_log(scenario.plant.as_mut(), &log).unwrap();
    assert_eq!(read.instants.len(), own.instants.len());
    for (here, there) in read.instants.iter().zip(&own.instants) {
        assert_near(here.zero_moment_point_m[0], there.zero_moment_point_m[0], 1e-8);
        assert_eq!(here.phase, there.phase);
    }
    let short = denavit_simulate::Log { columns: vec!["t".to_owned()], ..log };
    assert!(course_of_log(scenario.plant.as_mut(), &short).is_err());
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
