//! Joints as explicit constraints come apart; minimal coordinates cannot (thesis 2.2.1).

use denavit_codegen::model;
use denavit_plants::LoadedPlant;
use denavit_plants::shipped;
use denavit_simulate::constraint_drift::{ConstrainedBodies, DriftSample};

/// The double pendulum of the thesis from rest at these angles, for 20 s.
fn drift(stabilisation_per_s: f64, step_s: f64) -> Vec<DriftSample> {
    let text = shipped::find("double_pendulum").unwrap().text;
    let robot = model::read("double_pendulum", text.as_bytes()).unwrap();
    let mut plant = LoadedPlant::new(&robot, &[]).unwrap();
    let mut bodies = ConstrainedBodies::new(&robot, stabilisation_per_s).unwrap();
    bodies.run(&mut plant, &[-1.2, 0.3], step_s, 0.1, 200).unwrap()
}

/// The largest value until a time.
fn worst(samples: &[DriftSample], until_s: f64, of: fn(&DriftSample) -> f64) -> f64 {
    let early = samples.iter().filter(|sample| sample.t_s <= until_s + 1e-9);
    early.map(of).fold(0.0, f64::max)
}

#[test]
fn joints_come_apart_with_the_square_of_time() {
    let free = drift(0.0, 5e-3);
    let order =
        |of: fn(&DriftSample) -> f64| (worst(&free, 20.0, of) / worst(&free, 5.0, of)).log2() / 2.0;
    let (position, rate) = (order(|s| s.constraint), order(|s| s.constraint_rate));
    assert!((position - 2.0).abs() < 0.35, "errors of position grow as t^{position}");
    assert!((rate - 1.0).abs() < 0.35, "errors of rates grow as t^{rate}");
    // it is the error of the method, of fourth order, that adds up
    let finer = drift(0.0, 2.5e-3);
    let gain = worst(&free, 20.0, |s| s.constraint) / worst(&finer, 20.0, |s| s.constraint);
    assert!((gain.log2() - 4.0).abs() < 0.7, "half the step, {gain} times less");
}

#[test]
fn baumgarte_holds_joints_together() {
    let [free, held] = [0.0, 20.0].map(|rate| drift(rate, 5e-3));
    let [free, late] = [&free, &held].map(|run| worst(run, 20.0, |s| s.constraint));
    let early = worst(&held, 5.0, |s| s.constraint);
    assert!(late < 3.0 * early, "no growth: {early} {late}");
    assert!(late < 0.05 * free, "{late} {free}");
    // and both move as minimal coordinates do
    assert!(worst(&held, 20.0, |s| s.distance_m) < 1e-3);
    assert!(worst(&held, 20.0, |s| s.minimal_energy_j.abs()) < 1e-4);
}
