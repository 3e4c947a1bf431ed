//! Entries of z that are held, against least squares without their columns.

use super::search::{puma, puma_log};
use denavit_diagnose::{Data, Filters, Nominal, Problem, Signals};
use nalgebra::{DMatrix, DVector};

#[test]
fn entries_that_are_held_are_least_squares_without_them() {
    let model = puma();
    let nominal = Nominal::new(&model);
    let phi = nominal.phi(&vec![0.5; nominal.len()]);
    let filters = Filters { motion_hz: 15.0, torque_hz: 7.5 };
    let signals = Signals::new(puma_log(&model, &phi.axes), filters);
    let data = Data::new(&nominal, vec![signals.expect("long enough")]);
    let deviation: Vec<f64> = (0..data.rows()).map(|row| 0.1 + (row % 7) as f64).collect();
    let width = data.columns.len();
    let mut held = vec![None; width];
    (held[3], held[10], held[width - 1]) = (Some(2.5), Some(-3.0), Some(0.25));
    let torques = data.model_torques(&vec![0.0; width]);
    let found = Problem::new(&data, &deviation).holding(&held).fit(&[], &torques);

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
