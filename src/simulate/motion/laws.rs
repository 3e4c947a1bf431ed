//! Accelerations where laws of added effects depend on them.

use crate::plants::{LawMoment, LawResponse, Plant};
use crate::simulate::breakdown::Breakdown;
use nalgebra::{DMatrix, DVector};

/// Steps of Newton's method: laws are linear in accelerations but for kinks.
const MAX_STEPS: usize = 60;

/// Solves D qdd + law(qdd) = driving by Newton's method from the accelerations without the law.
/// `laws` has its response at the end.
pub(super) fn solve_laws(
    plant: &mut dyn Plant,
    moment: &LawMoment<'_>,
    mass: &[f64],
    driving: &[f64],
    (acceleration, laws): (&mut [f64], &mut LawResponse),
) -> Result<(), Breakdown> {
    let n = driving.len();
    for step in 0..MAX_STEPS {
        plant.laws(&LawMoment { qdd: acceleration, ..*moment }, laws);
        let residual = DVector::from_fn(n, |i, _| {
            let row = &mass[i * n..(i + 1) * n];
            let inertial: f64 = row.iter().zip(&*acceleration).map(|(d, a)| d * a).sum();
            driving[i] - laws.torque[i] - inertial
        });
        let matrix = DMatrix::from_fn(n, n, |i, j| mass[i * n + j] + laws.slopes[i * n + j]);
        let change = matrix.lu().solve(&residual).ok_or(Breakdown::Singular { coordinate: 0 })?;
        let mut largest = 0.0_f64;
        for (entry, change) in acceleration.iter_mut().zip(change.iter()) {
            // at a kink whole steps may jump to and fro
            let part = if step < MAX_STEPS / 2 { 1.0 } else { 0.5 };
            *entry += part * change;
            largest = largest.max(change.abs() / (1.0 + entry.abs()));
        }
        if largest < 1e-12 {
            return Ok(());
        }
    }
    Err(Breakdown::NotFinite)
}
