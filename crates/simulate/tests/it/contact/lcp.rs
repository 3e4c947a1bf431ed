//! Lemke's method against known answers and against all complementary bases.

use super::systems::{assert_close, number};
use denavit_numerics::MinimumNorm;
use denavit_simulate::contact::lemke::{LcpOutcome, Lemke};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

const LIMIT: usize = 1000;

/// All solutions of the problem on complementary bases.
fn solutions(m: &DMatrix<f64>, q: &DVector<f64>) -> Vec<DVector<f64>> {
    let n = q.len();
    let basis = |mask: usize| {
        // Columns of z where the mask is set, of w elsewhere: (-M_a | I) y = q.
        let columns = DMatrix::from_fn(n, n, |i, j| {
            if mask >> j & 1 == 1 { -m[(i, j)] } else { f64::from(u8::from(i == j)) }
        });
        let y = columns.clone().lu().solve(q)?;
        let exact = (&columns * &y - q).amax() < 1e-9 && y.iter().all(|entry| *entry >= -1e-9);
        let z = DVector::from_fn(n, |j, _| if mask >> j & 1 == 1 { y[j] } else { 0.0 });
        exact.then_some(z)
    };
    (0..1 << n).filter_map(basis).collect()
}

fn row_major(m: &DMatrix<f64>) -> Vec<f64> {
    m.transpose().as_slice().to_vec()
}

fn worst_violation(m: &DMatrix<f64>, q: &DVector<f64>, z: &[f64]) -> f64 {
    let z = DVector::from_column_slice(z);
    let w = m * &z + q;
    w.iter().zip(z.iter()).fold(0.0, |worst, (w, z)| worst.max(w.min(*z).abs()))
}

#[test]
fn exponentially_many_bases_of_murty() {
    // M lower triangular with 1 on and 2 below the diagonal, q = -1: z = e_1.
    let n = 8;
    let m =
        DMatrix::from_fn(n, n, |i, j| if i == j { 1.0 } else { f64::from(2 * u8::from(i > j)) });
    let mut lemke = Lemke::new();
    let report = lemke.solve(&row_major(&m), &[-1.0; 8], LIMIT);
    assert_eq!(report.outcome, LcpOutcome::Solved);
    let mut expected = [0.0; 8];
    expected[0] = 1.0;
    assert_close(lemke.solution(), &expected, 1e-12);
}

#[test]
fn a_problem_without_solution_ends_in_a_ray_and_a_long_one_at_the_limit() {
    let mut lemke = Lemke::new();
    // w_1 = -1 whatever z is; positive semidefinite, so that the ray proves it.
    assert_eq!(lemke.solve(&[0.0, 0.0, 0.0, 1.0], &[-1.0, 1.0], LIMIT).outcome, LcpOutcome::Ray);
    let m = [2.0, 1.0, 1.0, 2.0];
    assert_eq!(lemke.solve(&m, &[-1.0, -2.0], 0).outcome, LcpOutcome::Limit);
    assert_eq!(lemke.solve(&m, &[-1.0, -2.0], LIMIT).outcome, LcpOutcome::Solved);
    assert_close(lemke.solution(), &[0.0, 1.0], 1e-14);
}

#[test]
fn ties_do_not_make_it_cycle() {
    // Every ratio is tied; M = J J^T of rank one, of opposite and equal rows.
    for seed in 0..50 {
        let n = 6;
        let signs =
            DVector::from_fn(n, |i, _| if number(seed, i as u64) > 0.0 { 1.0 } else { -1.0 });
        let m = &signs * signs.transpose();
        let q = -signs.map(|sign| f64::from(u8::from(sign > 0.0)));
        let mut lemke = Lemke::new();
        let report = lemke.solve(&row_major(&m), q.as_slice(), LIMIT);
        let expected = solutions(&m, &q);
        assert_eq!(report.outcome == LcpOutcome::Solved, !expected.is_empty(), "seed {seed}");
        if !expected.is_empty() {
            assert!(worst_violation(&m, &q, lemke.solution()) < 1e-12, "seed {seed}");
        }
    }
}

