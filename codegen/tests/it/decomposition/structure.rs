//! The thesis's own way, Gauss-Jordan on B (3.3-3.5), against the relations that the structure of
//! the tree gives: two ways that share the columns' definitions and nothing else.

use crate::robots::load;
use denavit_codegen::expr::{Dag, ExprId, text};
use denavit_codegen::fundamental::{Basis, DEFAULT_MEMORY_BYTES, Expansion, equal, smallest};
use denavit_codegen::model::{Robot, Terms};
use denavit_codegen::regressor::{
    RegressorOptions, RobotDecomposition, Theta, base_parameters, decompose_robot,
};

const INERTIAL: RegressorOptions = RegressorOptions {
    friction: false,
    rotor: false,
    offset: false,
    only_modelled: false,
    unknowns: denavit_codegen::regressor::Unknowns::Parameters,
};
const WITH_FRICTION: RegressorOptions = RegressorOptions { friction: true, ..INERTIAL };
const WITH_ROTORS: RegressorOptions = RegressorOptions { rotor: true, ..WITH_FRICTION };
const WITH_OFFSETS: RegressorOptions = RegressorOptions { offset: true, ..WITH_ROTORS };

fn without_coriolis(name: &str) -> Robot {
    let mut robot = load(name);
    robot.terms = Terms { coriolis: false, ..robot.terms };
    robot
}

/// B, eliminated.
fn eliminated(
    robot: &Robot,
    options: RegressorOptions,
    keep: &[String],
) -> (RobotDecomposition, Theta) {
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
    let mut found = decompose_robot(robot, options, &Basis::ALL, &mut expansion)
        .unwrap_or_else(|error| panic!("{error}"));
    let least = smallest(std::mem::take(&mut found.decompositions)).expect("a basis");
    let theta = found.theta(&least, keep).unwrap_or_else(|error| panic!("{error}"));
    found.decompositions.push(least);
    (found, theta)
}

fn read(dag: &mut Dag, source: &str) -> ExprId {
    let mut resolve = |dag: &mut Dag, name: &str| {
        let id = dag.find_symbol(name)?;
        Some(dag.symbol_expr(id))
    };
    text::parse(dag, source, &mut resolve).expect(source)
}

/// Both ways have the same pivots and the same coefficients. Returns columns and rank.
fn agreement(robot: &Robot, options: RegressorOptions, keep: &[String]) -> (usize, usize) {
    let name = &robot.name;
    let (mut found, theta) = eliminated(robot, options, keep);
    let base = base_parameters(robot, options, keep).unwrap_or_else(|error| panic!("{error}"));
    let names = |regressor: &[denavit_codegen::regressor::Column]| -> Vec<String> {
        regressor.iter().map(|column| column.name.clone()).collect()
    };
    assert_eq!(names(&found.columns), names(&base.regressor.columns), "{name}");
    let structural: Vec<usize> = base.parameters.iter().map(|one| one.column).collect();
    assert_eq!(theta.echelon.pivots, structural, "{name}: pivots");
    for dependent in &base.dependent {
        let ours = theta.echelon.relation(dependent.column);
        assert_eq!(ours.len(), dependent.relation.len(), "{name}: {}", base.name(dependent.column));
        for (pivot, factor) in ours {
            let (_, theirs) = dependent.relation.iter().find(|(c, _)| *c == pivot).expect(name);
            let theirs = text::print(&base.regressor.dag, *theirs);
            let (ours, theirs) = (factor.to_expr(&mut found.dag), read(&mut found.dag, &theirs));
            assert_eq!(
                equal(&mut found.dag, ours, theirs),
                Ok(true),
                "{name}: {} in {}",
                base.name(dependent.column),
                base.name(pivot)
            );
        }
    }
    (found.columns.len(), theta.rank())
}

#[test]
fn both_ways_agree_on_legs() {
    for (name, size) in
        [("tulip_leg", (17, 14)), ("tulip_leg5", (50, 29)), ("tulip_leg6", (60, 36))]
    {
        assert_eq!(agreement(&without_coriolis(name), INERTIAL, &[]), size, "{name}");
        let reversed = base_parameters(&load(name), INERTIAL, &[]).unwrap().regressor;
        let reversed: Vec<String> =
            reversed.columns.iter().rev().map(|column| column.name.clone()).collect();
        assert_eq!(agreement(&without_coriolis(name), INERTIAL, &reversed), size, "{name}");
    }
    assert_eq!(agreement(&load("tulip_leg"), INERTIAL, &[]), (17, 14), "with Coriolis terms");
}

#[test]
fn both_ways_agree_on_puma() {
    assert_eq!(agreement(&without_coriolis("puma560"), INERTIAL, &[]), (60, 36));
    // Also with every Coriolis term.
    assert_eq!(agreement(&load("puma560"), INERTIAL, &[]), (60, 36));
}

/// On the torso: the virtual chain of the structural way has the same relations.
#[test]
fn both_ways_agree_on_tulip() {
    let (columns, rank) = agreement(&without_coriolis("tulip"), INERTIAL, &[]);
    assert_eq!((columns, rank), (140, 94));
    let (_, rank) = agreement(&without_coriolis("planar_biped"), INERTIAL, &[]);
    let joints = load("planar_biped").degrees_of_freedom() - 3;
    assert_eq!(rank, 4 + 3 * joints);
}

#[test]
fn both_ways_agree_with_friction_rotors_and_offsets() {
    for (name, options, rank) in [
        ("planar_2r", WITH_OFFSETS, 13),
        ("puma560", WITH_FRICTION, 48),
        ("puma560", WITH_ROTORS, 52),
        ("puma560", WITH_OFFSETS, 58),
        ("tulip_leg6", WITH_OFFSETS, 58),
        ("double_pendulum", INERTIAL, 4),
        ("double_pendulum", WITH_FRICTION, 8),
        ("double_pendulum", WITH_ROTORS, 9),
    ] {
        let mut robot = without_coriolis(name);
        for link in robot.links.values_mut() {
            (link.drive, link.joint.damping) = (None, None);
        }
        assert_eq!(agreement(&robot, options, &[]).1, rank, "{name}");
    }
}

/// Gear ratios and series-elastic drives, as the model has them.
#[test]
fn both_ways_agree_with_drives() {
    for name in ["puma560", "tulip_leg"] {
        let robot = without_coriolis(name);
        assert!(robot.links.values().any(|link| link.drive.is_some()), "{name}");
        agreement(&robot, WITH_OFFSETS, &[]);
    }
}

#[test]
fn a_column_to_keep_that_is_not_there_is_named() {
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
    let robot = load("planar_2r");
    let mut found =
        decompose_robot(&robot, INERTIAL, &[Basis::Product], &mut expansion).expect("small");
    let decomposition = found.decompositions.remove(0);
    let error = found.theta(&decomposition, &["m_link9".to_owned()]).expect_err("no such link");
    assert!(error.to_string().contains("m_link9"), "{error}");
}
