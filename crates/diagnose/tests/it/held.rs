//! Entries of z that are held, against least squares without their columns.

use super::search::{puma, puma_log};
use denavit_diagnose::{Data, Filters, Nominal, Problem, RowResponse, Signals, Uncertainty};
use nalgebra::{DMatrix, DVector};

#[test]
fn entries_that_are_held_are_least_squares_without_them() {
    let model = puma();
    let nominal = Nominal::new(&model, Uncertainty::default());
    let phi = nominal.phi(&vec![0.5; nominal.len()]);
    let signals = Signals::new(puma_log(&model, &phi.axes), Filters::new(0.002, 0.03));
    let data = Data::new(&nominal, vec![signals.expect("long enough")]);
    let deviation: Vec<f64> = (0..data.rows()).map(|row| 0.1 + (row % 7) as f64).collect();
    let width = data.columns.len();
    let mut held = vec![None; width];
    (held[3], held[10], held[width - 1]) = (Some(2.5), Some(-3.0), Some(0.25));
    let torques = data.model_torques(&vec![0.0; width]);
    let found = Problem::new(&data, &deviation, &[]).holding(&held).at(&[], &torques);

    let free: Vec<usize> = (0..width).filter(|place| held[*place].is_none()).collect();
    let given: Vec<f64> = held.iter().map(|z| z.unwrap_or(0.0)).collect();
    let left = data.residual_of(&given);
    let rows = data.rows();
    let stacked = DMatrix::from_fn(rows + free.len(), free.len(), |row, column| match row < rows {
        true => data.columns[free[column]][row] / deviation[row],
        false => f64::from(u8::from(row - rows == column)),
    });
    let target = DVector::from_fn(rows + free.len(), |row, _| match row < rows {
        true => left[row] / deviation[row],
        false => 0.0,
    });
    let solved = stacked.clone().svd(true, true).solve(&target, 1e-14).expect("full rank");
    for (place, z) in free.iter().zip(solved.iter()) {
        assert!((found.z[*place] - z).abs() < 1e-8, "{place}: {} {z}", found.z[*place]);
    }
    let held_squares: f64 = given.iter().map(|z| z * z).sum();
    let cost = (&target - stacked * solved).norm_squared() + held_squares;
    assert!((found.cost - cost).abs() < 1e-7 * cost, "{} {cost}", found.cost);
}

/// A number of the model that is 8 of its deviations off, and a law that does what it does.
#[test]
fn a_law_takes_what_a_number_at_its_bound_cannot() {
    let model = puma();
    let nominal = Nominal::new(&model, Uncertainty::default());
    let norm = |column: &[f64]| column.iter().map(|entry| entry * entry).sum::<f64>();
    let with = |z: &[f64]| {
        let log = puma_log(&model, &nominal.phi(z).axes);
        let signals = Signals::new(log, Filters::new(0.002, 0.03)).expect("long enough");
        Data::new(&nominal, vec![signals])
    };
    let plain = with(&vec![0.0; nominal.len()]);
    let largest =
        |a: &usize, b: &usize| norm(&plain.columns[*a]).total_cmp(&norm(&plain.columns[*b]));
    let off = (0..nominal.len()).max_by(largest).expect("numbers");
    let mut z = vec![0.0; nominal.len()];
    z[off] = 8.0;
    let data = with(&z);
    let (rows, width) = (data.rows(), data.columns.len());
    let deviation = vec![1.0; rows];
    let problem = Problem::new(&data, &deviation, &[]);
    let mut law = RowResponse { stiffness: vec![0.0], ..RowResponse::default() };
    for stretch in &data.stretches {
        let own = stretch.first..stretch.first + stretch.rows;
        law.stretches.push(*stretch);
        law.torque.push(vec![0.0; stretch.rows]);
        law.gradient.push(vec![data.columns[off][own].to_vec()]);
    }
    let [alone, with_law] = [problem.least_cost(&[], 3.0), problem.least_cost(&[law], 3.0)];

    // The same by stacked rows: all numbers with their prior, then the law, which has none.
    let stacked = DMatrix::from_fn(rows + width, width + 1, |row, column| match row < rows {
        true => data.columns[if column < width { column } else { off }][row],
        false => f64::from(u8::from(row - rows == column)),
    });
    let target =
        DVector::from_fn(rows + width, |row, _| if row < rows { data.residual[row] } else { 0.0 });
    let solved = stacked.clone().svd(true, true).solve(&target, 1e-14).expect("full rank");
    assert!(solved.iter().take(width).all(|z| z.abs() < 3.0), "no number is at its bound");
    let cost = (&target - stacked * solved).norm_squared();
    assert!((with_law / cost - 1.0).abs() < 1e-6, "{with_law} {cost}");
    let held = problem.holding(&(0..width).map(|k| (k == off).then_some(3.0)).collect::<Vec<_>>());
    let others = held.look(&[]).cost;
    assert!(
        alone >= others * (1.0 - 1e-9) && alone > 10.0 * with_law,
        "{alone} {others} {with_law}"
    );
}
