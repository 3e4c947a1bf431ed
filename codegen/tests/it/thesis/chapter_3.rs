//! Chapter 3: the trajectories of identification and the tables of what was identified.

use crate::robots::load;
use denavit_codegen::expr::{Dag, ExprId, Floats, evaluate, text};
use denavit_codegen::fundamental::{Basis, DEFAULT_MEMORY_BYTES, Expansion, equal, smallest};
use denavit_codegen::model::equations::read;
use denavit_codegen::number::{parse_decimal, to_f64};
use denavit_codegen::regressor::equations::equations_regressor;
use denavit_codegen::regressor::{
    RegressorOptions, RobotDecomposition, Theta, base_parameters, decompose_robot,
};

/// q_j = sum of a_i sin(..) + b_i: the offsets are one column.
#[test]
fn eq_3_10_has_more_offsets_than_can_be_found() {
    let source = br#"{"format": "denavit-equations/1", "name": "trajectory",
 "variables": {"q": {}, "wt": {}},
 "unknowns": {"a1": {}, "a2": {}, "b1": {}, "b2": {}},
 "equations": ["q = a1*sin(wt) + b1 + a2*sin(2*wt) + b2"]}"#;
    let equations = read("trajectory.json", source).unwrap_or_else(|error| panic!("{error}"));
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
    let found = equations_regressor(&equations, Basis::Fourier, &mut expansion).expect("linear");
    assert_eq!(found.column_names(), ["a1", "a2", "b1 + b2"]);
}

/// The columns of table 3.6, what is kept first.
const ORDER: [[&str; 2]; 17] = [
    ["c6x^2", "m6"],
    ["c6x", "m6"],
    ["m6", ""],
    ["c5x^2", "m5"],
    ["c5x", "m5"],
    ["c4x^2", "m4"],
    ["c4x", "m4"],
    ["c3z^2", "m3"],
    ["m3", ""],
    ["I6y", ""],
    ["I5z", ""],
    ["I4z", ""],
    ["I2y", ""],
    ["I3y", ""],
    ["m5", ""],
    ["m4", ""],
    ["c3z", "m3"],
];

/// The inertial rows of table 3.6, with the two plus signs that are lost in rows 1 and 4, and the
/// estimates in it.
const TABLE: [(&str, &str); 14] = [
    ("c6x^2*m6 + a11^2*m5 + a11^2*m4 + a11^2*1/d9*c3z*m3", "0.01942"),
    ("c6x*m6 + a11*m5 + a11*m4 + a11*1/d9*c3z*m3", "0.90143"),
    ("m6 + m5 + m4 + 1/d9*c3z*m3", "1.31041"),
    ("m5*c5x^2 + a10^2*m4 + a10^2*1/d9*c3z*m3", "0.05399"),
    ("m5*c5x + a10*m4 + a10*1/d9*c3z*m3", "0.76691"),
    ("c4x^2*m4 + a9^2*1/d9*c3z*m3", "-0.25609"),
    ("c4x*m4 + 1/d9*a9*c3z*m3", "-0.14063"),
    ("c3z^2*m3 - d9*c3z*m3", "-0.04169"),
    ("m3 - 1/d9*c3z*m3", "13.17218"),
    ("I6y", "0.04489"),
    ("I5z", "0.09691"),
    ("I4z", "0.14063"),
    ("I2y", "0.01008"),
    ("I3y", "0.28832"),
];

