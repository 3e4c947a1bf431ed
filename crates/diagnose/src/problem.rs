//! Weighted least squares with everything that the nominal model is not sure of eliminated.
//!
//! For each try of an effect the best z is implied: with [A; I] = Q R the cost of what is left is
//! |rho|^2 - |Q' rho|^2, so that only the few parameters of effects are searched (variable
//! projection, Golub and Pereyra 1973).

use super::data::{Data, ModelTorques, RowResponse};
use super::held::Held;
use super::law::Law;
use super::signals::Signals;
use crate::policy::problem::{INDEPENDENT, SETTLED, STUCK};
use denavit_measure::LogIndex;
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
    /// The motion that laws are evaluated on: that of the data, or a coarse view of it.
    pub signals: &'a [Signals],
    /// One over the deviation of each row.
    pub weights: Vec<f64>,
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
    /// Directions in which the laws' parameters change what is left: a body's ten numbers move few
    /// torques of a planar robot.
    pub rank: usize,
}

/// Most iterations of a search.
const ITERATIONS: usize = 12;

impl<'a> Problem<'a> {
    /// A problem with a deviation for each row. Laws that are `given` are taken away, and what
    /// they are linear in near their values is eliminated too.
    pub fn new(data: &'a Data<'a>, deviation: &[f64], given: &[RowResponse]) -> Self {
        let weights: Vec<f64> = deviation.iter().map(|deviation| 1.0 / deviation).collect();
        let (rows, own) = (data.rows(), data.columns.len());
        let of_given = |response: &RowResponse| response.gradient.first().map_or(0, Vec::len);
        let width = own + given.iter().map(of_given).sum::<usize>();
        let mut stacked = DMatrix::zeros(rows + width, width);
        let residual = data.residual.iter().zip(&weights).map(|(r, w)| r * w);
        let mut residual = DVector::from_iterator(rows, residual);
        for (place, column) in data.columns.iter().enumerate() {
            stacked[(rows + place, place)] = 1.0;
            for (row, (entry, weight)) in column.iter().zip(&weights).enumerate() {
                stacked[(row, place)] = entry * weight;
            }
        }
        let mut begin = own;
        for response in given {
            for (place, stretch) in response.stretches.iter().enumerate() {
                for k in 0..stretch.rows {
                    let (row, weight) = (stretch.first + k, weights[stretch.first + k]);
                    residual[row] -= weight * response.torque[place][k];
                    for (parameter, gradient) in response.gradient[place].iter().enumerate() {
                        let is_certain = response.stiffness[parameter].is_infinite();
                        let weight = if is_certain { 0.0 } else { weight };
                        stacked[(row, begin + parameter)] = weight * gradient[k];
                    }
                }
            }
            for parameter in 0..of_given(response) {
                // A column of zeros must not make R singular.
                let place = begin + parameter;
                let least = 1e-6 * stacked.column(place).norm().max(1e-6);
                let stiffness = response.stiffness[parameter];
                let stated = if stiffness.is_finite() { stiffness } else { 0.0 };
                stacked[(rows + place, place)] = stated.max(least);
            }
            begin += of_given(response);
        }
        let qr = stacked.qr();
        let (q, r) = (qr.q().rows(0, rows).into_owned(), qr.r());
        let held = Held::new(&r, &vec![None; width]);
        let factors = Rc::new(Factors { q, r });
        Self { data, signals: &data.signals, weights, factors, held, residual, rows: None }
    }

    /// The same problem for other rows in place of those of the data.
    pub fn of_rows(&self, rows: Vec<f64>) -> Self {
        let weighted = rows.iter().zip(&self.weights).map(|(row, weight)| row * weight);
        let residual = DVector::from_iterator(rows.len(), weighted);
        Self { residual, rows: Some(Rc::new(rows)), ..self.clone() }
    }

    /// The same problem with entries of z that have values: the first ones of `held`, others are
    /// free.
    pub fn holding(&self, held: &[Option<f64>]) -> Self {
        let mut values = held.to_vec();
        values.resize(self.factors.r.ncols(), None);
        Self { held: Held::new(&self.factors.r, &values), ..self.clone() }
    }

    /// The responses of laws to all logs, in the rows.
    pub fn responses(&self, laws: &[Fitted<'_>], torques: &[ModelTorques]) -> Vec<RowResponse> {
        let of_law = |fitted: &Fitted<'_>| {
            let stiffness = |place: usize| {
                fitted.law.beliefs().get(place).map_or(0.0, |belief| 1.0 / belief.std)
            };
            let stiffness = (0..fitted.values.len()).map(stiffness).collect();
            let mut all = RowResponse { stiffness, ..RowResponse::default() };
            for (log, torques) in torques.iter().enumerate() {
                let signals = &self.signals[log];
                let motion = torques.motion(self.data.nominal, signals);
                let response = fitted.law.response(motion, &fitted.values);
                all.append(self.data.in_rows(LogIndex(log), signals, &response));
            }
            all
        };
        laws.iter().map(of_law).collect()
    }

