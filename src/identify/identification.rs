//! All that identification says: data alone, for tables, files and reports to show.

use super::condition::Conditioned;
use super::estimate::{
    Consistent, Convergence, Estimate, EstimateError, IdentifiedParameter, Options, Status,
    Validation, consistent, convergence, estimate, parameters, validate,
};
use crate::plants::regression::{RegressionModel, StandardParameter};

/// What is to be identified, from what.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// Base parameters and their columns.
    pub model: &'a RegressionModel,
    /// Logs to estimate from.
    pub train: &'a [Conditioned],
    /// Logs to judge the estimate with.
    pub validate: &'a [Conditioned],
    /// Logs of the same motion without its noise, for instrumental variables.
    pub instruments: &'a [Conditioned],
    /// How.
    pub options: &'a Options,
}

/// What was identified.
#[derive(Clone, Debug)]
pub struct Identification {
    /// The base parameters that are listed.
    pub parameters: Vec<IdentifiedParameter>,
    /// What is left of the torques of the logs that the estimate is from.
    pub train: Validation,
    /// What is left of those of other logs; none without any.
    pub validate: Option<Validation>,
    /// What is left of these with the values that the model had; none if it lacks one.
    pub before: Option<f64>,
    /// The estimate came about so.
    pub convergence: Vec<Convergence>,
    /// The nearest bodies that exist.
    pub consistent: Consistent,
    /// The estimate on the joint axes.
    pub estimate: Estimate,
}

impl Identification {
    /// The names of parameters that the motion does not show.
    pub fn not_excited(&self) -> Vec<&str> {
        let hidden = self.parameters.iter().filter(|one| one.status == Status::NotExcited);
        hidden.map(|one| one.name.as_str()).collect()
    }
}

/// Estimates, judges, and finds the nearest bodies that exist.
pub fn identify(request: Request<'_>) -> Result<Identification, EstimateError> {
    let Request { model, train, validate: held_out, instruments, options } = request;
    let given = model.model_axes();
    let start = given.clone().unwrap_or_else(|| vec![0.0; model.rank()]);
    let found = estimate(model, train, instruments, options, &start)?;
    let phi = found.solution.phi.as_slice();
    let judged = |phi: &[f64]| (!held_out.is_empty()).then(|| validate(model, phi, held_out));
    let of_model = |one: &StandardParameter| one.value.unwrap_or(0.0);
    let standard: Vec<f64> = model.standard.iter().map(of_model).collect();
    Ok(Identification {
        parameters: parameters(model, &found),
        train: validate(model, phi, train),
        validate: judged(phi),
        before: given.and_then(|phi| judged(&phi)).map(|validation| validation.relative),
        convergence: convergence(model, &found),
        consistent: consistent(model, &found, &standard),
        estimate: found,
    })
}
