//! Coulomb friction with the true cone, all contacts at once: semismooth Newton.
//!
//! Alart and Curnier's form of the laws, with w = G f + b and any r > 0,
//!
//! > f_n = max(0, f_n - r w_n),  f_t = projection of f_t - r w_t onto the disk of radius mu f_n,
//!
//! is an equation without inequalities, smooth but for the edges of its cases, and Newton's method
//! converges in some ten steps where sweeps over single contacts take thousands. Redundant contacts
//! are told apart by a little compliance: all points give way alike, by so little that nothing but
//! the distribution of their forces depends on it.

use super::{ContactProblem, Mode, closed_mode, length};
use nalgebra::{DMatrix, DVector};

/// Compliance of all points, relative to the mean of G's diagonal: more where less leaves the
/// method between cases.
const COMPLIANCE: [f64; 4] = [1e-9, 1e-7, 1e-5, 1e-3];
/// Solutions, each with the compliance of the one before taken back.
const CORRECTIONS: usize = 30;
/// As much of what points give way is left, in units of what counts as no response; and is where
/// they are nearly one.
const TAKEN_BACK: f64 = 1e-2;
const NEARLY: f64 = 1e3;
/// Steps at most.
const STEPS: usize = 80;
/// Where steps cease to get nearer than this, relative to the largest force, sweeps go on.
const NEAR: f64 = 1e-6;
/// Halvings of a step that does not get nearer.
const HALVINGS: usize = 12;
/// By how much the laws are missed at most, relative to the largest force; and how little is enough
/// to stop at once.
const RESIDUAL: [f64; 2] = [1e-11, 1e-14];

/// What one contact is, and the row scales r of its normal and of its tangents.
#[derive(Clone, Copy, Debug)]
struct Scales {
    normal: f64,
    tangent: f64,
}

/// How near forces come to the laws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Found {
    /// They obey them.
    Forces,
    /// Points that are all but one are told apart by less than the compliance: they give way by
    /// as much as this many times what counts as no response.
    Nearly(f64),
    /// No steps led to any.
    Nothing,
}

/// Improves `force` (the start) until it obeys the laws, or nearly. No contact is `NoSlip`.
pub fn solve(problem: &ContactProblem<'_>, force: &mut [f64]) -> Found {
    let (mut nearest, mut kept) = (NEARLY, None);
    for compliance in COMPLIANCE {
        let mut trial = force.to_vec();
        let Some((_, way)) = solve_compliant(problem, compliance, RESIDUAL[0], &mut trial) else {
            continue;
        };
        if way <= TAKEN_BACK {
            force.copy_from_slice(&trial);
            return Found::Forces;
        }
        if way <= nearest {
            (nearest, kept) = (way, Some(trial));
        }
    }
    kept.map_or(Found::Nothing, |kept| {
        force.copy_from_slice(&kept);
        Found::Nearly(nearest)
    })
}

/// As `solve`, from forces that obey the laws already: only how redundant contacts share them may
/// change. Says whether the new forces obey the laws exactly, or nearly; none, with `force` as it
/// was, if no steps lead there.
pub fn improve(problem: &ContactProblem<'_>, force: &mut [f64]) -> Option<bool> {
    let mut trial = force.to_vec();
    let (missed, way) = solve_compliant(problem, COMPLIANCE[0], NEAR, &mut trial)?;
    (way <= TAKEN_BACK).then(|| {
        force.copy_from_slice(&trial);
        missed <= RESIDUAL[0]
    })
}

