//! Operations of the regressors, against the best known of the prototypes and as recorded.

use super::rigid;
use crate::robots::{fixture, load};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::expr::Operations;
use denavit_codegen::function::FunctionName::{self, BaseRegressor, Regressor};
use denavit_codegen::model::Robot;

/// (robot, base parameters, multiplications + additions of the regressor, of the base regressor):
/// the best of the prototypes, whose columns are entries of pseudo-inertias in frames on the joint
/// axes.
const BEST_KNOWN: [(&str, usize, usize, usize); 8] = [
    ("planar_2r", 6, 29, 26),
    ("puma560", 36, 847, 665),
    ("rx90", 36, 778, 612),
    ("iiwa", 43, 1344, 1056),
    ("general_6r", 38, 1598, 1342),
    ("tulip_leg5", 29, 642, 505),
    ("tulip_leg6", 36, 911, 708),
    ("tulip", 94, 5543, 4171),
];

fn count(robot: &Robot, function: FunctionName) -> (Vec<usize>, usize) {
    let derivation = derive(robot, Flavour::Tunable, &[function]).unwrap();
    let function = &derivation.functions[0];
    let ours = Operations::count(&derivation.dag, &function.entries());
    (function.outputs[0].shape.clone(), ours.mul + ours.add)
}

fn robot(name: &str) -> Robot {
    match name {
        "general_6r" => rigid(fixture("general_6r.json")),
        _ => rigid(load(name)),
    }
}

#[test]
fn regressors_are_at_or_below_the_best_known() {
    for (name, _, known, _) in BEST_KNOWN {
        let (_, ours) = count(&robot(name), Regressor);
        // Its frames, of standard rows, are not on the axes: they lie behind skew twists, and at
        // the tip of a planar arm.
        let known = match name {
            "general_6r" => known * 6 / 5,
            "planar_2r" => known * 4 / 3,
            _ => known,
        };
        assert!(ours <= known, "{name}: {ours}, best known {known}");
    }
}

#[test]
fn base_regressors_are_at_or_below_the_best_known() {
    for (name, rank, _, known) in BEST_KNOWN {
        let (shape, ours) = count(&robot(name), BaseRegressor);
        assert_eq!(shape[1], rank, "{name}");
        assert!(ours <= known, "{name}: {ours}, best known {known}");
    }
}
