//! Bodies that exist: the parameters nearest to an estimate with positive definite pseudo-inertias,
//! and friction and rotor inertia that are not negative.
//!
//! Bodies have log-Cholesky coordinates, so that no step can leave those that exist. What the
//! estimate says nothing about stays near where it started.

use super::least_squares::Estimate;
use crate::policy::consistent::{BOUND_WEIGHTS, FAR, STAY};
use denavit_plants::coordinates::{Bounds, Coordinates};
use denavit_plants::regression::{RegressionModel, StandardParameter};
use nalgebra::{DMatrix, DVector};

/// Steps of the search.
const MAX_STEPS: usize = 200;

const STAGES: usize = 20;

/// Bodies and joints near an estimate.
#[derive(Clone, Debug, PartialEq)]
pub struct Consistent {
    /// theta0, in the order of [`RegressionModel::standard`].
    pub standard: Vec<f64>,
    /// phi of it.
    pub phi: Vec<f64>,
    /// How far phi is from the estimate, in standard errors: the root of their mean square over
    /// the parameters. Far below 1, the estimate itself belongs to bodies that exist.
    pub distance: f64,
    /// Values of the model's own numbers, where columns are products of them: their places in
    /// [`RegressionModel::parameters`].
    pub own: Vec<(usize, f64)>,
}

/// The nearest parameters of bodies that exist, from those of the model before.
pub fn consistent(model: &RegressionModel, found: &Estimate) -> Consistent {
    let triangles = found.condensed.whole();
    let rank = found.condensed.rank;
    let r = found.condensed.system(&triangles, &found.weights, &[]);
    let w = r.view((0, 0), (rank, rank)).into_owned();
    let b = model.of_standard();
    let target = &w * &found.solution.phi;
    // Weights are 1 over noise, or 1 where there is none: what counts is the residual's own size.
    let scale = noise_scale(&r, &target, rank);
    let coordinates = Coordinates::new(model);
    let of_model = |one: &StandardParameter| one.value.unwrap_or(0.0);
    let first = coordinates.of_start(&model.standard.iter().map(of_model).collect::<Vec<f64>>());
    let mut problem = Problem {
        jacobian: (&w * b) / scale,
        target: target / scale,
        bounds: Bounds::new(model),
        weight: 0.0,
        coordinates,
        first,
    };
    let mut eta = problem.search(&problem.first);
    let cost = problem.cost(&eta);
    if cost > FAR.powi(2) * rank as f64 {
        let next = problem.search_in_stages();
        eta = if problem.cost(&next) < cost { next } else { eta };
    }
    for weight in BOUND_WEIGHTS {
        if problem.bounds.hold(&problem.coordinates.file_values(&eta)) {
            break;
        }
        problem.weight = weight;
        eta = problem.search(&eta);
    }
    let (theta, _) = problem.coordinates.standard(&eta);
    let residual = &problem.target - &problem.jacobian * &theta;
    let standard = theta.as_slice().to_vec();
    let phi = model.axes_of_standard(&standard);
    let own = problem.coordinates.own_values(&eta);
    let distance = (residual.norm_squared() / rank.max(1) as f64).sqrt();
    Consistent { standard, phi, distance, own }
}

struct Problem<'a> {
    /// Of theta0.
    jacobian: DMatrix<f64>,
    target: DVector<f64>,
    bounds: Bounds<'a>,
    /// Of what entries of bodies fall short of.
    weight: f64,
    coordinates: Coordinates<'a>,
    /// Those of the model before, near which what nothing is said about stays.
    first: DVector<f64>,
}

