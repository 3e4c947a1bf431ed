//! The data, and what every hypothesis has: the model's own parameters.

use crate::layout::{Layout, Spectrum};
use crate::policy;
use nalgebra::{DMatrix, DMatrixViewMut, DVector, SymmetricEigen};
use std::ops::Range;

/// Data with the columns of everything that the model itself is not sure of.
#[derive(Clone, Debug)]
pub struct Base {
    /// Channels and bands.
    pub layout: Layout,
    /// What is to be explained.
    pub data: Spectrum,
    /// For each channel the columns of the model's own parameters, one deviation of each: of
    /// combinations of these that rows show.
    pub(crate) own: Vec<DMatrix<f64>>,
    /// For each combination its shares of the own parameters, orthonormal: factors of combinations
    /// have the prior N(0, 1), too.
    basis: DMatrix<f64>,
    /// For each cell the products of data and own columns with each other, the data first.
    pub(crate) products: Vec<DMatrix<f64>>,
    /// Number of combinations of own parameters.
    pub(crate) parameters: usize,
}

impl Base {
    /// By how much a torque can change the log evidence, with the variance of each cell.
    pub fn nats(&self, torque: &Spectrum, variances: &[f64]) -> f64 {
        let of = |((channel, rows), variance): ((usize, Range<usize>), &f64)| {
            let rows = torque[channel].get(rows).into_iter().flatten();
            rows.map(|row| row * row).sum::<f64>() / variance
        };
        0.5 * self.layout.cells().zip(variances).map(of).sum::<f64>()
    }

    /// Data and own columns, each a spectrum with the prior N(0, 1) of its factor.
    pub fn new(layout: Layout, data: Spectrum, own: &[Spectrum]) -> Self {
        let parameters = own.len();
        let of_channel = |channel: usize| {
            let mut columns = DMatrix::zeros(layout.rows(channel), parameters);
            fill(&mut columns.columns_mut(0, parameters), own, channel);
            columns
        };
        let own: Vec<DMatrix<f64>> = (0..layout.channels()).map(of_channel).collect();
        let basis = shown(&layout, &own, parameters);
        let own: Vec<DMatrix<f64>> = own.iter().map(|columns| columns * &basis).collect();
        let parameters = basis.ncols();
        Self { layout, data: Vec::new(), own, basis, products: Vec::new(), parameters }.of(data)
    }

    /// The same of other data.
    pub fn of(self, data: Spectrum) -> Self {
        let parameters = self.parameters;
        let of_cell = |(channel, rows): (usize, Range<usize>)| {
            let mut all = DMatrix::zeros(rows.len(), 1 + parameters);
            all.column_mut(0).copy_from_slice(&data[channel][rows.clone()]);
            all.columns_mut(1, parameters)
                .copy_from(&self.own[channel].rows(rows.start, rows.len()));
            all.tr_mul(&all)
        };
        let products = self.layout.cells().map(of_cell).collect();
        Self { products, data, ..self }
    }

    /// What factors of the own columns leave of the data.
    pub fn left(&self, factors: &[f64]) -> Spectrum {
        let factors = self.basis.tr_mul(&DVector::from_column_slice(factors));
        let of = |(data, own): (&Vec<f64>, &DMatrix<f64>)| {
            (DVector::from_column_slice(data) - own * &factors).as_slice().to_vec()
        };
        self.data.iter().zip(&self.own).map(of).collect()
    }

    /// The factors of the own columns that have those of the combinations; others stay 0.
    pub(crate) fn own_factors(&self, combinations: &[f64]) -> Vec<f64> {
        (&self.basis * DVector::from_column_slice(combinations)).as_slice().to_vec()
    }
}

/// Fills columns with the rows that spectra have in a channel.
pub(crate) fn fill<'s>(
    columns: &mut DMatrixViewMut<'_, f64>,
    spectra: impl IntoIterator<Item = &'s Spectrum>,
    channel: usize,
) {
    for (mut column, spectrum) in columns.column_iter_mut().zip(spectra) {
        if let Some(rows) = spectrum.get(channel).filter(|rows| !rows.is_empty()) {
            column.copy_from_slice(rows);
        }
    }
}

/// The combinations of own columns that rows show: the others do nothing beside the least noise.
fn shown(layout: &Layout, own: &[DMatrix<f64>], parameters: usize) -> DMatrix<f64> {
    let mut squares = DMatrix::zeros(parameters, parameters);
    for (columns, level) in own.iter().zip(&layout.levels) {
        squares += columns.tr_mul(columns) / level.powi(2);
    }
    // Where the level is that of no torque at all, or a column is not finite, all are kept.
    let is_finite = squares.iter().all(|entry: &f64| entry.is_finite());
    if parameters == 0 || !is_finite || squares.amax() > f64::MAX.sqrt() {
        return DMatrix::identity(parameters, parameters);
    }
    let found = SymmetricEigen::new(squares);
    let places = (0..parameters).filter(|&k| found.eigenvalues[k] > policy::LEAST_SHOWN);
    let kept: Vec<usize> = places.collect();
    found.eigenvectors.select_columns(&kept)
}