/// Points that give way alike; what that changes of the motion is taken back afterwards. Returns by
/// how much the laws are missed, relative to the largest force, none if that is too much; and what
/// could not be taken back, in units of what counts as no response.
fn solve_compliant(
    problem: &ContactProblem<'_>,
    relative: f64,
    enough: f64,
    force: &mut [f64],
) -> Option<(f64, f64)> {
    let n = problem.rows();
    let trace: f64 = (0..n).map(|i| problem.delassus[i * n + i]).sum();
    let compliance = relative * trace / n.max(1) as f64;
    let mut g = DMatrix::from_row_slice(n, n, problem.delassus);
    for i in 0..n {
        g[(i, i)] += compliance;
    }
    let scales: Vec<Scales> = (0..problem.contacts.len())
        .map(|contact| {
            let (block, normal) = (problem.block(contact), problem.normal(contact));
            let stiffest = (block.start..normal).fold(0.0_f64, |most, row| most.max(g[(row, row)]));
            Scales { normal: 1.0 / g[(normal, normal)], tangent: 1.0 / stiffest }
        })
        .collect();
    let free = DVector::from_column_slice(problem.free);
    let mut f = DVector::from_column_slice(force);
    let mut given_way = DVector::zeros(n);
    let mut result = None;
    for _ in 0..CORRECTIONS {
        let missed = iterate(problem, &scales, &g, &(&free - &given_way), enough, &mut f);
        if missed.is_nan() || missed > enough {
            return None;
        }
        let before = std::mem::replace(&mut given_way, compliance * &f);
        let way = (&given_way - before).amax() / problem.response_zero();
        force.copy_from_slice(f.as_slice());
        result = Some((missed, way));
        // the distribution of forces stays as the compliance made it
        if way <= TAKEN_BACK {
            break;
        }
    }
    result
}

/// Newton's method on w = g f + b; returns by how much the laws are missed, relative to the largest
/// force.
fn iterate(
    problem: &ContactProblem<'_>,
    scales: &[Scales],
    g: &DMatrix<f64>,
    b: &DVector<f64>,
    enough: f64,
    f: &mut DVector<f64>,
) -> f64 {
    let mut w = g * &*f + b;
    let mut missed = laws(problem, scales, f, &w);
    let mut last = f64::INFINITY;
    for _ in 0..STEPS {
        let size = missed.norm();
        if !size.is_finite() {
            return f64::INFINITY;
        }
        let scale = f.amax() + 1e-9;
        // one more step, once it is near: convergence is quadratic there
        if size <= RESIDUAL[1] * scale || (size <= RESIDUAL[0] * scale && size >= 0.1 * last) {
            return (size / scale).min(RESIDUAL[0]);
        }
        // at the edge of a case steps go to and fro
        if size <= enough * scale && size >= 0.5 * last {
            return size / scale;
        }
        last = size;
        let slope = slopes(problem, scales, g, f, &w);
        let Some(step) = slope.lu().solve(&missed) else { return f64::INFINITY };
        let mut share = 1.0;
        for _ in 0..HALVINGS {
            let trial = &*f - share * &step;
            w = g * &trial + b;
            missed = laws(problem, scales, &trial, &w);
            if missed.norm() <= (1.0 - 0.1 * share) * size {
                *f = trial;
                break;
            }
            share *= 0.5;
        }
        // a short step leads across the edge of a case where no step gets nearer
        if share < 1.0 / f64::from(1 << (HALVINGS - 1)) {
            *f -= 0.5 * &step;
            w = g * &*f + b;
            missed = laws(problem, scales, f, &w);
        }
    }
    missed.norm() / (f.amax() + 1e-9)
}

/// The modes that forces which obey the laws belong to; closed is what does not leave the ground,
/// with or without a force.
pub fn modes(problem: &ContactProblem<'_>, force: &[f64], response: &[f64], modes: &mut Vec<Mode>) {
    modes.clear();
    let zero = 10.0 * problem.response_zero();
    let no_force = problem.force_zero(force.iter().fold(0.0_f64, |most, f| most.max(f.abs())));
    for (index, contact) in problem.contacts.iter().enumerate() {
        let (block, tangents) = (problem.block(index), problem.space.tangents());
        let (f, w) = (&force[block.clone()], &response[block]);
        let speed = length(&w[..tangents]);
        // saturated, but held by the other points of its foot
        let grips = speed <= zero
            || contact
                .coefficient()
                .is_none_or(|mu| length(&f[..tangents]) < mu * f[tangents] * (1.0 - 1e-9));
        modes.push(if contact.released || (f[tangents] <= no_force && w[tangents] > zero) {
            Mode::Open
        } else if contact.has_slip_law() || grips {
            closed_mode(contact)
        } else {
            Mode::Slip(std::array::from_fn(|axis| match tangents > axis {
                true => w[axis] / speed,
                false => 0.0,
            }))
        });
    }
}

