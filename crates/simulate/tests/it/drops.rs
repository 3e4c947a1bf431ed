//! Bodies thrown onto the ground in space: what a run does must not depend on its log.

use super::in_space::{Body, tetrahedral};
use denavit_numerics::Random;
use denavit_simulate::contact::Friction;
use denavit_simulate::{Breakdown, Control, Run, Simulation, State, Stop, Tolerances, simulate};

/// A body with three, four or eight corners in a random pose above the ground, and random laws of
/// contact.
struct Drop {
    body: Body,
    initial: State,
    friction: f64,
    restitution: f64,
}

impl Drop {
    fn random(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut within = |low: f64, high: f64| low + (high - low) * random.uniform();
        let corners = [3, 4, 8][(3.0 * within(0.0, 1.0)) as usize];
        let body = match corners {
            3 => tetrahedral(),
            4 => Body::block([0.2, 0.1, 0.05], 4),
            _ => Body::block([0.2, 0.1, 0.05], 8),
        };
        let friction = [0.0, 0.3, 0.8][(3.0 * within(0.0, 1.0)) as usize];
        let restitution = [0.0, 0.3, 0.5, 0.7][(4.0 * within(0.0, 1.0)) as usize];
        // z, x, y, yaw, roll, pitch
        let q = vec![within(0.3, 0.6), 0.0, 0.0, 0.0, within(-0.3, 0.3), within(-0.3, 0.3)];
        let qd = vec![0.0, within(-0.5, 0.5), 0.0, within(-1.0, 1.0), 0.0, within(-1.0, 1.0)];
        Self { body, initial: State { qd, ..State::resting(q) }, friction, restitution }
    }

    fn run(&self, log_period_s: f64) -> Run {
        let mut simulation = Simulation { end_s: 1.0, log_period_s, ..Simulation::default() };
        simulation.friction = Friction::Coulomb(self.friction);
        simulation.touching.restitution = self.restitution;
        simulation.touching.rest_speed = 1e-3;
        simulation.max_events = 5000;
        let mut plant = self.body.plant();
        simulate(&mut plant, &Control::passive(6), &self.initial, &simulation).unwrap()
    }
}

/// What is wrong with the drop of a seed.
fn faults(seed: u64) -> Vec<String> {
    let drop = Drop::random(seed);
    let runs = [0.01, 0.0023].map(|period| drop.run(period));
    let mut faults = Vec::new();
    let what = format!(
        "seed {seed}: {} corners, friction {}, restitution {}",
        drop.body.contacts.len(),
        drop.friction,
        drop.restitution
    );
    for run in &runs {
        let turned = run.stop == Stop::Breakdown(Breakdown::SingularPose);
        if run.stop != Stop::End && !turned {
            faults.push(format!("{what}: {} at {} s", run.stop, run.end.t_s));
        }
        let broken = run.audit.broken(&Tolerances::default());
        if !broken.is_empty() {
            faults.push(format!("{what}: {broken:?}"));
        }
    }
    // errors grow by impacts, so that the first ones are compared; forces that vanish slowly have
    // no better time
    for (index, (a, b)) in runs[0].events.iter().zip(&runs[1].events).take(12).enumerate() {
        if (a.t_s - b.t_s).abs() > 1e-5 {
            faults.push(format!("{what}: event {index} at {} and {} s", a.t_s, b.t_s));
            break;
        }
    }
    faults
}

#[test]
fn drops_do_not_depend_on_the_log() {
    let faults: Vec<String> = (0..24).flat_map(faults).collect();
    assert!(faults.is_empty(), "{faults:#?}");
}

/// `cargo test --release --test it -- --ignored six_hundred --nocapture`
#[test]
#[ignore = "takes a minute"]
fn six_hundred_drops_do_not_depend_on_the_log() {
    let faults: Vec<String> = (0..600)
        .flat_map(|seed| {
            let faults = faults(seed);
            faults.iter().for_each(|fault| println!("{fault}"));
            faults
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.len());
}