    /// What laws with these responses leave, and the normal equations of their parameters.
    pub fn look(&self, responses: &[RowResponse]) -> View {
        self.products(responses).view(&self.held)
    }

    fn products(&self, responses: &[RowResponse]) -> Products {
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
        Products::new(&self.factors.q, &rho, &columns)
    }

    /// Searches the values of laws from those given: Levenberg and Marquardt's steps within bounds.
    pub fn fit(&self, laws: &[Fitted<'_>], torques: &[ModelTorques]) -> Found {
        let mut laws = laws.to_vec();
        let mut responses = self.responses(&laws, torques);
        let mut view = self.look(&responses).believing(&laws);
        let mut damping = 1e-4;
        for _ in 0..ITERATIONS {
            if view.gradient.is_empty() {
                break;
            }
            let tried = moved(&laws, view.step(damping, &outward(&laws, &view)).as_slice());
            let next = self.responses(&tried, torques);
            let seen = self.look(&next).believing(&tried);
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

    /// What laws leave with the values that they have.
    pub fn at(&self, laws: &[Fitted<'_>], torques: &[ModelTorques]) -> Found {
        let responses = self.responses(laws, torques);
        let view = self.look(&responses).believing(laws);
        self.found(laws, &responses, &view)
    }

    fn found(&self, laws: &[Fitted<'_>], responses: &[RowResponse], view: &View) -> Found {
        let z = self.z(&view.explained);
        let mut residual = self.data.without(self.rows.as_deref(), &z);
        responses.iter().for_each(|response| response.subtract_from(&mut residual));
        Found {
            values: laws.iter().map(|fitted| fitted.values.clone()).collect(),
            cost: view.cost,
            rank: view.rank(),
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
#[derive(Clone, Debug)]
pub struct View {
    /// Sum of squares of what is left.
    pub cost: f64,
    /// Half the negative derivative of the cost by each parameter.
    pub gradient: DVector<f64>,
    /// Half its second derivative, of Gauss and Newton.
    pub normal: DMatrix<f64>,
    /// Squared length of each column before z is eliminated.
    pub lengths: Vec<f64>,
    explained: DVector<f64>,
}

/// Products of the rows and of the laws' columns with Q, whatever is held.
struct Products {
    /// |rho|^2.
    square: f64,
    /// Q' rho.
    all: DVector<f64>,
    /// Q' times the columns.
    inside: DMatrix<f64>,
    gradient: DVector<f64>,
    normal: DMatrix<f64>,
    lengths: Vec<f64>,
}

impl Products {
    fn new(q: &DMatrix<f64>, rho: &DVector<f64>, columns: &[Vec<(usize, Vec<f64>)>]) -> Self {
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
        let mut lengths = vec![0.0; count];
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
                if a == b {
                    lengths[a] = sum;
                }
                normal[(a, b)] = sum;
                normal[(b, a)] = sum;
            }
        }
        Self { square: rho.norm_squared(), all: q.tr_mul(rho), inside, gradient, normal, lengths }
    }

    fn view(&self, held: &Held) -> View {
        let mut inside = self.inside.clone();
        let explained = &self.all - &held.across * held.across.tr_mul(&self.all);
        let mut gradient = &self.gradient - inside.tr_mul(&held.offset);
        held.free(&mut inside);
        gradient -= inside.tr_mul(&explained);
        let normal = &self.normal - inside.tr_mul(&inside);
        let offset = held.offset.norm_squared() - 2.0 * held.offset.dot(&self.all);
        let cost = self.square - explained.norm_squared() + offset;
        View { cost, gradient, normal, lengths: self.lengths.clone(), explained }
    }
}

impl View {
    /// With what the model says of parameters, as if it had been measured.
    pub(super) fn believing(mut self, laws: &[Fitted<'_>]) -> Self {
        let mut begin = 0;
        for fitted in laws {
            let beliefs = fitted.law.beliefs().iter().zip(&fitted.values).enumerate();
            for (place, (belief, value)) in beliefs.filter(|(_, (belief, _))| belief.std > 0.0) {
                let place = begin + place;
                let weight = belief.std.powi(-2);
                self.cost += weight * (belief.value - value).powi(2);
                self.gradient[place] += weight * (belief.value - value);
                self.normal[(place, place)] += weight;
            }
            begin += fitted.values.len();
        }
        self
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

    fn rank(&self) -> usize {
        let scale = |k: usize| self.normal[(k, k)].max(1e-12 * self.lengths[k]).max(1e-300).sqrt();
        let count = self.gradient.len();
        if count == 0 {
            return 0;
        }
        let scaled =
            DMatrix::from_fn(count, count, |a, b| self.normal[(a, b)] / (scale(a) * scale(b)));
        scaled.symmetric_eigenvalues().iter().filter(|&&value| value > INDEPENDENT).count()
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
