//! Base parameters against formulas that others derived: RX-90 by hand, the thesis's table 3.6.

use super::{INERTIAL, base, rigid};
use crate::robots::load;
use denavit_codegen::expr::{Dag, ExprId, text};
use denavit_codegen::fundamental::equal;
use denavit_codegen::model::Terms;
use denavit_codegen::regressor::{BaseParameters, Regressor, RegressorOptions, base_parameters};

fn parse(dag: &mut Dag, formula: &str) -> ExprId {
    let resolve = &mut |dag: &mut Dag, name: &str| {
        let id = dag.find_symbol(name)?;
        Some(dag.symbol_expr(id))
    };
    text::parse(dag, formula, resolve).unwrap_or_else(|error| panic!("{formula}: {error}"))
}

/// Khalil and Dombre's grouped parameters, second moments and first moments of links 1 to 6.
const RX90: [(&str, &str); 16] = [
    ("Izz_j1", "Izz_j1 + Iyy_j2 + Iyy_j3 + D3^2*(m_j3 + m_j4 + m_j5 + m_j6)"),
    ("Ixx_j2", "Ixx_j2 - Iyy_j2 - D3^2*(m_j3 + m_j4 + m_j5 + m_j6)"),
    ("Ixy_j2", "Ixy_j2"),
    ("Ixz_j2", "Ixz_j2 - D3*mz_j3"),
    ("Izz_j2", "Izz_j2 + D3^2*(m_j3 + m_j4 + m_j5 + m_j6)"),
    ("mx_j2", "mx_j2 + D3*(m_j3 + m_j4 + m_j5 + m_j6)"),
    ("Ixx_j3", "Ixx_j3 - Iyy_j3 + Iyy_j4 + 2*RL4*mz_j4 + RL4^2*(m_j4 + m_j5 + m_j6)"),
    ("Izz_j3", "Izz_j3 + Iyy_j4 + 2*RL4*mz_j4 + RL4^2*(m_j4 + m_j5 + m_j6)"),
    ("my_j3", "my_j3 + mz_j4 + RL4*(m_j4 + m_j5 + m_j6)"),
    ("Ixx_j4", "Ixx_j4 + Iyy_j5 - Iyy_j4"),
    ("Izz_j4", "Izz_j4 + Iyy_j5"),
    ("my_j4", "my_j4 - mz_j5"),
    ("Ixx_j5", "Ixx_j5 + Iyy_j6 - Iyy_j5"),
    ("Izz_j5", "Izz_j5 + Iyy_j6"),
    ("my_j5", "my_j5 + mz_j6"),
    ("Ixx_j6", "Ixx_j6 - Iyy_j6"),
];

#[test]
fn rx90_has_the_closed_forms_of_khalil_and_dombre() {
    let robot = rigid(load("rx90"));
    let kept = ["Ixx", "Ixy", "Ixz", "Iyz", "Izz", "mx", "my"];
    let keep: Vec<String> =
        (1..=6).flat_map(|j| kept.iter().map(move |name| format!("{name}_j{j}"))).collect();
    let mut found = base_parameters(&robot, INERTIAL, &keep).unwrap();
    assert_eq!(found.rank(), 36);
    for (name, formula) in RX90 {
        let parameter = found.parameters.iter().find(|p| found.name(p.column) == name);
        let ours = parameter.unwrap_or_else(|| panic!("{name} is not kept")).expression;
        let theirs = parse(&mut found.regressor.dag, formula);
        let same = equal(&mut found.regressor.dag, ours, theirs).unwrap();
        assert!(same, "{name}: {}, not {formula}", found.text(ours));
    }
}

/// A column by the factors of its product, in whatever order they are printed.
fn column(regressor: &Regressor, product: &str) -> usize {
    let factors = |name: &str| {
        let mut factors: Vec<String> = name.split('*').map(str::to_owned).collect();
        factors.sort();
        factors
    };
    let mut columns = regressor.columns.iter();
    columns.position(|column| factors(&column.name) == factors(product)).expect(product)
}

/// The order of table 3.6: what is kept first.
const TABLE: [&str; 17] = [
    "c6x^2*m6", "c6x*m6", "m6", "c5x^2*m5", "c5x*m5", "c4x^2*m4", "c4x*m4", "c3z^2*m3", "m3",
    "I6y", "I5z", "I4z", "I2y", "I3y", "m5", "m4", "c3z*m3",
];

fn relation_is(found: &mut BaseParameters, product: &str, expected: &[(&str, &str)]) {
    let own = column(&found.regressor, product);
    let dependent = found.dependent.iter().find(|d| d.column == own).expect(product).clone();
    assert_eq!(dependent.relation.len(), expected.len(), "{product}");
    for (name, factor) in expected {
        let other = column(&found.regressor, name);
        let (_, ours) = dependent.relation.iter().find(|(c, _)| *c == other).expect(name);
        let theirs = parse(&mut found.regressor.dag, factor);
        assert!(equal(&mut found.regressor.dag, *ours, theirs).unwrap(), "{product}: {name}");
    }
}

#[test]
fn table_3_6_of_the_thesis_comes_out() {
    for coriolis in [true, false] {
        let mut robot = rigid(load("tulip_leg"));
        robot.terms = Terms { coriolis, ..robot.terms };
        let regressor = Regressor::new(&robot, INERTIAL, robot.torque_side).unwrap();
        assert_eq!(regressor.columns.len(), 17);
        let names = |product: &&str| regressor.columns[column(&regressor, product)].name.clone();
        let keep: Vec<String> = TABLE.iter().map(names).collect();
        let mut found = base_parameters(&robot, INERTIAL, &keep).unwrap();
        assert_eq!(found.rank(), 14);
        let m5 = [("c6x^2*m6", "a11^2"), ("c6x*m6", "a11"), ("m6", "1")];
        relation_is(&mut found, "m5", &m5);
        let m4 = [&m5[..], &[("c5x^2*m5", "a10^2"), ("c5x*m5", "a10")]].concat();
        relation_is(&mut found, "m4", &m4);
        let c3z = [
            ("c6x^2*m6", "a11^2/d9"),
            ("c6x*m6", "a11/d9"),
            ("m6", "1/d9"),
            ("c5x^2*m5", "a10^2/d9"),
            ("c5x*m5", "a10/d9"),
            ("c4x^2*m4", "a9^2/d9"),
            ("c4x*m4", "a9/d9"),
            ("c3z^2*m3", "-d9"),
            ("m3", "-1/d9"),
        ];
        relation_is(&mut found, "c3z*m3", &c3z);
    }
}

#[test]
fn the_pendulum_of_the_thesis_has_four_base_parameters() {
    let robot = load("double_pendulum");
    let found = base(&robot, INERTIAL);
    assert_eq!(found.rank(), 4);
    let friction = RegressorOptions { friction: true, ..INERTIAL };
    assert_eq!(base(&robot, friction).rank(), 8);
}
