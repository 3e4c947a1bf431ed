//! Contacts and impacts against closed forms (each written out beside its test).

use super::{assert_near, plant, plant_with};
use denavit_plants::{Cradle, LoadedPlant, Plant};
use denavit_simulate::contact::{ContactFailure, Friction};
use denavit_simulate::integrate::{Accuracy, Method};
use denavit_simulate::{
    Breakdown, Control, ErrorKind, Event, EventKind, Run, Simulation, State, Stop, Tolerances,
    Touching, simulate,
};
use serde_json::{Value, json};
use std::path::Path;

const G: f64 = 9.81;

fn accurate() -> Simulation {
    let simulation = Simulation::default();
    Simulation {
        method: Method::DormandPrince(Accuracy {
            relative: 1e-12,
            absolute: 1e-13,
            max_step_s: 0.02,
        }),
        touching: Touching { rest_speed: 1e-10, ..simulation.touching },
        ..simulation
    }
}

fn run(plant: &mut LoadedPlant, initial: &State, simulation: &Simulation) -> Run {
    let control = Control::passive(plant.model().joints.len());
    let run = simulate(plant, &control, initial, simulation).unwrap();
    let broken = run.audit.broken(&Tolerances::default());
    assert!(broken.is_empty(), "{broken:?}");
    run
}

fn touches(run: &Run) -> Vec<&Event> {
    run.events.iter().filter(|event| matches!(event.kind, EventKind::Touch(_))).collect()
}

/// t_n = sqrt(2 h / g) (1 + 2 e (1 - e^(n-1)) / (1 - e)), and the ball lies still at the limit.
#[test]
fn a_bouncing_ball_comes_to_rest_after_infinitely_many_bounces() {
    let mut ball = plant("bodies/ball");
    let e: f64 = 0.8;
    let mut simulation = Simulation { end_s: 5.0, ..accurate() };
    simulation.touching.restitution = e;
    let run = run(&mut ball, &State::resting(vec![1.0, 0.0, 0.0]), &simulation);
    assert_eq!(run.stop, Stop::End);
    let bounces = touches(&run);
    assert!(bounces.len() > 100);
    for (index, bounce) in bounces.iter().enumerate() {
        let powers = (1.0 - e.powi(index as i32)) / (1.0 - e);
        let time = (2.0 / G).sqrt() * (1.0 + 2.0 * e * powers);
        assert_near(bounce.t_s, time, 1e-9);
    }
    assert_near(bounces[0].t_s, 0.45152364099, 1e-11);
    assert_near(bounces[29].t_s, 4.05812317693, 1e-9);
    assert_near(bounces[bounces.len() - 1].t_s, 4.06371276887, 1e-9);
    assert_eq!(run.closed, [0]);
    assert_near(run.log.column("f_ball_z").unwrap()[500], G, 1e-9);
}

/// Housner's rocking block: alpha = atan(b/h), p^2 = m g R / I, omega+ = (1 - 1.5 sin^2 alpha)
/// omega-. At an impact the old corner has to open.
#[test]
fn a_block_rocks_and_loses_speed_at_every_impact() {
    let mut block = plant("bodies/block");
    let (b, h, tilt) = (0.1, 0.4, 0.1_f64);
    let (sine, cosine) = tilt.sin_cos();
    let initial = State::resting(vec![h * cosine + b * sine, h * sine - b * cosine, tilt]);
    let run = run(&mut block, &initial, &Simulation { end_s: 1.5, ..accurate() });
    let impacts = touches(&run);
    let times = [0.26471341573, 0.71090100939, 1.09632732987, 1.43418602083];
    let rates = [0.83136807670, 0.75801206993, 0.69112865200];
    for (impact, time) in impacts.iter().zip(times) {
        assert_near(impact.t_s, time, 1e-9);
        assert_eq!(impact.closed.len(), 1, "one corner opens as the other closes");
        assert_near(impact.after[2] / impact.before[2], 31.0 / 34.0, 1e-9);
    }
    for (index, rate) in rates.iter().enumerate() {
        assert_near(impacts[index].before[2].abs(), *rate, 1e-9);
    }
    assert_eq!(impacts.len(), 4);
}

