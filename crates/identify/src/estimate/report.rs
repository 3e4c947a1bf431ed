//! What was found, in the parameters that are reported: values, errors, and which mean something.

use super::half_cutoff::HalfCutoff;
use super::least_squares::Estimate;
use crate::policy::report::{BIASING, DEAD_SHARE, LIKELY, SURE};
use denavit_measure::PartIndex;
use denavit_numerics::interval_factor;
use denavit_numerics::least_squares::solve;
use denavit_plants::regression::RegressionModel;
use nalgebra::DVector;

/// Points of time at which convergence is shown.
const CONVERGENCE_POINTS: usize = 24;

/// What the data say about a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Its interval of 95 % excludes 0.
    Identified,
    /// Its interval contains 0: the motion excites it too little, or it is small.
    Uncertain,
    /// The motion does not show it at all; its value is the model's.
    NotExcited,
}

impl Status {
    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Identified => "identified",
            Self::Uncertain => "uncertain",
            Self::NotExcited => "not_excited",
        }
    }
}

/// A base parameter with what was found.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifiedParameter {
    /// Name of its column.
    pub name: String,
    /// The sum that it is.
    pub expression: String,
    /// The same as LaTeX.
    pub latex: String,
    /// Its SI unit.
    pub unit: String,
    /// The estimate.
    pub value: f64,
    /// Its standard error; none where it is not excited.
    pub std: Option<f64>,
    /// Half the width of the interval that holds the true value in 95 of 100 cases.
    pub interval: Option<f64>,
    /// Degrees of freedom of the standard error.
    pub degrees_of_freedom: f64,
    /// What noise of the positions adds to the estimate in the mean, in standard errors.
    pub noise_bias: Option<f64>,
    /// How it changes with half the cutoff of the filter.
    pub half_cutoff: Option<HalfCutoff>,
    /// The value of the model before.
    pub model_value: Option<f64>,
    /// What the data say about it.
    pub status: Status,
}

impl IdentifiedParameter {
    /// Whether noise of the positions biases it by more than its interval forgives.
    pub fn is_biased(&self) -> bool {
        self.noise_bias.is_some_and(|bias| bias.abs() > BIASING)
    }

    /// Whether it changes with half the cutoff of the filter by more than chance.
    pub fn is_changed(&self) -> bool {
        self.half_cutoff.is_some_and(|one| one.is_beyond(SURE))
    }

    /// Whether noise of the positions biases it by more than an interval forgives that does not
    /// count how it changes with half the cutoff: a lower filter is needed.
    pub fn is_biased_without_change(&self) -> bool {
        let own = self.half_cutoff.map_or(self.std, |one| Some(one.own_std));
        let bias = self.noise_bias.zip(self.std).zip(own);
        bias.is_some_and(|((bias, std), own)| bias.abs() * std > BIASING * own)
    }

    /// Whether it seems to change with half the cutoff: a lower filter may be better.
    pub fn may_change(&self) -> bool {
        self.half_cutoff.is_some_and(|one| one.is_beyond(LIKELY))
    }
}

/// The listed parameters of an estimate.
pub fn parameters(model: &RegressionModel, found: &Estimate) -> Vec<IdentifiedParameter> {
    let to_listed = model.to_listed();
    let values = to_listed * &found.solution.phi;
    let covariance = to_listed * &found.covariance * to_listed.transpose();
    let biases = to_listed * &found.noise_bias;
    let dead = to_listed * &found.solution.dead;
    // Against how far a parameter moves along all directions, the excited among them.
    let alive = to_listed * &found.solution.factor;
    let size = |row: usize| (dead.row(row).norm_squared() + alive.row(row).norm_squared()).sqrt();
    let one = |(row, listed): (usize, &denavit_plants::regression::RegressionParameter)| {
        let is_dead = dead.row(row).norm() > DEAD_SHARE * size(row);
        let std = (!is_dead).then(|| covariance[(row, row)].max(0.0).sqrt());
        let degrees_of_freedom = found.degrees_of_freedom[row];
        let interval = std.map(|std| interval_factor(degrees_of_freedom) * std);
        let status = match interval {
            None => Status::NotExcited,
            Some(interval) if values[row].abs() > interval => Status::Identified,
            Some(_) => Status::Uncertain,
        };
        IdentifiedParameter {
            name: listed.name.clone(),
            expression: listed.expression.clone(),
            latex: listed.latex.clone(),
            unit: listed.unit.clone(),
            value: values[row],
            std,
            interval,
            degrees_of_freedom,
            noise_bias: std.filter(|std| *std > 0.0).map(|std| biases[row] / std),
            half_cutoff: found.change.as_ref().filter(|_| !is_dead).map(|all| all[row]),
            model_value: listed.value,
            status,
        }
    };
    model.listed.iter().enumerate().map(one).collect()
}

/// An estimate of the data up to a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    /// Time of measurement so far \[s\].
    pub time_s: f64,
    /// The listed parameters.
    pub values: Vec<f64>,
    /// Largest over smallest singular value.
    pub condition: f64,
    /// The same of columns scaled to length 1.
    pub scaled_condition: f64,
}

/// How the estimate came about as data came in (thesis figures 3.5, 3.7, 3.9), with the weights of
/// the end.
pub fn convergence(model: &RegressionModel, found: &Estimate) -> Vec<Convergence> {
    let condensed = &found.condensed;
    let count = condensed.parts.len();
    let stride = count.div_ceil(CONVERGENCE_POINTS).max(1);
    let start = vec![0.0; condensed.rank];
    let mut merged = condensed.merged(std::iter::empty());
    let mut points = Vec::new();
    let mut before_s = 0.0;
    for part in 0..count {
        condensed.merge(PartIndex(part), &mut merged);
        let is_last_of_log =
            condensed.log_of_part.get(part + 1) != Some(&condensed.log_of_part[part]);
        let time_s = before_s + condensed.end_s[part];
        if is_last_of_log {
            before_s = time_s;
        }
        if (part + 1) % stride != 0 && part + 1 != count {
            continue;
        }
        let r = condensed.system(&merged, &found.weights, &[]);
        let solution = solve(&r, &start);
        let values: DVector<f64> = model.to_listed() * &solution.phi;
        let (condition, scaled_condition) = (solution.condition, solution.scaled_condition);
        let values = values.as_slice().to_vec();
        points.push(Convergence { time_s, values, condition, scaled_condition });
    }
    points
}
