//! How strong an effect is: what it leaves in the torques after the nominal model has been fitted
//! within its stated uncertainty, against what noise leaves.
//!
//! Positions pass a zero-phase filter of 100 Hz and are differentiated; the difference between
//! measured torque and nominal inverse dynamics passes one of 20 Hz (each of fourth order, forwards
//! and backwards). Numbers of the model file move as far as their standard deviations let them
//! (least squares with the stated uncertainty as a prior, and two standard deviations as a bound),
//! linear in the changes.

use super::experiment::Log;
use super::filter::{LowPass, rate};
use super::nominal::{Motion, Nominal};
use nalgebra::DMatrix;

/// Filter of residuals \[Hz\].
pub const CUTOFF_HZ: f64 = 20.0;
const POSITIONS_HZ: f64 = 100.0;
/// Within their stated uncertainty: this many standard deviations.
const MOST_STDS: f64 = 2.0;
const SWEEPS: usize = 2000;
/// Left out at both ends \[s\].
const EDGE_S: f64 = 0.4;

/// Motion of all joints, sample by sample.
struct Series {
    q: Vec<Vec<f64>>,
    motor: Vec<Vec<f64>>,
}

fn by_sample(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let rows = 0..columns[0].len();
    rows.map(|row| columns.iter().map(|column| column[row]).collect()).collect()
}

/// Root mean square of what is left of each equation of the model [N m]; `noise` is that of the
/// measured torques.
pub fn left(log: &Log, nominal: &Nominal, noise: &[f64]) -> Vec<f64> {
    let (joints, equations) = (log.q.len(), nominal.equations());
    let smooth = LowPass::new(POSITIONS_HZ, log.step_s);
    let low = LowPass::new(CUTOFF_HZ, log.step_s);
    let filtered = |columns: &[Vec<f64>]| columns.iter().map(|one| smooth.apply(one)).collect();
    let mut series = Series { q: filtered(&log.q), motor: filtered(&log.motor) };
    for joint in (0..joints).filter(|joint| nominal.elastic_joints().all(|one| one != *joint)) {
        series.motor[joint] = series.q[joint].clone();
    }
    let derived = |columns: &[Vec<f64>]| -> Vec<Vec<f64>> {
        columns.iter().map(|one| rate(one, log.step_s)).collect()
    };
    let (qd, motor_rate) = (derived(&series.q), derived(&series.motor));
    let (qdd, motor_acceleration) = (derived(&qd), derived(&motor_rate));
    let signals = [&series.q, &qd, &qdd, &series.motor, &motor_rate, &motor_acceleration]
        .map(|s| by_sample(s));
    let motion = |row: usize| {
        let [q, qd, qdd, motor, motor_rate, motor_acceleration] =
            [0, 1, 2, 3, 4, 5].map(|k| &signals[k][row]);
        Motion { q, qd, qdd, motor, motor_rate, motor_acceleration }
    };
    let rows = log.q[0].len();
    let directions: Vec<Vec<f64>> = motor_rate.iter().map(|rate| direction(rate)).collect();
    let mut residual = vec![vec![0.0; rows]; equations];
    let mut torques = vec![0.0; equations];
    for row in 0..rows {
        nominal.smooth_torques(&motion(row), &mut torques);
        for joint in 0..joints {
            let dry = nominal.robot.joint_side(joint)[2] * directions[joint][row];
            residual[joint][row] = log.tau[joint][row] - torques[joint] - dry;
        }
        for spring in joints..equations {
            residual[spring][row] = -torques[spring];
        }
    }
    let edge = (EDGE_S / log.step_s) as usize;
    let stride = ((0.5 / CUTOFF_HZ) / log.step_s).max(1.0) as usize;
    let kept: Vec<usize> = (edge..rows - edge).step_by(stride).collect();
    let residual: Vec<Vec<f64>> = residual.iter().map(|one| low.apply(one)).collect();
    let share = (2.0 * CUTOFF_HZ * log.step_s).sqrt();
    let springs = nominal.elastic_joints().map(|joint| noise[joint]);
    let noise = noise.iter().copied().chain(springs);
    let weights: Vec<f64> = noise.map(|noise| 1.0 / (noise * share)).collect();
    let right: Vec<f64> = stacked(equations, &kept, &weights, |joint, row| residual[joint][row]);
    let mut columns = smooth_columns(nominal, &kept, &weights, motion);
    for joint in 0..joints {
        let level = nominal.robot.joint_side(joint)[2] * nominal.friction_std;
        let signs: Vec<f64> = directions[joint].iter().map(|sign| level * sign).collect();
        let signs = low.apply(&signs);
        let of = |at: usize, row: usize| if at == joint { signs[row] } else { 0.0 };
        columns.push(stacked(equations, &kept, &weights, of));
    }
    let fitted = fit(&columns, &right);
    let per_joint = fitted.chunks(kept.len()).zip(&weights);
    per_joint
        .map(|(part, weight)| {
            (part.iter().map(|x| x * x).sum::<f64>() / part.len() as f64).sqrt() / weight
        })
        .collect()
}

