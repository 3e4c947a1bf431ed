//! Emitted functions for walking against both interpreters, bit for bit.

use super::flat::{Flat, Interpreted, bits, random_sample};
use denavit_codegen::derive::Flavour;
use denavit_codegen::function::FunctionName as F;

/// What planar_biped's module has besides, as the build script asks for it.
const OF_A_PLANT: [F; 12] = [
    F::MassMatrix,
    F::Bias,
    F::LinkTransforms,
    F::ContactPositions,
    F::ContactJacobian,
    F::ContactBias,
    F::KineticEnergy,
    F::PotentialEnergy,
    F::CenterOfMass,
    F::CenterOfMassJacobian,
    F::Momentum,
    F::InverseDynamicsDerivatives,
];

macro_rules! compare {
    ($module:ident, $forces:literal, $others:expr) => {
        use denavit_plants::emitted::$module as m;
        // All functions of the module: they share nodes, whose order sums follow.
        let functions = [&$others[..], &F::WALKING].concat();
        let interpreted = Interpreted::new(stringify!($module), Flavour::Tunable, &functions);
        let p = &m::Parameters::default();
        assert_eq!(m::Foot::ALL.len(), 2);
        let call = |function: F, foot: Option<&str>, sample: &[Vec<f64>]| {
            let [q, qd, qdd]: [[f64; m::DOF]; 3] =
                [0, 1, 2].map(|row| std::array::from_fn(|entry| sample[row][entry]));
            let foot = m::Foot::ALL.into_iter().find(|known| Some(known.name()) == foot);
            match function {
                F::ContactDerivatives => {
                    let f: &[f64; $forces] = sample[3][..].try_into().unwrap();
                    let found = m::contact_derivatives(p, &q, &qd, &qdd, f);
                    [
                        found.contact_velocity_dq.flat(),
                        found.contact_acceleration_dq.flat(),
                        found.contact_acceleration_dqd.flat(),
                        found.contact_torque_dq.flat(),
                    ]
                    .concat()
                }
                F::CenterOfMassBias => m::center_of_mass_bias(p, &q, &qd).flat(),
                F::CentroidalMomentumMatrix => m::centroidal_momentum_matrix(p, &q).flat(),
                F::CentroidalMomentumBias => m::centroidal_momentum_bias(p, &q, &qd).flat(),
                F::AngularMomenta => m::angular_momenta(p, &q, &qd).flat(),
                F::ZeroMomentPoint => m::zero_moment_point(p, &q, &qd, &qdd).flat(),
                F::CartTableZmp => m::cart_table_zmp(p, &q, &qd, &qdd).flat(),
                F::FootRotationIndicator => {
                    m::foot_rotation_indicator(p, foot.unwrap(), &q, &qd, &qdd).flat()
                }
                F::CapturePoint => m::capture_point(p, &q, &qd).flat(),
                _ => unreachable!("{function} is not for walking"),
            }
        };
        let samples: Vec<Vec<Vec<f64>>> = (0..20)
            .map(|seed| {
                let mut sample = random_sample(seed, m::DOF);
                sample.truncate(3);
                // Above the ground, so that there is a capture point.
                sample[0][0] = sample[0][0].abs() + 2.0;
                sample.push(random_sample(seed + 100, $forces).swap_remove(0));
                sample
            })
            .collect();
        let routines = interpreted.program.routines.iter();
        let routines: Vec<_> = routines.filter(|made| F::WALKING.contains(&made.name)).collect();
        assert_eq!(routines.len(), F::WALKING.len() + 1);
        for routine in routines {
            let lanes = interpreted.many(routine, &samples);
            for (sample, lane) in samples.iter().zip(&lanes) {
                let arguments: Vec<&[f64]> =
                    sample.iter().take(routine.arguments.len()).map(|v| &v[..]).collect();
                let expected = interpreted.one(routine, &arguments);
                let found = call(routine.name, routine.link.as_deref(), sample);
                assert!(found.iter().all(|entry| entry.is_finite()), "{}", routine.full_name());
                assert_eq!(bits(&found), bits(&expected), "{}", routine.full_name());
                assert_eq!(bits(lane), bits(&expected), "{} in a batch", routine.full_name());
            }
        }
    };
}

#[test]
fn emitted_functions_for_walking_are_the_interpreters_on_planar_biped() {
    compare!(planar_biped, 12, OF_A_PLANT);
}

#[test]
fn emitted_functions_for_walking_are_the_interpreters_on_tulip() {
    compare!(tulip, 24, F::ALL);
}
