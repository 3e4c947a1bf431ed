//! Whole robots, in the parameters that a user knows.

use crate::robots::{load, repository};
use denavit_codegen::dynamics::methods::{Method, derive};
use denavit_codegen::expr::{Residues, derivative, evaluate};
use denavit_codegen::fundamental::{Basis, DEFAULT_MEMORY_BYTES, Expansion, echelon, smallest};
use denavit_codegen::model::{self, About, BodyEntry, Role};
use denavit_codegen::number::Residue;
use denavit_codegen::regressor::{
    DecomposeError, RegressorOptions, RobotDecomposition, decompose_robot,
};

/// Every term, Coriolis terms among them or not.
const FULL: bool = true;
const WITHOUT_CORIOLIS: bool = false;

fn decompose(name: &str, coriolis: bool) -> RobotDecomposition {
    let mut robot = load(name);
    robot.terms.coriolis = coriolis;
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
    let options = RegressorOptions::default();
    decompose_robot(&robot, options, &Basis::ALL, &mut expansion).expect("it fits")
}

/// The columns are the derivatives of Lagrange's torques by inertia entries: these act alike
/// whatever point the tensor is about.
#[test]
fn columns_are_what_lagrange_says() {
    for name in ["planar_2r", "scara"] {
        let robot = load(name);
        let mut dag = robot.dag.clone();
        let torque = derive(&mut dag, &robot, Method::Lagrange).inverse_dynamics;
        let found = decompose(name, FULL);
        let mut compared = 0;
        for parameter in robot.parameters.values() {
            let Role::Body(link, entry) = parameter.role else { continue };
            let is_inertia = BodyEntry::ALL[4..].contains(&entry);
            if !is_inertia || robot.links[link].body.is_none_or(|body| body.about == About::Origin)
            {
                continue;
            }
            let seeds = std::iter::once((parameter.symbol, dag.one())).collect();
            let slopes = derivative(&mut dag, &torque, &seeds);
            let column = found.columns.iter().position(|c| c.name == parameter.name).unwrap();
            let rows: Vec<_> = found.rows.iter().map(|row| row[column]).collect();
            let expected = evaluate(&dag, &slopes, &mut Residues::new(3)).unwrap();
            let ours = evaluate(&found.dag, &rows, &mut Residues::new(3)).unwrap();
            assert_eq!(ours, expected, "{name} {}", parameter.name);
            compared += usize::from(expected.iter().any(|value| *value != Residue::ZERO));
        }
        assert!(compared > 0, "{name}");
    }
}

#[test]
fn the_smallest_basis_is_chosen_and_b_has_the_known_rank() {
    for (name, basis, functions, rank) in
        [("planar_2r", Basis::Fourier, 10, 6), ("puma560", Basis::Cumulated, 865, 36)]
    {
        let mut found = decompose(name, WITHOUT_CORIOLIS);
        let least = smallest(std::mem::take(&mut found.decompositions)).expect("a basis");
        assert_eq!((least.basis, least.functions.len()), (basis, functions), "{name}");
        let order: Vec<usize> = (0..found.columns.len()).collect();
        let echelon = echelon(&mut found.dag, &least, &order).expect("small");
        assert_eq!(echelon.rank(), rank, "{name}");
    }
}

#[test]
fn without_parallel_axes_products_of_single_angles_are_fewest() {
    let mut found = decompose("iiwa", WITHOUT_CORIOLIS);
    assert_eq!(found.decompositions.len(), 2, "nothing to cumulate");
    let least = smallest(std::mem::take(&mut found.decompositions)).expect("a basis");
    assert!(least.basis == Basis::Product && least.functions.len() < 25_954);
    let order: Vec<usize> = (0..found.columns.len()).collect();
    assert_eq!(echelon(&mut found.dag, &least, &order).expect("small").rank(), 43);
}

#[test]
fn floating_bases_have_equations_of_the_torso() {
    let mut found = decompose("planar_biped", WITHOUT_CORIOLIS);
    assert_eq!(found.equations[..3], ["torso moment z", "torso force x", "torso force y"]);
    let least = smallest(std::mem::take(&mut found.decompositions)).expect("a basis");
    let order: Vec<usize> = (0..found.columns.len()).collect();
    // 4 for the torso (mass, two first moments, inertia), 3 for each joint of a planar tree
    let joints = found.equations.len() - 3;
    let echelon = echelon(&mut found.dag, &least, &order).expect("small");
    assert_eq!(echelon.rank(), 4 + 3 * joints);
}

#[test]
fn springs_are_on_the_left_side() {
    let text = std::fs::read_to_string(repository().join("models/planar_2r.json")).unwrap();
    let spring = r#""a": "l1", "spring": {"stiffness": 3, "angle": 0.2}"#;
    let text = text.replacen(r#""a": "l1""#, spring, 1);
    let robot = model::read("sprung", text.as_bytes()).expect("a model");
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
    let options = RegressorOptions::default();
    let mut found = decompose_robot(&robot, options, &[Basis::Product], &mut expansion).unwrap();
    let variables = *robot.joints().next().expect("it has joints").1;
    let dag = &mut found.dag;
    let [angle, stiffness] = ["qs_link1", "ks_link1"].map(|name| {
        let symbol = dag.find_symbol(name).expect(name);
        dag.symbol_expr(symbol)
    });
    let stretch = dag.sub(variables.q, angle);
    let torque = dag.mul(stiffness, stretch);
    let expected = dag.sub(variables.tau, torque);
    let values = evaluate(dag, &[found.left[0], expected], &mut Residues::new(5)).unwrap();
    assert_eq!(values[0], values[1]);
}

/// Without the terms of inertia the motion of the torso is no other way to write its joints.
#[test]
fn floating_bases_need_the_terms_of_inertia() {
    let mut robot = load("planar_biped");
    robot.terms.inertia = false;
    let options = RegressorOptions::default();
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
    let error = decompose_robot(&robot, options, &[Basis::Fourier], &mut expansion).unwrap_err();
    assert_eq!(error, DecomposeError::TorsoTerms("planar_biped".to_owned()));
}
