//! Agreement of the methods on a tree that has every kind of joint, body, spring and drive.

use super::linear::{add_lists, apply_rows, inner};
use super::{Method, MethodResult, derive, newton_euler};
use crate::arena::Handle;
use crate::expr::{Dag, ExprId, Residues, evaluate, free_symbols, substitute};
use crate::model::{Convention, JointKind, JointVariables, Robot, Terms, read};
use crate::number::Residue;
use crate::spatial::{Vector, cross, dot};
use rustc_hash::FxHashMap;

const SEEDS: [u64; 4] = [1, 2, 3, 4];

/// A turning trunk with two branches: one slides, ends in a fixed link and turns again; the other
/// turns and slides. All entries are symbols.
fn tree_robot(convention: Convention) -> Robot {
    let file = include_str!("../../../tests/fixtures/every_joint.json");
    let robot = read("every_joint.json", file.as_bytes()).expect("the file has no faults");
    Robot { convention, ..robot }
}

fn values(dag: &Dag, outputs: &[ExprId], seed: u64) -> Vec<Residue> {
    evaluate(dag, outputs, &mut Residues::new(seed)).expect("no division by zero here")
}

/// All entries of a result, in one list.
fn entries(result: &MethodResult) -> Vec<ExprId> {
    [
        result.mass_matrix.concat(),
        result.coriolis_matrix.concat(),
        result.gravity.clone(),
        result.drive_torque.clone(),
        result.inverse_dynamics.clone(),
    ]
    .concat()
}

#[test]
fn the_methods_agree_on_every_kind_of_joint_in_both_conventions() {
    for convention in [Convention::Standard, Convention::Modified] {
        let robot = tree_robot(convention);
        let mut dag = robot.dag.clone();
        let results = Method::ALL.map(|method| derive(&mut dag, &robot, method));
        for seed in SEEDS {
            let [first, others @ ..] =
                &results.each_ref().map(|result| values(&dag, &entries(result), seed));
            assert!(first.iter().filter(|value| **value != Residue::ZERO).count() > 40);
            for (other, method) in others.iter().zip(&Method::ALL[1..]) {
                assert_eq!(first, other, "{method} differs, {convention:?}");
            }
        }
    }
}

/// D qdd + C qd + G and what the drives ask for.
fn sum_of_terms(dag: &mut Dag, robot: &Robot, result: &MethodResult) -> Vec<ExprId> {
    let pick = |pick: fn(&JointVariables) -> ExprId| -> Vec<ExprId> {
        robot.joints().map(|(_, variables)| pick(variables)).collect()
    };
    let (qd, qdd) = (pick(|joint| joint.qd), pick(|joint| joint.qdd));
    let accelerated = apply_rows(dag, &result.mass_matrix, &qdd);
    let moving = apply_rows(dag, &result.coriolis_matrix, &qd);
    [moving, result.gravity.clone(), result.drive_torque.clone()]
        .iter()
        .fold(accelerated, |sum, part| add_lists(dag, &sum, part))
}

#[test]
fn inverse_dynamics_is_the_sum_of_its_terms() {
    let robot = tree_robot(Convention::Standard);
    let mut dag = robot.dag.clone();
    for method in Method::ALL {
        let result = derive(&mut dag, &robot, method);
        let sum = sum_of_terms(&mut dag, &robot, &result);
        for seed in SEEDS {
            let expected = values(&dag, &sum, seed);
            assert_eq!(values(&dag, &result.inverse_dynamics, seed), expected, "{method}");
        }
    }
}

#[test]
fn a_model_without_a_term_has_zeros_in_its_place() {
    let all = Terms::ALL;
    let cases = [
        Terms { inertia: false, rotor: false, ..all },
        Terms { coriolis: false, ..all },
        Terms { gravity: false, ..all },
        Terms { friction: false, ..all },
        Terms { rotor: false, ..all },
        Terms { spring: false, ..all },
    ];
    for terms in cases {
        let robot = Robot { terms, ..tree_robot(Convention::Standard) };
        let mut dag = robot.dag.clone();
        for method in Method::ALL {
            let result = derive(&mut dag, &robot, method);
            let vanishes = |part: &[ExprId]| part.iter().all(|&entry| entry == dag.zero());
            assert_eq!(vanishes(&result.mass_matrix.concat()), !terms.inertia, "{method}");
            assert_eq!(vanishes(&result.coriolis_matrix.concat()), !terms.coriolis, "{method}");
            assert_eq!(vanishes(&result.gravity), !terms.gravity, "{method}");
            let sum = sum_of_terms(&mut dag, &robot, &result);
            let [torque, sum] =
                [&result.inverse_dynamics, &sum].map(|list| values(&dag, list, SEEDS[0]));
            assert_eq!(torque, sum, "{method}, {terms:?}");
            let classes = |wanted: &str| {
                let symbols = free_symbols(&dag, &result.inverse_dynamics);
                symbols.iter().any(|&id| dag.symbols()[id].name.starts_with(wanted))
            };
            assert_eq!(classes("Ia_"), terms.rotor, "{method}");
            assert_eq!(classes("fc_"), terms.friction, "{method}");
            assert_eq!(classes("gx"), terms.gravity, "{method}");
            assert_eq!(classes("ks_"), terms.spring, "{method}");
        }
    }
}

