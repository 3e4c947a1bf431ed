//! Factors that cannot be below some value.

use crate::gaussian::log_below;
use nalgebra::{DMatrix, DVector};

/// Rounds of a coordinate descent, which for the few factors of a hypothesis is at its end long
/// before.
const ROUNDS: usize = 300;

/// The most likely factors of N(mean, covariance) with lower bounds, and what the bounds add to
/// the log evidence.
///
/// A factor that is believed to be on one side of its bound has twice the density there, of which
/// the posterior keeps the share on that side. Where the mean is beyond a bound the density at the
/// nearest allowed point is what counts, with the room that is left beside it: signs are judged
/// jointly, since each of two columns that are nearly one may have either sign alone.
pub(crate) fn bounded(
    mean: &DVector<f64>,
    covariance: &DMatrix<f64>,
    lowest: &[f64],
    believed: &[f64],
) -> (DVector<f64>, f64) {
    let is_bound = |k: usize| lowest[k].is_finite();
    let places: Vec<usize> = (0..mean.len()).filter(|&k| is_bound(k)).collect();
    if places.is_empty() {
        return (mean.clone(), 0.0);
    }
    // of what is believed alone: its share on the allowed side
    let gained: f64 = places.iter().map(|&k| -log_below(believed[k] - lowest[k])).sum();
    if places.iter().all(|&k| mean[k] >= lowest[k]) {
        let share = |&k: &usize| {
            let deviation = covariance[(k, k)].max(f64::MIN_POSITIVE).sqrt();
            log_below((mean[k] - lowest[k]) / deviation)
        };
        return (mean.clone(), gained + places.iter().map(share).sum::<f64>());
    }
    let regular = covariance + DMatrix::identity(mean.len(), mean.len()) * 1e-12;
    let Some(precision) = regular.cholesky().map(|factor| factor.inverse()) else {
        return (mean.clone(), gained);
    };
    let mut at = mean.clone();
    for _ in 0..ROUNDS {
        let mut largest = 0.0_f64;
        for k in 0..mean.len() {
            let slope: f64 = (0..mean.len()).map(|j| precision[(k, j)] * (at[j] - mean[j])).sum();
            let next = (at[k] - slope / precision[(k, k)]).max(lowest[k]);
            largest = largest.max((next - at[k]).abs());
            at[k] = next;
        }
        if largest < 1e-10 {
            break;
        }
    }
    let off = &at - mean;
    let slopes = &precision * &off;
    let squares = off.dot(&slopes);
    // beside its bound a factor has less room than a normal variable of its width
    let room = |&k: &usize| {
        let width = precision[(k, k)].max(f64::MIN_POSITIVE).sqrt();
        match at[k] > lowest[k] {
            true => log_below((at[k] - lowest[k]) * width),
            false => {
                let slope = slopes[k] / width;
                0.5 * slope * slope + log_below(-slope)
            }
        }
    };
    let rooms: f64 = places.iter().map(room).sum();
    (at, gained - 0.5 * squares + rooms)
}
