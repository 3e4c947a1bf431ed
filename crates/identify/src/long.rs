//! What a long log says, whose head was identified as any log is.

use super::error::Error;
use super::estimate::long::LongRows;
use super::estimate::{Unexplained, Validation, consistent, convergence, parameters, validate};
use super::identification::{Identification, Request, left_out_rows, shares};
use crate::policy::unexplained::{LEFT, LEFT_ALIKE};
use denavit_plants::regression::RegressionModel;

impl Identification {
    /// That of a long log of whose head this is one, with the rows of the whole. Parameters,
    /// residuals and bodies are those of the whole; doubts are those of the head.
    ///
    /// # Errors
    /// There are fewer rows than parameters, or none.
    pub fn of_long(self, request: Request<'_>, rows: &LongRows) -> Result<Self, Error> {
        let Request { model, validate: held_out, options, .. } = request;
        let (head, periods) = (self.train, self.periods);
        let longer = rows.samples() as f64 / head.samples.max(1) as f64;
        let found = self.estimate.of_long(model, rows, options)?;
        let phi = found.solution.phi.as_slice();
        let train = rows.left(model, phi, &head);
        let left_out = left_out_rows(model, rows.left_out(), &shares(model, &found, &train));
        let before = model.model_axes().map(|phi| match held_out.is_empty() {
            true => rows.left(model, &phi, &head).relative,
            false => validate(model, &phi, held_out).relative,
        });
        let mut unexplained = self.unexplained;
        unexplained.extend(left_behind_the_head(model, &train, &head, &unexplained));
        Ok(Self {
            unexplained,
            validate: (!held_out.is_empty()).then(|| validate(model, phi, held_out)),
            parameters: parameters(model, &found),
            convergence: convergence(model, &found),
            consistent: consistent(model, &found),
            periods: periods * longer,
            train,
            before,
            left_out,
            estimate: found,
            ..self
        })
    }
}

/// The joints of whose torque nearly all is left of the whole, or much that is not left of the
/// head: noise would be left of both.
fn left_behind_the_head(
    model: &RegressionModel,
    whole: &Validation,
    head: &Validation,
    told: &[Unexplained],
) -> Vec<Unexplained> {
    let is_base = |name: &str| model.joints.iter().any(|one| one.is_base && one.name == name);
    let of_head = |name: &str| head.joint(name).map_or(0.0, |one| one.relative);
    let is_left =
        |name: &str, share: f64| share > LEFT || share > LEFT_ALIKE && of_head(name) < LEFT_ALIKE;
    let own = whole.joints.iter().filter(|one| is_left(&one.name, one.relative));
    let own = own.filter(|one| !is_base(&one.name) && told.iter().all(|t| t.joint != one.name));
    own.map(|one| Unexplained::of(&one.name, one.relative)).collect()
}
