//! The emitted base regressor and base parameters, on the joint axes: against the torques, and
//! against the columns of R0 that the list keeps, which are derived in link frames.

use super::{INERTIAL, Row, base, rigid, tree};
use crate::robots::{fixture, load, shipped};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::expr::{Dag, ExprId, Residues, evaluate, text};
use denavit_codegen::function::{Function, FunctionName};
use denavit_codegen::fundamental::equal;
use denavit_codegen::model::{Robot, Terms};
use denavit_codegen::number::Residue;
use denavit_codegen::regressor::functions::modelled;
use denavit_codegen::regressor::{RegressorOptions, base_parameters, joint_basis};

fn values(dag: &Dag, exprs: &[ExprId], seed: u64) -> Vec<Residue> {
    evaluate(dag, exprs, &mut Residues::new(seed)).unwrap()
}

fn dot(a: &[Residue], b: &[Residue]) -> Residue {
    a.iter().zip(b).fold(Residue::ZERO, |sum, (&a, &b)| sum + a * b)
}

/// The emitted functions of a name, with the graph that holds them.
fn derived(robot: &Robot, flavour: Flavour, name: FunctionName) -> (Dag, Function) {
    let mut derivation = derive(robot, flavour, &[name]).unwrap();
    (derivation.dag, derivation.functions.remove(0))
}

/// As they are; without drives; without Coriolis terms; some of them at rest.
fn variants(name: &str) -> Vec<Robot> {
    let robot = load(name);
    let plain = rigid(robot.clone());
    let with = |terms| Robot { terms, ..plain.clone() };
    let slow = with(Terms { coriolis: false, ..plain.terms });
    let still = with(Terms { inertia: false, ..slow.terms });
    let is_simple_at_rest = ["puma560", "planar_3r", "tulip_leg5"].contains(&name);
    let still = is_simple_at_rest.then_some(still);
    [robot, plain.clone(), slow].into_iter().chain(still).collect()
}

/// Y theta + known = tau, with as many columns as the rank.
fn regressor_is_the_torque(robot: &Robot, flavour: Flavour) {
    let (dag, regressor) = derived(robot, flavour, FunctionName::BaseRegressor);
    let (of_values, parameters) = derived(robot, flavour, FunctionName::BaseParameters);
    let rank = parameters.entries().len();
    assert_eq!(regressor.outputs[0].shape, [robot.degrees_of_freedom(), rank]);
    assert_eq!(parameters.outputs[0].shape, [rank]);
    assert!(parameters.arguments.is_empty());
    let (inverse, torques) = derived(robot, flavour, FunctionName::InverseDynamics);
    for seed in [5, 6] {
        let entries = values(&dag, &regressor.outputs[0].entries, seed);
        let theta = values(&of_values, &parameters.entries(), seed);
        let mut sum: Vec<_> = entries.chunks(rank).map(|row| dot(row, &theta)).collect();
        if let Some(known) = regressor.outputs.get(1) {
            let known = values(&dag, &known.entries, seed);
            sum = sum.iter().zip(known).map(|(&a, b)| a + b).collect();
        }
        let expected = values(&inverse, &torques.entries(), seed);
        assert_eq!(sum, expected, "{} {:?} {flavour}", robot.name, robot.terms);
    }
}

#[test]
fn base_regressor_times_base_parameters_is_the_torque() {
    for robot in shipped().iter().flat_map(|name| variants(name)) {
        let (_, parameters) = derived(&robot, Flavour::Tunable, FunctionName::BaseParameters);
        assert_eq!(parameters.entries().len(), base(&robot, modelled(&robot)).rank());
        regressor_is_the_torque(&robot, Flavour::Tunable);
        regressor_is_the_torque(&robot, Flavour::Sparse);
    }
}

