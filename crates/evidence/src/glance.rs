//! A first look at many terms: with the variances of a hypothesis that is known, and then once
//! with those that the look leaves.

use crate::base::{Base, fill};
use crate::filtered::Filtered;
use crate::layout::Spectrum;
use crate::policy;
use crate::terms::Terms;
use crate::unpredicted::unearned;
use crate::weigh::positive;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use std::ops::Range;

/// A hypothesis to which terms are added one at a time.
pub struct Glance {
    cells: Vec<(usize, Range<usize>)>,
    /// One over the deviation of each row, channel by channel.
    weights: Vec<Vec<f64>>,
    /// The data less known parts, weighted.
    data: Vec<DVector<f64>>,
    /// Own columns and those of the hypothesis, weighted.
    columns: Vec<DMatrix<f64>>,
    factor: Cholesky<f64, Dyn>,
    /// What the hypothesis explains of the data.
    right: DVector<f64>,
    /// For each cell, of its variance, what the inverse gamma prior adds.
    expected: Vec<f64>,
    idle: f64,
}

/// What was seen of terms.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// By how much the log evidence grows, roughly.
    pub gain: f64,
    /// What the data say of each factor alone: one over its squared error.
    pub precision: Vec<f64>,
    /// The most likely factors.
    pub factors: Vec<f64>,
}

impl Glance {
    /// A look from a hypothesis with variances.
    pub fn new(base: &Base, terms: &[&Terms], variances: &[f64]) -> Self {
        let cells: Vec<(usize, Range<usize>)> = base.layout.cells().collect();
        let mut weights: Vec<Vec<f64>> =
            (0..base.layout.channels()).map(|c| vec![0.0; base.layout.rows(c)]).collect();
        for ((channel, rows), variance) in cells.iter().zip(variances) {
            weights[*channel][rows.clone()].fill(1.0 / variance.sqrt());
        }
        let more: Vec<&Spectrum> = terms.iter().flat_map(|one| &one.columns).collect();
        let width = base.parameters + more.len();
        let (mut data, mut columns) = (Vec::new(), Vec::new());
        for (channel, weights) in weights.iter().enumerate() {
            let mut rows = base.data[channel].clone();
            terms.iter().for_each(|one| one.less_known(channel, &mut rows));
            data.push(weighted(&rows, weights));
            let mut all = DMatrix::zeros(weights.len(), width);
            all.columns_mut(0, base.parameters).copy_from(&base.own[channel]);
            fill(&mut all.columns_mut(base.parameters, more.len()), more.iter().copied(), channel);
            weigh(&mut all, weights);
            columns.push(all);
        }
        let mut normal = DMatrix::identity(width, width);
        let mut right = DVector::zeros(width);
        for (columns, data) in columns.iter().zip(&data) {
            normal += columns.tr_mul(columns);
            right += columns.tr_mul(data);
        }
        let factor = positive(normal);
        let levels = base.layout.expected();
        let expected = levels.iter().zip(variances).map(|(level, v)| level / v).collect();
        let own = Self { cells, weights, data, columns, factor, right, expected, idle: 0.0 };
        let solved = own.factor.solve(&own.right);
        let variances =
            own.variances(&|channel| &own.data[channel] - &own.columns[channel] * &solved);
        let idle = own.density(&variances) - 0.5 * solved.norm_squared();
        Self { idle, ..own }
    }

