//! States of a law, integrated along samples together with their derivatives by the parameters.
//!
//! From sample to sample the motion is held at the mean of both, and the state takes one step of
//! the exponential Rosenbrock method: x + h phi_1(h J) f, with the symbolic J = df/dx. It is exact
//! where f is affine in x and the motion rests between samples, as for Dahl's and LuGre's bristles
//! at constant rate, and stable however fast a bristle settles. The sensitivities are the exact
//! derivative of these steps, not of the differential equation, so that they agree with differences
//! of two integrations.

use super::affine::is_affine;
use super::program::LawProgram;
use super::{gradient, names};
use crate::error::Error;
use denavit_codegen::effect::Effect;
use denavit_codegen::expr::{Dag, ExprId};
use nalgebra::DMatrix;

/// The rates of the states of one effect.
#[derive(Clone, Debug)]
pub(super) struct StateLaw {
    pub(super) states: usize,
    pub(super) parameters: usize,
    kind: Kind,
    /// f, df/dx, df/dp, then for each x and each p the derivative of df/dx.
    pub(super) rates: LawProgram,
    /// Initial values and their derivatives by the parameters.
    initial: LawProgram,
}

/// What is known of df/dx before any motion is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// No state's rate depends on another state, and each is affine in its own: all but the states
    /// themselves is known of all steps before the first.
    Affine,
    /// No state's rate depends on another state.
    Separate,
    /// It depends on parameters alone: one propagator serves all steps of a length.
    Steady,
    /// Neither.
    Changing,
}

/// One step of a matrix of rates: the rates with their derivatives, at one sample.
struct Rates<'a> {
    states: usize,
    parameters: usize,
    entries: &'a [f64],
}

impl Rates<'_> {
    fn rate(&self, i: usize) -> f64 {
        self.entries[i]
    }

    fn by_state(&self, i: usize, j: usize) -> f64 {
        self.entries[self.states + i * self.states + j]
    }

    fn by_parameter(&self, i: usize, p: usize) -> f64 {
        let s = self.states;
        self.entries[s + s * s + i * self.parameters + p]
    }

    /// The derivative of df_i/dx_j by the m-th of states and parameters.
    fn second(&self, i: usize, j: usize, m: usize) -> f64 {
        let (s, by) = (self.states, self.states + self.parameters);
        self.entries[s + s * by + (i * s + j) * by + m]
    }
}

impl StateLaw {
    /// The rates of `effect`, as functions of `inputs`: columns, then states.
    pub(super) fn new(dag: &mut Dag, effect: &Effect, inputs: Vec<ExprId>) -> Result<Self, Error> {
        let states: Vec<ExprId> = effect.states.iter().map(|state| state.symbol).collect();
        let parameters: Vec<ExprId> = effect.parameters.iter().map(|p| p.symbol).collect();
        let by: Vec<ExprId> = states.iter().chain(&parameters).copied().collect();
        let rates: Vec<ExprId> = effect.states.iter().map(|state| state.rate).collect();
        let slopes = gradient(dag, &rates, &states).concat();
        let zero = dag.zero();
        let count = states.len();
        let mut others = slopes.iter().enumerate().filter(|(at, _)| at / count != at % count);
        let is_separate = others.all(|(_, slope)| *slope == zero);
        let known: Vec<ExprId> = inputs.iter().chain(&states).copied().collect();
        let changes = gradient(dag, &slopes, &known).concat();
        let kind = match is_separate {
            true if is_affine(dag, &rates, &states) => Kind::Affine,
            true => Kind::Separate,
            false if changes.iter().all(|change| *change == zero) => Kind::Steady,
            false => Kind::Changing,
        };
        let mut entries = rates.clone();
        entries.extend(&slopes);
        entries.extend(gradient(dag, &rates, &parameters).concat());
        entries.extend(gradient(dag, &slopes, &by).concat());
        let rates = LawProgram::new(dag, &names(effect), inputs.clone(), entries)?;
        let mut initial: Vec<ExprId> = effect.states.iter().map(|state| state.initial).collect();
        initial.extend(gradient(dag, &initial.clone(), &parameters).concat());
        let initial = LawProgram::new(dag, &names(effect), inputs, initial)?;
        Ok(Self { states: count, parameters: parameters.len(), kind, rates, initial })
    }

