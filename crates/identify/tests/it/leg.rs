//! The simulated experiment of thesis 3.3.3, a few times: the true values of table 3.4 are within
//! intervals as often as these say. examples/identification_coverage.rs does it 200 times.

use super::{random_motion, robot, torques};
use denavit_codegen::regressor::RegressorOptions;
use denavit_identify::estimate::{Options, consistent, estimate};
use denavit_measure::condition::{Conditioned, Conditioning, Filter};
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_numerics::{Random, interval_factor};
use denavit_plants::regression::RegressionModel;
use denavit_plants::shipped;
use denavit_simulate::{Log, scenario};
use nalgebra::DVector;

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

/// The moment of inertia of a link is a sum of two unknowns, each of which may have either sign. Of
/// data that make the sum negative the nearest parameters of bodies that exist are others.
#[test]
fn no_moment_that_is_a_sum_is_negative() {
    let keep: Vec<String> = PRINTED.iter().map(|(name, _)| (*name).to_owned()).collect();
    let robot = robot("tulip_leg_table34");
    let model = RegressionModel::new(&robot, RegressorOptions::default(), &keep).expect("a model");
    let printed = |name: &str| PRINTED.iter().find(|(own, _)| *own == name).expect("printed").1;
    let value = |name: &str| if name == "e3" { -0.6 } else { printed(name) };
    let listed = model.listed.iter().map(|one| value(&one.name));
    let listed = DVector::from_iterator(model.rank(), listed);
    let phi = model.to_listed().clone().lu().solve(&listed).expect("a change of basis");
    let (n, samples) = (model.joints.len(), 400);
    let motion = random_motion(n, samples, 3);
    let mut random = Random::new(4);
    let mut noisy = |torque: Vec<f64>| -> Vec<f64> {
        torque.into_iter().map(|torque| torque + 0.01 * random.normal()).collect()
    };
    let data = Conditioned {
        step_s: 0.01,
        q: motion[..n].to_vec(),
        rates: Some([motion[n..2 * n].to_vec(), motion[2 * n..].to_vec()]),
        torque: torques(&model, &motion, phi.as_slice())
            .into_iter()
            .map(|torque| Some(noisy(torque)))
            .collect(),
        range: 0..samples,
        decimation: 1,
        ..Conditioned::default()
    };
    let found = estimate(&model, &[data], &[], &Options::default(), &vec![0.0; model.rank()]);
    let near = consistent(&model, &found.expect("the motion excites"));
    let mut values: Vec<f64> = model.parameters.iter().map(|one| one.value).collect();
    near.own.iter().for_each(|&(place, value)| values[place] = value);
    let least = model.masses_and_moments(&values).into_iter().fold(f64::INFINITY, f64::min);
    assert!(least >= 0.0 && near.distance > 1.0, "{least} {}", near.distance);
}
