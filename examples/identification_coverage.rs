//! The simulated experiment of thesis 3.3.3, repeated with other noise: how often intervals of 95 %
//! cover the true values of table 3.4, and whether standard errors are as large as estimates
//! scatter. `cargo run --release --example identification_coverage [REPETITIONS]`

use denavit::identify::estimate::{Options, estimate};
use denavit::measure::condition::{Conditioned, Conditioning, Filter};
use denavit::measure::log::{JointSignals, MeasuredLog};
use denavit::model;
use denavit::numerics::interval_factor;
use denavit::plants::regression::RegressionModel;
use denavit::regressor::RegressorOptions;
use denavit::shipped;
use denavit::simulate::Log;
use denavit::simulate::scenario;
use std::error::Error;
use std::thread;

/// The columns of table 3.6, in its order.
const KEEP: &str = "e6,c6x*m6,m6,e5,c5x*m5,e4,c4x*m4,e3,m3,I6y,I5z,I4z,I2y,I3y";

/// Values and half widths of the 95 % intervals of one repetition.
type Estimates = Vec<[f64; 3]>;

fn main() -> Result<(), Box<dyn Error>> {
    let repetitions: usize = std::env::args().nth(1).map_or(Ok(200), |text| text.parse())?;
    let shipped = shipped::find("tulip_leg_table34").ok_or("a shipped model")?;
    let robot = model::read(shipped.name, shipped.text.as_bytes())?;
    let with = RegressorOptions { friction: true, ..RegressorOptions::default() };
    let keep: Vec<String> = KEEP.split(',').map(str::to_owned).collect();
    let regression = RegressionModel::new(&robot, with, &keep)?;
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let mut all: Vec<Estimates> = Vec::new();
    thread::scope(|scope| {
        let share = |first: usize| {
            let regression = &regression;
            scope.spawn(move || {
                let seeds = (first..repetitions).step_by(threads);
                seeds.map(|seed| experiment(regression, seed as u64)).collect::<Vec<_>>()
            })
        };
        let handles: Vec<_> = (0..threads).map(share).collect();
        for handle in handles {
            all.extend(handle.join().expect("no repetition panics"));
        }
    });
    println!(
        "{:<12} {:>10} {:>10} {:>11} {:>11} {:>8} {:>8}",
        "parameter", "true", "mean", "scatter", "std error", "ratio", "covered"
    );
    for (at, parameter) in regression.listed.iter().enumerate() {
        let truth = parameter.value.ok_or("the model has values")?;
        let count = all.len() as f64;
        let mean = all.iter().map(|one| one[at][0]).sum::<f64>() / count;
        let squares = all.iter().map(|one| (one[at][0] - mean).powi(2)).sum::<f64>();
        let scatter = (squares / (count - 1.0)).sqrt();
        let error = all.iter().map(|one| one[at][1]).sum::<f64>() / count;
        let covered = all.iter().filter(|one| (one[at][0] - truth).abs() <= one[at][2]).count();
        println!(
            "{:<12} {truth:>10.5} {mean:>10.5} {scatter:>11.2e} {error:>11.2e} {:>8.3} {:>6.1} %",
            parameter.name,
            error / scatter,
            100.0 * covered as f64 / count
        );
    }
    Ok(())
}

/// Runs the scenario with a seed, and identifies from its log: value, standard error and half the
/// interval of each base parameter.
fn experiment(regression: &RegressionModel, seed: u64) -> Estimates {
    let shipped = shipped::find_scenario("tulip_leg_identification").expect("shipped");
    let load = |name: &str| {
        let found = shipped::find_referred(name).ok_or("no such file")?;
        Ok(found.text.as_bytes().to_vec())
    };
    let read = scenario::read(shipped.name, shipped.text.as_bytes(), &load);
    let mut scenario = read.expect("shipped scenarios are sound");
    scenario.simulation.seed = seed;
    let run = scenario.run().expect("the scenario runs");
    let how = Conditioning {
        filter: Some(Filter { order: 4, cutoff_hz: 10.0 }),
        decimation: 20,
        ..Conditioning::default()
    };
    let names: Vec<String> = regression.joints.iter().map(|joint| joint.name.clone()).collect();
    let log = measured(&run.log, &names);
    let conditioned = Conditioned::new(log, &names, &how).expect("the log is long enough");
    let start = vec![0.0; regression.rank()];
    let found = estimate(regression, &[conditioned], &[], &Options::default(), &start);
    let found = found.expect("the motion excites");
    let to = regression.to_listed();
    let (values, spread) = (to * &found.solution.phi, to * &found.covariance * to.transpose());
    let factor = |at: usize| interval_factor(found.degrees_of_freedom[at]);
    let one = |at: usize| {
        let std = spread[(at, at)].sqrt();
        [values[at], std, factor(at) * std]
    };
    (0..values.len()).map(one).collect()
}

fn measured(log: &Log, names: &[String]) -> MeasuredLog {
    let times = log.column("t").expect("a log has times");
    let joint = |name: &String| JointSignals {
        q: log.column(&format!("q_{name}")).expect("positions"),
        tau: log.column(&format!("tau_{name}")),
        ..JointSignals::default()
    };
    MeasuredLog {
        start_s: times[0],
        step_s: (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64,
        joints: names.iter().map(joint).collect(),
        ..MeasuredLog::default()
    }
}
