//! Weighted least squares with everything that the nominal model is not sure of eliminated.
//!
//! For each try of an effect the best z is implied: with [A; I] = Q R the cost of what is left is
//! |rho|^2 - |Q' rho|^2, so that only the few parameters of effects are searched (variable
//! projection, Golub and Pereyra 1973).

use super::data::{Data, ModelTorques, RowResponse};
use super::held::Held;
use super::law::Law;
use crate::policy::problem::{SETTLED, STUCK};
use nalgebra::{DMatrix, DVector};
use std::rc::Rc;

/// A law with the values of its parameters.
#[derive(Clone)]
pub struct Fitted<'l> {
    /// The law.
    pub law: &'l dyn Law,
    /// Its parameters.
    pub values: Vec<f64>,
}

/// Rows with their weights, and what of them z explains.
#[derive(Clone)]
pub struct Problem<'a> {
    /// The rows.
    pub data: &'a Data<'a>,
    /// One over the deviation of each row.
    weights: Vec<f64>,
    factors: Rc<Factors>,
    held: Held,
    residual: DVector<f64>,
    /// The rows as they are, if they are others than those of the data.
    rows: Option<Rc<Vec<f64>>>,
}

/// [A; I] = Q R, of Q the rows of A.
struct Factors {
    q: DMatrix<f64>,
    r: DMatrix<f64>,
}

/// What was found of effects.
#[derive(Clone, Debug)]
pub struct Found {
    /// The values of each law's parameters.
    pub values: Vec<Vec<f64>>,
    /// Sum of squares of what is left, weighted, with that of z.
    pub cost: f64,
    /// The nominal model's own parameters, in their deviations.
    pub z: Vec<f64>,
    /// What is left of each row [N m, N].
    pub residual: Vec<f64>,
}

/// Most iterations of a search.
const ITERATIONS: usize = 12;

impl<'a> Problem<'a> {
    /// A problem with a deviation for each row.
    pub fn new(data: &'a Data<'a>, deviation: &[f64]) -> Self {
        let weights: Vec<f64> = deviation.iter().map(|deviation| 1.0 / deviation).collect();
        let (rows, width) = (data.rows(), data.columns.len());
        let mut stacked = DMatrix::zeros(rows + width, width);
        let residual = data.residual.iter().zip(&weights).map(|(r, w)| r * w);
        let residual = DVector::from_iterator(rows, residual);
        for (place, column) in data.columns.iter().enumerate() {
            stacked[(rows + place, place)] = 1.0;
            for (row, (entry, weight)) in column.iter().zip(&weights).enumerate() {
                stacked[(row, place)] = entry * weight;
            }
        }
        let qr = stacked.qr();
        let (q, r) = (qr.q().rows(0, rows).into_owned(), qr.r());
        let held = Held::new(&r, &vec![None; width]);
        Self { data, weights, factors: Rc::new(Factors { q, r }), held, residual, rows: None }
    }

    /// The same problem for other rows in place of those of the data.
    pub fn of_rows(&self, rows: Vec<f64>) -> Self {
        let weighted = rows.iter().zip(&self.weights).map(|(row, weight)| row * weight);
        let residual = DVector::from_iterator(rows.len(), weighted);
        Self { residual, rows: Some(Rc::new(rows)), ..self.clone() }
    }

    /// The same problem with entries of z that have values; those without one are free.
    pub fn holding(&self, held: &[Option<f64>]) -> Self {
        Self { held: Held::new(&self.factors.r, held), ..self.clone() }
    }

