//! The experiment of thesis 3.3.4 as a simulation: springs and motor friction of TUlip's leg in the
//! layout of table 3.5, base parameters in that of table 3.6, for two laws of friction, and how
//! often intervals of 95 % cover the true values.
//! `cargo run --release --example two_stage [SEEDS]`

use denavit::elastic::{Estimate, TwoStage, TwoStageOptions, two_stage};
use denavit::identify::estimate::SlowRows;
use denavit::measure::condition::{Conditioning, Filter};
use denavit::measure::log::{ColumnMapping, LogOf, MeasuredLog, read_log};
use denavit::model;
use denavit::plants::PlantModel;
use denavit::plants::regression::{CoulombLaw, RegressionModel};
use denavit::regressor::RegressorOptions;
use denavit::shipped;
use denavit::simulate::scenario;
use std::error::Error;

/// The columns of table 3.6, in its order.
const KEEP: &str =
    "m6*c6x^2,c6x*m6,m6,m5*c5x^2,c5x*m5,m4*c4x^2,c4x*m4,m3*c3z^2,m3,I6y,I5z,I4z,I2y,I3y";

/// Standard errors of an interval of 95 %, of some 50 degrees of freedom.
const INTERVAL: f64 = 2.0;

fn main() -> Result<(), Box<dyn Error>> {
    let seeds: u64 = std::env::args().nth(1).map_or(Ok(1), |text| text.parse())?;
    let shipped = shipped::find("tulip_leg").ok_or("a shipped model")?;
    // the weight on the foot that the scenario has
    let mut weighted: serde_json::Value = serde_json::from_str(shipped.text)?;
    for (unknown, value) in [("m6", 2.367), ("c6x", -0.08)] {
        weighted["unknowns"][unknown]["value"] = value.into();
    }
    let robot = model::read(shipped.name, weighted.to_string().as_bytes())?;
    let with =
        RegressorOptions { friction: true, only_modelled: true, ..RegressorOptions::default() };
    let keep: Vec<String> = KEEP.split(',').map(str::to_owned).collect();
    let mut regression = RegressionModel::new(&robot, with, &keep)?;
    // the simulation's steep line is 0.01 rad/s wide
    let laws = [CoulombLaw::Sign, CoulombLaw::Tanh(0.01)];
    let mut found = [Vec::new(), Vec::new()];
    for seed in 1..=seeds {
        let (plant, log) = experiment(&regression, seed)?;
        for (law, found) in laws.into_iter().zip(&mut found) {
            regression.law = law;
            let how = TwoStageOptions {
                of_springs: conditioning(100.0, 1),
                of_load: conditioning(100.0, 10),
                slow: SlowRows::default(),
            };
            let stages = two_stage(&plant, &regression, &log, &how)?;
            if seed == 1 {
                missed(law, &plant, &stages);
            }
            found.push(rows(&plant, &regression, &stages));
        }
    }
    for (law, found) in laws.into_iter().zip(&found) {
        println!("{law:?}");
        table(found);
    }
    Ok(())
}

fn conditioning(cutoff_hz: f64, decimation: usize) -> Conditioning {
    let filter = Some(Filter { order: 4, cutoff_hz });
    Conditioning { filter, decimation, ..Conditioning::default() }
}

fn experiment(
    regression: &RegressionModel,
    seed: u64,
) -> Result<(PlantModel, MeasuredLog), Box<dyn Error>> {
    let name = "tulip_leg_elastic_identification";
    let shipped = shipped::find_scenario(name).ok_or("a shipped scenario")?;
    let load = |name: &str| {
        let found = shipped::find_referred(name).ok_or("no such file")?;
        Ok(found.text.as_bytes().to_vec())
    };
    let mut scenario = scenario::read(shipped.name, shipped.text.as_bytes(), &load)?;
    scenario.simulation.seed = seed;
    let run = scenario.run()?;
    let of = LogOf {
        model: &regression.model,
        joints: &regression.joints,
        contacts: &[],
        // springs let the joints swing beyond the limits of the trajectory
        accepts_suspicious: true,
    };
    let csv = run.log.to_csv();
    let log = read_log("log.csv", csv.as_bytes(), of, &ColumnMapping::default())?;
    Ok((scenario.plant.model().clone(), log))
}

/// What each equation misses.
fn missed(law: CoulombLaw, plant: &PlantModel, stages: &TwoStage) {
    println!("{law:?}, seed 1");
    for spring in &stages.springs {
        let (joint, missed, size) = (&spring.joint, spring.residual, spring.torque);
        println!("motor of {joint:<8} misses {missed:.2e} of {size:.2e} N m");
    }
    for (joint, [missed, size]) in plant.joints.iter().zip(&stages.residuals) {
        println!("{:<8} misses {missed:.3e} of {size:.3e} N m", joint.name);
    }
}

/// Names, true values and estimates of tables 3.5 and 3.6.
fn rows(
    plant: &PlantModel,
    regression: &RegressionModel,
    stages: &TwoStage,
) -> Vec<(String, f64, Estimate)> {
    let mut rows = Vec::new();
    for spring in &stages.springs {
        let joint = plant.joints.iter().find(|joint| joint.name == spring.joint);
        let drive = joint.and_then(|joint| joint.drive).expect("an elastic drive");
        let stiffness = drive.series_elastic.expect("an elastic drive").stiffness;
        rows.push((format!("Bm {}", spring.joint), drive.viscous, spring.viscous));
        rows.push((format!("Fc {}", spring.joint), drive.coulomb, spring.coulomb));
        rows.push((format!("k {}", spring.joint), stiffness, spring.stiffness));
    }
    for (parameter, estimate) in regression.listed.iter().zip(&stages.listed) {
        rows.push((parameter.name.clone(), parameter.value.unwrap_or(f64::NAN), *estimate));
    }
    rows
}

/// Each parameter over all seeds.
fn table(found: &[Vec<(String, f64, Estimate)>]) {
    let count = found.len() as f64;
    println!(
        "{:<17} {:>12} {:>12} {:>9} {:>9} {:>7} {:>7}  {:>6}  {:>6}",
        "", "true", "mean", "scatter", "std", "ratio", "bias", "held", "worst"
    );
    for (at, (name, truth, _)) in found[0].iter().enumerate() {
        let all = || found.iter().map(|one| one[at].2);
        let mean = all().map(|one| one.value).sum::<f64>() / count;
        let squares = all().map(|one| (one.value - mean).powi(2)).sum::<f64>();
        let scatter = (squares / (count - 1.0)).sqrt();
        let std = all().map(|one| one.std).sum::<f64>() / count;
        let apart = |one: Estimate| ((one.value - truth) / one.std).abs();
        let held = all().filter(|one| apart(*one) < INTERVAL).count();
        let worst = all().map(apart).fold(0.0, f64::max);
        println!(
            "{name:<17} {truth:>12.5} {mean:>12.5} {scatter:>9.2e} {std:>9.2e} {:>7.2} {:>7.2}  \
             {:>4.0} %  {worst:>6.2}",
            std / scatter,
            (mean - truth) / std,
            100.0 * held as f64 / count
        );
    }
}
