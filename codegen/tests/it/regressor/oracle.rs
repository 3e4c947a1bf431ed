//! Ranks against the tables that an independent engine's singular values confirm (gap 0.1 : 1e-15).

use super::{INERTIAL, base, rigid, tree};
use crate::robots::{fixture, load};
use denavit_codegen::model::{self, Base, Robot};
use denavit_codegen::regressor::{BaseError, Certificate, RegressorOptions, base_parameters};
use serde_json::json;

/// Ranks: inertial, + friction, + rotor, + offset.
fn ranks(robot: &Robot) -> [usize; 4] {
    let friction = RegressorOptions { friction: true, ..INERTIAL };
    let rotor = RegressorOptions { rotor: true, ..friction };
    let offset = RegressorOptions { offset: true, ..rotor };
    [INERTIAL, friction, rotor, offset].map(|options| base(robot, options).rank())
}

#[test]
fn arms_and_legs_have_the_ranks_of_the_table() {
    for (name, expected) in [
        ("planar_2r", [6, 10, 11, 13]),
        ("planar_3r", [9, 15, 17, 20]),
        ("scara", [8, 16, 19, 22]),
        ("stanford", [33, 45, 49, 55]),
        ("puma560", [36, 48, 52, 58]),
        ("rx90", [36, 48, 52, 58]),
        ("iiwa", [43, 57, 62, 69]),
        ("panda", [43, 57, 62, 69]),
        ("tulip_leg5", [29, 39, 42, 47]),
        ("tulip_leg6", [36, 48, 52, 58]),
    ] {
        assert_eq!(ranks(&rigid(load(name))), expected, "{name}");
    }
    assert_eq!(ranks(&rigid(fixture("general_6r.json"))), [38, 50, 55, 61]);
}

#[test]
fn floating_robots_have_the_ranks_of_the_table() {
    let free = rigid(load("tulip"));
    let options = RegressorOptions { friction: true, rotor: true, ..INERTIAL };
    assert_eq!(base(&free, INERTIAL).rank(), 94);
    assert_eq!(base(&free, options).rank(), 130, "twelve driven joints");
    // The chain's six joints with friction, rotor and offset of their own.
    let chain = Robot { base: Base::Fixed, ..free };
    assert_eq!(ranks(&chain), [94, 130, 148, 165]);
}

#[test]
fn general_arms_have_the_ranks_of_the_formula() {
    for n in 2..=7 {
        let names: Vec<[String; 3]> =
            (0..n).map(|i| ["a", "al", "d"].map(|name| format!("{name}{i}"))).collect();
        let rows: Vec<_> = (0..n)
            .map(|i| {
                let [a, al, d] = &names[i];
                ("revolute", a.as_str(), al.as_str(), d.as_str(), i.checked_sub(1))
            })
            .collect();
        let free = tree("skew", ["gx", "gy", "gz"], &rows);
        assert_eq!(base(&free, INERTIAL).rank(), 7 * n - 4, "n = {n}, free gravity");
        let upright = tree("skew", ["0", "0", "-g"], &rows);
        assert_eq!(base(&upright, INERTIAL).rank(), 7 * n - 6, "n = {n}, first axis upright");
    }
}

/// A twist that is a function of lengths is the same at every pose, and as general as any.
#[test]
fn twists_may_be_functions_of_parameters() {
    for twist in ["atan2(a0, d)", "max(a0, d)/d", "select(a0 < d, 0.3, 0.4)", "sqrt(a0/d)"] {
        let rows = [
            ("revolute", "a0", twist, "d", None),
            ("revolute", "a1", twist, "d", Some(0)),
            ("revolute", "a2", "0", "d", Some(1)),
        ];
        let upright = tree("skew", ["0", "0", "-g"], &rows);
        assert_eq!(base(&upright, INERTIAL).rank(), 7 * 3 - 6, "{twist}");
    }
}

#[test]
fn twists_with_a_square_case_are_refused() {
    for twist in ["select(a0 < d, 0, 0.4)", "select(a0 < d, 0.3, pi/2)", "sign(d)*pi/2"] {
        let rows = [("revolute", "a0", twist, "d", None), ("revolute", "a0", "0", "d", Some(0))];
        let robot = tree("cases", ["0", "0", "-g"], &rows);
        let error = base_parameters(&robot, INERTIAL, &[]).unwrap_err();
        assert!(matches!(error, BaseError::Piecewise { .. }), "{twist}: {error}");
    }
}

