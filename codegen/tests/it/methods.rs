//! The thesis's four derivations against each other and against the recursions, on shipped robots.

use super::robots::{fixture, load, shipped};
use denavit_codegen::derive::{Derivation, Flavour, derive as derive_recursively};
use denavit_codegen::dynamics::methods::{Method, MethodResult, derive};
use denavit_codegen::expr::{Dag, ExprId, Residues, evaluate};
use denavit_codegen::function::FunctionName;
use denavit_codegen::fundamental::canonical_all;
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
    // agreement that everything is zero would say little; a horizontal slide has neither Coriolis
    // nor gravity terms
    for (entries, wanted) in recursive.iter().zip(wanted) {
        let values = values(&dag, entries, SEEDS[0]);
        let is_zero = values.iter().all(|value| *value == Residue::ZERO);
        let may_be = name == "emps" && [CoriolisMatrix, GravityVector].contains(&wanted);
        assert_eq!(is_zero, may_be, "{name}: {wanted:?}");
    }
}

#[test]
fn all_methods_agree_with_the_recursions_on_every_kind_of_joint() {
    for convention in [Convention::Standard, Convention::Modified] {
        agree(&Robot { convention, ..fixture("every_joint.json") });
    }
}

#[test]
fn all_methods_are_identical_on_the_double_pendulum_term_by_term() {
    let robot = load("double_pendulum");
    let mut dag = robot.dag.clone();
    let mut forms = |method| {
        let entries = terms_of(&derive(&mut dag, &robot, method)).map(|(_, entries)| entries);
        canonical_all(&mut dag, &entries.concat()).expect("a polynomial of a few terms")
    };
    let [first, others @ ..] = Method::ALL.map(&mut forms);
    // 4 entries of D, 4 of C, 2 of G, 2 torques; C22 alone is 0
    assert_eq!(first.iter().filter(|form| form.is_zero()).count(), 1);
    for (other, method) in others.iter().zip(&Method::ALL[1..]) {
        assert_eq!(*other, first, "{method}");
    }
}

#[test]
fn all_methods_agree_with_the_recursions_on_every_shipped_robot() {
    let names = shipped();
    for name in ["puma560", "tulip", "tulip_leg6"] {
        assert!(names.iter().any(|shipped| shipped == name), "{name}");
    }
    names.iter().for_each(|name| agree(&load(name)));
}