/// Kept columns of R0 = (columns on the axes) T, where T is the change of basis: if it were wrong
/// in one entry, a column would differ. And phi = T theta.
fn change_is_exact(robot: &Robot, options: RegressorOptions, seed: u64) {
    let mut found = base_parameters(robot, options, &[]).unwrap();
    let joints = joint_basis(&mut found, robot).unwrap();
    assert_eq!(joints.len(), found.rank(), "{}", robot.name);
    let dag = &found.regressor.dag;
    let matrix: Vec<Vec<Residue>> = joints
        .iter()
        .map(|parameter| {
            let factors: Vec<_> = parameter.of_kept.iter().map(|&(_, factor)| factor).collect();
            let mut row = vec![Residue::ZERO; found.rank()];
            for (&(kept, _), value) in parameter.of_kept.iter().zip(values(dag, &factors, seed)) {
                row[kept] = value;
            }
            row
        })
        .collect();
    let listed: Vec<_> = found.parameters.iter().map(|parameter| parameter.value).collect();
    let ours: Vec<_> = joints.iter().map(|parameter| parameter.value).collect();
    let (listed, ours) = (values(dag, &listed, seed), values(dag, &ours, seed));
    for (row, &value) in matrix.iter().zip(&ours) {
        assert_eq!(dot(row, &listed), value, "{}", robot.name);
    }
    // With values that know nothing of each other, so that no factor is left out.
    let free: Vec<Residue> =
        (0..found.regressor.columns.len()).map(|c| Residue::scrambled(seed, c as u64)).collect();
    let by_columns = |members: &[(usize, ExprId)]| {
        let factors: Vec<_> = members.iter().map(|&(_, factor)| factor).collect();
        let factors = values(dag, &factors, seed);
        let chosen: Vec<_> = members.iter().map(|&(column, _)| free[column]).collect();
        dot(&factors, &chosen)
    };
    let listed: Vec<_> = found.parameters.iter().map(|p| by_columns(&p.members)).collect();
    for (row, parameter) in matrix.iter().zip(&joints) {
        let name = &parameter.name;
        assert_eq!(dot(row, &listed), by_columns(&parameter.members), "{} {name}", robot.name);
    }
    if options != modelled(robot) {
        return;
    }
    let (graph, regressor) = derived(robot, Flavour::Tunable, FunctionName::BaseRegressor);
    let entries = values(&graph, &regressor.outputs[0].entries, seed);
    let kept: Vec<usize> = found.parameters.iter().map(|parameter| parameter.column).collect();
    for (joint, row) in entries.chunks(found.rank()).enumerate() {
        for (place, &column) in kept.iter().enumerate() {
            let along: Vec<_> = matrix.iter().map(|row| row[place]).collect();
            let own = found.regressor.columns[column].entries[joint];
            let expected = values(dag, &[own], seed)[0];
            assert_eq!(dot(row, &along), expected, "{} {}", robot.name, found.name(column));
        }
    }
}

#[test]
fn the_change_of_basis_is_exact_on_every_robot() {
    let all = RegressorOptions { friction: true, rotor: true, offset: true, ..INERTIAL };
    let skew = rigid(fixture("general_6r.json"));
    let robots = shipped().into_iter().flat_map(|name| variants(&name));
    for robot in robots.chain([skew]) {
        for options in [INERTIAL, all, modelled(&robot)] {
            change_is_exact(&robot, options, 8);
        }
    }
}

