//! Fixed points and multipliers of passive walkers against walking.md's oracles: published models
//! solved elsewhere to many digits (tests/oracles/README.md says how).

use super::assert_near;
use denavit_codegen::model;
use denavit_plants::{KneedWalker, LoadedPlant, Override, Plant, SimplestWalker};
use denavit_simulate::integrate::{Accuracy, Method};
use denavit_simulate::{Control, Scuffing, Simulation, State, Touching};
use denavit_walk::LegExchange;
use denavit_walk::poincare::{
    Multiplier, ReturnMap, Section, by_differences, doubling, fixed_point, multipliers,
};
use std::path::Path;

fn accurate() -> Simulation {
    let accuracy = Accuracy { relative: 1e-12, absolute: 1e-13, max_step_s: 0.02 };
    Simulation { method: Method::DormandPrince(accuracy), ..Simulation::default() }
}

fn plant(path: &str, overrides: &[(&str, f64)]) -> LoadedPlant {
    let file =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models").join(format!("{path}.json"));
    let robot = model::read(path, &std::fs::read(file).unwrap()).unwrap();
    let set =
        |(name, value): &(&str, f64)| Override { parameter: (*name).to_owned(), value: *value };
    LoadedPlant::new(&robot, &overrides.iter().map(set).collect::<Vec<_>>()).unwrap()
}

/// A walker without a clock, looked at where `section` says.
fn passive<'a>(
    plant: &'a mut dyn Plant,
    control: &'a Control,
    section: Section,
    patience_s: f64,
) -> ReturnMap<'a> {
    ReturnMap {
        plant,
        control,
        simulation: accurate(),
        exchange: None,
        section,
        cycles: 1,
        patience_s,
        clock_s: None,
    }
}

#[track_caller]
fn assert_multipliers(map: &mut ReturnMap<'_>, near: &State, expected: &[[f64; 2]]) -> State {
    let cycle = fixed_point(map, near).unwrap();
    let found = multipliers(&by_differences(map, &cycle.chart).unwrap()).unwrap();
    for (index, multiplier) in found.iter().enumerate() {
        let expected = expected.get(index).copied().unwrap_or_default();
        for part in 0..2 {
            assert_near(multiplier.value[part], expected[part], 2e-6);
        }
    }
    assert!(found.len() >= expected.len());
    cycle.chart.base
}

#[test]
fn the_simplest_walker_has_a_stable_and_an_unstable_gait() {
    let long = [[-0.190099841066, 0.557598776682], [-0.190099841066, -0.557598776682]];
    let short = [[4.0038643589, 0.0], [0.4595895898, 0.0]];
    for (start, cycle, expected) in [
        ([0.2003, -0.1998], [0.20031090054425, -0.19983247300495], long),
        ([0.1939, -0.2039], [0.19393736981023, -0.20386692744206], short),
    ] {
        let (mut walker, control) = (SimplestWalker::new(0.009), Control::passive(2));
        let mut map = passive(&mut walker, &control, Section::Jump(0), 6.0);
        let [angle, rate]: [f64; 2] = start;
        let qd = vec![rate, rate * (1.0 - (2.0 * angle).cos())];
        let near = State { qd, ..State::resting(vec![angle, 2.0 * angle]) };
        let fixed = assert_multipliers(&mut map, &near, &expected);
        assert_near(fixed.q[0], cycle[0], 1e-8);
        assert_near(fixed.qd[0], cycle[1], 1e-8);
    }
}

#[test]
fn the_kneed_walker_is_stable() {
    let (mut walker, control) = (KneedWalker::new((7.25_f64 / 144.0).asin()), Control::passive(3));
    let section = Section::Jump(KneedWalker::HEEL_STRIKE);
    let mut map = passive(&mut walker, &control, section, 0.8);
    let near = State { qd: vec![-1.134, -0.109, 0.0], ..State::resting(vec![0.1893, -0.29, 0.0]) };
    let expected = [[0.54818500, 0.49857750], [0.54818500, -0.49857750], [0.10774936, 0.0]];
    let fixed = assert_multipliers(&mut map, &near, &expected);
    assert_near(fixed.q[0], 0.18927347963, 1e-8);
    assert_near(fixed.q[1], -0.29001051344, 1e-8);
    assert_near(fixed.qd[0], -1.13381658645, 1e-8);
    assert_near(fixed.qd[1], -0.10872933848, 1e-8);
}

