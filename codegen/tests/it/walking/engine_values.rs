//! TUlip's centroidal momentum by an engine: tests/oracles/centroidal_momentum.json.

use crate::robots::{load, repository};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::function::FunctionName::*;
use denavit_codegen::program::{Evaluator, lower};
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|entry| entry.as_f64().unwrap()).collect()
}

#[test]
fn centroidal_momentum_of_tulip_is_the_engines() {
    let path = repository().join("tests/oracles/centroidal_momentum.json");
    let oracle: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let wanted = [
        CentroidalMomentumMatrix,
        CentroidalMomentumBias,
        Momentum,
        CenterOfMassJacobian,
        CenterOfMassBias,
    ];
    let derivation = derive(&load("tulip"), Flavour::Baked, &wanted).unwrap();
    let program = lower(&derivation.dag, &derivation.functions).unwrap();
    let keys = ["matrix", "bias", "momentum", "center_of_mass_velocity", "center_of_mass_bias"];
    let mut compared = 0;
    for sample in oracle.as_array().unwrap() {
        let (q, qd) = (numbers(&sample["q"]), numbers(&sample["qd"]));
        for (routine, key) in program.routines.iter().zip(keys) {
            let mut evaluator = Evaluator::<f64>::new(routine, &[]);
            let mut ours = vec![0.0; evaluator.outputs()];
            let all: [&[f64]; 2] = [&q, &qd];
            evaluator.evaluate(&all[..routine.arguments.len()], &mut ours).unwrap();
            if key == "center_of_mass_velocity" {
                let row = |row: &[f64]| row.iter().zip(&qd).map(|(a, b)| a * b).sum();
                ours = ours.chunks(qd.len()).map(row).collect();
            }
            let theirs = numbers(&sample[key]);
            assert_eq!(ours.len(), theirs.len(), "{key}");
            let scale = theirs.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
            for (ours, theirs) in ours.iter().zip(&theirs) {
                assert!((ours - theirs).abs() <= 1e-12 * scale, "{key}: {ours} {theirs}");
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 4 * (6 * 18 + 6 + 6 + 3 + 3));
}