/// A rod of 1 m tilted by 0.5 rad falls on its end with 1 m/s: impulse m v / (1 + 3 c^2) without
/// friction; no slip makes omega = 3 v c / (2 L).
#[test]
fn a_falling_rod_gets_the_impulse_of_its_law_of_friction() {
    let mut rod = plant("bodies/rod");
    let lean = std::f64::consts::FRAC_PI_2 - 0.5;
    let mut initial = State::resting(vec![0.5 * 0.5_f64.sin(), 0.0, lean]);
    initial.qd[0] = -1.0;
    let mut first = |friction| {
        let simulation = Simulation { end_s: 0.0, friction, ..accurate() };
        run(&mut rod, &initial, &simulation).events[0].clone()
    };
    let smooth = first(Friction::Coulomb(0.0));
    assert_near(smooth.impulses[0].1[2], 0.30207342059, 1e-10);
    assert_near(smooth.after[2].abs(), 1.59056619792, 1e-10);
    let rough = first(Friction::NoSlip);
    assert_near(rough.after[2].abs(), 1.31637384284, 1e-10);
    assert_near(rough.impulses[0].1[0].abs(), 0.31555162, 1e-8);
    assert_near(rough.impulses[0].1[2], 0.42238664, 1e-8);
    // half the impulse times the speed that it takes away
    let normal = 1.0 - 0.5 * 1.31637384284 * 0.5_f64.cos();
    assert_near(rough.energy_j, -0.5 * normal, 1e-10);
    // the coefficient that no slip needs
    let [almost, enough] = [0.7470, 0.7471].map(|mu| first(Friction::Coulomb(mu)));
    assert!((almost.after[2] - rough.after[2]).abs() > 1e-6);
    assert_near(enough.after[2], rough.after[2], 1e-10);
}

/// 1 + 3 c (c - mu s) < 0 has no forces; at 0.5 rad beyond mu = 2.6227511256.
#[test]
fn a_rod_that_jams_is_said_to_jam() {
    let mut rod = plant("bodies/rod");
    let lean = std::f64::consts::FRAC_PI_2 - 0.5;
    let initial =
        State { qd: vec![0.0, -1.0, 0.0], ..State::resting(vec![0.5 * 0.5_f64.sin(), 0.0, lean]) };
    let control = Control::passive(3);
    let mut start = |mu| {
        let simulation = Simulation { end_s: 0.0, friction: Friction::Coulomb(mu), ..accurate() };
        simulate(&mut rod, &control, &initial, &simulation)
    };
    assert_eq!(start(2.63).unwrap_err().breakdown(), Some(Breakdown::Painleve));
    assert!(start(2.61).is_ok());
}

/// v - v0 = -g (mu cos - sin) t until it stops, and then it sticks.
#[test]
fn a_block_slides_down_a_slope_and_sticks() {
    let mut block = plant("bodies/slope");
    let slope = 10.0_f64.to_radians();
    let initial = State {
        qd: vec![-2.0 * slope.sin(), 2.0 * slope.cos(), 0.0],
        ..State::resting(vec![0.0; 3])
    };
    let simulation = Simulation { end_s: 2.0, friction: Friction::Coulomb(0.3), ..accurate() };
    let run = run(&mut block, &initial, &simulation);
    let stop = run.events.iter().find(|event| matches!(event.kind, EventKind::SlipEnds(_)));
    let stop = stop.expect("it stops");
    assert_near(stop.t_s, 1.67391948891, 1e-9);
    assert_near(stop.q[1].hypot(stop.q[0]), 1.67391948891, 1e-9);
    assert_near(run.end.q[1], stop.q[1], 1e-9);
    // at rest the ground carries the weight
    let last = run.log.len() - 1;
    assert_near(run.log.column("f_block_z").unwrap()[last], G, 1e-9);
    assert_near(run.log.column("f_block_x").unwrap()[last], 0.0, 1e-9);
    assert_near(run.audit.friction_demand, 0.3, 1e-9);
}

/// Newton's law for all pairs at once: three balls leave with -1/3, 2/3, 2/3; with e = 0 together.
#[test]
fn a_cradle_obeys_newtons_law_for_all_pairs_at_once() {
    for (balls, e, after) in [
        (3, 1.0, vec![-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0]),
        (5, 1.0, vec![-0.6, 0.4, 0.4, 0.4, 0.4]),
        (4, 0.0, vec![0.25; 4]),
    ] {
        let mut cradle = Cradle::new(balls);
        let mut initial = State::resting(vec![0.0; balls]);
        initial.q[0] = -0.5;
        initial.qd[0] = 1.0;
        let mut simulation =
            Simulation { end_s: 0.6, friction: Friction::Coulomb(0.0), ..accurate() };
        simulation.touching.restitution = e;
        let run = simulate(&mut cradle, &Control::passive(balls), &initial, &simulation).unwrap();
        assert_near(run.events.iter().map(|e| e.t_s).fold(0.0, f64::max), 0.5, 1e-9);
        for (found, expected) in run.end.qd.iter().zip(after) {
            assert_near(*found, expected, 1e-9);
        }
    }
}

