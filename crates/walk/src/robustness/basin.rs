//! Starts around the fixed point of a gait: which of them go on walking, and how near they come.

use super::outcome::Outcome;
use super::parallel::{Observer, Opener, each};
use crate::poincare::FixedPoint;
use denavit_numerics::Random;
use denavit_plants::Plant;
use denavit_simulate::scenario::Scenario;
use denavit_simulate::{Simulation, State, simulate};

/// A deviation from the fixed point: the change of some coordinates, which the others follow where
/// contacts ask for it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Change of each position [rad, m].
    pub q: Vec<f64>,
    /// Change of each velocity [rad/s, m/s].
    pub qd: Vec<f64>,
}

/// How starts are tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BasinOptions {
    /// Cycles to be walked.
    pub cycles: usize,
}

/// What became of a start.
#[derive(Clone, Debug, PartialEq)]
pub struct BasinStart {
    /// From where.
    pub deviation: Deviation,
    /// What became of it.
    pub outcome: Outcome,
    /// Whole cycles that it walked.
    pub cycles: usize,
    /// How far it is from the fixed point at the end: largest coordinate [rad, rad/s, m, m/s].
    pub distance: f64,
}

/// Deviations on a grid: of two entries, numbers of coordinates, of which those from n on are
/// velocities; from -`reach` to +`reach`, with `count` values each.
pub fn grid(n: usize, entries: [usize; 2], reach: [f64; 2], count: usize) -> Vec<Deviation> {
    let value = |axis: usize, index: usize| {
        if count < 2 { 0.0 } else { reach[axis] * (2.0 * index as f64 / (count - 1) as f64 - 1.0) }
    };
    let mut deviations = Vec::with_capacity(count * count);
    for row in 0..count {
        for column in 0..count {
            let mut all = vec![0.0; 2 * n];
            all[entries[0]] += value(0, column);
            all[entries[1]] += value(1, row);
            deviations.push(Deviation { q: all[..n].to_vec(), qd: all[n..].to_vec() });
        }
    }
    deviations
}

/// Normal deviations of all joint velocities, the base's turning included, from a seed.
pub fn noise(plant: &dyn Plant, deviation: f64, count: usize, seed: u64) -> Vec<Deviation> {
    let joints = &plant.model().joints;
    let mut random = Random::new(seed);
    let velocity = |joint: &denavit_plants::JointModel, random: &mut Random| {
        let follows = !joint.drivable && joint.slides;
        let value = deviation * random.normal();
        if follows { 0.0 } else { value }
    };
    (0..count)
        .map(|_| Deviation {
            q: vec![0.0; joints.len()],
            qd: joints.iter().map(|joint| velocity(joint, &mut random)).collect(),
        })
        .collect()
}

/// Walks from every deviation from a gait's fixed point. `open` must make the scenario that
/// the cycle was found of.
pub fn basin(
    open: &Opener<'_>,
    cycle: &FixedPoint,
    deviations: &[Deviation],
    options: &BasinOptions,
    observer: &Observer<'_>,
) -> Vec<BasinStart> {
    each(deviations.len(), observer, &|| open(), &|scenario, index| {
        let deviation = deviations[index].clone();
        let Some(scenario) = scenario else {
            let (outcome, distance) = (Outcome::NoStart, f64::INFINITY);
            return BasinStart { deviation, outcome, cycles: 0, distance };
        };
        let start = start(scenario.plant.as_mut(), cycle, &deviation);
        let (outcome, cycles, distance) = walk(scenario, cycle, &start, options.cycles);
        BasinStart { deviation, outcome, cycles, distance }
    })
}

/// The state of a deviation, inside the manifold of the contacts.
fn start(plant: &mut dyn Plant, cycle: &FixedPoint, deviation: &Deviation) -> State {
    let base = &cycle.chart.base;
    let zero = |values: &[f64]| vec![0.0; values.len()];
    let change = State {
        t_s: 0.0,
        q: deviation.q.clone(),
        qd: deviation.qd.clone(),
        motor: zero(&base.motor),
        motor_rate: zero(&base.motor_rate),
        laws: zero(&base.laws),
    };
    cycle.chart.state(plant, &cycle.chart.coordinates_of_change(&change))
}

fn walk(
    scenario: &mut Scenario,
    cycle: &FixedPoint,
    start: &State,
    cycles: usize,
) -> (Outcome, usize, f64) {
    let length_s = cycles as f64 * cycle.period_s;
    let simulation = Simulation {
        end_s: start.t_s + length_s,
        log_period_s: length_s.max(1e-9),
        ..scenario.simulation.clone()
    };
    let run = simulate(scenario.plant.as_mut(), &scenario.control, start, &simulation);
    let Ok(run) = run else { return (Outcome::NoStart, 0, f64::INFINITY) };
    let walked = ((run.end.t_s - start.t_s) / cycle.period_s + 1e-9).floor() as usize;
    let mut end = State { t_s: cycle.chart.base.t_s, ..run.end.clone() };
    if let (Some(exchange), true) = (&cycle.exchange, walked % 2 == 1) {
        (end.q, end.qd) = (exchange.positions(&end.q), exchange.velocities(&end.qd));
    }
    let apart = cycle.chart.coordinates(&end);
    let distance = apart.iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
    (Outcome::of(run.stop, run.end.t_s), walked, distance)
}
