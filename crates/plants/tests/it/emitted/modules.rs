//! The modules that the project's build script made.

use super::flat::{Flat, Interpreted, bits, random_sample};
use denavit_codegen::derive::Flavour;
use denavit_codegen::function::FunctionName;

/// The functions that every module has: its name, its arguments, its outputs.
macro_rules! call {
    ($module:ident, $scalar:ty) => {
        /// Calls a function by its name; all outputs, one after the other.
        fn call(
            parameters: &denavit_plants::emitted::$module::Parameters<$scalar>,
            function: FunctionName,
            link: Option<denavit_plants::emitted::$module::Link>,
            arguments: &[Vec<f64>],
        ) -> Vec<$scalar> {
            use FunctionName as F;
            use denavit_plants::emitted::$module as m;
            let p = parameters;
            let [q, qd, x]: [[$scalar; m::DOF]; 3] =
                [0, 1, 2].map(|row| std::array::from_fn(|entry| arguments[row][entry] as $scalar));
            match function {
                F::InverseDynamics => m::inverse_dynamics(p, &q, &qd, &x).flat(),
                F::MassMatrix => m::mass_matrix(p, &q).flat(),
                F::CoriolisMatrix => m::coriolis_matrix(p, &q, &qd).flat(),
                F::GravityVector => m::gravity_vector(p, &q).flat(),
                F::Bias => m::bias(p, &q, &qd).flat(),
                F::DynamicsTerms => {
                    let terms = m::dynamics_terms(p, &q, &qd);
                    let matrices = [terms.mass_matrix, terms.coriolis_matrix];
                    [matrices.flat(), terms.gravity_vector.flat()].concat()
                }
                F::ForwardDynamics => m::forward_dynamics(p, &q, &qd, &x).flat(),
                F::MassMatrixSolve => m::mass_matrix_solve(p, &q, &qd).flat(),
                F::InverseDynamicsDerivatives => {
                    let derivatives = m::inverse_dynamics_derivatives(p, &q, &qd, &x);
                    [derivatives.dtau_dq, derivatives.dtau_dqd].flat()
                }
                F::ForwardDynamicsDerivatives => {
                    let derivatives = m::forward_dynamics_derivatives(p, &q, &qd, &x);
                    [derivatives.dqdd_dq, derivatives.dqdd_dqd, derivatives.dqdd_dtau].flat()
                }
                F::LinkTransforms => m::link_transforms(p, &q).flat(),
                F::LinkJacobian => m::link_jacobian(p, link.unwrap(), &q).flat(),
                F::CenterOfMass => m::center_of_mass(p, &q).flat(),
                F::CenterOfMassJacobian => m::center_of_mass_jacobian(p, &q).flat(),
                F::Momentum => {
                    let momentum = m::momentum(p, &q, &qd);
                    [momentum.linear_momentum, momentum.angular_momentum].flat()
                }
                F::KineticEnergy => m::kinetic_energy(p, &q, &qd).flat(),
                F::PotentialEnergy => m::potential_energy(p, &q).flat(),
                F::ContactPositions | F::ContactJacobian | F::ContactBias => {
                    contacts(p, function, [&q, &qd])
                }
                F::ContactDerivatives
                | F::CenterOfMassBias
                | F::CentroidalMomentumMatrix
                | F::CentroidalMomentumBias
                | F::AngularMomenta
                | F::ZeroMomentPoint
                | F::CartTableZmp
                | F::FootRotationIndicator
                | F::CapturePoint
                | F::StateRates
                | F::Regressor
                | F::BaseRegressor
                | F::BaseParameters => {
                    unreachable!("{function} is emitted on request, not in these modules")
                }
            }
        }
    };
}

