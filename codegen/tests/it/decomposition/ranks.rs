//! Gauss-Jordan on B: the number of base parameters, and that Coriolis terms change nothing.

use super::{Case, FULL, WITHOUT_CORIOLIS};
use crate::robots::{load, shipped};
use denavit_codegen::expr::text;
use denavit_codegen::fundamental::{
    Basis, DEFAULT_MEMORY_BYTES, Echelon, Expansion, Fraction, echelon,
};
use denavit_codegen::model::{self, Terms};
use denavit_codegen::regressor::{Dependent, RegressorOptions, base_parameters, decompose_robot};
use std::collections::BTreeMap;

fn eliminate(case: &mut Case) -> Echelon {
    let found = case.decompose(&[Basis::Fourier]).remove(0);
    let order: Vec<usize> = (0..found.columns.len()).collect();
    echelon(&mut case.dag, &found, &order).unwrap_or_else(|error| panic!("{error}"))
}

/// B_Eu as text.
fn rows_of(mut case: Case) -> Vec<Vec<(usize, String)>> {
    let found = eliminate(&mut case);
    let row = |row: &BTreeMap<usize, Fraction>| {
        let mut text = |(&column, value): (&usize, &Fraction)| {
            let value = value.to_expr(&mut case.dag);
            (column, text::print(&case.dag, value).to_string())
        };
        row.iter().map(&mut text).collect()
    };
    found.rows.iter().map(row).collect()
}

#[test]
fn b_has_the_rank_of_the_known_base_parameters() {
    for (name, rank) in [
        ("planar_2r", 6),
        ("planar_3r", 9),
        ("scara", 8),
        ("stanford", 33),
        ("puma560", 36),
        ("rx90", 36),
        ("tulip_leg5", 29),
        ("tulip_leg6", 36),
        ("iiwa", 43),
    ] {
        assert_eq!(eliminate(&mut Case::new(name, WITHOUT_CORIOLIS)).rank(), rank, "{name}");
    }
    // 10 for the torso and 7 for each joint
    assert_eq!(eliminate(&mut Case::torso("tulip", WITHOUT_CORIOLIS)).rank(), 94);
}

#[test]
fn coriolis_terms_add_no_relation_and_take_none() {
    for name in [
        "double_pendulum",
        "planar_2r",
        "planar_3r",
        "scara",
        "stanford",
        "puma560",
        "rx90",
        "tulip_leg",
        "tulip_leg5",
        "tulip_leg6",
    ] {
        let (without, full) = (Case::new(name, WITHOUT_CORIOLIS), Case::new(name, FULL));
        assert_eq!(rows_of(without), rows_of(full), "{name}");
    }
}

/// What all columns of a robot are in the kept ones, by the structure of its tree: proved
/// relations, with the rank that the torques have modulo a prime.
fn relations_of(name: &str, coriolis: bool) -> (Vec<usize>, Vec<(String, String)>) {
    let mut robot = load(name);
    robot.terms = Terms { coriolis, ..robot.terms };
    let options = RegressorOptions::default();
    let found = base_parameters(&robot, options, &[]).unwrap_or_else(|error| panic!("{error}"));
    let relation = |dependent: &Dependent| {
        (found.name(dependent.column).to_owned(), found.text(dependent.expression))
    };
    let relations = found.dependent.iter().map(relation).collect();
    (found.parameters.iter().map(|parameter| parameter.column).collect(), relations)
}

/// D qdd + G alone has the null space of the full model, on every robot that is shipped.
#[test]
fn the_null_space_without_coriolis_terms_is_that_of_the_full_model() {
    for name in shipped() {
        let (without, full) = (relations_of(&name, false), relations_of(&name, true));
        assert!(!full.0.is_empty(), "{name}");
        assert_eq!(without, full, "{name}");
    }
}

/// Twists of 0.31, 0.47 and 0.7853 rad are multiples of 0.0001 rad, but not small ones: each has
/// a cosine and a sine of its own. A first axis along gravity has 1 base parameter, any other
/// joint 7.
#[test]
fn twists_that_are_numbers_are_generic() {
    let link = |name: &str, row: &str| {
        format!(
            r#"{{"name": "{name}", "joint": {{"type": "revolute", {row}}}, "body": {{"mass": 1,
                "com": [0.1, 0, 0], "inertia": {{"xx": 0.01, "yy": 0.01, "zz": 0.01}},
                "about": "com"}}}}"#
        )
    };
    let links = [
        link("one", r#""alpha": 0.31, "a": "l""#),
        link("two", r#""alpha": 0.47, "a": "l""#),
        link("three", r#""alpha": 0.7853, "d": "l""#),
        link("four", r#""alpha": 0"#),
    ];
    let file = format!(
        r#"{{"format": "denavit-model/1", "name": "skew", "convention": "standard",
            "gravity": [0, 0, "-g"],
            "constants": {{"l": {{"value": 0.3, "unit": "m"}},
                           "g": {{"value": 9.81, "unit": "m/s^2"}}}},
            "links": [{}]}}"#,
        links.join(", ")
    );
    let mut robot = model::read("skew.json", file.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    robot.terms.coriolis = false;
    let options = RegressorOptions::default();
    let expansion = &mut Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
    let mut found = decompose_robot(&robot, options, &[Basis::Fourier], expansion)
        .unwrap_or_else(|error| panic!("{error}"));
    let decomposition = found.decompositions.remove(0);
    let theta = found.theta(&decomposition, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(theta.rank(), 1 + 7 * 3);
    let base = base_parameters(&robot, options, &[]).unwrap_or_else(|error| panic!("{error}"));
    let kept: Vec<usize> = base.parameters.iter().map(|parameter| parameter.column).collect();
    assert_eq!(theta.echelon.pivots, kept);
}
