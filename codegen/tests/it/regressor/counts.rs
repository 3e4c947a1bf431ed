//! Operations of the regressors, against the best known of the prototypes and as recorded.

use super::rigid;
use crate::robots::{fixture, load, repository};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::expr::Operations;
use denavit_codegen::function::FunctionName::{self, BaseRegressor, Regressor};
use denavit_codegen::model::{self, Robot};
use serde_json::Value;

/// (robot, joints and cumulated angles that may turn, base parameters, multiplications + additions
/// of the regressor, of the base regressor): the best of the prototypes, whose columns are entries
/// of pseudo-inertias in frames on the joint axes.
const BEST_KNOWN: [(&str, usize, usize, usize, usize); 8] = [
    ("planar_2r", 3, 6, 29, 26),
    ("puma560", 7, 36, 847, 665),
    ("rx90", 7, 36, 778, 612),
    ("iiwa", 7, 43, 1344, 1056),
    ("general_6r", 6, 38, 1598, 1342),
    ("tulip_leg5", 7, 29, 642, 505),
    ("tulip_leg6", 8, 36, 911, 708),
    ("tulip", 19, 94, 5543, 4171),
];

/// Columns, multiplications and additions, sines.
fn count(robot: &Robot, function: FunctionName) -> (usize, usize, usize) {
    let derivation = derive(robot, Flavour::Tunable, &[function]).unwrap();
    let function = &derivation.functions[0];
    let ours = Operations::count(&derivation.dag, &function.entries());
    (function.outputs[0].shape[1], ours.mul + ours.add, ours.sincos)
}

fn robot(name: &str) -> Robot {
    match name {
        "general_6r" => rigid(fixture("general_6r.json")),
        _ => rigid(load(name)),
    }
}

#[test]
fn regressors_are_at_or_below_the_best_known() {
    for (name, angles, _, known, _) in BEST_KNOWN {
        let (_, ours, sincos) = count(&robot(name), Regressor);
        assert!(sincos <= angles, "{name}: {sincos}");
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

/// The same two arms with the frames of modified rows, which are on the axes: the columns that
/// were counted.
#[test]
fn regressors_in_frames_on_the_axes_are_at_or_below_the_best_known() {
    for (name, known) in [("planar_2r", 29), ("general_6r", 1598)] {
        let path = match name {
            "general_6r" => "codegen/tests/fixtures/general_6r.json",
            _ => "models/planar_2r.json",
        };
        let text = std::fs::read(repository().join(path)).unwrap();
        let mut file: Value = serde_json::from_slice(&text).unwrap();
        file["convention"] = "modified".into();
        let links = file["links"].as_array_mut().unwrap();
        // a and alpha of a standard row are those of the next modified one.
        for row in (0..links.len()).rev() {
            for key in ["a", "alpha"] {
                let before = match row {
                    0 => Value::from(0),
                    _ => links[row - 1]["joint"].get(key).cloned().unwrap_or(0.into()),
                };
                links[row]["joint"][key] = before;
            }
        }
        let robot = model::read(name, &serde_json::to_vec(&file).unwrap()).unwrap();
        let (_, ours, _) = count(&robot, Regressor);
        assert!(ours <= known, "{name}: {ours}, best known {known}");
    }
}

#[test]
fn base_regressors_are_at_or_below_the_best_known() {
    for (name, angles, rank, _, known) in BEST_KNOWN {
        let (columns, ours, sincos) = count(&robot(name), BaseRegressor);
        assert_eq!(columns, rank, "{name}");
        assert!(sincos <= angles, "{name}: {sincos}");
        assert!(ours <= known, "{name}: {ours}, best known {known}");
    }
}
