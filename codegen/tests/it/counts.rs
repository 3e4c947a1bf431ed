//! Operation counts: at or below the best published by the prototypes, and recorded per model so
//! that a change shows.

use crate::robots::{fixture, load, repository};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::expr::{Dag, Operations, SymbolClass};
use denavit_codegen::function::FunctionName::{self, *};
use denavit_codegen::model::Robot;
use denavit_codegen::program::{counts, lower};
use std::fmt::Write;

/// The rigid robot: full inertias, symbolic geometry, nothing in the joints.
fn rigid(mut robot: Robot) -> Robot {
    for link in robot.links.values_mut() {
        (link.drive, link.joint.spring, link.joint.damping) = (None, None, None);
    }
    robot
}

fn robots() -> Vec<Robot> {
    let mut robots = vec![rigid(fixture("general_6r.json"))];
    for name in ["planar_2r", "puma560", "rx90", "iiwa", "tulip_leg5", "tulip_leg6", "tulip"] {
        robots.push(rigid(load(name)));
    }
    robots.push(rigid(load("planar_biped")));
    robots
}

const FUNCTIONS: [FunctionName; 7] = [
    InverseDynamics,
    Bias,
    MassMatrix,
    GravityVector,
    CoriolisMatrix,
    DynamicsTerms,
    ForwardDynamics,
];