/// The case of the laws that a contact is in, at forces f and responses w.
enum Case {
    /// Nothing presses: the force is 0.
    Open,
    /// The direction of its friction is given.
    Slips([f64; 2]),
    /// f_t - r w_t lies within the disk.
    Sticks,
    /// f_t - r w_t has this unit vector and this length, and mu f_n - mu r w_n is the radius.
    Leaves { along: [f64; 2], length: f64, radius: f64 },
}

impl Case {
    fn of(
        problem: &ContactProblem<'_>,
        index: usize,
        scales: Scales,
        f: &DVector<f64>,
        w: &DVector<f64>,
    ) -> Self {
        let (first, n) = (problem.block(index).start, problem.normal(index));
        let contact = &problem.contacts[index];
        let pressed = f[n] - scales.normal * w[n];
        if contact.released || pressed <= 0.0 {
            return Self::Open;
        }
        if contact.has_slip_law() {
            return Self::Slips(contact.slipping.unwrap_or([0.0; 2]));
        }
        let pulled = [0, 1].map(|axis| match axis < problem.space.tangents() {
            true => f[first + axis] - scales.tangent * w[first + axis],
            false => 0.0,
        });
        let (length, radius) = (length(&pulled), friction(problem, index) * pressed);
        match length <= radius {
            true => Self::Sticks,
            false => Self::Leaves { along: pulled.map(|entry| entry / length), length, radius },
        }
    }
}

/// The coefficient of a contact; none is `NoSlip`.
fn friction(problem: &ContactProblem<'_>, index: usize) -> f64 {
    problem.contacts[index].coefficient().unwrap_or(0.0)
}

/// By how much forces miss the laws \[N\].
fn laws(
    problem: &ContactProblem<'_>,
    scales: &[Scales],
    f: &DVector<f64>,
    w: &DVector<f64>,
) -> DVector<f64> {
    // an open contact misses by its whole force
    let mut missed = f.clone();
    for (index, &own) in scales.iter().enumerate() {
        let (first, n) = (problem.block(index).start, problem.normal(index));
        let case = Case::of(problem, index, own, f, w);
        if !matches!(case, Case::Open) {
            missed[n] = own.normal * w[n];
        }
        for axis in 0..problem.space.tangents() {
            let row = first + axis;
            match case {
                Case::Open => {}
                Case::Slips(way) => missed[row] += friction(problem, index) * way[axis] * f[n],
                Case::Sticks => missed[row] = own.tangent * w[row],
                Case::Leaves { along, radius, .. } => missed[row] -= radius * along[axis],
            }
        }
    }
    missed
}

/// The derivative of `laws`.
fn slopes(
    problem: &ContactProblem<'_>,
    scales: &[Scales],
    g: &DMatrix<f64>,
    f: &DVector<f64>,
    w: &DVector<f64>,
) -> DMatrix<f64> {
    let rows = f.len();
    let mut slope = DMatrix::identity(rows, rows);
    let tangents = problem.space.tangents();
    for (index, &own) in scales.iter().enumerate() {
        let (first, n) = (problem.block(index).start, problem.normal(index));
        let mu = friction(problem, index);
        let case = Case::of(problem, index, own, f, w);
        if !matches!(case, Case::Open) {
            slope.set_row(n, &(own.normal * g.row(n)));
        }
        for axis in 0..tangents {
            let row = first + axis;
            match case {
                Case::Open => {}
                Case::Slips(way) => slope[(row, n)] += mu * way[axis],
                Case::Sticks => slope.set_row(row, &(own.tangent * g.row(row))),
                // f_t - mu p a / |a|, with a = f_t - r_t w_t and p = f_n - r_n w_n
                Case::Leaves { along, length, radius } => {
                    for column in 0..rows {
                        let unit = |other: usize| f64::from(u8::from(other == column));
                        let pressed = unit(n) - own.normal * g[(n, column)];
                        slope[(row, column)] -= mu * along[axis] * pressed;
                        for other in 0..tangents {
                            let across =
                                f64::from(u8::from(axis == other)) - along[axis] * along[other];
                            let turned =
                                unit(first + other) - own.tangent * g[(first + other, column)];
                            slope[(row, column)] -= radius / length * across * turned;
                        }
                    }
                }
            }
        }
    }
    slope
}
