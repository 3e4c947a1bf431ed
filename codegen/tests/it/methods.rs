//! The thesis's four derivations against each other and against the recursions, on shipped robots.

use super::models::{fixture, model};
use denavit_codegen::derive::{Derivation, Flavour, derive as derive_recursively};
use denavit_codegen::dynamics::methods::{Method, MethodResult, derive};
use denavit_codegen::expr::{Dag, ExprId, Residues, evaluate};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::{Convention, Robot};
use denavit_codegen::number::Residue;

const SEEDS: [u64; 3] = [11, 12, 13];

/// D, C, G and inverse dynamics, each with its name.
type Terms = [(&'static str, Vec<ExprId>); 4];

fn terms_of(result: &MethodResult) -> Terms {
    [
        ("mass_matrix", result.mass_matrix.concat()),
        ("coriolis_matrix", result.coriolis_matrix.concat()),
        ("gravity_vector", result.gravity.clone()),
        ("inverse_dynamics", result.inverse_dynamics.clone()),
    ]
}

fn values(dag: &Dag, entries: &[ExprId], seed: u64) -> Vec<Residue> {
    evaluate(dag, entries, &mut Residues::new(seed)).expect("no division by zero")
}

/// The first entry in which two lists differ at some point.
fn first_difference(dag: &Dag, left: &[ExprId], right: &[ExprId]) -> Option<usize> {
    assert_eq!(left.len(), right.len());
    SEEDS.iter().find_map(|&seed| {
        let [left, right] = [left, right].map(|entries| values(dag, entries, seed));
        left.iter().zip(right).position(|(x, y)| *x != y)
    })
}

/// Asserts that all methods agree with the recursions, and so with each other, entry by entry.
fn agree(robot: &Robot) {
    use FunctionName::{CoriolisMatrix, GravityVector, InverseDynamics, MassMatrix};
    let wanted = [MassMatrix, CoriolisMatrix, GravityVector, InverseDynamics];
    let Derivation { mut dag, functions, .. } =
        derive_recursively(robot, Flavour::Tunable, &wanted).expect("nothing to bake");
    let recursive: Vec<_> = functions.iter().map(|function| function.entries()).collect();
    let name = &robot.name;
    for method in Method::ALL {
        let result = derive(&mut dag, robot, method);
        for ((term, ours), theirs) in terms_of(&result).iter().zip(&recursive) {
            let difference = first_difference(&dag, ours, theirs);
            assert_eq!(difference, None, "{name}: entry of {term} by {method}");
        }
    }
    // agreement that everything is zero would say little
    for entries in &recursive {
        let values = values(&dag, entries, SEEDS[0]);
        assert!(values.iter().any(|value| *value != Residue::ZERO), "{name}");
    }
}

#[test]
fn all_methods_agree_with_the_recursions_on_every_kind_of_joint() {
    for convention in [Convention::Standard, Convention::Modified] {
        agree(&Robot { convention, ..fixture("every_joint") });
    }
}

#[test]
fn all_methods_agree_with_the_recursions_on_the_double_pendulum() {
    agree(&model("double_pendulum"));
}

#[test]
fn all_methods_agree_with_the_recursions_on_puma560() {
    agree(&model("puma560"));
}

#[test]
fn all_methods_agree_with_the_recursions_on_the_leg_of_tulip() {
    agree(&model("tulip_leg6"));
}

#[test]
fn all_methods_agree_with_the_recursions_where_joints_slide() {
    agree(&model("scara"));
    agree(&model("stanford"));
}

#[test]
fn all_methods_agree_with_the_recursions_in_modified_frames() {
    agree(&model("rx90"));
}

#[test]
fn all_methods_agree_with_the_recursions_on_a_walker_in_the_plane() {
    agree(&model("planar_biped"));
}

#[test]
fn all_methods_agree_with_the_recursions_on_tulip() {
    agree(&model("tulip"));
}