/// Slides across and along, axes along gravity, several children, a body on a fixed row.
#[test]
fn special_geometry_has_a_basis_too() {
    let all = RegressorOptions { friction: true, rotor: true, offset: true, ..INERTIAL };
    let (turn, slide) = ("revolute", "prismatic");
    let lists: [&[Row<'_>]; 5] = [
        &[
            (turn, "a", "0", "0", None),
            (turn, "b", "0", "0", Some(0)),
            (slide, "0", "0", "0", Some(1)),
        ],
        &[
            (slide, "0", "pi/2", "0", None),
            (slide, "0", "pi/2", "0", Some(0)),
            (turn, "a", "0", "d", Some(1)),
        ],
        &[
            (turn, "a", "pi/2", "0", None),
            (slide, "0", "pi/2", "0", Some(0)),
            (turn, "b", "0", "0", Some(1)),
        ],
        &[
            (turn, "a", "pi/2", "d", None),
            (turn, "b", "0", "0", Some(0)),
            (turn, "b", "pi/2", "c", Some(0)),
            (slide, "c", "0", "0", Some(0)),
            (turn, "0", "0", "0", Some(3)),
        ],
        &[
            ("fixed", "a", "al", "d", None),
            (turn, "b", "al", "0", Some(0)),
            (turn, "0", "0", "0", Some(1)),
        ],
    ];
    for gravity in [["0", "0", "-g"], ["0", "-g", "0"], ["0", "0", "0"]] {
        for rows in lists {
            let robot = tree("special", gravity, rows);
            for options in [INERTIAL, all, modelled(&robot)] {
                change_is_exact(&robot, options, 9);
            }
        }
    }
}

/// Khalil and Dombre's grouped parameters of RX-90. They hand on so much that Iyy becomes 0, here
/// Kzz does: theirs is Kxx more. So their Ixx is our Kyy - Kxx, their Izz our Kxx + Kyy, and what
/// is carried has left Kxx more with a carrier whose axis is not parallel.
#[test]
fn rx90_agrees_with_the_closed_forms_of_khalil_and_dombre() {
    let robot = rigid(load("rx90"));
    let mut found = base(&robot, INERTIAL);
    let joints = joint_basis(&mut found, &robot).unwrap();
    assert_eq!(joints.len(), 36);
    let dag = &mut found.regressor.dag;
    for (signs, theirs) in [
        ("sx_j2", "mx_j2 + D3*(m_j3 + m_j4 + m_j5 + m_j6)"),
        ("sy_j2", "my_j2"),
        ("-Kxy_j2", "Ixy_j2"),
        ("-Kxz_j2", "Ixz_j2 - D3*mz_j3"),
        ("Kyy_j2 - Kxx_j2", "Ixx_j2 - Iyy_j2 - D3^2*(m_j3 + m_j4 + m_j5 + m_j6)"),
        ("Kyy_j2 + Kxx_j2", "Izz_j2 + D3^2*(m_j3 + m_j4 + m_j5 + m_j6)"),
        ("sy_j3", "my_j3 + mz_j4 + RL4*(m_j4 + m_j5 + m_j6)"),
        ("Kyy_j3 + Kxx_j3 + Kxx_j4", "Izz_j3 + Iyy_j4 + 2*RL4*mz_j4 + RL4^2*(m_j4 + m_j5 + m_j6)"),
        ("Kyy_j4 - Kxx_j4 + Kxx_j5", "Ixx_j4 + Iyy_j5 - Iyy_j4"),
        ("Kyy_j5 + Kxx_j5 + Kxx_j6", "Izz_j5 + Iyy_j6"),
        ("sy_j5", "my_j5 + mz_j6"),
        ("Kyy_j6 - Kxx_j6", "Ixx_j6 - Iyy_j6"),
    ] {
        let ours = parse(dag, signs, &|name| {
            joints.iter().find(|parameter| parameter.name == name).map(|one| one.expression)
        });
        let theirs = parse(dag, theirs, &|_| None);
        assert!(equal(dag, ours, theirs).unwrap(), "{signs}");
    }
}

fn parse(dag: &mut Dag, formula: &str, given: &dyn Fn(&str) -> Option<ExprId>) -> ExprId {
    let resolve = &mut |dag: &mut Dag, name: &str| {
        given(name).or_else(|| dag.find_symbol(name).map(|id| dag.symbol_expr(id)))
    };
    text::parse(dag, formula, resolve).unwrap_or_else(|error| panic!("{formula}: {error}"))
}
