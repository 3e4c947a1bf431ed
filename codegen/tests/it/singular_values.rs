//! Exact ranks against singular values: another arithmetic, another algorithm.

use crate::robots::load;
use crate::trees::random_tree;
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::expr::{Dag, ExprId, Floats, evaluate};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model;
use denavit_codegen::regressor::{BaseParameters, RegressorOptions, base_parameters};
use nalgebra::DMatrix;

/// A number between -1 and 1 that a name and a point have.
fn value(name: &str, point: u64) -> f64 {
    let mut hash = 0xcbf2_9ce4_8422_2325 ^ point.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    for byte in name.bytes() {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    }
    hash ^= hash >> 29;
    hash = hash.wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (hash >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// R0 at random points, one below the other; constants keep their values.
fn stacked(base: &BaseParameters) -> DMatrix<f64> {
    let regressor = &base.regressor;
    at_points(&regressor.dag, &regressor.entries(), regressor.columns.len())
}

/// A matrix of so many columns at random points, one below the other.
fn at_points(dag: &Dag, entries: &[ExprId], columns: usize) -> DMatrix<f64> {
    let n = entries.len() / columns;
    let mut rows = Vec::new();
    for point in 1..=(3 * columns / n + 5) as u64 {
        let of = |name: &str| {
            let moves = name.starts_with('q');
            Some(value(name, if moves { point } else { 0 }) * if moves { 3.0 } else { 1.0 })
        };
        rows.extend(evaluate(dag, entries, &mut Floats::new(of)).unwrap());
    }
    DMatrix::from_row_slice(rows.len() / columns, columns, &rows)
}

/// Singular values over the largest, of the columns that are not 0, each of length 1.
fn relative_singular_values(matrix: &DMatrix<f64>) -> Vec<f64> {
    let columns: Vec<_> = (0..matrix.ncols())
        .map(|column| matrix.column(column).into_owned())
        .filter(|column| column.norm() > 1e-12)
        .map(|column| column.normalize())
        .collect();
    let singular = DMatrix::from_columns(&columns).singular_values();
    singular.iter().map(|value| value / singular.max()).collect()
}

#[test]
fn ranks_are_those_of_singular_values() {
    let mut separated = 0;
    for seed in 0..24 {
        let joints = 2 + seed as usize % 6;
        let robot = model::read("random", &random_tree(joints, 100 + seed)).unwrap();
        let friction = seed % 2 == 0;
        let options = RegressorOptions { friction, rotor: friction, ..RegressorOptions::default() };
        let base = base_parameters(&robot, options, &[]).unwrap();
        let relative = relative_singular_values(&stacked(&base));
        if relative.iter().any(|value| (1e-12..1e-6).contains(value)) {
            continue;
        }
        separated += 1;
        let rank = relative.iter().filter(|&&value| value >= 1e-6).count();
        assert_eq!(base.rank(), rank, "seed {seed}");
    }
    assert!(separated >= 16, "{separated} of 24 trees are well separated");
}

/// Of every robot with less than all terms.
#[test]
fn ranks_of_some_terms_are_those_of_singular_values() {
    for name in ["planar_3r", "scara", "stanford", "puma560", "iiwa", "tulip_leg6", "tulip"] {
        for (inertia, coriolis, gravity) in
            [(true, false, false), (true, true, false), (false, false, true)]
        {
            let mut robot = load(name);
            (robot.terms.inertia, robot.terms.coriolis) = (inertia, coriolis);
            robot.terms.gravity = gravity;
            let base = base_parameters(&robot, RegressorOptions::default(), &[]).unwrap();
            let relative = relative_singular_values(&stacked(&base));
            let doubtful = relative.iter().any(|value| (1e-12..1e-7).contains(value));
            assert!(!doubtful, "{name}: the points tell too little");
            let rank = relative.iter().filter(|&&value| value >= 1e-7).count();
            assert_eq!(base.rank(), rank, "{name}, {inertia} {coriolis} {gravity}");
        }
    }
}

/// The emitted columns, on the joint axes: none is 0, and none a sum of others.
#[test]
fn columns_on_the_axes_are_independent() {
    for seed in 0..12 {
        let joints = 2 + seed as usize % 6;
        let robot = model::read("random", &random_tree(joints, 300 + seed)).unwrap();
        let derivation = derive(&robot, Flavour::Tunable, &[FunctionName::BaseRegressor]).unwrap();
        let output = &derivation.functions[0].outputs[0];
        let matrix = at_points(&derivation.dag, &output.entries, output.shape[1]);
        let relative = relative_singular_values(&matrix);
        assert_eq!(relative.len(), output.shape[1], "seed {seed}");
        // Where the points tell them badly apart, exact ranks do.
        let least = relative.iter().copied().fold(1.0, f64::min);
        assert!(least > 1e-9, "seed {seed}: {least}");
    }
}

#[test]
fn dependent_columns_are_what_their_relations_say() {
    for seed in 0..12 {
        let joints = 2 + seed as usize % 6;
        let robot = model::read("random", &random_tree(joints, 200 + seed)).unwrap();
        let base = base_parameters(&robot, RegressorOptions::default(), &[]).unwrap();
        let matrix = stacked(&base);
        for dependent in &base.dependent {
            let mut left = matrix.column(dependent.column).into_owned();
            let mut size = left.amax().max(1e-3);
            for &(column, factor) in &dependent.relation {
                let of = |name: &str| Some(value(name, 0));
                let dag = &base.regressor.dag;
                let factor = evaluate(dag, &[factor], &mut Floats::new(of)).unwrap()[0];
                let part = matrix.column(column) * factor;
                size = size.max(part.amax());
                left -= part;
            }
            let name = base.name(dependent.column);
            assert!(left.amax() <= 1e-9 * size, "seed {seed}, {name}: {}", left.amax());
        }
    }
}