    /// The states at each sample, one column for each, and their derivatives: one column for each
    /// parameter of each state. `t` are the times of the samples \[s\].
    pub(super) fn integrate(
        &self,
        t: &[f64],
        columns: &[&[f64]],
        values: &[f64],
    ) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let mut state = vec![0.0; self.states * (1 + self.parameters)];
        if t.is_empty() {
            return (vec![Vec::new(); self.states], vec![Vec::new(); state.len() - self.states]);
        }
        let mut first: Vec<f64> = columns.iter().map(|column| column[0]).collect();
        first.resize(columns.len() + self.states, 0.0);
        let mut initial = self.initial.evaluator(values);
        initial.evaluate(&[&first], &mut state).expect("the shapes are those of the law");
        let mut paths: Vec<Vec<f64>> = state.iter().map(|first| vec![*first]).collect();
        paths.iter_mut().for_each(|path| path.reserve(t.len()));
        match self.kind {
            Kind::Affine => self.affine_steps(t, columns, values, &mut paths),
            _ => self.steps(t, columns, values, &mut paths),
        }
        let sensitivities = paths.split_off(self.states);
        (paths, sensitivities)
    }

    /// Steps from sample to sample, each with the rates at the state that it begins with. `paths`
    /// of states and, behind them, of their sensitivities have the first sample, and get the
    /// others.
    fn steps(&self, t: &[f64], columns: &[&[f64]], values: &[f64], paths: &mut [Vec<f64>]) {
        let (s, p) = (self.states, self.parameters);
        let mut state: Vec<f64> = paths.iter().map(|path| path[0]).collect();
        let mut steps = state.clone();
        let mut inputs = vec![0.0; columns.len() + s];
        let mut entries = vec![0.0; s + s * (s + p) + s * s * (s + p)];
        let mut rates = self.rates.evaluator(values);
        let mut kept: Option<Propagator> = None;
        for k in 1..t.len() {
            for (input, column) in inputs.iter_mut().zip(columns) {
                *input = 0.5 * (column[k - 1] + column[k]);
            }
            inputs[columns.len()..].copy_from_slice(&state[..s]);
            rates.evaluate(&[&inputs], &mut entries).expect("the shapes are those of the law");
            let rates = Rates { states: s, parameters: p, entries: &entries };
            let h = t[k] - t[k - 1];
            match self.kind {
                Kind::Separate | Kind::Affine => separate_step(&rates, h, &state, &mut steps),
                Kind::Steady => {
                    let propagator = match kept.take().filter(|kept| kept.is_of(h)) {
                        Some(kept) => kept,
                        None => Propagator::new(&rates, h),
                    };
                    propagator.step(&rates, &state, &mut steps);
                    kept = Some(propagator);
                }
                Kind::Changing => changing_step(&rates, h, &state, &mut steps),
            }
            state.iter_mut().zip(&steps).for_each(|(x, step)| *x += step);
            paths.iter_mut().zip(&state).for_each(|(path, x)| path.push(*x));
        }
    }
}

impl Rates<'_> {
    /// How f_i moves with a parameter, by itself and through the states.
    fn along(&self, state: &[f64], parameter: usize, i: usize) -> f64 {
        let (s, p) = (self.states, self.parameters);
        let through: f64 = (0..s).map(|j| self.by_state(i, j) * state[s + j * p + parameter]).sum();
        self.by_parameter(i, parameter) + through
    }

    /// How df_i/dx_j moves with a parameter.
    fn slope_along(&self, state: &[f64], parameter: usize, [i, j]: [usize; 2]) -> f64 {
        let (s, p) = (self.states, self.parameters);
        let through: f64 =
            (0..s).map(|m| self.second(i, j, m) * state[s + m * p + parameter]).sum();
        self.second(i, j, s + parameter) + through
    }
}

/// One step of the states and, behind them, their sensitivities, where states are separate.
fn separate_step(rates: &Rates<'_>, h: f64, state: &[f64], steps: &mut [f64]) {
    let (s, p) = (rates.states, rates.parameters);
    for i in 0..s {
        let (phi, slope) = phi_1(h * rates.by_state(i, i));
        steps[i] = h * phi * rates.rate(i);
        for parameter in 0..p {
            let turned = h * slope * rates.slope_along(state, parameter, [i, i]) * rates.rate(i);
            steps[s + i * p + parameter] = h * (phi * rates.along(state, parameter, i) + turned);
        }
    }
}

/// The same whatever the rates depend on.
fn changing_step(rates: &Rates<'_>, h: f64, state: &[f64], steps: &mut [f64]) {
    let (s, p) = (rates.states, rates.parameters);
    // the exponential of [[h J, h f], [0, 0]] has h phi_1(h J) f in its last column
    let generator = DMatrix::from_fn(s + 1, s + 1, |i, j| match (i < s, j < s) {
        (true, true) => h * rates.by_state(i, j),
        (true, false) => h * rates.rate(i),
        _ => 0.0,
    });
    let exponential = generator.exp();
    (0..s).for_each(|i| steps[i] = exponential[(i, s)]);
    for parameter in 0..p {
        let change = DMatrix::from_fn(s + 1, s + 1, |i, j| match (i < s, j < s) {
            (true, true) => h * rates.slope_along(state, parameter, [i, j]),
            (true, false) => h * rates.along(state, parameter, i),
            _ => 0.0,
        });
        let moved = derivative_of_exponential(&generator, &change);
        (0..s).for_each(|i| steps[s + i * p + parameter] = moved[(i, s)]);
    }
}