    /// The responses of laws to all logs, in the rows.
    fn responses(&self, laws: &[Fitted<'_>], torques: &[ModelTorques]) -> Vec<RowResponse> {
        laws.iter().map(|one| self.data.response(one.law, &one.values, torques)).collect()
    }

    /// What laws with these responses leave, and the normal equations of their parameters.
    fn look(&self, responses: &[RowResponse]) -> View {
        let mut rho = self.residual.clone();
        let mut columns: Vec<Vec<(usize, Vec<f64>)>> = Vec::new();
        for response in responses {
            let parameters = response.gradient.first().map_or(0, Vec::len);
            let begin = columns.len();
            columns.resize(begin + parameters, Vec::new());
            for (place, stretch) in response.stretches.iter().enumerate() {
                let rows = stretch.first..stretch.first + stretch.rows;
                let weights = &self.weights[rows.clone()];
                let part = rho.as_mut_slice()[rows].iter_mut();
                for ((row, torque), weight) in part.zip(&response.torque[place]).zip(weights) {
                    *row -= weight * torque;
                }
                for (parameter, gradient) in response.gradient[place].iter().enumerate() {
                    let weighted =
                        gradient.iter().zip(weights).map(|(entry, w)| w * entry).collect();
                    columns[begin + parameter].push((stretch.first, weighted));
                }
            }
        }
        View::new(&self.factors.q, &rho, &columns, &self.held)
    }

    /// Searches the values of laws from those given: Levenberg and Marquardt's steps within bounds.
    pub fn fit(&self, laws: &[Fitted<'_>], torques: &[ModelTorques]) -> Found {
        let mut laws = laws.to_vec();
        let mut responses = self.responses(&laws, torques);
        let mut view = self.look(&responses);
        let mut damping = 1e-4;
        for _ in 0..ITERATIONS {
            if view.gradient.is_empty() {
                break;
            }
            let tried = moved(&laws, view.step(damping, &outward(&laws, &view)).as_slice());
            let next = self.responses(&tried, torques);
            let seen = self.look(&next);
            let gain = view.cost - seen.cost;
            if gain > 0.0 {
                let is_done = gain < SETTLED * view.cost;
                (laws, responses, view) = (tried, next, seen);
                damping = (damping * 0.1_f64).max(1e-12);
                if is_done {
                    break;
                }
            } else if damping > STUCK {
                break;
            } else {
                damping *= 10.0;
            }
        }
        self.found(&laws, &responses, &view)
    }

    fn found(&self, laws: &[Fitted<'_>], responses: &[RowResponse], view: &View) -> Found {
        let z = self.z(&view.explained);
        let mut residual = self.data.without(self.rows.as_deref(), &z);
        responses.iter().for_each(|response| response.subtract_from(&mut residual));
        Found {
            values: laws.iter().map(|fitted| fitted.values.clone()).collect(),
            cost: view.cost,
            z,
            residual,
        }
    }

    /// z of Q' rho.
    fn z(&self, explained: &DVector<f64>) -> Vec<f64> {
        let own = self.data.columns.len();
        let solved = self.factors.r.solve_upper_triangular(&(explained + &self.held.offset));
        let mut z = solved.map_or_else(|| vec![0.0; own], |z| z.as_slice()[..own].to_vec());
        for (z, held) in z.iter_mut().zip(&self.held.values) {
            *z = held.unwrap_or(*z);
        }
        z
    }
}

/// What is left of the rows, and the normal equations of the laws' parameters.
struct View {
    /// Sum of squares of what is left.
    cost: f64,
    /// Half the negative derivative of the cost by each parameter.
    gradient: DVector<f64>,
    /// Half its second derivative, of Gauss and Newton.
    normal: DMatrix<f64>,
    /// Squared length of each column before z is eliminated.
    lengths: DVector<f64>,
    explained: DVector<f64>,
}

impl View {
    fn new(
        q: &DMatrix<f64>,
        rho: &DVector<f64>,
        columns: &[Vec<(usize, Vec<f64>)>],
        held: &Held,
    ) -> Self {
        let count = columns.len();
        let mut inside = DMatrix::zeros(q.ncols(), count);
        let mut gradient = DVector::zeros(count);
        for (place, column) in columns.iter().enumerate() {
            for (first, entries) in column {
                let part = q.rows(*first, entries.len());
                let entries = DVector::from_column_slice(entries);
                let mut sum = inside.column_mut(place);
                sum += part.tr_mul(&entries);
                gradient[place] += entries.dot(&rho.rows(*first, entries.len()));
            }
        }
        let mut normal = DMatrix::zeros(count, count);
        for a in 0..count {
            for b in a..count {
                let mut sum = 0.0;
                for (first, entries) in &columns[a] {
                    let same = columns[b].iter().filter(|(other, _)| other == first);
                    let dot = |other: &Vec<f64>| -> f64 {
                        entries.iter().zip(other).map(|(x, y)| x * y).sum()
                    };
                    sum += same.map(|(_, other)| dot(other)).sum::<f64>();
                }
                normal[(a, b)] = sum;
                normal[(b, a)] = sum;
            }
        }
        let lengths = normal.diagonal();
        let all = q.tr_mul(rho);
        let explained = &all - &held.across * held.across.tr_mul(&all);
        gradient -= inside.tr_mul(&held.offset);
        held.free(&mut inside);
        gradient -= inside.tr_mul(&explained);
        normal -= inside.tr_mul(&inside);
        let offset = held.offset.norm_squared() - 2.0 * held.offset.dot(&all);
        let cost = rho.norm_squared() - explained.norm_squared() + offset;
        Self { cost, gradient, normal, lengths, explained }
    }

    /// The damped step; parameters in `held` stay.
    fn step(&self, damping: f64, held: &[bool]) -> DVector<f64> {
        let count = self.gradient.len();
        let mut normal = self.normal.clone();
        let mut gradient = self.gradient.clone();
        for place in 0..count {
            let own = normal[(place, place)].max(1e-9 * self.lengths[place]);
            normal[(place, place)] = own * (1.0 + damping);
            // A column of zeros, or one that z explains whole, says nothing.
            if held[place] || own <= 1e-12 * self.lengths[place] || own == 0.0 {
                normal.row_mut(place).fill(0.0);
                normal.column_mut(place).fill(0.0);
                normal[(place, place)] = 1.0;
                gradient[place] = 0.0;
            }
        }
        scaled_solve(&normal, &gradient).unwrap_or_else(|| DVector::zeros(count))
    }
}

/// Solves positive definite equations whose unknowns have different units.
fn scaled_solve(normal: &DMatrix<f64>, gradient: &DVector<f64>) -> Option<DVector<f64>> {
    let count = gradient.len();
    let scale: Vec<f64> = (0..count).map(|k| normal[(k, k)].max(1e-300).sqrt().recip()).collect();
    let scaled = DMatrix::from_fn(count, count, |a, b| normal[(a, b)] * scale[a] * scale[b]);
    let right = DVector::from_fn(count, |k, _| gradient[k] * scale[k]);
    let solved = scaled.clone().cholesky().map(|factor| factor.solve(&right));
    let solved = solved.or_else(|| scaled.svd(true, true).solve(&right, 1e-10).ok())?;
    let step = DVector::from_fn(count, |k, _| solved[k] * scale[k]);
    step.iter().all(|entry| entry.is_finite()).then_some(step)
}

/// The laws after a step, within their bounds.
fn moved<'l>(laws: &[Fitted<'l>], step: &[f64]) -> Vec<Fitted<'l>> {
    let mut steps = step.iter();
    let mut laws = laws.to_vec();
    for fitted in &mut laws {
        let parameters = fitted.law.parameters();
        for (value, parameter) in fitted.values.iter_mut().zip(parameters) {
            let [low, high] = parameter.bounds;
            let mut step = *steps.next().unwrap_or(&0.0);
            if !parameter.linear {
                // What a law is not linear in is not moved further than it is worth trusting.
                let most = (0.5 * value.abs()).max(1e-3 * (high - low).min(1e3));
                step = step.clamp(-most, most);
            }
            *value = (*value + step).clamp(low, high);
        }
    }
    laws
}

/// Parameters at a bound that a step would leave.
fn outward(laws: &[Fitted<'_>], view: &View) -> Vec<bool> {
    let mut held = Vec::new();
    for fitted in laws {
        for (value, parameter) in fitted.values.iter().zip(fitted.law.parameters()) {
            let slope = view.gradient[held.len()];
            let [low, high] = parameter.bounds;
            held.push((*value <= low && slope < 0.0) || (*value >= high && slope > 0.0));
        }
    }
    held
}