/// Three axes through one point: without weight only the six second moments about it are felt, of
/// which each carrier takes the one along the axis: 1 + 5 + 5. With weight, upright, two first
/// moments of each carried body come to them.
#[test]
fn a_body_about_a_fixed_point_feels_no_mass_there() {
    // the second frame is away from the point, on an axis through it
    let rows = [
        ("revolute", "0", "al0", "0", None),
        ("fixed", "0", "0", "d", Some(0)),
        ("revolute", "0", "0", "0", Some(1)),
        ("fixed", "0", "al1", "-d", Some(2)),
        ("revolute", "0", "0", "0", Some(3)),
    ];
    for (gravity, rank) in [(["0", "0", "0"], 11), (["0", "0", "-g"], 15)] {
        let robot = tree("spherical", gravity, &rows);
        assert_eq!(certified(&robot), rank);
    }
    let mut away = rows;
    away[3].3 = "d";
    assert_eq!(
        certified(&tree("away", ["0", "0", "0"], &away)),
        13,
        "the third does not meet them"
    );
}

/// The rank, with a certificate that verifies.
fn certified(robot: &Robot) -> usize {
    let base = base(robot, INERTIAL);
    let verdict = Certificate::new(robot, INERTIAL, &base, false).verify(robot);
    assert!(verdict.is_verified(), "{}: {verdict}", robot.name);
    base.rank()
}

/// Terms that no robot moves by have relations that no rule about trees tells.
#[test]
fn terms_may_be_any() {
    for name in ["planar_2r", "scara", "stanford", "puma560", "tulip_leg5"] {
        for (inertia, coriolis, gravity) in
            [(true, false, false), (true, true, false), (false, true, true), (false, false, true)]
        {
            let mut robot = rigid(load(name));
            (robot.terms.inertia, robot.terms.coriolis) = (inertia, coriolis);
            robot.terms.gravity = gravity;
            certified(&robot);
        }
    }
}

/// Their relations have sines and cosines in denominators.
#[test]
fn terms_of_skew_arms_may_be_any() {
    for second in ["al", "0.62"] {
        let rows = [("revolute", "0", "pi/2", "0", None), ("revolute", "0", second, "0", Some(0))];
        let mut robot = tree("skew", ["0", "0", "-g"], &rows);
        robot.terms.inertia = false;
        certified(&robot);
    }
}

/// Numbers and symbols as angles, on slides: the coefficients are found, or refused, but looked for
/// no longer than a number of multiplications.
#[test]
fn large_coefficients_come_to_an_end() {
    let body = json!({"mass": 3.4, "com": [-0.1, 0.2, -0.1], "about": "com",
        "inertia": {"xx": 1.1, "yy": 1, "zz": 1, "xy": 0.05, "xz": -0.03, "yz": 0.02}});
    let file = json!({
        "format": "denavit-model/1", "name": "slides", "convention": "modified",
        "gravity": [0, 0, "-g"], "base": "floating",
        "constants": {"g": 9.81, "al": 0.4, "be": 0.7},
        "links": [
            {"name": "k0", "joint": {"type": "prismatic", "alpha": "be", "theta": 1}, "body": body},
            {"name": "k1", "joint": {"type": "prismatic", "alpha": 1}, "parent": "base"},
            {"name": "k2", "joint": {"type": "revolute", "alpha": "al"}},
        ],
    });
    let robot = model::read("slides", &serde_json::to_vec(&file).unwrap()).unwrap();
    if let Err(error) = base_parameters(&robot, INERTIAL, &[]) {
        assert!(matches!(error, BaseError::Canonical(_)), "{error}");
    }
}

#[test]
fn planar_arms_have_the_ranks_of_the_formula() {
    for n in 1..=5usize {
        let names: Vec<String> = (0..n).map(|i| format!("a{i}")).collect();
        let rows: Vec<_> =
            (0..n).map(|i| ("revolute", names[i].as_str(), "0", "0", i.checked_sub(1))).collect();
        let rotor = RegressorOptions { rotor: true, ..INERTIAL };
        let upright = tree("planar", ["0", "-g", "0"], &rows);
        assert_eq!(base(&upright, INERTIAL).rank(), 3 * n);
        assert_eq!(base(&upright, rotor).rank(), 4 * n - 1);
        let lying = tree("planar", ["0", "0", "-g"], &rows);
        assert_eq!(base(&lying, INERTIAL).rank(), 3 * n - 2);
        assert_eq!(base(&lying, rotor).rank(), 4 * n - 3);
    }
}

#[test]
fn planar_floating_trees_have_the_ranks_of_the_formula() {
    let robot = rigid(load("planar_biped"));
    let n = robot.degrees_of_freedom() - 3;
    assert_eq!(base(&robot, INERTIAL).rank(), 4 + 3 * n);
}
