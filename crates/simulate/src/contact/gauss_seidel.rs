//! Coulomb friction with the true cone, contact by contact: projected Gauss-Seidel.
//!
//! In turn, each contact gets the force that solves its own block while the others stand still: it
//! sticks if that force lies in its cone; otherwise the normal force is corrected and the
//! tangential one is projected onto the disk of radius mu f_n. A fixed point solves the contact
//! problem. Redundant contacts do no harm: of all distributions the one near the start is found.

use super::ContactProblem;
use super::cholesky::dot;

/// When the sweeps end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepLimits {
    /// Most sweeps over all contacts.
    pub sweeps: usize,
    /// A sweep that changes no response of a contact's own force by more ends the iteration [m/s,
    /// or m/s^2 for forces].
    pub response: f64,
}

impl Default for SweepLimits {
    fn default() -> Self {
        Self { sweeps: 500, response: 1e-10 }
    }
}

/// How the sweeps ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepReport {
    /// Number of sweeps.
    pub sweeps: usize,
    /// The largest change of the last sweep, in the units of the response.
    pub change: f64,
    /// The change fell below its limit.
    pub converged: bool,
}

/// Improves `force` (the start: zeros, or the forces of the step before) until sweeps change
/// nothing. All contacts have Coulomb friction; released ones keep a force of zero.
pub fn solve(problem: &ContactProblem<'_>, limits: SweepLimits, force: &mut [f64]) -> SweepReport {
    let mut change = f64::INFINITY;
    for sweep in 1..=limits.sweeps {
        change = 0.0;
        for contact in 0..problem.contacts.len() {
            change = update(problem, contact, force).max(change);
        }
        if change <= limits.response {
            return SweepReport { sweeps: sweep, change, converged: true };
        }
    }
    SweepReport { sweeps: limits.sweeps, change, converged: false }
}

/// The same with steps of half the length: sweeps that circle, between friction and normal forces
/// of redundant contacts that slip, come to rest. Cones are convex, so that what is between two
/// forces within them is within them too. `memory` is overwritten.
pub fn solve_damped(
    problem: &ContactProblem<'_>,
    limits: SweepLimits,
    force: &mut [f64],
    memory: &mut Vec<f64>,
) -> SweepReport {
    let one = SweepLimits { sweeps: 1, ..limits };
    let mut last = SweepReport { sweeps: 0, change: f64::INFINITY, converged: false };
    for sweep in 1..=limits.sweeps {
        memory.clear();
        memory.extend_from_slice(force);
        last = SweepReport { sweeps: sweep, ..solve(problem, one, force) };
        if last.converged {
            break;
        }
        for (entry, old) in force.iter_mut().zip(memory.iter()) {
            *entry = 0.5 * (*entry + old);
        }
    }
    last
}

/// Gives one contact its force; returns the largest change times the row's diagonal.
fn update(problem: &ContactProblem<'_>, contact: usize, force: &mut [f64]) -> f64 {
    let (size, tangents) = (problem.space.rows(), problem.space.tangents());
    let (rows, first) = (problem.rows(), contact * size);
    let law = &problem.contacts[contact];
    if law.released {
        return 0.0;
    }
    let (mut block, mut w, mut old) = ([[0.0; 3]; 3], [0.0; 3], [0.0; 3]);
    for i in 0..size {
        let line = &problem.delassus[(first + i) * rows..(first + i + 1) * rows];
        w[i] = problem.free[first + i] + dot(line, force);
        block[i][..size].copy_from_slice(&line[first..first + size]);
        old[i] = force[first + i];
    }
    let n = tangents;
    // A point that nothing can move needs no force.
    if block[n][n] <= 0.0 {
        return 0.0;
    }
    let mu = law.coefficient().unwrap_or(0.0);
    let new = sticking(&block, &w, &old, size)
        .filter(|f| f[n] >= 0.0 && f[0].hypot(if n == 2 { f[1] } else { 0.0 }) <= mu * f[n])
        .unwrap_or_else(|| slipping(&block, &w, &old, n, mu));
    let mut change = 0.0_f64;
    for i in 0..size {
        force[first + i] = new[i];
        change = change.max((new[i] - old[i]).abs() * block[i][i]);
    }
    change
}

/// old - block^-1 w, by Cramer's rule; nothing if the block is singular.
fn sticking(block: &[[f64; 3]; 3], w: &[f64; 3], old: &[f64; 3], size: usize) -> Option<[f64; 3]> {
    let g = block;
    if size == 2 {
        let determinant = g[0][0] * g[1][1] - g[0][1] * g[1][0];
        if determinant <= 1e-12 * g[0][0] * g[1][1] {
            return None;
        }
        let x = (w[0] * g[1][1] - w[1] * g[0][1]) / determinant;
        let z = (w[1] * g[0][0] - w[0] * g[1][0]) / determinant;
        return Some([old[0] - x, old[1] - z, 0.0]);
    }
    let cross = |a: &[f64; 3], b: &[f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let minors = [cross(&g[1], &g[2]), cross(&g[2], &g[0]), cross(&g[0], &g[1])];
    let determinant = dot(&g[0], &minors[0]);
    if determinant <= 1e-12 * g[0][0] * g[1][1] * g[2][2] {
        return None;
    }
    // The block is symmetric, so that its cofactors are too.
    Some(std::array::from_fn(|i| old[i] - dot(&minors[i], w) / determinant))
}

/// Corrects the normal force, then the tangential one by a step that cannot overshoot.
fn slipping(block: &[[f64; 3]; 3], w: &[f64; 3], old: &[f64; 3], n: usize, mu: f64) -> [f64; 3] {
    let mut new = *old;
    new[n] = (old[n] - w[n] / block[n][n]).max(0.0);
    let change = new[n] - old[n];
    // The largest eigenvalue of the tangential block.
    let stiffest = if n == 1 {
        block[0][0]
    } else {
        let (half, off) = (0.5 * (block[0][0] - block[1][1]), block[0][1]);
        0.5 * (block[0][0] + block[1][1]) + half.hypot(off)
    };
    if stiffest <= 0.0 {
        return new;
    }
    for axis in 0..n {
        new[axis] = old[axis] - (w[axis] + block[axis][n] * change) / stiffest;
    }
    let (size, radius) = (new[0].hypot(if n == 2 { new[1] } else { 0.0 }), mu * new[n]);
    if size > radius {
        for axis in 0..n {
            new[axis] *= radius / size;
        }
    }
    new
}