/// Mean sign of a rate over the window of each sample, in which a torque is measured: the rate
/// passes 0 between samples.
fn direction(rate: &[f64]) -> Vec<f64> {
    let last = rate.len() - 1;
    let mean = |row: usize| {
        let change = (rate[(row + 1).min(last)] - rate[row.saturating_sub(1)]).abs();
        if change > 0.0 { (4.0 * rate[row] / change).clamp(-1.0, 1.0) } else { rate[row].signum() }
    };
    (0..rate.len()).map(mean).collect()
}

/// Joint after joint, weighted.
fn stacked(
    joints: usize,
    kept: &[usize],
    weights: &[f64],
    value: impl Fn(usize, usize) -> f64,
) -> Vec<f64> {
    let each = (0..joints).flat_map(|joint| kept.iter().map(move |row| (joint, *row)));
    each.map(|(joint, row)| weights[joint] * value(joint, row)).collect()
}

/// What one standard deviation of each number of the file does, Coulomb friction left out.
fn smooth_columns<'a>(
    nominal: &Nominal,
    kept: &[usize],
    weights: &[f64],
    motion: impl Fn(usize) -> Motion<'a>,
) -> Vec<Vec<f64>> {
    let equations = weights.len();
    let all = |model: &Nominal| {
        let mut table = vec![vec![0.0; equations]; kept.len()];
        for (row, torques) in kept.iter().zip(&mut table) {
            model.smooth_torques(&motion(*row), torques);
        }
        table
    };
    let plain = all(nominal);
    let index: Vec<usize> = (0..kept.len()).collect();
    let changed = nominal.deviations().into_iter().map(|robot| {
        let table = all(&Nominal { robot, ..nominal.clone() });
        stacked(equations, &index, weights, |joint, row| table[row][joint] - plain[row][joint])
    });
    changed.collect()
}

/// What is left of `right` after the columns, each counted in standard deviations of a prior and
/// moved by two of them at most: descent along one coordinate after the other, clamped.
fn fit(columns: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let count = columns.len();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut normal: DMatrix<f64> = DMatrix::identity(count, count);
    let mut slope: Vec<f64> = columns.iter().map(|column| dot(column, right)).collect();
    for row in 0..count {
        for other in 0..=row {
            let entry = dot(&columns[row], &columns[other]);
            normal[(row, other)] += entry;
            if other != row {
                normal[(other, row)] += entry;
            }
        }
    }
    let mut solution = vec![0.0; count];
    for _ in 0..SWEEPS {
        let mut farthest = 0.0_f64;
        for index in 0..count {
            let old: f64 = solution[index];
            let new = (old + slope[index] / normal[(index, index)]).clamp(-MOST_STDS, MOST_STDS);
            let change = new - old;
            solution[index] = new;
            farthest = farthest.max(change.abs());
            let pulls = normal.column(index);
            slope.iter_mut().zip(pulls.iter()).for_each(|(slope, pull)| *slope -= change * pull);
        }
        if farthest < 1e-4 {
            break;
        }
    }
    let mut left = right.to_vec();
    for (column, factor) in columns.iter().zip(&solution) {
        left.iter_mut().zip(column).for_each(|(left, entry)| *left -= factor * entry);
    }
    left
}