/// Compares all functions of a module with both interpreters, on 20 samples each.
macro_rules! compare {
    ($module:ident) => {
        let model = stringify!($module);
        let interpreted = Interpreted::new(model, Flavour::Tunable, &FunctionName::ALL);
        let parameters = denavit_plants::emitted::$module::Parameters::default();
        let samples: Vec<_> = (0..20)
            .map(|seed| random_sample(seed, denavit_plants::emitted::$module::DOF))
            .collect();
        assert!(interpreted.program.routines.len() >= 17);
        for routine in &interpreted.program.routines {
            let variant = |link| {
                denavit_plants::emitted::$module::Link::ALL
                    .into_iter()
                    .find(|known| known.name() == link)
            };
            let link = routine.link.as_deref().map(|link| variant(link).unwrap());
            let batch = interpreted.many(routine, &samples);
            for (sample, lane) in samples.iter().zip(&batch) {
                let arguments: Vec<&[f64]> =
                    sample.iter().take(routine.arguments.len()).map(|v| &v[..]).collect();
                let expected = interpreted.one(routine, &arguments);
                let found = call(&parameters, routine.name, link, sample);
                assert_eq!(bits(&found), bits(&expected), "{}", routine.full_name());
                assert_eq!(bits(lane), bits(&expected), "{} in a batch", routine.full_name());
            }
        }
    };
}

#[test]
fn emitted_interpreted_and_batch_agree_bit_for_bit_on_puma560() {
    call!(puma560, f64);
    fn contacts<P>(_: P, function: FunctionName, _: [&[f64; 6]; 2]) -> Vec<f64> {
        unreachable!("PUMA 560 has no contact points, so no {function}")
    }
    compare!(puma560);
}

#[test]
fn emitted_interpreted_and_batch_agree_bit_for_bit_on_tulip() {
    call!(tulip, f64);
    fn contacts(
        p: &denavit_plants::emitted::tulip::Parameters<f64>,
        function: FunctionName,
        [q, qd]: [&[f64; 18]; 2],
    ) -> Vec<f64> {
        match function {
            FunctionName::ContactPositions => {
                denavit_plants::emitted::tulip::contact_positions(p, q).flat()
            }
            FunctionName::ContactJacobian => {
                denavit_plants::emitted::tulip::contact_jacobian(p, q).flat()
            }
            _ => denavit_plants::emitted::tulip::contact_bias(p, q, qd).flat(),
        }
    }
    compare!(tulip);
}

/// In f32 the prelude is that of f64, rounded once.
#[test]
fn single_precision_agrees_bit_for_bit_with_its_interpreter() {
    use denavit_plants::emitted::puma560 as m;
    let interpreted = Interpreted::new("puma560", Flavour::Tunable, &FunctionName::ALL);
    let parameters = m::Parameters::<f32>::default();
    for seed in 0..20 {
        let sample = random_sample(seed, m::DOF);
        let [q, qd, qdd]: [[f32; m::DOF]; 3] =
            [0, 1, 2].map(|row| std::array::from_fn(|entry| sample[row][entry] as f32));
        let arguments: [&[f32]; 3] = [&q, &qd, &qdd];
        let routine = interpreted.routine(FunctionName::InverseDynamics, None);
        let expected = interpreted.one_f32(routine, &arguments);
        let found = m::inverse_dynamics(&parameters, &q, &qd, &qdd).flat();
        assert_eq!(bits(&found), bits(&expected));
        let routine = interpreted.routine(FunctionName::ForwardDynamics, None);
        let expected = interpreted.one_f32(routine, &arguments);
        let found = m::forward_dynamics(&parameters, &q, &qd, &qdd).flat();
        assert_eq!(bits(&found), bits(&expected));
    }
}

/// A parameter that is changed changes what depends on it, and nothing has to be emitted again.
#[test]
fn parameters_are_tunable_at_run_time() {
    use denavit_plants::emitted::puma560 as m;
    let q = [0.3, -0.2, 0.5, 0.1, 0.4, -0.6];
    let nominal = m::gravity_vector(&m::Parameters::<f64>::default(), &q);
    let mut model = m::ModelParameters::<f64>::default();
    model.g *= 2.0;
    let doubled = m::gravity_vector(&m::Parameters::new(&model), &q);
    for (once, twice) in nominal.iter().zip(doubled) {
        assert!((2.0 * once - twice).abs() <= 1e-13 * once.abs().max(1.0), "{nominal:?}");
    }
    assert!(nominal[1].abs() > 1.0);
}
