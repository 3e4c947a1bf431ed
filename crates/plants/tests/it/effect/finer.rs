//! Laws that refine others are these, with some values of their parameters.

use super::laws::motion;
use denavit_codegen::effect::{catalogue, find};
use denavit_codegen::model::JointKind;
use denavit_plants::effect::EffectLaw;
use std::collections::BTreeSet;

/// Of each: the law with its values, and what it refines with the same.
const SAME: [(&str, &[f64], &str, &[f64]); 17] = [
    ("arctangent_coulomb", &[2.0, 1e-5], "coulomb", &[2.0]),
    ("asymmetric_coulomb", &[2.0, 2.0], "coulomb", &[2.0]),
    ("bouc_wen", &[2.0, 0.0, 0.0, 1e-4], "coulomb", &[2.0]),
    ("capstan_posture", &[0.3, 0.0], "capstan", &[0.3]),
    ("cold_friction", &[2.0, 2.0, 0.0, 5.0], "coulomb", &[2.0]),
    ("cold_viscous", &[2.0, 2.0, 0.0, 5.0], "viscous", &[2.0]),
    ("dahl", &[2.0, 1e-4], "coulomb", &[2.0]),
    ("gear_efficiency", &[0.2, 0.2], "load_friction", &[0.2]),
    ("hardening_spring", &[3.0, 0.0, 0.1], "spring", &[3.0, 0.1]),
    ("lugre", &[2.0, 0.0, 0.1, 1e-5, 0.0], "coulomb", &[2.0]),
    ("lugre", &[2.0, 0.0, 0.1, 0.01, 0.0], "dahl", &[2.0, 0.01]),
    ("lugre", &[2.0, 0.5, 0.1, 1e-5, 0.0], "stribeck_friction", &[2.0, 1.0, 0.1]),
    ("maxwell_slip", &[1.5, 0.5, 1e-4, 1e-4], "coulomb", &[2.0]),
    ("shear_thinning", &[2.0, 1000.0], "viscous", &[2.0]),
    ("smoothed_coulomb", &[2.0, 1e-5], "coulomb", &[2.0]),
    ("stribeck_friction", &[2.0, 0.0, 0.1], "coulomb", &[2.0]),
    ("stribeck_friction", &[0.0, 2.0, 0.1], "stribeck", &[2.0, 0.1]),
];

#[test]
fn a_law_that_refines_another_is_that_with_some_values() {
    let motion = motion(200_001, 0.00002);
    for (finer, own, plain, values) in SAME {
        let torque = |name: &str, values: &[f64]| {
            let effect = find(name).expect("shipped");
            let law = EffectLaw::new(effect, JointKind::Revolute).expect("a law");
            for (value, known) in values.iter().zip(&law.parameters) {
                assert!((known.bounds[0]..=known.bounds[1]).contains(value), "{name}: {value}");
            }
            law.torque(&motion.samples(), values)
        };
        let [own, other] = [torque(finer, own), torque(plain, values)];
        let square = |of: &dyn Fn(usize) -> f64| (0..own.len()).map(|k| of(k).powi(2)).sum::<f64>();
        let apart = square(&|k| own[k] - other[k]) / square(&|k| other[k]);
        // bristles bend for a moment after each reversal, where the joint is slow
        let bends = !find(finer).expect("shipped").states.is_empty();
        let most = if bends { 0.05 } else { 1e-4 };
        assert!(apart < most, "{finer} is not {plain}: {apart}");
    }
}

/// So the table above holds all of the catalogue.
#[test]
fn every_law_that_refines_another_is_compared_with_it() {
    let of = |effect: &denavit_codegen::effect::Effect| {
        let name = effect.name.clone();
        effect.refines.iter().map(move |plain| (name.clone(), plain.clone())).collect::<Vec<_>>()
    };
    let stated: BTreeSet<(String, String)> = catalogue().iter().flat_map(of).collect();
    let compared = SAME.iter().map(|(finer, _, plain, _)| ((*finer).into(), (*plain).into()));
    assert_eq!(stated, compared.collect::<BTreeSet<(String, String)>>());
}
