//! Both gaits of the planar biped by time stepping, beside the event-driven scheme.

use denavit_plants::shipped;
use denavit_simulate::Stop;
use denavit_simulate::contact::Friction;
use denavit_simulate::integrate::{Accuracy, Method};
use denavit_simulate::scenario::{self, RunScheme, Scenario};

fn open(name: &str, scheme: RunScheme) -> Scenario {
    let load = |model: &str| {
        let found = shipped::find(model).ok_or("no such model")?;
        Ok(found.text.as_bytes().to_vec())
    };
    let shipped = shipped::find_scenario(name).unwrap();
    let read = scenario::read(name, shipped.text.as_bytes(), &load);
    let mut scenario = read.unwrap_or_else(|error| panic!("{error}"));
    scenario.scheme = scheme;
    scenario
}

/// Joint positions after one step of the robot.
fn after_one_step(name: &str, duration_s: f64, step_s: Option<f64>) -> Vec<f64> {
    let scheme = if step_s.is_some() { RunScheme::TimeStepping } else { RunScheme::Event };
    let mut scenario = open(name, scheme);
    scenario.simulation.end_s = duration_s;
    let accuracy = Accuracy { relative: 1e-8, absolute: 1e-8, max_step_s: 0.02 };
    scenario.simulation.method = Method::Radau(accuracy);
    // one law for both: a toe that unloads slips before it leaves, whatever its friction
    scenario.simulation.friction = Friction::Coulomb(1.0);
    step_s.into_iter().for_each(|step_s| scenario.set_step_s(step_s));
    let run = scenario.run().unwrap();
    assert_eq!(run.stop, Stop::End, "{name}, {step_s:?}");
    run.end.q
}

const STEPS_S: [f64; 4] = [1e-3, 5e-4, 2.5e-4, 1.25e-4];

/// Two independent simulators of the same kinds were apart by these after one step [rad, m].
#[test]
fn the_schemes_converge_to_each_other() {
    for (name, duration_s, apart) in [
        ("planar_biped_zmp_gait", 1.2, [1.3e-4, 7.8e-5, 4.0e-5, 7.0e-6]),
        ("planar_biped_limit_cycle_gait", 0.45, [1.5e-3, 8.1e-4, 2.5e-4, 6.6e-5]),
    ] {
        let exact = after_one_step(name, duration_s, None);
        let found = STEPS_S.map(|step_s| {
            let q = after_one_step(name, duration_s, Some(step_s));
            q.iter().zip(&exact).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()))
        });
        for (found, apart) in found.iter().zip(apart) {
            assert!(*found < 2.5 * apart, "{name}: {found:e}, elsewhere {apart:e}");
        }
        let order = (found[0] / found[3]).log2() / 3.0;
        assert!(order > 0.8, "{name}: {found:?} of order {order}");
    }
}

/// How often one foot takes over from the other.
fn steps(scenario: &Scenario, run: &denavit_simulate::Run) -> usize {
    let links: Vec<usize> = scenario.plant.model().contacts.iter().map(|c| c.link).collect();
    let on = |closed: &[usize], link: usize| closed.iter().any(|contact| links[*contact] == link);
    let feet: std::collections::BTreeSet<usize> = links.iter().copied().collect();
    let mut stood = [false; 2];
    let mut count = 0;
    for event in &run.events {
        let stands: Vec<bool> = feet.iter().map(|foot| on(&event.closed, *foot)).collect();
        // a foot has landed when it carries the robot alone
        if stands != stood && stands.iter().filter(|stands| **stands).count() == 1 {
            count += usize::from(stood != [stands[0], stands[1]]);
            stood = [stands[0], stands[1]];
        }
    }
    count
}

#[test]
fn both_gaits_walk_by_steps() {
    for (name, least, distance_m) in
        [("planar_biped_zmp_gait", 30, 2.9), ("planar_biped_limit_cycle_gait", 39, 12.0)]
    {
        for step_s in [2e-3, 1e-3] {
            let mut scenario = open(name, RunScheme::TimeStepping);
            scenario.set_step_s(step_s);
            let start = scenario.initial.q[1];
            let run = scenario.run().unwrap();
            assert_eq!(run.stop, Stop::End, "{name}, {step_s} s");
            let count = steps(&scenario, &run);
            assert!(count >= least, "{name}, {step_s} s: {count} steps");
            assert!(run.end.q[1] - start > distance_m, "{name}: {} m", run.end.q[1] - start);
        }
    }
}
