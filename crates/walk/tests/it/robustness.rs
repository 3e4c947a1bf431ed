//! What gaits endure: the basin of the limit cycle under noise, and pushes that fell.

use super::{assert_near, scenario};
use denavit_plants::PointModel;
use denavit_simulate::scenario::Scenario;
use denavit_walk::poincare::{PoincareAnalysis, PoincareOptions, analyse};
use denavit_walk::robustness::{BasinOptions, Outcome, PushOptions, basin, least_pushes, noise};

const GAIT: &str = "planar_biped_limit_cycle_gait";

fn disturbed() -> Scenario {
    let mut scenario = scenario(GAIT);
    scenario.simulation.touching.fallback_friction = Some(0.8);
    scenario
}

fn cycle() -> (Scenario, PoincareAnalysis) {
    let mut scenario = disturbed();
    let options = PoincareOptions { checks: false, ..PoincareOptions::default() };
    let found = analyse(&mut scenario, &options).unwrap();
    (scenario, found)
}

/// A deviation shrinks by the modulus of the largest multiplier, .670, a step; small noise fells
/// nothing.
#[test]
fn starts_near_the_cycle_return_to_it_as_its_multipliers_say() {
    let (scenario, found) = cycle();
    let deviations = noise(scenario.plant.as_ref(), 0.05, 4, 11);
    let open = || Some(disturbed());
    let distances = |cycles: usize| -> Vec<f64> {
        let options = BasinOptions { cycles };
        let starts = basin(&open, &found.cycle, &deviations, &options, &|_, _| true);
        assert!(starts.iter().all(|start| start.outcome.walks() && start.cycles == cycles));
        starts.iter().map(|start| start.distance).collect()
    };
    let (early, late) = (distances(6), distances(14));
    for (early, late) in early.iter().zip(&late) {
        let shrink = (late / early).powf(1.0 / 8.0);
        assert_near(shrink, 0.66995, 0.12);
    }
    // the same on any number of processors
    assert_eq!(distances(6), early);
}

#[test]
fn the_least_push_fells_and_less_does_not() {
    let (scenario, found) = cycle();
    let model = scenario.plant.model();
    let link = model.links.iter().position(|link| link == "base_pitch").unwrap();
    let point = PointModel { name: "hip".to_owned(), link, position: [0.0; 3] };
    let options = PushOptions {
        point,
        times_s: vec![0.1],
        directions: vec![[1.0, 0.0, 0.0]],
        most_ns: 20.0,
        coarse: 8,
        resolution_ns: 0.05,
        after_s: 3.0,
    };
    let open = || Some(disturbed());
    let start = found.cycle.chart.base;
    let push = &least_pushes(&open, &start, &options, &|_, _| true)[0];
    let least = push.impulse_ns.expect("20 N s fell it");
    assert!(matches!(push.outcome, Outcome::Fell(..)), "{push:?}");
    // the same search, told that nothing stronger is tried, finds none
    let weaker = PushOptions { most_ns: least - 0.1, coarse: 1, ..options };
    let push = &least_pushes(&open, &start, &weaker, &|_, _| true)[0];
    assert_eq!(push.impulse_ns, None, "{push:?}");
}
