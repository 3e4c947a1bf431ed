//! The simulated experiment of thesis 3.3.3, a few times: the true values of table 3.4 are within
//! intervals as often as these say. examples/identification_coverage.rs does it 200 times.

use super::robot;
use denavit_codegen::regressor::RegressorOptions;
use denavit_identify::estimate::{Options, estimate};
use denavit_measure::condition::{Conditioned, Conditioning, Filter};
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_numerics::interval_factor;
use denavit_plants::regression::RegressionModel;
use denavit_plants::shipped;
use denavit_simulate::{Log, scenario};

/// The columns of table 3.6, and the values of table 3.4.
const PRINTED: [(&str, f64); 14] = [
    ("e6", 1.9559),
    ("c6x*m6", 0.3445),
    ("m6", 0.0902),
    ("e5", 0.3791),
    ("c5x*m5", 0.0855),
    ("e4", 0.1252),
    ("c4x*m4", 0.0175),
    ("e3", 0.0702),
    ("m3", 0.0014),
    ("I6y", 0.1),
    ("I5z", 0.68),
    ("I4z", 0.68),
    ("I2y", 0.1),
    ("I3y", 0.5),
];

/// The log of the scenario with another seed.
fn experiment(seed: u64) -> Log {
    let shipped = shipped::find_scenario("tulip_leg_identification").expect("shipped");
    let load = |name: &str| {
        let found = shipped::find_referred(name).ok_or("no such file")?;
        Ok(found.text.as_bytes().to_vec())
    };
    let read = scenario::read(shipped.name, shipped.text.as_bytes(), &load);
    let mut scenario = read.unwrap_or_else(|error| panic!("{error}"));
    scenario.simulation.seed = seed;
    scenario.run().unwrap_or_else(|error| panic!("{error}")).log
}

fn measured(log: &Log, names: &[String]) -> MeasuredLog {
    let joint = |name: &String| JointSignals {
        q: log.column(&format!("q_{name}")).expect("positions"),
        tau: log.column(&format!("tau_{name}")),
        ..JointSignals::default()
    };
    let joints = names.iter().map(joint).collect();
    MeasuredLog { step_s: 1e-3, joints, ..MeasuredLog::default() }
}

#[test]
fn the_true_values_of_table_3_4_are_within_their_intervals() {
    let with = RegressorOptions { friction: true, ..RegressorOptions::default() };
    let keep: Vec<String> = PRINTED.iter().map(|(name, _)| (*name).to_owned()).collect();
    let robot = robot("tulip_leg_table34");
    let model = RegressionModel::new(&robot, with, &keep).expect("a regression model");
    let names: Vec<String> = model.joints.iter().map(|joint| joint.name.clone()).collect();
    let friction = |name: &str| if name.starts_with("fv") { 0.01 } else { 0.0001 };
    let truth: Vec<f64> = model
        .listed
        .iter()
        .map(|one| {
            let printed = PRINTED.iter().find(|(name, _)| *name == one.name);
            printed.map_or_else(|| friction(&one.name), |(_, value)| *value)
        })
        .collect();
    assert_eq!(truth.len(), 24);
    let how = Conditioning {
        filter: Some(Filter { order: 4, cutoff_hz: 10.0 }),
        decimation: 20,
        ..Conditioning::default()
    };
    let (mut covered, mut squares, seeds) = (0, 0.0, 6);
    for seed in 0..seeds {
        let log = measured(&experiment(seed), &names);
        let conditioned = Conditioned::new(log, &names, &how).expect("the log is long enough");
        let start = vec![0.0; model.rank()];
        let found = estimate(&model, &[conditioned], &[], &Options::default(), &start);
        let found = found.expect("the motion excites");
        let to = model.to_listed();
        let (values, spread) = (to * &found.solution.phi, to * &found.covariance * to.transpose());
        let factor = |at: usize| interval_factor(found.degrees_of_freedom[at]);
        for (at, truth) in truth.iter().enumerate() {
            let apart = (values[at] - truth) / spread[(at, at)].sqrt();
            assert!(apart.abs() < 6.0, "{}: {} for {truth}", model.listed[at].name, values[at]);
            covered += usize::from(apart.abs() <= factor(at));
            squares += apart * apart;
        }
    }
    // 144 intervals, in groups that are correlated
    let count = 24.0 * seeds as f64;
    assert!(covered as f64 >= 0.88 * count, "{covered} of {count}");
    assert!((0.5..1.6).contains(&(squares / count)), "{}", squares / count);
}