/// McGeer: with mu = 1 + lam2 (cos 2 al - 1), lam2 = m l^2 / (J + m l^2) = 2/3, the multiplier of
/// the velocity after a strike is mu^2. A wheel is itself again after an eighth of a turn.
#[test]
fn the_rimless_wheel_forgets_by_its_closed_form() {
    let (mut wheel, control) = (plant("bodies/rimless_wheel", &[]), Control::passive(3));
    let names: Vec<String> =
        wheel.model().contacts.iter().map(|contact| contact.name.clone()).collect();
    let spokes = names.len();
    let (slope, half) = (0.08, std::f64::consts::PI / 8.0);
    let mu: f64 = 1.0 + 2.0 / 3.0 * ((2.0 * half).cos() - 1.0);
    let cycle = 0.3871291327521;
    let pitch = slope + half;
    let spoke = pitch + 3.0 * std::f64::consts::FRAC_PI_4;
    let [x, z] = [-spoke.sin(), -spoke.cos()];
    let rate = 1.02 * cycle;
    let near = State { qd: vec![-rate * x, rate * z, rate], ..State::resting(vec![z, x, pitch]) };
    // two spokes are on the ground just after a strike; which of them stands, and in which order
    // they follow each other, is seen by what rolls
    let mut positions = vec![0.0; 3 * spokes];
    wheel.contact_positions(&near.q, &mut positions);
    let normal = wheel.model().ground.normal;
    let height = |spoke: usize| -> f64 {
        (0..3).map(|axis| normal[axis] * positions[3 * spoke + axis]).sum()
    };
    let lowest = |a: &usize, b: &usize| height(*a).total_cmp(&height(*b));
    let mut standing: Vec<usize> = (0..spokes).collect();
    standing.sort_by(lowest);
    for (turn, standing) in
        [1, spokes - 1].into_iter().flat_map(|turn| [(turn, standing[0]), (turn, standing[1])])
    {
        let contacts: Vec<usize> = (0..spokes).map(|spoke| (spoke + turn) % spokes).collect();
        let exchange = LegExchange {
            coordinates: vec![0, 1, 2],
            signs: vec![1.0; 3],
            offsets: vec![0.0, 0.0, -2.0 * half],
            contacts,
        };
        let mut map = passive(&mut wheel, &control, Section::Touch(standing), 6.0);
        map.exchange = Some(exchange);
        let Ok(cycle) = fixed_point(&mut map, &near) else { continue };
        let matrix = by_differences(&mut map, &cycle.chart).unwrap();
        assert_eq!(matrix.nrows(), 1, "{matrix}");
        assert_near(matrix[(0, 0)], mu * mu, 2e-6);
        assert_near(cycle.chart.base.qd[2], 0.3871291327521, 1e-8);
        return;
    }
    panic!("the wheel does not roll");
}

/// Slope [deg]; stance and swing angle from the vertical just after a strike, with velocities;
/// multipliers.
const COMPASS: [(f64, [f64; 4], [[f64; 2]; 3]); 4] = [
    (
        1.0,
        [0.1695389582, -0.2044455433, -0.8617139625, -0.6057394138],
        [[0.36256348, 0.46031883], [0.36256348, -0.46031883], [0.21567936, 0.0]],
    ),
    (
        2.0,
        [0.2013567786, -0.2711699488, -1.0126381043, -0.5191890494],
        [[0.09804256, 0.58438725], [0.09804256, -0.58438725], [0.16048890, 0.0]],
    ),
    (
        3.0,
        [0.21866880294, -0.32338855806, -1.09238358988, -0.37737394891],
        [[-0.19972613, 0.54447606], [-0.19972613, -0.54447606], [0.13157262, 0.0]],
    ),
    (
        4.0,
        [0.2290852640, -0.3687116041, -1.1398991122, -0.2164114237],
        [[-0.52097681, 0.20794999], [-0.52097681, -0.20794999], [0.11189264, 0.0]],
    ),
];

/// The second foot strikes in the first step of a walker that stands on the first.
const STRIKES: Section = Section::Touch(0);

fn compass(degrees: f64) -> LoadedPlant {
    plant("bodies/compass", &[("slope", degrees.to_radians())])
}

