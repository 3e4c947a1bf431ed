//! The number of fundamental functions of robots of which every link has ten parameters, against
//! counts made with another program (Laurent polynomials in Python). It depends on the basis, and
//! not on how the columns are chosen: an invertible combination of columns leaves no row empty.

use super::{Case, FULL, WITHOUT_CORIOLIS};
use denavit_codegen::expr::{ExprId, Residues, evaluate};
use denavit_codegen::fundamental::Basis::{Cumulated, Fourier, Product};
use denavit_codegen::fundamental::{Basis, FourierError};
use denavit_codegen::regressor::MotionTerms;

fn assert_sizes(name: &str, terms: MotionTerms, expected: &[(Basis, usize)]) {
    let bases: Vec<Basis> = expected.iter().map(|&(basis, _)| basis).collect();
    let found = Case::new(name, terms).decompose(&bases);
    let sizes: Vec<_> = found.iter().map(|found| (found.basis, found.functions.len())).collect();
    assert_eq!(sizes, expected, "{name} {terms:?}");
}

#[test]
fn planar_arms_have_the_counted_functions() {
    for (name, terms, [fourier, product, cumulated]) in [
        ("planar_2r", WITHOUT_CORIOLIS, [10, 12, 14]),
        ("planar_2r", FULL, [16, 18, 26]),
        ("planar_3r", WITHOUT_CORIOLIS, [25, 39, 41]),
        ("planar_3r", FULL, [55, 81, 101]),
    ] {
        let expected = [(Fourier, fourier), (Product, product), (Cumulated, cumulated)];
        assert_sizes(name, terms, &expected);
    }
}

#[test]
fn legs_have_the_counted_functions() {
    // The other program counted the other two bases on a variant of the legs.
    for (name, terms, fourier) in [
        ("tulip_leg5", WITHOUT_CORIOLIS, 292),
        ("tulip_leg5", FULL, 1079),
        ("tulip_leg6", WITHOUT_CORIOLIS, 910),
        ("tulip_leg6", FULL, 3809),
    ] {
        assert_sizes(name, terms, &[(Fourier, fourier)]);
    }
}

#[test]
fn puma_has_the_counted_functions() {
    for (terms, [fourier, product, cumulated]) in
        [(WITHOUT_CORIOLIS, [2043, 1349, 865]), (FULL, [9040, 6280, 3611])]
    {
        let expected = [(Fourier, fourier), (Product, product), (Cumulated, cumulated)];
        assert_sizes("puma560", terms, &expected);
    }
}

/// On its torso, with every term, body by body down one leg: torso, hip z, x, y, knee, ankle, foot.
#[test]
fn a_leg_of_tulip_has_the_counted_functions() {
    let case = Case::torso("tulip", FULL);
    let expected = [12, 67, 391, 2264, 5997, 11_963, 39_599];
    for (body, functions) in (5..).zip(expected) {
        // The foot takes a while.
        if functions > 20_000 && cfg!(debug_assertions) {
            continue;
        }
        let own = 10 * body..10 * (body + 1);
        let rows = case.rows.iter().map(|row| row[own.clone()].to_vec()).collect();
        let (robot, dag, chains) = (case.robot.clone(), case.dag.clone(), case.chains.clone());
        let found = Case { robot, dag, rows, chains }.decompose(&[Fourier]);
        assert_eq!(found[0].functions.len(), functions, "body {body}");
    }
}

/// In the coordinates of the virtual chain there are many more functions than on the torso. The
/// first five bodies of the chain have no mass and no columns.
#[test]
fn the_virtual_chain_of_tulip_has_the_counted_functions() {
    // A minute without optimisation.
    if !cfg!(debug_assertions) {
        let mut case = Case::new("tulip", WITHOUT_CORIOLIS);
        case.rows.iter_mut().for_each(|row| _ = row.drain(..50));
        let found = case.decompose(&[Fourier]);
        assert_eq!((found[0].functions.len(), found[0].shape()), (176_037, (3_168_666, 130)));
    }
}

#[test]
fn iiwa_has_the_counted_functions() {
    assert_sizes("iiwa", WITHOUT_CORIOLIS, &[(Fourier, 25_954)]);
    // In full only where it is fast: 20 s without optimisation.
    if !cfg!(debug_assertions) {
        assert_sizes("iiwa", FULL, &[(Fourier, 146_551)]);
    }
}

/// f^T B equals R0 at a random point modulo p, in every basis.
fn assert_holds(mut case: Case) {
    let columns = case.rows[0].len();
    let direct = evaluate(&case.dag, &case.rows.concat(), &mut Residues::new(5)).unwrap();
    for found in case.decompose(&Basis::ALL) {
        let dag = &mut case.dag;
        let functions: Vec<ExprId> = found.functions.iter().map(|f| f.to_expr(dag)).collect();
        let coefficients: Vec<_> = found.coefficients.iter().map(|c| c.to_expr(dag)).collect();
        let at = |exprs: &[ExprId]| evaluate(dag, exprs, &mut Residues::new(5)).unwrap();
        let (functions, coefficients) = (at(&functions), at(&coefficients));
        let mut sums = vec![denavit_codegen::number::Residue::ZERO; direct.len()];
        for (column, entries) in found.columns.iter().enumerate() {
            for entry in entries {
                let place = &mut sums[entry.equation as usize * columns + column];
                let function = functions[entry.function as usize];
                *place = *place + coefficients[entry.coefficient as usize] * function;
            }
        }
        assert!(sums == direct, "{} {}", case.robot.name, found.basis);
    }
}

#[test]
fn the_functions_with_their_coefficients_are_the_regressor() {
    for name in ["planar_2r", "planar_3r", "scara", "stanford", "rx90", "puma560", "tulip_leg6"] {
        for terms in [WITHOUT_CORIOLIS, FULL] {
            assert_holds(Case::new(name, terms));
        }
    }
    assert_holds(Case::new("iiwa", WITHOUT_CORIOLIS));
    assert_holds(Case::torso("tulip", WITHOUT_CORIOLIS));
}

#[test]
fn a_memory_limit_ends_with_a_message() {
    let error = Case::new("iiwa", FULL).try_decompose(&[Fourier], 1 << 20).expect_err("1 MiB");
    assert!(matches!(error, FourierError::Memory { limit_bytes: 0x10_0000, .. }), "{error}");
}
