//! Cycles of the planar biped: fixed points and multipliers of both shipped gaits against those of
//! another simulator (walking.md 2), and the two ways to a monodromy against each other.

use super::{assert_near, scenario};
use denavit_simulate::integrate::{Accuracy, Method};
use denavit_simulate::{Simulation, State, simulate};
use denavit_walk::LegExchange;
use denavit_walk::poincare::{
    Chart, PoincareOptions, ReturnMap, Section, WantedSection, analyse, by_differences,
    by_variation, fixed_point, multipliers,
};

/// The return map of a gait with this time of a step, looked at after a share of it.
fn with_map<T>(
    name: &str,
    step_s: f64,
    share: f64,
    then: impl FnOnce(&mut ReturnMap<'_>, State) -> T,
) -> T {
    let mut scenario = scenario(name);
    let accuracy = Accuracy { relative: 1e-13, absolute: 1e-14, max_step_s: 0.02 };
    let simulation = Simulation { method: Method::Radau(accuracy), ..scenario.simulation.clone() };
    let (plant, at_s) = (scenario.plant.as_mut(), share * step_s);
    let exchange = LegExchange::find(plant);
    assert!(exchange.is_some(), "the biped is its own mirror image");
    let approach = Simulation { end_s: at_s + 4.0 * step_s, ..simulation.clone() };
    let run = simulate(plant, &scenario.control, &scenario.initial, &approach).unwrap();
    let mut map = ReturnMap {
        plant,
        control: &scenario.control,
        simulation,
        exchange,
        section: Section::Clock { at_s, period_s: step_s },
        cycles: 1,
        patience_s: 2.0,
        clock_s: Some(step_s),
    };
    then(&mut map, State { t_s: at_s, ..run.end })
}

/// Largest first; those after them are smaller than 1e-3.
fn assert_cycle(gait: (&str, f64), share: f64, travel_m: f64, expected: &[[f64; 2]]) {
    with_map(gait.0, gait.1, share, |map, near| {
        let cycle = fixed_point(map, &near).unwrap();
        assert_eq!(cycle.chart.len(), 12, "fourteen, of which a flat foot forbids two");
        assert_near(cycle.travel_m[0], travel_m, 2e-4);
        let varied = by_variation(map, &cycle.chart, cycle.period_s).unwrap();
        let differences = by_differences(map, &cycle.chart).unwrap();
        assert_near((&varied - &differences).amax(), 0.0, 1e-5);
        let found = multipliers(&varied).unwrap();
        for (multiplier, expected) in found.iter().zip(expected) {
            for part in 0..2 {
                assert_near(multiplier.value[part], expected[part], 2e-6);
            }
        }
        assert!(found[expected.len()..].iter().all(|multiplier| multiplier.modulus() < 1e-3));
    });
}

/// From (0.1, -0.1) rad/s off its cycle (walking.md 6): 0.0013 is left of 0.141 after 12 steps, as
/// the modulus of the largest multipliers has it.
#[test]
fn the_limit_cycle_is_returned_to_as_its_multipliers_say() {
    let mut scenario = scenario(LIMIT_CYCLE.0);
    let options =
        PoincareOptions { checks: false, returns: (0.1, 12), ..PoincareOptions::default() };
    let found = analyse(&mut scenario, &options).unwrap();
    let returns = found.convergence.unwrap();
    assert_eq!(returns.stopped, None);
    assert_eq!(returns.lengths.len(), 13);
    assert_near(returns.lengths[0], 0.1_f64.hypot(0.1), 0.01);
    assert!(returns.lengths[12] < 2e-3, "{:?}", returns.lengths);
    // a pair turns as it shrinks: its modulus is met in the mean alone
    assert_near(returns.factor().unwrap(), found.multipliers[0].modulus(), 0.05);
}

/// With the place along the ground among the coordinates there is one more, equal to 1.
#[test]
fn the_place_along_the_ground_has_the_multiplier_1() {
    with_map(LIMIT_CYCLE.0, LIMIT_CYCLE.1, 0.5, |map, near| {
        let cycle = fixed_point(map, &near).unwrap();
        let of = |map: &mut ReturnMap<'_>, chart: &Chart| {
            multipliers(&by_variation(map, chart, cycle.period_s).unwrap()).unwrap()
        };
        let own = of(map, &cycle.chart);
        let whole = Chart::new(map.plant, &cycle.chart.base, &cycle.closed, &[], false);
        let all = of(map, &whole);
        assert_eq!(all.len(), own.len() + 1);
        assert_near(all[0].value[0], 1.0, 1e-9);
        for (with, without) in all[1..].iter().zip(&own).take(3) {
            assert_near(with.modulus(), without.modulus(), 1e-6);
        }
    });
}