    /// Looks at terms.
    pub fn see(&self, terms: &Terms) -> Seen {
        let (width, count) = (self.right.len(), terms.len());
        let mut cross = DMatrix::zeros(width, count);
        let mut normal = DMatrix::zeros(count, count);
        let (mut right, mut inner) = (self.right.clone(), DVector::zeros(count));
        let mut touched: Vec<Option<(DVector<f64>, DMatrix<f64>)>> = Vec::new();
        for (channel, weights) in self.weights.iter().enumerate() {
            if !terms.touches(channel) {
                touched.push(None);
                continue;
            }
            let mut known = vec![0.0; weights.len()];
            terms.less_known(channel, &mut known);
            let known = weighted(&known, weights);
            let data = &self.data[channel] + &known;
            let mut columns = DMatrix::zeros(weights.len(), count);
            fill(&mut columns.columns_mut(0, count), &terms.columns, channel);
            weigh(&mut columns, weights);
            cross += self.columns[channel].tr_mul(&columns);
            normal += columns.tr_mul(&columns);
            inner += columns.tr_mul(&data);
            right += self.columns[channel].tr_mul(&known);
            touched.push(Some((data, columns)));
        }
        let solved = self.factor.solve(&cross);
        let beyond = &normal - cross.tr_mul(&solved);
        let slope = inner - solved.tr_mul(&right);
        let precision: Vec<f64> = (0..count).map(|k| beyond[(k, k)].max(0.0)).collect();
        let lowest: Vec<f64> =
            terms.lowest.iter().zip(&terms.believed).map(|(low, own)| low - own).collect();
        let Some(chol) = with_belief(&beyond, 1.0) else {
            return Seen { gain: f64::NEG_INFINITY, precision, factors: vec![0.0; count] };
        };
        let determinant: f64 = (0..count).map(|k| chol.l_dirty()[(k, k)].ln()).sum();
        let gain = |factors: &DVector<f64>| {
            let own = self.factor.solve(&(&right - &cross * factors));
            let left = |channel: usize| match &touched[channel] {
                Some((data, columns)) => data - columns * factors - &self.columns[channel] * &own,
                None => &self.data[channel] - &self.columns[channel] * &own,
            };
            let variances = self.variances(&left);
            let gain = self.density(&variances)
                - self.idle
                - determinant
                - 0.5 * factors.norm_squared()
                - 0.5 * own.norm_squared()
                + self.log_volume(terms, &left)
                - self.unpredicted(terms, &variances);
            if gain.is_finite() { gain } else { f64::NEG_INFINITY }
        };
        // Beside large variances the belief in small factors weighs more than it will once these
        // have become what the terms leave.
        let all = [1.0, policy::UNBELIEVED].into_iter().filter_map(|belief| {
            let mut factors = with_belief(&beyond, belief)?.solve(&slope);
            factors.iter_mut().zip(&lowest).for_each(|(factor, low)| *factor = factor.max(*low));
            Some((gain(&factors), factors))
        });
        let best = all.max_by(|a, b| a.0.total_cmp(&b.0));
        let (gain, factors) = best.expect("the first has a solution");
        let factors = (0..count).map(|k| factors[k] + terms.believed[k]).collect();
        Seen { gain, precision, factors }
    }

    /// The variance of each cell of what is left, in units of those that are known.
    fn variances(&self, left: &dyn Fn(usize) -> DVector<f64>) -> Vec<f64> {
        let left: Vec<DVector<f64>> = (0..self.data.len()).map(left).collect();
        let shape = policy::NOISE_SHAPE;
        let of = |((channel, rows), level): (&(usize, Range<usize>), &f64)| {
            let squares = left[*channel].rows(rows.start, rows.len()).norm_squared();
            (squares + 2.0 * shape * level) / counted(rows)
        };
        self.cells.iter().zip(&self.expected).map(of).collect()
    }

    /// The log density of rows with the variances that they have.
    fn density(&self, variances: &[f64]) -> f64 {
        let cells = self.cells.iter().zip(variances);
        cells.map(|((_, rows), variance)| -0.5 * counted(rows) * variance.ln()).sum()
    }

    /// The log of by how much terms shrink data, with what is left of each channel.
    fn log_volume(&self, terms: &Terms, left: &dyn Fn(usize) -> DVector<f64>) -> f64 {
        let of = |one: &Filtered| {
            let mut left = left(one.channel);
            let both = left.iter_mut().zip(&self.weights[one.channel]);
            both.for_each(|(row, weight)| *row /= weight);
            one.log_volume(self.cells.iter().cloned(), left.as_slice())
        };
        terms.filtered.iter().map(of).sum()
    }

    /// What terms do not earn, since they say nothing of some rows.
    fn unpredicted(&self, terms: &Terms, variances: &[f64]) -> f64 {
        if terms.unpredicted.share <= 0.0 {
            return 0.0;
        }
        let of = |((channel, rows), variance): (&(usize, Range<usize>), &f64)| {
            let weight = self.weights[*channel][rows.start];
            (*channel, rows.clone(), variance / weight.powi(2))
        };
        unearned(&[terms], &self.cells.iter().zip(variances).map(of).collect::<Vec<_>>())
    }
}

/// Rows with those that the prior of a variance counts for.
fn counted(rows: &Range<usize>) -> f64 {
    rows.len() as f64 + 2.0 * policy::NOISE_SHAPE + 2.0
}

/// The factor of what the data say of factors and what is believed of them.
fn with_belief(beyond: &DMatrix<f64>, belief: f64) -> Option<Cholesky<f64, Dyn>> {
    let mut normal = beyond.clone();
    (0..normal.nrows()).for_each(|k| normal[(k, k)] += belief);
    normal.cholesky()
}

fn weigh(columns: &mut DMatrix<f64>, weights: &[f64]) {
    for mut column in columns.column_iter_mut() {
        column.iter_mut().zip(weights).for_each(|(entry, weight)| *entry *= weight);
    }
}

fn weighted(rows: &[f64], weights: &[f64]) -> DVector<f64> {
    DVector::from_iterator(rows.len(), rows.iter().zip(weights).map(|(row, weight)| row * weight))
}