/// The leg by elimination of B, columns in the order of the table.
fn leg(coriolis: bool) -> (RobotDecomposition, Theta) {
    let mut robot = load("tulip_leg");
    robot.terms.coriolis = coriolis;
    let options = RegressorOptions::default();
    let columns = base_parameters(&robot, options, &[]).unwrap().regressor.columns;
    let names = ORDER.map(|factors| {
        let is_it = |name: &str| {
            let mut own: Vec<&str> = name.split('*').collect();
            let mut wanted: Vec<&str> = factors.into_iter().filter(|f| !f.is_empty()).collect();
            own.sort_unstable();
            wanted.sort_unstable();
            own == wanted
        };
        columns.iter().find(|column| is_it(&column.name)).expect(factors[0]).name.clone()
    });
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
    let mut found = decompose_robot(&robot, options, &Basis::ALL, &mut expansion).unwrap();
    let least = smallest(std::mem::take(&mut found.decompositions)).expect("a basis");
    let theta = found.theta(&least, &names).expect("small");
    (found, theta)
}

fn parse(dag: &mut Dag, source: &str) -> ExprId {
    let mut resolve = |dag: &mut Dag, name: &str| {
        let id = dag.find_symbol(name)?;
        Some(dag.symbol_expr(id))
    };
    text::parse(dag, source, &mut resolve).expect(source)
}

#[test]
fn table_3_6_has_lost_a_plus_in_rows_1_and_4() {
    for coriolis in [true, false] {
        let (mut found, theta) = leg(coriolis);
        assert_eq!((found.columns.len(), theta.rank()), (17, 14));
        assert_eq!(theta.dependent().count(), 3);
        for (row, (formula, _)) in TABLE.iter().enumerate() {
            let expected = parse(&mut found.dag, formula);
            let ours = theta.parameters[row];
            assert_eq!(equal(&mut found.dag, ours, expected), Ok(true), "{formula}");
        }
        for (row, printed) in [
            (0, "c6x^2*m6*a11^2*m5 + a11^2*m4 + a11^2*1/d9*c3z*m3"),
            (3, "m5*c5x^2 + a10^2*m4*a10^2*1/d9*c3z*m3"),
        ] {
            let printed = parse(&mut found.dag, printed);
            assert_eq!(equal(&mut found.dag, theta.parameters[row], printed), Ok(false));
        }
    }
}

/// Of the fourteen estimates one pair is exactly opposite.
#[test]
fn table_3_6_repeats_a_value_for_i4z() {
    let values = TABLE.map(|(_, value)| parse_decimal(value).expect("a decimal"));
    let mut opposite = Vec::new();
    for (row, value) in values.iter().enumerate() {
        for (other, second) in values.iter().enumerate().skip(row + 1) {
            if *value == -second.clone() {
                opposite.push((row, other));
            }
        }
    }
    assert_eq!(opposite, [(6, 11)], "rows c4x m4 and I4z");
}

/// What table 3.4 calls actual values of theta_1 .. theta_13 (those that our copy shows).
const ACTUAL: [f64; 13] = [
    1.9559, 0.3445, 0.0902, 0.3791, 0.0855, 0.1252, 0.0175, 0.0702, 0.0014, 0.1000, 0.6800, 0.6800,
    0.1000,
];

/// The third parameter is m6 + m5 + m4 while c3z is 0, whatever the other centres of mass: heavier
/// than any value of table 3.4.
#[test]
fn table_3_4_has_values_of_another_robot() {
    let (found, theta) = leg(true);
    let robot = load("tulip_leg");
    let mut values = Floats::new(|name: &str| {
        let parameter = robot.parameters.values().find(|parameter| parameter.name == name)?;
        robot.dag.as_constant(parameter.default?).map(to_f64)
    });
    let theta = evaluate(&found.dag, &theta.parameters, &mut values).expect("there are values");
    let masses = 2.141 + 0.315 + 0.001 + 0.366;
    assert!((theta[2] - masses).abs() < 1e-9, "{}", theta[2]);
    assert!(ACTUAL.iter().all(|actual| *actual < theta[2]));
    let is_near = |a: f64, b: f64| (a - b).abs() < 0.05 * b;
    let matches = theta.iter().zip(ACTUAL).filter(|&(&ours, actual)| is_near(ours, actual));
    assert_eq!(matches.count(), 0, "{theta:?}");
}