impl Problem<'_> {
    fn cost(&self, eta: &DVector<f64>) -> f64 {
        let (theta, _) = self.coordinates.standard(eta);
        let residual = &self.target - &self.jacobian * theta;
        let short = self.short(eta).norm_squared();
        residual.norm_squared() + short + STAY * (eta - &self.first).norm_squared()
    }

    /// What entries of bodies fall short of, weighted.
    fn short(&self, eta: &DVector<f64>) -> DVector<f64> {
        if self.weight == 0.0 {
            return DVector::zeros(0);
        }
        let short = self.bounds.short(&self.coordinates.file_values(eta));
        DVector::from_vec(short) * self.weight
    }

    /// All residuals, and how they fall with the coordinates.
    fn rows(&self, eta: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let (theta, slope) = self.coordinates.standard(eta);
        let j = &self.jacobian * slope;
        let residual = &self.target - &self.jacobian * &theta;
        if self.weight == 0.0 {
            return (residual, j);
        }
        let (rows, bounded) = (residual.len(), self.bounds.count());
        let mut all = residual.resize_vertically(rows + bounded, 0.0);
        all.rows_mut(rows, bounded).copy_from(&self.short(eta));
        let mut j = j.resize_vertically(rows + bounded, 0.0);
        for (at, _) in self.coordinates.own() {
            let step = 1e-5 * eta[at].abs().max(1e-2);
            let moved = |by: f64| {
                let mut moved = eta.clone();
                moved[at] += by;
                self.short(&moved)
            };
            let fall = (moved(-step) - moved(step)) / (2.0 * step);
            j.view_mut((rows, at), (bounded, 1)).copy_from(&fall);
        }
        (all, j)
    }

    /// The nearest coordinates to targets on the way from those of before to the target, one after
    /// the other.
    fn search_in_stages(&mut self) -> DVector<f64> {
        let last = self.target.clone();
        let begin = &self.jacobian * self.coordinates.standard(&self.first).0;
        let mut eta = self.first.clone();
        for stage in 1..=STAGES {
            self.target = &begin + (&last - &begin) * (stage as f64 / STAGES as f64);
            eta = self.search(&eta);
        }
        self.target = last;
        eta
    }

    /// The nearest coordinates from `eta` on (Levenberg, Marquardt).
    fn search(&self, eta: &DVector<f64>) -> DVector<f64> {
        let mut eta = eta.clone();
        let mut damping = 1e-3;
        let mut cost = self.cost(&eta);
        for _ in 0..MAX_STEPS {
            let (residual, j) = self.rows(&eta);
            let next = damped(&j, &residual, &(&self.first - &eta), damping).map(|step| {
                let longest = step.amax();
                let limited = if longest > 2.0 { step * (2.0 / longest) } else { step };
                &eta + limited
            });
            let better = next.map(|next| (self.cost(&next), next));
            match better.filter(|(there, _)| *there < cost) {
                Some((there, next)) => {
                    let gain = cost - there;
                    (cost, eta) = (there, next);
                    damping = (damping * 0.2).max(1e-14);
                    if gain < 1e-12 * cost.max(1e-12) {
                        break;
                    }
                }
                None if damping > 1e12 => break,
                None => damping = damping.max(1e-12) * 8.0,
            }
        }
        eta
    }
}

/// The step that makes residuals smallest, damped, and drawn `home` a little.
fn damped(
    j: &DMatrix<f64>,
    residual: &DVector<f64>,
    home: &DVector<f64>,
    damping: f64,
) -> Option<DVector<f64>> {
    let (rows, columns) = j.shape();
    let mut matrix = DMatrix::zeros(rows + columns, columns);
    let mut right = DVector::zeros(rows + columns);
    matrix.rows_mut(0, rows).copy_from(j);
    right.rows_mut(0, rows).copy_from(residual);
    let stay = (STAY + damping).sqrt();
    for place in 0..columns {
        matrix[(rows + place, place)] = stay;
        right[rows + place] = STAY / stay * home[place];
    }
    let qr = matrix.qr();
    let right = qr.q().tr_mul(&right);
    qr.r().solve_upper_triangular(&right)
}

/// The deviation of a weighted row: from the residual, or from rounding where there is none.
fn noise_scale(r: &DMatrix<f64>, target: &DVector<f64>, rank: usize) -> f64 {
    let left = if r.nrows() > rank { r[(rank, rank)].abs() } else { 0.0 };
    let floor = 1e-9 * target.norm();
    // Weighted rows have a deviation near 1, whatever their number is.
    if left > floor { 1.0 } else { floor.max(f64::MIN_POSITIVE) }
}
