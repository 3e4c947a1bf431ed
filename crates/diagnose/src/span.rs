//! What effects can do, whatever their factors are.

use super::hypothesis::Part;
use super::spectra::Spectra;
use crate::policy::span::RANK;
use nalgebra::{DMatrix, DVector};

/// The space of what columns make together: an orthonormal base, none where there are none.
pub(super) struct Span(Option<DMatrix<f64>>);

impl Span {
    /// What the columns of parts make, and what they do where they stand.
    pub(super) fn of<'p>(spectra: &Spectra, parts: impl IntoIterator<Item = &'p Part>) -> Self {
        let all = |part: &'p Part| part.terms.columns.iter().chain([&part.terms.known]);
        let columns: Vec<DVector<f64>> = parts
            .into_iter()
            .flat_map(all)
            .map(|spectrum| spectra.stacked(spectrum))
            .filter(|column| column.norm() > 0.0 && column.norm().is_finite())
            .map(|column| column.normalize())
            .collect();
        let base = (!columns.is_empty()).then(|| {
            let svd = DMatrix::from_columns(&columns).svd(true, false);
            let base = svd.u.expect("asked for");
            let kept: Vec<usize> = (0..svd.singular_values.len())
                .filter(|&k| svd.singular_values[k] > RANK * svd.singular_values[0])
                .collect();
            base.select_columns(&kept)
        });
        Self(base)
    }

    /// What of a column is outside.
    pub(super) fn outside(&self, column: &DVector<f64>) -> DVector<f64> {
        self.0.as_ref().map_or_else(|| column.clone(), |base| column - base * base.tr_mul(column))
    }
}