/// (robot, joints and cumulated angles that may turn, [multiplications, additions] of the functions
/// in the order of `FUNCTIONS`): the better row of each, as measured with the Python prototypes
/// that the algorithms come from (own graph, operations on parameters not counted).
type Bounds = (&'static str, usize, [[usize; 2]; 7]);

const BEST_KNOWN: [Bounds; 8] = [
    ("planar_2r", 3, [[23, 15], [18, 9], [6, 6], [9, 4], [25, 12], [43, 25], [27, 20]]),
    (
        "puma560",
        7,
        [[252, 224], [233, 200], [150, 132], [35, 21], [568, 465], [709, 566], [444, 403]],
    ),
    ("rx90", 7, [[244, 216], [226, 193], [135, 118], [35, 21], [535, 437], [653, 518], [422, 382]]),
    ("iiwa", 7, [[291, 274], [286, 257], [198, 168], [50, 32], [794, 645], [863, 688], [582, 530]]),
    (
        "general_6r",
        6,
        [[413, 348], [404, 334], [408, 305], [88, 54], [1289, 933], [1429, 1021], [877, 710]],
    ),
    (
        "tulip_leg5",
        7,
        [[217, 197], [203, 176], [101, 91], [22, 13], [350, 335], [512, 415], [308, 294]],
    ),
    (
        "tulip_leg6",
        8,
        [[273, 252], [259, 229], [152, 138], [32, 20], [544, 506], [762, 606], [440, 420]],
    ),
    (
        "tulip",
        19,
        [[771, 724], [759, 704], [789, 617], [114, 81], [2592, 2162], [3129, 2412], [2194, 1898]],
    ),
];

#[test]
fn counts_are_at_or_below_the_best_known() {
    let robots = robots();
    for (name, angles, bounds) in BEST_KNOWN {
        let robot = robots.iter().find(|robot| robot.name == name).unwrap();
        let derivation = derive(robot, Flavour::Tunable, &FUNCTIONS).unwrap();
        for (function, [mul, add]) in derivation.functions.iter().zip(bounds) {
            let ours = Operations::count(&derivation.dag, &function.entries());
            let known = mul + add;
            let text = format!("{name} {}: {ours:?}, best known {mul}M {add}A", function.name);
            assert!(ours.mul + ours.add <= known, "{text}");
            assert!(ours.sincos <= angles, "{text}");
        }
    }
}

#[test]
fn contact_functions_of_tulip_are_at_or_below_the_best_known() {
    let robot = rigid(load("tulip"));
    let wanted = [ContactJacobian, ContactPositions, ContactBias];
    let derivation = derive(&robot, Flavour::Tunable, &wanted).unwrap();
    for (function, known) in derivation.functions.iter().zip([598 + 513, 230 + 185, 544 + 406]) {
        let ours = Operations::count(&derivation.dag, &function.entries());
        assert!(ours.mul + ours.add <= known, "{}: {ours:?}, best known {known}", function.name);
    }
}

#[test]
fn derivatives_are_at_or_below_the_best_known() {
    // Both Jacobians of inverse dynamics, better of plain and grouped.
    let robots = robots();
    for (name, known) in
        [("puma560", 1215 + 1003), ("tulip_leg6", 1172 + 1073), ("tulip", 5225 + 4317)]
    {
        let robot = robots.iter().find(|robot| robot.name == name).unwrap();
        let wanted = [InverseDynamicsDerivatives];
        let derivation = derive(robot, Flavour::Tunable, &wanted).unwrap();
        let ours = Operations::count(&derivation.dag, &derivation.functions[0].entries());
        assert!(ours.mul + ours.add <= known, "{name}: {ours:?}, best known {known}");
    }
}

#[test]
fn the_graph_and_the_program_count_alike() {
    for robot in robots() {
        let wanted = [&FunctionName::ALL[..], &FunctionName::WALKING].concat();
        let derivation = derive(&robot, Flavour::Tunable, &wanted).unwrap();
        let program = lower(&derivation.dag, &derivation.functions).unwrap();
        for (function, routine) in derivation.functions.iter().zip(&program.routines) {
            let graph = Operations::count(&derivation.dag, &function.entries());
            let code = counts(&program, routine);
            let name = format!("{} {}", robot.name, function.full_name());
            assert_eq!(graph.mul, code.mul, "{name}: multiplications");
            assert_eq!(graph.add, code.add, "{name}: additions");
            assert_eq!(graph.div, code.div, "{name}: divisions");
            assert_eq!(graph.sincos, code.sincos, "{name}: sines");
            assert!(code.neg <= graph.neg, "{name}: lowering added negations");
        }
    }
}

#[test]
fn a_pendulum_is_counted_by_hand() {
    // tau = J qdd + w cos q: two multiplications, one addition, one sine; 2 J is of the prelude.
    let mut dag = Dag::new();
    let [q, qdd] = [("q", SymbolClass::Configuration), ("qdd", SymbolClass::Acceleration)]
        .map(|(name, class)| dag.symbol(name, class));
    let [inertia, weight] = ["J", "w"].map(|name| dag.symbol(name, SymbolClass::Inertia));
    let cos = dag.cos(q);
    let twice = dag.add(inertia, inertia);
    let (left, right) = (dag.mul(twice, qdd), dag.mul(weight, cos));
    let tau = dag.add(left, right);
    let ours = Operations::count(&dag, &[tau]);
    assert_eq!((ours.mul, ours.add, ours.sincos, ours.prelude), (2, 1, 1, 1));
}

#[test]
fn counts_are_recorded_per_model() {
    let mut text = String::from(
        "Operations per call, tunable flavour, rigid bodies (no drives), cheapest formulation.\n\
         UPDATE_EXPECT=1 rewrites this file.\n",
    );
    for robot in robots() {
        let wanted =
            [&FunctionName::ALL[..], &FunctionName::WALKING, &FunctionName::REGRESSORS].concat();
        let derivation = derive(&robot, Flavour::Tunable, &wanted).unwrap();
        writeln!(text, "\n{}", robot.name).unwrap();
        for function in derivation.functions.iter().filter(|function| function.link.is_none()) {
            let o = Operations::count(&derivation.dag, &function.entries());
            let form = format!("{:?}", function.form).to_lowercase();
            writeln!(
                text,
                "  {:28} {:8} {:6}M {:6}A {:4}N {:4}D {:3} sincos {:4} prelude",
                function.name.as_str(),
                form,
                o.mul,
                o.add,
                o.neg,
                o.div,
                o.sincos,
                o.prelude
            )
            .unwrap();
        }
    }
    let path = repository().join("codegen/tests/fixtures/counts.txt");
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let recorded = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(recorded == text, "counts changed; UPDATE_EXPECT=1 rewrites {}", path.display());
}