/// What a step does to rates whose df/dx depends on parameters alone.
struct Propagator {
    h: f64,
    /// h phi_1(h J), row by row.
    phi: Vec<f64>,
    /// Its derivative by each parameter.
    by: Vec<Vec<f64>>,
}

/// Steps are alike whose lengths differ by the rounding of the times.
const ROUNDING: f64 = 1e-9;

impl Propagator {
    fn new(rates: &Rates<'_>, h: f64) -> Self {
        let s = rates.states;
        // the exponential of [[h J, h], [0, 0]] has h phi_1(h J) in its corner
        let generator = DMatrix::from_fn(2 * s, 2 * s, |i, j| match (i < s, j < s) {
            (true, true) => h * rates.by_state(i, j),
            (true, false) if i + s == j => h,
            _ => 0.0,
        });
        let corner = |matrix: &DMatrix<f64>| -> Vec<f64> {
            (0..s * s).map(|at| matrix[(at / s, s + at % s)]).collect()
        };
        let by = |parameter: usize| {
            let change = DMatrix::from_fn(2 * s, 2 * s, |i, j| match i < s && j < s {
                true => h * rates.second(i, j, s + parameter),
                false => 0.0,
            });
            corner(&derivative_of_exponential(&generator, &change))
        };
        let by = (0..rates.parameters).map(by).collect();
        Self { h, phi: corner(&generator.exp()), by }
    }

    fn is_of(&self, h: f64) -> bool {
        (self.h - h).abs() <= ROUNDING * self.h
    }

    fn step(&self, rates: &Rates<'_>, state: &[f64], steps: &mut [f64]) {
        let (s, p) = (rates.states, rates.parameters);
        for i in 0..s {
            let row = |matrix: &[f64], column: &dyn Fn(usize) -> f64| -> f64 {
                (0..s).map(|j| matrix[i * s + j] * column(j)).sum()
            };
            steps[i] = row(&self.phi, &|j| rates.rate(j));
            for (parameter, by) in self.by.iter().enumerate() {
                let moved = row(&self.phi, &|j| rates.along(state, parameter, j));
                steps[s + i * p + parameter] = moved + row(by, &|j| rates.rate(j));
            }
        }
    }
}

/// The derivative of exp(A) in the direction E: the corner of the exponential of [[A, E], [0, A]].
fn derivative_of_exponential(a: &DMatrix<f64>, e: &DMatrix<f64>) -> DMatrix<f64> {
    let n = a.nrows();
    let mut block = DMatrix::zeros(2 * n, 2 * n);
    block.view_mut((0, 0), (n, n)).copy_from(a);
    block.view_mut((n, n), (n, n)).copy_from(a);
    block.view_mut((0, n), (n, n)).copy_from(e);
    block.exp().view((0, n), (n, n)).into_owned()
}

/// 1/(n+1)! and (n+1)/(n+2)!, for each n: what is left out is less than rounding up to 0.5.
const SERIES: [[f64; 2]; 14] = {
    let (mut series, mut factorial, mut n) = ([[0.0; 2]; 14], 1.0, 0);
    while n < series.len() {
        factorial *= n as f64 + 1.0;
        series[n] = [1.0 / factorial, (n as f64 + 1.0) / (factorial * (n as f64 + 2.0))];
        n += 1;
    }
    series
};

/// phi_1(z) = (exp z - 1)/z and its derivative.
pub(super) fn phi_1(z: f64) -> (f64, f64) {
    if z.abs() < 0.5 {
        // so many terms are enough below 0.03
        let terms = if z.abs() < 0.03 { 8 } else { SERIES.len() };
        let horner = |(value, slope): (f64, f64), [a, b]: &[f64; 2]| (value * z + a, slope * z + b);
        return SERIES[..terms].iter().rev().fold((0.0, 0.0), horner);
    }
    let value = z.exp_m1() / z;
    (value, (z.exp() - value) / z)
}

#[cfg(test)]
mod tests {
    use super::phi_1;

    #[test]
    fn phi_and_its_slope_agree_with_their_integrals() {
        // phi_1(z) is the mean of exp(z u) over u in [0, 1], its slope that of u exp(z u)
        for z in [-40.0, -3.0, -0.51, -0.49, -0.031, -0.029, -1e-9, 0.0, 0.3, 2.0] {
            let (count, mut sums) = (20_000, [0.0; 2]);
            for k in 0..count {
                let u = (f64::from(k) + 0.5) / f64::from(count);
                sums[0] += (z * u).exp() / f64::from(count);
                sums[1] += u * (z * u).exp() / f64::from(count);
            }
            let (value, slope) = phi_1(z);
            assert!((value - sums[0]).abs() < 1e-6 * sums[0], "{z}: {value}, {sums:?}");
            assert!((slope - sums[1]).abs() < 1e-6 * sums[1], "{z}: {slope}, {sums:?}");
        }
    }
}
