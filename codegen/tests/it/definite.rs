//! D of a robot that could exist is positive definite at every state.

use crate::robots::{load, shipped};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::function::FunctionName::MassMatrix;
use denavit_codegen::number::Residue;
use denavit_codegen::program::{Evaluator, lower, prelude_values};

/// The smallest pivot of a Cholesky factorisation relative to the largest entry of its diagonal:
/// positive exactly for a positive definite matrix.
fn smallest_pivot(matrix: &[f64], n: usize) -> f64 {
    let mut a = matrix.to_vec();
    let mut smallest = f64::INFINITY;
    for k in 0..n {
        let pivot = a[k * n + k];
        smallest = smallest.min(pivot / matrix[k * n + k]);
        for i in k + 1..n {
            for j in k + 1..n {
                a[i * n + j] -= a[i * n + k] * a[k * n + j] / pivot;
            }
        }
    }
    smallest
}

#[test]
fn d_is_positive_definite() {
    let mut checked = Vec::new();
    for name in shipped() {
        let robot = load(&name);
        let Ok(derivation) = derive(&robot, Flavour::Baked, &[MassMatrix]) else {
            continue; // models of the thesis whose unknowns have no values
        };
        let program = lower(&derivation.dag, &derivation.functions).unwrap();
        let prelude = prelude_values(&program, &[]).unwrap();
        let mut evaluator = Evaluator::<f64>::new(&program.routines[0], &prelude);
        let n = robot.degrees_of_freedom();
        for sample in 0..50 {
            let angle = |joint: usize| {
                let random = Residue::scrambled(sample, joint as u64).value();
                (random as f64 / Residue::MODULUS as f64 - 0.5) * 2.8
            };
            let q: Vec<f64> = (0..n).map(angle).collect();
            let mut d = vec![0.0; n * n];
            evaluator.evaluate(&[&q], &mut d).unwrap();
            let pivot = smallest_pivot(&d, n);
            assert!(pivot > 1e-9, "{name}: pivot {pivot} at {q:?}");
        }
        checked.push(name);
    }
    for name in ["tulip", "tulip_one_torso", "puma560", "panda", "iiwa", "planar_biped"] {
        assert!(checked.iter().any(|done| done == name), "{name} was not checked: {checked:?}");
    }
}