/// A capsule about the rod is on the ground when its lower end is a radius above it:
/// t = sqrt(2 (z - l/2 cos a - r) / g).
#[test]
fn a_capsule_touches_by_its_radius() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/bodies/rod.json");
    let mut model: Value = serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap();
    model["contacts"] = json!([]);
    model["bodies_that_must_not_touch"] = json!([{"name": "shell", "link": "base_pitch",
        "from": ["half", 0, 0], "to": ["-half", 0, 0], "radius_m": "half/5"}]);
    let robot = denavit_codegen::model::read("rod", model.to_string().as_bytes()).unwrap();
    for pitch in [0.5, -2.0] {
        let mut rod = LoadedPlant::new(&robot, &[]).unwrap();
        let control = Control::passive(3);
        let initial = State::resting(vec![1.0, 0.0, pitch]);
        let run = simulate(&mut rod, &control, &initial, &accurate()).unwrap();
        assert_eq!(run.stop, Stop::Fall("shell".to_owned()));
        let height = 1.0 - 0.5 * pitch.cos().abs() - 0.1;
        assert_near(run.end.t_s, (2.0 * height / G).sqrt(), 1e-9);
    }
}

/// A massless-footed fall: a run always ends, and says why.
#[test]
fn bad_starts_are_refused() {
    let mut ball = plant("bodies/ball");
    let control = Control::passive(3);
    let below = State::resting(vec![-0.1, 0.0, 0.0]);
    let error = simulate(&mut ball, &control, &below, &accurate()).unwrap_err();
    assert_eq!((error.kind(), error.contact()), (ErrorKind::Penetration, Some("ball")));
    assert_eq!(error.to_string(), "`ball` starts 1.000e-1 m below the ground");
    let nan = State::resting(vec![f64::NAN, 0.0, 0.0]);
    let unusable = simulate(&mut ball, &control, &nan, &accurate()).unwrap_err();
    assert_eq!(unusable.kind(), ErrorKind::Options);
    assert!(unusable.to_string().ends_with("is not a usable number"), "{unusable}");
    let short = State::resting(vec![1.0]);
    let short = simulate(&mut ball, &control, &short, &accurate()).unwrap_err();
    assert_eq!(short.to_string(), "q: 3 values expected, 1 given");
    let mut massless = plant_with("bodies/ball", &[("m_base_pitch", 0.0)]);
    let run = simulate(&mut massless, &control, &State::resting(vec![1.0, 0.0, 0.0]), &accurate());
    assert!(matches!(run.map(|run| run.stop), Ok(Stop::Breakdown(Breakdown::Singular { .. }))));
}

/// A rod that rolls off its end, 0.8 rad from the vertical: no slip would need the ground to pull,
/// and without forces the end would sink. It slides by the fallback law, as its equations say:
/// I th'' = h N (s + mu c), x'' = -mu N, N = (g - h c th'^2) / (1 + (h^2/I) s (s + mu c)).
#[test]
fn where_no_forces_hold_the_fallback_friction_acts() {
    const HALF: f64 = 0.5;
    const MU: f64 = 0.3;
    let rates = |[_, theta, speed, rate]: [f64; 4]| {
        let (s, c) = (theta.sin(), theta.cos());
        let lever = s + MU * c;
        let normal = (G - HALF * c * rate * rate) / (1.0 + 12.0 * HALF * HALF * s * lever);
        [speed, rate, -MU * normal, 12.0 * HALF * normal * lever]
    };
    let tilt = 0.8_f64;
    let rate = (0.8 * G / (HALF * tilt.cos())).sqrt();
    let start = [HALF * tilt.sin(), tilt, HALF * rate * tilt.cos(), rate];
    let (end_s, steps) = (0.05, 2000);
    let (mut y, h) = (start, end_s / f64::from(steps));
    for _ in 0..steps {
        let along = |k: [f64; 4], share: f64| std::array::from_fn(|i| y[i] + share * h * k[i]);
        let a = rates(y);
        let b = rates(along(a, 0.5));
        let c = rates(along(b, 0.5));
        let d = rates(along(c, 1.0));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
    }
    let mut rod = plant("bodies/rod");
    let initial = State {
        qd: vec![-HALF * rate * tilt.sin(), start[2], rate],
        ..State::resting(vec![HALF * tilt.cos(), start[0], tilt])
    };
    let control = Control::passive(3);
    let mut simulation = Simulation { end_s, friction: Friction::NoSlip, ..accurate() };
    let refused = simulate(&mut rod, &control, &initial, &simulation).unwrap_err();
    let no_solution = Breakdown::Contact(ContactFailure::NoSolution);
    assert_eq!(refused.breakdown(), Some(no_solution));
    simulation.touching.fallback_friction = Some(MU);
    let run = run(&mut rod, &initial, &simulation);
    assert!(run.events[0].fell_back);
    assert_near(run.end.q[1], y[0], 1e-9);
    assert_near(run.end.q[2], y[1], 1e-9);
    assert_near(run.end.qd[2], y[3], 1e-8);
    let slid = run.end.q[1] - HALF * y[1].sin() - (start[0] - HALF * tilt.sin());
    assert!(slid > 1e-3, "its end slides: {slid} m");
}
