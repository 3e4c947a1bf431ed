//! What criteria say of the shipped examples of chapter 4, and what comes out.

use super::{assert_near, scenario};
use denavit_walk::balance::course_of_scenario;
use denavit_walk::comparison::{CASES, Compared, Verdict, compare};

fn compared(name: &str) -> Compared {
    assert!(CASES.iter().any(|case| case.scenario == name), "{name} is not among the cases");
    let mut scenario = scenario(name);
    scenario.simulation.touching.fallback_friction.get_or_insert(0.8);
    compare(&mut scenario, 2e-3).unwrap()
}

/// The run ended so, and these criteria are wrong about it.
#[track_caller]
fn assert_wrong(name: &str, fell: bool, wrong: &[&str]) -> Compared {
    let run = compared(name);
    assert_eq!(run.fell(), fell, "{name}: {:?}", run.outcome);
    let verdicts = [
        ("zero_moment", run.zero_moment),
        ("cart_table", run.cart_table),
        ("foot_rotation", run.foot_rotation),
        ("capture", run.capture),
        ("momentum", run.momentum),
        ("poincare", run.poincare),
    ];
    let found: Vec<&str> =
        verdicts.iter().filter(|(_, v)| v.is_wrong(fell)).map(|(name, _)| *name).collect();
    assert_eq!(found, wrong, "{name}: {verdicts:?}");
    run
}

#[test]
fn a_limit_cycle_walks_without_static_criteria() {
    let wrong = ["cart_table", "foot_rotation", "capture", "momentum"];
    let run = assert_wrong("planar_biped_limit_cycle_gait", false, &wrong);
    assert_eq!(run.poincare, Verdict::Met);
    assert_wrong("planar_biped_zmp_gait", false, &[]);
}

/// From standing to standing there is no period to judge by.
#[test]
fn a_walk_that_starts_and_stops_has_no_cycle() {
    let run = compared("planar_biped_start_stop");
    assert!(!run.fell());
    assert_eq!(run.poincare, Verdict::Silent);
    assert_eq!(run.largest_multiplier, None);
}

#[test]
fn the_zero_moment_point_stays_inside_while_the_robot_collapses() {
    let run = assert_wrong("planar_biped_switched_off", true, &["zero_moment"]);
    // for most of the fall it is not even near the edge
    assert!(matches!(run.cart_table, Verdict::Missed(t_s) if t_s > 0.8 * run.outcome.1));
}

#[test]
fn flight_is_no_fall() {
    let run = assert_wrong(
        "planar_biped_hopping",
        false,
        &["zero_moment", "cart_table", "capture", "momentum", "poincare"],
    );
    assert!(run.largest_multiplier.unwrap() > 1.0, "an unstable cycle that it does not leave");
    let course = course_of_scenario(&mut scenario("planar_biped_hopping"), 2e-3, true).unwrap();
    let flights = course.instants.windows(2).filter(|pair| {
        use denavit_walk::balance::Phase::Flight;
        pair[0].phase != Flight && pair[1].phase == Flight
    });
    assert!(flights.count() >= 10, "it lands and goes on");
    assert_wrong(
        "planar_biped_landing",
        false,
        &["zero_moment", "cart_table", "capture", "momentum"],
    );
}

#[test]
fn angular_momentum_is_neither_sufficient_nor_necessary() {
    let run = assert_wrong("planar_biped_dropped", true, &["momentum"]);
    assert!(run.largest_momentum < 1e-9, "{}", run.largest_momentum);
    let run = compared("planar_biped_trunk_swing");
    assert!(!run.fell() && run.momentum.is_wrong(false));
    // how far apart its feet stand stays as it is: a multiplier of 1, not inside the circle
    assert_near(run.largest_multiplier.unwrap(), 1.0, 1e-6);
    assert_eq!(run.poincare, Verdict::Missed(0.0));
    assert!(run.largest_momentum > 0.6);
}

#[test]
fn a_lunge_saves_from_the_push_that_fells() {
    assert!(compared("planar_biped_pushed").fell());
    assert!(!compared("planar_biped_lunge").fell());
}

/// Thesis 4.4.1: "energy consumption decreases significantly" holds for torque squared alone.
#[test]
fn limit_cycles_need_more_energy_a_metre_and_less_torque_squared() {
    let energy = |name: &str| {
        let mut scenario = scenario(name);
        let course = course_of_scenario(&mut scenario, 5e-4, false).unwrap();
        course.energy(scenario.plant.as_ref()).unwrap()
    };
    let (zmp, cycle) = (energy("planar_biped_zmp_gait"), energy("planar_biped_limit_cycle_gait"));
    for (found, expected) in [
        (zmp.speed_m_s, 0.084),
        (zmp.cost_of_transport, 0.187),
        (zmp.torque_squared, 5804.0),
        (cycle.speed_m_s, 0.687),
        (cycle.cost_of_transport, 0.583),
        (cycle.torque_squared, 1818.0),
    ] {
        assert_near(found / expected, 1.0, 6e-3);
    }
}

/// A model that names nothing that must not touch the ground never falls: nothing is wrong then.
#[test]
fn where_nothing_counts_as_a_fall_no_criterion_is_wrong() {
    let mut scenario = scenario("compass_gait");
    let run = compare(&mut scenario, 2e-3).unwrap();
    assert!(!run.falls_are_seen && !run.fell());
    assert!(!run.is_wrong(Verdict::Missed(0.1)) && run.capture.is_wrong(false));
}
