//! Passive walkers on their limit cycles, against published models solved to many digits
//! elsewhere (tests/oracles/README.md says how).

use super::{assert_near, plant, plant_with};
use denavit_plants::SimplestWalker;
use denavit_simulate::integrate::{Accuracy, Method};
use denavit_simulate::{
    Control, Event, EventKind, Run, Scuffing, Simulation, State, Touching, simulate,
};

fn accurate(end_s: f64) -> Simulation {
    Simulation {
        end_s,
        method: Method::DormandPrince(Accuracy {
            relative: 1e-12,
            absolute: 1e-13,
            max_step_s: 0.02,
        }),
        ..Simulation::default()
    }
}

fn strikes(run: &Run) -> Vec<&Event> {
    run.events.iter().filter(|event| !matches!(event.kind, EventKind::Start)).collect()
}

#[test]
fn the_simplest_walker_walks_its_long_and_its_short_gait() {
    for (angle, rate, period, walks) in [
        (0.20031090054425_f64, -0.19983247300495, 3.8824637528514, 10),
        (0.19393736981023, -0.20386692744206, 3.0961058680780, 1),
    ] {
        let mut walker = SimplestWalker::new(0.009);
        let cosine = (2.0 * angle).cos();
        let initial = State {
            qd: vec![rate, rate * (1.0 - cosine)],
            ..State::resting(vec![angle, 2.0 * angle])
        };
        let simulation = accurate(period * (walks as f64 + 0.5));
        let run = simulate(&mut walker, &Control::passive(2), &initial, &simulation).unwrap();
        assert_eq!(run.events.len(), walks);
        for (index, event) in run.events.iter().enumerate() {
            assert_near(event.t_s, (index + 1) as f64 * period, 1e-9);
            assert_near(event.q[0], angle, 1e-9);
            assert_near(event.after[0], rate, 1e-9);
        }
    }
}

/// McGeer: with lam2 = m l^2 / (J + m l^2) = 2/3 and mu = 1 + lam2 (cos 2 al - 1), the rate after
/// a strike is omega^2 = mu^2 / (1 - mu^2) 4 lam2 (g/l) sin al sin slope, and a deviation of it
/// shrinks by mu^2 in the square.
#[test]
fn the_rimless_wheel_rolls_at_its_speed_and_returns_to_it() {
    let mut wheel = plant("bodies/rimless_wheel");
    let (slope, half) = (0.08, std::f64::consts::PI / 8.0);
    let mu = 1.0 + 2.0 / 3.0 * ((2.0 * half).cos() - 1.0);
    let cycle = 0.3871291327521;
    let mut start = |rate: f64| {
        let pitch = slope + half;
        let spoke = pitch + 3.0 * std::f64::consts::FRAC_PI_4;
        let [x, z] = [-spoke.sin(), -spoke.cos()];
        let initial =
            State { qd: vec![-rate * x, rate * z, rate], ..State::resting(vec![z, x, pitch]) };
        let control = Control::passive(3);
        let run = simulate(&mut wheel, &control, &initial, &accurate(12.0)).unwrap();
        assert!(run.audit.zmp_m < 1e-7 && run.audit.energy_j < 1e-9, "{:?}", run.audit);
        strikes(&run).into_iter().cloned().collect::<Vec<_>>()
    };
    let rolling = start(cycle);
    assert!(rolling.len() >= 3);
    for strike in &rolling {
        assert_near(strike.before[2], cycle / mu, 1e-9);
        assert_near(strike.after[2], cycle, 1e-9);
        assert_eq!(strike.closed.len(), 1, "the old spoke opens");
    }
    let faster = start(1.1 * cycle);
    let excess = |rate: f64| rate * rate - cycle * cycle;
    assert_near(excess(faster[0].after[2]) / excess(1.1 * cycle), mu * mu, 1e-8);
}

/// Goswami's walker on 1 to 4 degrees: the state just after a strike repeats, legs exchanged. The
/// swing foot passes through the ground in the middle of a step, which is ignored by a declared
/// rule. Slope [deg]; stance and swing angle, their rates; period.
const COMPASS: [(f64, [f64; 4], f64); 4] = [
    (1.0, [0.1695389582, -0.2044455433, -0.8617139625, -0.6057394138], 0.7036485256),
    (2.0, [0.2013567786, -0.2711699488, -1.0126381043, -0.5191890494], 0.7196522124),
    (3.0, [0.21866880294, -0.32338855806, -1.09238358988, -0.37737394891], 0.73434639116),
    (4.0, [0.2290852640, -0.3687116041, -1.1398991122, -0.2164114237], 0.7482409702),
];

/// Strikes of a walker that starts with these angles and rates from the vertical.
fn walk(degrees: f64, [stance, swing, stance_rate, swing_rate]: [f64; 4], end_s: f64) -> Run {
    let slope = degrees.to_radians();
    assert_near(stance + swing, -2.0 * slope, 2e-10);
    let mut compass = plant_with("bodies/compass", &[("slope", slope)]);
    let rates = [-stance.sin() * stance_rate, -stance.cos() * stance_rate];
    let initial = State {
        qd: vec![rates[0], rates[1], 0.0, -stance_rate, -swing_rate],
        ..State::resting(vec![stance.cos(), -stance.sin(), 0.0, -stance, -swing])
    };
    let simulation = accurate(end_s);
    let touching = Touching { scuffing: Scuffing::IgnoredBehind, ..simulation.touching };
    let simulation = Simulation { touching, ..simulation };
    let run = simulate(&mut compass, &Control::passive(5), &initial, &simulation).unwrap();
    assert!(run.audit.energy_j < 1e-8, "{:?}", run.audit);
    run
}

#[test]
fn the_compass_walks_on_its_limit_cycle() {
    for (degrees, cycle, period) in COMPASS {
        let [stance, swing, stance_rate, swing_rate] = cycle;
        let run = walk(degrees, cycle, 2.5 * period);
        let strikes: Vec<_> =
            strikes(&run).into_iter().filter(|event| !event.impulses.is_empty()).collect();
        assert_eq!(strikes.len(), 2, "{:?}", run.events);
        for (index, strike) in strikes.iter().enumerate() {
            let (new, old) = if index % 2 == 0 { (4, 3) } else { (3, 4) };
            assert_near(strike.t_s, (index + 1) as f64 * period, 1e-9);
            assert_near(-strike.q[new], stance, 1e-9);
            assert_near(-strike.q[old], swing, 1e-9);
            assert_near(-strike.after[new], stance_rate, 1e-9);
            assert_near(-strike.after[old], swing_rate, 1e-9);
        }
        if degrees == 3.0 {
            let hit = strikes[0].impulses.iter().find(|(contact, _)| *contact == 1).unwrap().1;
            assert_near(hit[0], -2.61949, 1e-5);
            assert_near(hit[2], 13.73560, 1e-5);
        }
    }
}
