//! Operations of the base regressor, against the best known.

use super::rigid;
use crate::robots::{fixture, load};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::expr::Operations;
use denavit_codegen::function::FunctionName::BaseRegressor;

/// (robot, base parameters, multiplications, additions).
const BEST_KNOWN: [(&str, usize, usize, usize); 8] = [
    ("planar_2r", 6, 16, 10),
    ("puma560", 36, 383, 282),
    ("rx90", 36, 356, 256),
    ("iiwa", 43, 623, 433),
    ("general_6r", 38, 774, 568),
    ("tulip_leg5", 29, 290, 215),
    ("tulip_leg6", 36, 404, 304),
    ("tulip", 94, 2450, 1721),
];

#[test]
fn base_regressors_are_at_or_below_the_best_known() {
    for (name, rank, mul, add) in BEST_KNOWN {
        let robot = match name {
            "general_6r" => rigid(fixture("general_6r.json")),
            _ => rigid(load(name)),
        };
        let derivation = derive(&robot, Flavour::Tunable, &[BaseRegressor]).unwrap();
        let function = &derivation.functions[0];
        assert_eq!(function.outputs[0].shape, [robot.degrees_of_freedom(), rank], "{name}");
        let ours = Operations::count(&derivation.dag, &function.entries());
        let text = format!("{name}: {}M {}A, best known {mul}M {add}A", ours.mul, ours.add);
        assert!(ours.mul + ours.add <= mul + add, "{text}");
    }
}