/// A flat foot's four normal forces, rank 3: the sums are known, not the single forces.
#[test]
fn redundant_normals_of_a_flat_foot() {
    let (mass, inertia, a, b) = (2.0, 0.1, 0.1, 0.05);
    let corners = [[a, b], [a, -b], [-a, b], [-a, -b]];
    let m = DMatrix::from_fn(4, 4, |i, j| {
        let (p, q) = (corners[i], corners[j]);
        1.0 / mass + (p[0] * q[0] + p[1] * q[1]) / inertia
    });
    // Falls and tips about y, so that the load is at x = 0.04.
    let (force, moment) = (mass * 9.81, mass * 9.81 * 0.04);
    let q = DVector::from_fn(4, |i, _| -force / mass - corners[i][0] * moment / inertia);
    let mut lemke = Lemke::new();
    assert_eq!(lemke.solve(&row_major(&m), q.as_slice(), LIMIT).outcome, LcpOutcome::Solved);
    let z = lemke.solution();
    let sums = [z.iter().sum(), (0..4).map(|i| z[i] * corners[i][0]).sum()];
    assert_close(&sums, &[force, moment], 1e-11);
}

proptest! {
    #[test]
    fn lemke_agrees_with_the_complementary_bases(
        n in 1_usize..=7, rank in 1_usize..=9, seed in 0_u64..1_000_000,
        zeros in any::<bool>(),
    ) {
        let a = DMatrix::from_fn(n, rank, |i, j| number(seed, (i * 16 + j) as u64));
        let m = &a * a.transpose();
        let q = DVector::from_fn(n, |i, _| {
            let entry = number(seed, 1000 + i as u64);
            if zeros && entry.abs() < 0.4 { 0.0 } else { entry }
        });
        let mut lemke = Lemke::new();
        let report = lemke.solve(&row_major(&m), q.as_slice(), LIMIT);
        let expected = solutions(&m, &q);
        match report.outcome {
            LcpOutcome::Solved => {
                let size = lemke.solution().iter().fold(1.0_f64, |sum, z| sum.max(*z));
                prop_assert!(worst_violation(&m, &q, lemke.solution()) < 1e-8 * size);
                // For positive semidefinite M the w of all solutions is one.
                let w = &m * DVector::from_column_slice(lemke.solution());
                for other in &expected {
                    prop_assert!((&w - &m * other).amax() < 1e-6 * size);
                }
            }
            LcpOutcome::Ray => prop_assert!(expected.is_empty()),
            other => prop_assert!(false, "{other:?}"),
        }
    }

    #[test]
    fn the_solution_of_least_norm_is_the_pseudoinverse(
        n in 1_usize..=9, rank in 1_usize..=9, seed in 0_u64..1_000_000,
    ) {
        let rank = rank.min(n);
        let a = DMatrix::from_fn(n, rank, |i, j| number(seed, (i * 16 + j) as u64))
            * DMatrix::from_fn(rank, n, |i, j| number(seed + 1, (i * 16 + j) as u64));
        let singular = a.clone().svd(false, false).singular_values;
        // Whether an ill-conditioned matrix has full rank is a question of taste.
        prop_assume!(singular[rank - 1] > 1e-4 * singular[0]);
        let b = &a * DVector::from_fn(n, |i, _| number(seed, 2000 + i as u64));
        let mut system = MinimumNorm::new();
        system.factor(&row_major(&a), n, 1e-11);
        prop_assert_eq!(system.rank(), rank);
        let mut x = vec![0.0; n];
        prop_assert!(system.solve(b.as_slice(), &mut x) < 1e-9);
        // Of least norm is the solution that is normal to the null space.
        let x = DVector::from_vec(x);
        prop_assert!((&a * &x - &b).amax() < 1e-9);
        for index in 0..system.nullity() {
            let null = DVector::from_column_slice(system.null_vector(index));
            prop_assert!((&a * &null).amax() < 1e-9);
            prop_assert!((null.norm() - 1.0).abs() < 1e-12);
            prop_assert!(null.dot(&x).abs() < 1e-9 * (1.0 + x.norm()));
        }
    }
}