/// A multiplier of a strike section against that of the clock.
#[test]
fn a_strike_section_is_compared_with_the_clock() {
    let mut scenario = scenario(LIMIT_CYCLE.0);
    let section = WantedSection::Strike;
    let options = PoincareOptions { section, ..PoincareOptions::default() };
    let found = analyse(&mut scenario, &options).unwrap();
    assert!(matches!(found.section, Section::Touch(_)));
    let (apart, count) = found.section_spread.unwrap();
    assert!(apart < 1e-4 && count == 2, "{apart}");
    assert_eq!(found.contradiction(), None);
}

const ZMP_GAIT: (&str, f64) = ("planar_biped_zmp_gait", 1.2);
const LIMIT_CYCLE: (&str, f64) = ("planar_biped_limit_cycle_gait", 0.45);

#[test]
fn the_zmp_gait_has_its_two_multipliers() {
    assert_cycle(ZMP_GAIT, 0.5, 0.1012, &[[-0.211688, 0.0], [-0.066230, 0.0]]);
}

#[test]
fn the_limit_cycle_has_its_multipliers_on_every_section() {
    let pair = [[-0.455933, 0.490869], [-0.455933, -0.490869]];
    let small = [[0.078810, 0.0], [0.00276, 0.00211], [0.00276, -0.00211]];
    for share in [0.3, 0.5, 0.65] {
        assert_cycle(LIMIT_CYCLE, share, 0.30933, &[&pair[..], &small[..]].concat());
    }
}

#[test]
fn the_fixed_points_are_those_of_walking_md() {
    // torso, stance thigh, shank, foot, swing thigh, shank, foot from upright, counterclockwise
    let expected = [0.1625252, 0.2582333, -0.74292352, 0.0, 0.31361067, -1.00950902, -0.0258306];
    with_map(LIMIT_CYCLE.0, LIMIT_CYCLE.1, 0.5, |map, near| {
        let cycle = fixed_point(map, &near).unwrap();
        let q = &cycle.chart.base.q;
        // clockwise from the base on: pitch, then hip, knee and ankle of each leg
        let right = [q[3], q[3] + q[4], q[3] + q[4] + q[5]].map(|angle| -q[2] - angle);
        let left = [q[6], q[6] + q[7], q[6] + q[7] + q[8]].map(|angle| -q[2] - angle);
        let (stance, swing) =
            if right[2].abs() < left[2].abs() { (right, left) } else { (left, right) };
        let found = [&[-q[2]][..], &stance[..], &swing[..]].concat();
        for (found, expected) in found.into_iter().zip(expected) {
            assert_near(found.abs(), f64::abs(expected), 2e-6);
        }
    });
}

/// Thesis 4.4.5 changes angles and velocities of the joints and leaves the base as it is. Then the
/// ground takes the rest out, which depends on where in the step that is done: one and the same
/// orbit has other multipliers on every section.
#[test]
fn perturbing_joints_without_the_base_gives_wrong_multipliers() {
    let largest = |share: f64| {
        with_map(LIMIT_CYCLE.0, LIMIT_CYCLE.1, share, |map, near| {
            let cycle = fixed_point(map, &near).unwrap();
            let chart = &cycle.chart;
            let (base, h) = (chart.base.clone(), 1e-4);
            let coordinates: Vec<usize> = (2..9).collect();
            let mut matrix = nalgebra::DMatrix::zeros(14, 14);
            for column in 0..14 {
                let mut at = |change: f64| {
                    let mut state = base.clone();
                    if column < 7 {
                        // angles cannot change without the base: the foot would be in the ground
                        let mut change_of =
                            State { q: vec![0.0; 9], qd: vec![0.0; 9], ..State::default() };
                        change_of.q[coordinates[column]] = change;
                        state.q =
                            chart.state(map.plant, &chart.coordinates_of_change(&change_of)).q;
                    } else {
                        state.qd[coordinates[column - 7]] += change;
                    }
                    map.apply(&state).unwrap().state
                };
                let (ahead, behind) = (at(h), at(-h));
                for row in 0..7 {
                    let of = coordinates[row];
                    matrix[(row, column)] = (ahead.q[of] - behind.q[of]) / (2.0 * h);
                    matrix[(row + 7, column)] = (ahead.qd[of] - behind.qd[of]) / (2.0 * h);
                }
            }
            multipliers(&matrix).unwrap()[0].modulus()
        })
    };
    let [early, late] = [0.3, 0.5].map(largest);
    assert!((early - 0.66995).abs() > 0.03 || (late - 0.66995).abs() > 0.03, "{early} {late}");
    assert!((early - late).abs() > 0.03, "{early} {late}");
}