fn compass_map<'a>(plant: &'a mut dyn Plant, control: &'a Control) -> ReturnMap<'a> {
    let exchange = LegExchange::find(plant);
    let mut map = passive(plant, control, STRIKES, 1.5);
    assert!(exchange.is_some());
    map.exchange = exchange;
    let touching = Touching { scuffing: Scuffing::IgnoredBehind, ..map.simulation.touching };
    map.simulation.touching = touching;
    map
}

fn compass_state([stance, swing, stance_rate, swing_rate]: [f64; 4]) -> State {
    let rates = [-stance.sin() * stance_rate, -stance.cos() * stance_rate];
    State {
        qd: vec![rates[0], rates[1], 0.0, -stance_rate, -swing_rate],
        ..State::resting(vec![stance.cos(), -stance.sin(), 0.0, -stance, -swing])
    }
}

#[test]
fn the_compass_has_its_published_multipliers() {
    for (degrees, cycle, expected) in COMPASS {
        let (mut walker, control) = (compass(degrees), Control::passive(5));
        let mut map = compass_map(&mut walker, &control);
        // not on the cycle: Newton's method has to find it
        let start = cycle.map(|entry| (entry * 1e3_f64).round() / 1e3);
        let swing = -2.0 * degrees.to_radians() - start[0];
        let near = compass_state([start[0], swing, start[2], start[3]]);
        let fixed = assert_multipliers(&mut map, &near, &expected);
        // joints turn against the hip, which nothing turns
        for (found, expected) in from_vertical(&fixed).into_iter().zip(cycle) {
            assert_near(found, expected, 1e-8);
        }
    }
}

/// Stance and swing angle from the vertical, and their velocities.
fn from_vertical(state: &State) -> [f64; 4] {
    let of = |values: &[f64], leg: usize| -values[2] - values[leg];
    [of(&state.q, 3), of(&state.q, 4), of(&state.qd, 3), of(&state.qd, 4)]
}

#[test]
fn the_compass_doubles_its_period_where_it_is_published_to() {
    let mut near = compass_state(COMPASS[3].1);
    let mut at = |degrees: f64| -> Result<Vec<Multiplier>, denavit_walk::Error> {
        let (mut walker, control) = (compass(degrees), Control::passive(5));
        let mut map = compass_map(&mut walker, &control);
        // the last cycle, with the swing foot on this slope
        let [stance, _, stance_speed, swing_speed] = from_vertical(&near);
        let swing = -2.0 * degrees.to_radians() - stance;
        let start = compass_state([stance, swing, stance_speed, swing_speed]);
        let cycle = fixed_point(&mut map, &start)?;
        near = cycle.chart.base.clone();
        Ok(multipliers(&by_differences(&mut map, &cycle.chart)?).unwrap())
    };
    let found = doubling(&mut at, [4.2, 4.5], 1e-9).unwrap().expect("a doubling");
    assert_near(found, 4.39089825, 1e-7);
}

#[test]
fn beyond_its_doubling_the_compass_limps() {
    let degrees = 4.6;
    let (mut walker, control) = (compass(degrees), Control::passive(5));
    let mut map = compass_map(&mut walker, &control);
    map.cycles = 2;
    let swing = |stance: f64| -2.0 * f64::to_radians(degrees) - stance;
    let near = compass_state([0.2453, swing(0.2453), -1.173, -0.092]);
    let cycle = fixed_point(&mut map, &near).unwrap();
    let first = cycle.chart.base.clone();
    let found = multipliers(&by_differences(&mut map, &cycle.chart).unwrap()).unwrap();
    assert!(found[0].modulus() < 1.0, "the orbit of two steps is stable: {:?}", found[0].value);
    map.cycles = 1;
    let second = map.apply(&first).unwrap().state;
    for (state, expected) in [
        // the note prints -0.0915918483, which differs in two digits; its other state agrees
        (first, [0.2452871620, -1.1734013832, -0.0915919484]),
        (second, [0.2196416020, -1.1504012099, -0.1595051611]),
    ] {
        let [stance, _, stance_speed, swing_speed] = from_vertical(&state);
        for (found, expected) in [stance, stance_speed, swing_speed].into_iter().zip(expected) {
            assert_near(found, expected, 1e-8);
        }
    }
}
