//! A module with fused products, on single numbers and on packs.

use super::flat::{Flat, Interpreted, bits, random_sample};
use denavit_codegen::derive::Flavour;
use denavit_codegen::function::FunctionName;
use denavit_plants::batch::map_packs_in_parallel;
use denavit_runtime::map_packs;
use denavit_runtime::wide::{f64x4, f64x8};

mod leg {
    #![allow(dead_code, unreachable_pub)] // a user's module is public
    include!(concat!(env!("OUT_DIR"), "/tulip_leg6_dynamics.rs"));
}

use leg::DOF;

const FUNCTIONS: [FunctionName; 5] = [
    FunctionName::InverseDynamics,
    FunctionName::ForwardDynamics,
    FunctionName::InverseDynamicsDerivatives,
    FunctionName::MassMatrix,
    FunctionName::BaseRegressor,
];

fn call(function: FunctionName, [q, qd, x]: [&[f64; DOF]; 3]) -> Vec<f64> {
    let p = &leg::Parameters::default();
    match function {
        FunctionName::InverseDynamics => leg::inverse_dynamics(p, q, qd, x).flat(),
        FunctionName::ForwardDynamics => leg::forward_dynamics(p, q, qd, x).flat(),
        FunctionName::MassMatrix => leg::mass_matrix(p, q).flat(),
        FunctionName::BaseRegressor => {
            let rows = leg::base_regressor(p, q, qd, x);
            [rows.base_regressor.flat(), rows.known.flat()].concat()
        }
        _ => {
            let derivatives = leg::inverse_dynamics_derivatives(p, q, qd, x);
            [derivatives.dtau_dq, derivatives.dtau_dqd].flat()
        }
    }
}

fn vectors(sample: &[Vec<f64>]) -> [[f64; DOF]; 3] {
    [0, 1, 2].map(|row| std::array::from_fn(|entry| sample[row][entry]))
}

/// Emitted code and the interpreters fuse the same products; against code that does not, only
/// rounding differs, as the operations are the same.
#[test]
fn fused_products_agree_with_their_interpreters_and_nearly_with_others() {
    let functions = [&FunctionName::ALL[..], &[FunctionName::BaseRegressor]].concat();
    let fused = Interpreted::fused("tulip_leg6", Flavour::Tunable, &functions);
    let plain = Interpreted::new("tulip_leg6", Flavour::Tunable, &functions);
    for function in FUNCTIONS {
        let (routine, other) = (fused.routine(function, None), plain.routine(function, None));
        assert!(routine.code.is_fused() && !other.code.is_fused());
        assert!(routine.code.instructions.len() < other.code.instructions.len());
        for seed in 0..20 {
            let sample = random_sample(seed, DOF);
            let arguments: Vec<&[f64]> =
                sample.iter().take(routine.arguments.len()).map(|v| &v[..]).collect();
            let expected = fused.one(routine, &arguments);
            let [q, qd, x] = vectors(&sample);
            assert_eq!(bits(&call(function, [&q, &qd, &x])), bits(&expected), "{function}");
            let lane = &fused.many(routine, std::slice::from_ref(&sample))[0];
            assert_eq!(bits(lane), bits(&expected), "{function} in a batch");
            let near = plain.one(other, &arguments);
            let scale = near.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
            for (value, near) in expected.iter().zip(&near) {
                assert!(
                    (value - near).abs() <= 1e-13 * scale.max(1.0),
                    "{function}: {value} {near}"
                );
            }
        }
    }
}

/// 997 samples: neither packs nor threads share them out evenly.
#[test]
fn packs_give_every_sample_the_bits_of_a_call() {
    let samples: Vec<[[f64; DOF]; 3]> =
        (0..997).map(|seed| vectors(&random_sample(seed, DOF))).collect();
    let columns = |row: usize| -> Vec<Vec<f64>> {
        (0..DOF).map(|entry| samples.iter().map(|sample| sample[row][entry]).collect()).collect()
    };
    let [q, qd, qdd] = [0, 1, 2].map(columns);
    let views = [&q, &qd, &qdd].map(|columns| columns.iter().map(|c| &c[..]).collect::<Vec<_>>());
    let inputs = views.each_ref().map(|columns| &columns[..]);

    let mut torques = vec![vec![0.0; samples.len()]; DOF];
    let parameters = leg::Parameters::<f64x4>::default();
    map_packs(inputs, &mut views_of(&mut torques), |[q, qd, qdd]: [&[f64x4; DOF]; 3]| {
        leg::inverse_dynamics(&parameters, q, qd, qdd)
    })
    .unwrap();
    let mut rows =
        vec![vec![0.0; samples.len()]; call(FunctionName::BaseRegressor, [&[0.0; DOF]; 3]).len()];
    let parameters = leg::Parameters::<f64x8>::default();
    map_packs_in_parallel(inputs, &mut views_of(&mut rows), |[q, qd, qdd]: [&[f64x8; DOF]; 3]| {
        let rows = leg::base_regressor(&parameters, q, qd, qdd);
        (rows.base_regressor, rows.known)
    })
    .unwrap();
    for (row, [q, qd, qdd]) in samples.iter().enumerate() {
        for (function, columns) in
            [(FunctionName::InverseDynamics, &torques), (FunctionName::BaseRegressor, &rows)]
        {
            let found: Vec<f64> = columns.iter().map(|column| column[row]).collect();
            assert_eq!(bits(&found), bits(&call(function, [q, qd, qdd])), "{function}, row {row}");
        }
    }
    let short: Vec<&[f64]> = views[0].iter().map(|column| &column[..9]).collect();
    let wrong = map_packs_in_parallel(
        [&views[0], &short],
        &mut views_of(&mut torques),
        |[q, _]: [&[f64x4; DOF]; 2]| *q,
    );
    let error = wrong.unwrap_err().to_string();
    assert_eq!(error, "input 1: column 0 has 9 samples instead of 997");
}

fn views_of(columns: &mut [Vec<f64>]) -> Vec<&mut [f64]> {
    columns.iter_mut().map(|column| &mut column[..]).collect()
}