#[test]
fn the_constrained_equations_have_the_eliminated_solution() {
    for convention in [Convention::Standard, Convention::Modified] {
        let robot = tree_robot(convention);
        let mut dag = robot.dag.clone();
        let solution = newton_euler::eliminate(&mut dag, &robot);
        let equations = newton_euler::dae(&mut dag, &robot);

        let mut state = FxHashMap::default();
        for (body, motion) in equations.bodies.iter().zip(&solution.motions) {
            let pairs = body.position.into_iter().zip(motion.position);
            let pairs = pairs.chain(body.velocity.into_iter().zip(motion.velocity));
            let spins = body.angular_velocity.into_iter().zip(motion.angular_velocity);
            let turns = body.rotation.into_iter().flatten();
            let pairs = pairs.chain(spins);
            state.extend(pairs.chain(turns.zip(motion.rotation.concat())));
        }
        for (link, variables) in robot.joints() {
            let wrench = solution.wrenches[link.index()];
            let slides = robot.links[link].joint.kind == JointKind::Prismatic;
            let effort = if slides { wrench.force } else { wrench.moment };
            state.insert(variables.tau, dot(&mut dag, wrench.axis, effort));
        }
        let velocities: Vec<ExprId> = solution
            .motions
            .iter()
            .flat_map(|motion| [motion.velocity, motion.angular_velocity].concat())
            .collect();
        let accelerations: Vec<ExprId> = solution
            .motions
            .iter()
            .flat_map(|motion| [motion.acceleration, motion.angular_acceleration].concat())
            .collect();
        let multipliers = multipliers(&mut dag, &robot, &solution);

        let at = |dag: &mut Dag, list: &[ExprId]| substitute(dag, list, &state);
        let rows = |dag: &mut Dag, rows: &[Vec<ExprId>]| -> Vec<Vec<ExprId>> {
            let width = rows[0].len();
            at(dag, &rows.concat()).chunks(width).map(<[ExprId]>::to_vec).collect()
        };
        let residuals = at(&mut dag, &equations.constraints);
        let jacobian = rows(&mut dag, &equations.constraint_jacobian);
        let rates = apply_rows(&mut dag, &jacobian, &velocities);
        let second = apply_rows(&mut dag, &jacobian, &accelerations);
        let bias = at(&mut dag, &equations.constraint_bias);
        let mass_matrix = rows(&mut dag, &equations.mass_matrix);
        let inertial = apply_rows(&mut dag, &mass_matrix, &accelerations);
        let forces = at(&mut dag, &equations.forces);
        let held: Vec<ExprId> = (0..velocities.len())
            .map(|column| {
                let entries: Vec<_> = jacobian.iter().map(|row| row[column]).collect();
                inner(&mut dag, &entries, &multipliers)
            })
            .collect();
        let supplied = add_lists(&mut dag, &forces, &held);

        assert_eq!(multipliers.len(), 5 * 5 + 6);
        for seed in SEEDS {
            let zeros = vec![Residue::ZERO; residuals.len()];
            assert_eq!(values(&dag, &residuals, seed), zeros, "position level, {convention:?}");
            assert_eq!(values(&dag, &rates, seed), zeros, "velocity level, {convention:?}");
            assert_eq!(values(&dag, &second, seed), values(&dag, &bias, seed));
            assert_ne!(values(&dag, &bias, seed), zeros);
            let [left, right] = [&inertial, &supplied].map(|side| values(&dag, side, seed));
            assert_eq!(left, right, "balance of forces, {convention:?}");
        }
    }
}

/// The multipliers that belong to the joint wrenches: components across the free direction.
fn multipliers(dag: &mut Dag, robot: &Robot, solution: &newton_euler::Elimination) -> Vec<ExprId> {
    let mut multipliers = Vec::new();
    for (id, link) in robot.links.iter() {
        let wrench = solution.wrenches[id.index()];
        let rotation = solution.motions[id.index()].rotation;
        let column = |k: usize| -> Vector { [0, 1, 2].map(|row| rotation[row][k]) };
        // two directions across the axis, fixed in the parent
        let first = match (robot.convention, link.parent) {
            (_, None) => [dag.one(), dag.zero(), dag.zero()],
            (_, Some(parent)) => {
                let parent = solution.motions[parent.index()].rotation;
                [0, 1, 2].map(|row| parent[row][0])
            }
        };
        let second = cross(dag, wrench.axis, first);
        match link.joint.kind {
            JointKind::Prismatic => {
                multipliers.push(dot(dag, first, wrench.force));
                multipliers.push(dot(dag, second, wrench.force));
            }
            JointKind::Revolute | JointKind::Fixed => multipliers.extend(wrench.force),
        }
        if link.joint.kind == JointKind::Revolute {
            // the residual's rate is w . (axis x direction)
            multipliers.push(dot(dag, second, wrench.moment));
            let along = dot(dag, first, wrench.moment);
            multipliers.push(dag.neg(along));
        } else {
            // the residual of columns (i, j) has the rate w . column k, (i, j, k) cyclic
            multipliers.extend([2, 0, 1].map(|k| dot(dag, column(k), wrench.moment)));
        }
    }
    multipliers
}
