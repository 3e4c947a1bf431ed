//! The experiment of thesis 3.3.4 as a simulation: springs and motor friction of TUlip's leg in the
//! layout of table 3.5, base parameters in that of table 3.6, for two laws of friction.
//! `cargo run --release --example two_stage`

use denavit::identify::condition::{Conditioning, Filter};
use denavit::identify::log::{ColumnMapping, LogOf, read_log};
use denavit::identify::two_stage::{Estimate, two_stage};
use denavit::model;
use denavit::plants::regression::{CoulombLaw, RegressionModel};
use denavit::regressor::RegressorOptions;
use denavit::shipped;
use denavit::simulate::scenario;
use std::error::Error;

/// The columns of table 3.6, in its order.
const KEEP: &str =
    "m6*c6x^2,c6x*m6,m6,m5*c5x^2,c5x*m5,m4*c4x^2,c4x*m4,m3*c3z^2,m3,I6y,I5z,I4z,I2y,I3y";

fn main() -> Result<(), Box<dyn Error>> {
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
    let name = "tulip_leg_elastic_identification";
    let shipped = shipped::find_scenario(name).ok_or("a shipped scenario")?;
    let load = |name: &str| {
        let found = shipped::find_referred(name).ok_or("no such file")?;
        Ok(found.text.as_bytes().to_vec())
    };
    let mut scenario = scenario::read(shipped.name, shipped.text.as_bytes(), &load)?;
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
    let plant = scenario.plant.model();
    let how = |cutoff_hz: f64, decimation: usize| Conditioning {
        filter: Some(Filter { order: 4, cutoff_hz }),
        decimation,
        ..Conditioning::default()
    };
    let both = [how(100.0, 1), how(40.0, 5)];
    // the simulation's steep line is 0.01 rad/s wide
    for law in [CoulombLaw::Sign, CoulombLaw::Tanh(0.01)] {
        regression.law = law;
        let found = two_stage(plant, &regression, &log, [&both[0], &both[1]])?;
        println!("{law:?}");
        let drives = plant
            .joints
            .iter()
            .filter(|joint| joint.drive.is_some_and(|drive| drive.series_elastic.is_some()));
        for (spring, joint) in found.springs.iter().zip(drives) {
            let drive = joint.drive.ok_or("an elastic drive")?;
            let stiffness = drive.series_elastic.map_or(0.0, |elastic| elastic.stiffness);
            let line = |what: &str, truth: f64, estimate: Estimate| {
                let Estimate { value, std } = estimate;
                let apart = (value - truth) / std;
                println!(
                    "{what:<8} {:<8} {truth:>12.5} {value:>12.5} {std:>10.2e} {apart:>6.2}",
                    spring.joint
                );
            };
            line("Bm", drive.viscous, spring.viscous);
            line("Fc", drive.coulomb, spring.coulomb);
            line("k", stiffness, spring.stiffness);
            println!("residual {:.2e} of {:.2e} N m", spring.residual, spring.torque);
        }
        for (parameter, estimate) in regression.listed.iter().zip(&found.listed) {
            let truth = parameter.value.unwrap_or(f64::NAN);
            let Estimate { value, std } = estimate;
            let apart = (value - truth) / std;
            let name = &parameter.name;
            println!("{name:<17} {truth:>12.5} {value:>12.5} {std:>10.2e} {apart:>6.2}");
        }
        for (joint, [missed, size]) in plant.joints.iter().zip(&found.residuals) {
            println!("{:<8} misses {missed:.3e} of {size:.3e} N m", joint.name);
        }
    }
    Ok(())
}
