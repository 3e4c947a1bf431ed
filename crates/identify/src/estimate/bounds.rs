//! Masses and moments of inertia that a model's file writes as expressions: none may be negative.
//!
//! Numbers of the file that are masses or moments themselves have coordinates that cannot leave
//! what is allowed; of a moment that is a sum of unknowns, each may have either sign. What such an
//! entry falls short of is a residual, whose weight grows until nothing does.

use crate::policy::bounds::LEAST;
use denavit_plants::regression::RegressionModel;

/// The entries with their bounds.
pub(super) struct Bounds<'a> {
    model: &'a RegressionModel,
    /// The size of each.
    sizes: Vec<f64>,
}

impl<'a> Bounds<'a> {
    /// Those of a model; sizes are those of its own values.
    pub(super) fn new(model: &'a RegressionModel) -> Self {
        let values: Vec<f64> = model.parameters.iter().map(|one| one.value).collect();
        let sizes = model.masses_and_moments(&values);
        Self { model, sizes: sizes.into_iter().map(|size| size.abs().max(1e-4)).collect() }
    }

    /// Number of entries.
    pub(super) fn count(&self) -> usize {
        self.sizes.len()
    }

    /// What each entry falls short of, over its size, for the numbers of the file.
    pub(super) fn short(&self, values: &[f64]) -> Vec<f64> {
        let entries = self.model.masses_and_moments(values);
        entries
            .iter()
            .zip(&self.sizes)
            .map(|(entry, size)| (LEAST - entry / size).max(0.0))
            .collect()
    }

    /// Whether all entries are above 0.
    pub(super) fn hold(&self, values: &[f64]) -> bool {
        self.short(values).iter().all(|short| *short < 0.9 * LEAST)
    }
}
