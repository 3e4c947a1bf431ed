//! The evidence of a hypothesis.
//!
//! With y what is left of the data after the known parts, X all columns, b their factors and L the
//! variances of the rows, y = X b + e, b ~ N(0, 1), e ~ N(0, L):
//!
//! log p(y | L) = -1/2 (sum log L + log det A + y' L^-1 y - r' A^-1 r), A = 1 + X' L^-1 X,
//! r = X' L^-1 y, up to a constant that all hypotheses share. The variance of each cell is the most
//! likely one under an inverse gamma prior, found by expectation and maximisation (Dempster, Laird,
//! Rubin 1977), the trace of the factors' covariance included.
//!
//! Parameters that an effect is not linear in have the values where it was linearised: what it does
//! there is known, and what it would do elsewhere is not. Their part of the evidence is Laplace's:
//! the density of what is believed of them there, and how much narrower the data make it.

use crate::base::{Base, fill};
use crate::filtered::Filtered;
use crate::layout::Spectrum;
use crate::orthant::bounded;
use crate::policy;
use crate::terms::Terms;
use crate::unpredicted::unearned;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use std::ops::Range;

/// What was found of a hypothesis.
#[derive(Clone, Debug)]
pub struct Weighed {
    /// Its log evidence, up to a constant that all hypotheses on the same data share.
    pub log_evidence: f64,
    /// The variance of a row of each cell.
    pub variances: Vec<f64>,
    /// The most likely factors of the model's own parameters.
    pub own: Vec<f64>,
    /// The most likely factors of all terms, in order; 0 of curved ones.
    pub factors: Vec<f64>,
    /// The factors to go to if curved ones may change as well.
    pub step: Vec<f64>,
    /// The covariance of all factors.
    pub covariance: DMatrix<f64>,
}

impl Weighed {
    /// By how much the log evidence grows with steps of curved factors, to second order; steps of
    /// factors that are not curved are 0.
    pub fn gain(&self, steps: &[f64]) -> f64 {
        let moved: Vec<usize> = (0..steps.len()).filter(|&k| steps[k] != 0.0).collect();
        let covariance = DMatrix::from_fn(moved.len(), moved.len(), |a, b| {
            self.covariance[(moved[a], moved[b])] + if a == b { 1e-14 } else { 0.0 }
        });
        let off = DVector::from_fn(moved.len(), |k, _| steps[moved[k]]);
        covariance.cholesky().map_or(f64::INFINITY, |factor| 0.5 * off.dot(&factor.solve(&off)))
    }
}

/// The products of one cell: of data, own columns and those of terms, in this order.
pub(crate) struct Cell {
    pub(crate) rows: f64,
    pub(crate) products: DMatrix<f64>,
    /// The least variance of a row.
    pub(crate) least: f64,
}

impl Base {
    /// Weighs a set of terms. Variances begin at those given, or else at what the data have.
    pub fn weigh(&self, terms: &[&Terms], start: Option<&[f64]>, rounds: usize) -> Weighed {
        if terms.iter().all(|one| one.is_curved.iter().all(|is| !is)) {
            return self.weigh_linear(terms, start, rounds);
        }
        let plain: Vec<Terms> = terms.iter().map(|one| one.linear()).collect();
        let mut weighed = self.weigh_linear(&plain.iter().collect::<Vec<_>>(), start, rounds);
        let cells = self.cells_with(terms, terms.iter().map(|one| one.len()).sum());
        Posterior::new(&cells, &weighed.variances, &[]).curve(terms, self.parameters, &mut weighed);
        weighed
    }

    /// Weighs terms that are linear in all their factors.
    fn weigh_linear(&self, terms: &[&Terms], start: Option<&[f64]>, rounds: usize) -> Weighed {
        let width = terms.iter().map(|one| one.len()).sum::<usize>();
        let cells = self.cells_with(terms, width);
        let expected = self.layout.expected();
        let (evidence, variances) = settled(&cells, &expected, start, rounds, &[]);
        let both = self.layout.cells().zip(&variances);
        let all: Vec<_> = both.map(|((channel, rows), v)| (channel, rows, *v)).collect();
        let posterior = Posterior::new(&cells, &variances, &[]);
        let log_volume = self.log_volume(terms, &posterior.mean);
        let evidence = evidence + log_volume - unearned(terms, &all);
        let mut weighed = posterior.told(terms, self.parameters, evidence, variances);
        weighed.own = self.own_factors(&weighed.own);
        weighed
    }

    /// How much each row of the data moves the factors of terms, curved ones as well, with the
    /// variance of each cell: a spectrum for each of them.
    pub fn influences(&self, terms: &[&Terms], variances: &[f64]) -> Vec<Spectrum> {
        let (own, width) = (self.parameters, terms.iter().map(|one| one.len()).sum::<usize>());
        let posterior = Posterior::new(&self.cells_with(terms, width), variances, &[]);
        let shares = posterior.covariance.columns(own, width);
        let of_channel = |channel: usize| {
            let mut all = &self.own[channel] * shares.rows(0, own);
            if let Some(columns) = self.touched(terms, channel, width) {
                all += columns.columns(1, width) * shares.rows(own, width);
            }
            let cells = self.layout.cells().zip(variances).filter(|((of, _), _)| *of == channel);
            for ((_, rows), variance) in cells {
                all.rows_mut(rows.start, rows.len()).unscale_mut(*variance);
            }
            all
        };
        let channels: Vec<DMatrix<f64>> = (0..self.layout.channels()).map(of_channel).collect();
        let of = |k: usize| channels.iter().map(|all| all.column(k).as_slice().to_vec()).collect();
        (0..width).map(of).collect()
    }

    /// The log of by how much terms shrink data, with these factors of all columns.
    fn log_volume(&self, terms: &[&Terms], factors: &DVector<f64>) -> f64 {
        let (own, width) = (self.parameters, factors.len() - self.parameters);
        let of = |one: &Filtered| {
            let columns = self.touched(terms, one.channel, width)?;
            let of_own = &self.own[one.channel] * factors.rows(0, own);
            let left =
                columns.column(0) - of_own - columns.columns(1, width) * factors.rows(own, width);
            Some(one.log_volume(self.layout.cells(), left.as_slice()))
        };
        terms.iter().flat_map(|one| &one.filtered).filter_map(of).sum()
    }

    /// The products of every cell with those of terms.
    fn cells_with(&self, terms: &[&Terms], width: usize) -> Vec<Cell> {
        let own = self.parameters;
        let size = 1 + own + width;
        let touched: Vec<Option<DMatrix<f64>>> = (0..self.layout.channels())
            .map(|channel| self.touched(terms, channel, width))
            .collect();
        let of_cell = |((channel, rows), base): ((usize, Range<usize>), &DMatrix<f64>)| {
            let mut products = DMatrix::zeros(size, size);
            products.view_mut((0, 0), (1 + own, 1 + own)).copy_from(base);
            if let Some(columns) = &touched[channel] {
                let columns = columns.rows(rows.start, rows.len());
                let with_own = self.own[channel].rows(rows.start, rows.len()).tr_mul(&columns);
                let each_other = columns.tr_mul(&columns);
                let place = |k: usize| if k == 0 { 0 } else { own + k };
                for a in 0..=width {
                    for k in 0..own {
                        products[(1 + k, place(a))] = with_own[(k, a)];
                        products[(place(a), 1 + k)] = with_own[(k, a)];
                    }
                    for b in 0..=width {
                        products[(place(a), place(b))] = each_other[(a, b)];
                    }
                }
            }
            Cell { rows: rows.len() as f64, products, least: 0.0 }
        };
        self.layout.cells().zip(&self.products).map(of_cell).collect()
    }

    /// What terms make of the data of one channel: these less known parts, then all columns.
    fn touched(&self, terms: &[&Terms], channel: usize, width: usize) -> Option<DMatrix<f64>> {
        if !terms.iter().any(|one| one.touches(channel)) {
            return None;
        }
        let mut columns = DMatrix::zeros(self.layout.rows(channel), 1 + width);
        columns.column_mut(0).copy_from_slice(&self.data[channel]);
        for one in terms {
            one.less_known(channel, columns.column_mut(0).as_mut_slice());
        }
        let own = terms.iter().flat_map(|one| &one.columns);
        fill(&mut columns.columns_mut(1, width), own, channel);
        Some(columns)
    }
}

impl Terms {
    /// Takes the known part and what is believed of factors away from rows of a channel.
    pub(crate) fn less_known(&self, channel: usize, rows: &mut [f64]) {
        let known = std::iter::once((&self.known, 1.0));
        let believed = self.columns.iter().zip(self.believed.iter().copied());
        for (spectrum, factor) in known.chain(believed).filter(|(_, factor)| *factor != 0.0) {
            let column = spectrum.get(channel).into_iter().flatten();
            rows.iter_mut().zip(column).for_each(|(row, entry)| *row -= factor * entry);
        }
    }
}

/// The log evidence of cells with the variances that are most likely, and these. They begin at
/// those given, or else at what the data have. Factors are believed to be 0, or near some values.
pub(crate) fn settled(
    cells: &[Cell],
    expected: &[f64],
    start: Option<&[f64]>,
    rounds: usize,
    believed: &[f64],
) -> (f64, Vec<f64>) {
    let mut variances = match start {
        Some(start) => start.to_vec(),
        None => {
            let mean = |(cell, expected): (&Cell, &f64)| {
                let own = cell.products[(0, 0)] / cell.rows;
                own.max(policy::LEAST_OF_LEVEL * expected).max(cell.least)
            };
            cells.iter().zip(expected).map(mean).collect()
        }
    };
    let mut before = f64::NEG_INFINITY;
    for _ in 0..rounds {
        let posterior = Posterior::new(cells, &variances, believed);
        let evidence = posterior.log_evidence(cells, &variances, expected);
        variances = posterior.variances(cells, expected);
        if (evidence - before).abs() < policy::SETTLED {
            break;
        }
        before = evidence;
    }
    let posterior = Posterior::new(cells, &variances, believed);
    (posterior.log_evidence(cells, &variances, expected), variances)
}

/// The factors of all columns, given variances.
pub(crate) struct Posterior {
    factor: Cholesky<f64, Dyn>,
    pub(crate) mean: DVector<f64>,
    pub(crate) covariance: DMatrix<f64>,
    right: DVector<f64>,
    square: f64,
}

impl Posterior {
    pub(crate) fn new(cells: &[Cell], variances: &[f64], believed: &[f64]) -> Self {
        let of_believed = 1 + believed.len(); // where nothing was measured
        let size = cells.first().map_or(of_believed, |cell| cell.products.nrows());
        let mut sum = DMatrix::zeros(size, size);
        for (cell, variance) in cells.iter().zip(variances) {
            let weight = 1.0 / variance;
            let entries = sum.as_mut_slice().iter_mut().zip(cell.products.as_slice());
            entries.for_each(|(sum, product)| *sum += weight * product);
        }
        let columns = size - 1;
        let mut right = DVector::from_fn(columns, |k, _| sum[(1 + k, 0)]);
        right.iter_mut().zip(believed).for_each(|(right, own)| *right += own);
        let square = sum[(0, 0)] + believed.iter().map(|own| own * own).sum::<f64>();
        let mut normal = sum.view((1, 1), (columns, columns)).into_owned();
        (0..columns).for_each(|k| normal[(k, k)] += 1.0);
        let factor = positive(normal);
        let mean = factor.solve(&right);
        Self { covariance: factor.inverse(), mean, factor, right, square }
    }

    fn log_evidence(&self, cells: &[Cell], variances: &[f64], expected: &[f64]) -> f64 {
        let of_rows: f64 = cells.iter().zip(variances).map(|(cell, v)| cell.rows * v.ln()).sum();
        let triangle = self.factor.l_dirty();
        let determinant: f64 = (0..self.mean.len()).map(|k| 2.0 * triangle[(k, k)].ln()).sum();
        let shape = policy::NOISE_SHAPE;
        let of_level =
            |(v, level): (&f64, &f64)| (shape + 1.0) * (v / level).ln() + shape * level / v;
        let of_noise = -variances.iter().zip(expected).map(of_level).sum::<f64>();
        let explained = self.right.dot(&self.mean);
        of_noise - 0.5 * (of_rows + determinant + self.square - explained)
    }

    /// The variances that are most likely with these factors.
    fn variances(&self, cells: &[Cell], expected: &[f64]) -> Vec<f64> {
        let shape = policy::NOISE_SHAPE;
        let of = |(cell, level): (&Cell, &f64)| {
            let squares = self.left(cell);
            let own = (squares + 2.0 * shape * level) / (cell.rows + 2.0 * shape + 2.0);
            own.max(cell.least)
        };
        cells.iter().zip(expected).map(of).collect()
    }

    /// The expected squares of what is left of a cell.
    fn left(&self, cell: &Cell) -> f64 {
        let products = &cell.products;
        let columns = self.mean.len();
        let mut squares = products[(0, 0)];
        for a in 0..columns {
            let column = &products.as_slice()[(1 + a) * (1 + columns)..(2 + a) * (1 + columns)];
            let covariance = &self.covariance.as_slice()[a * columns..(1 + a) * columns];
            let mean = self.mean.as_slice();
            let mut inner = 0.0;
            let mut trace = 0.0;
            for b in 0..columns {
                inner += column[1 + b] * mean[b];
                trace += column[1 + b] * covariance[b];
            }
            squares += mean[a] * (inner - 2.0 * column[0]) + trace;
        }
        squares.max(0.0)
    }

    fn told(&self, terms: &[&Terms], own: usize, evidence: f64, variances: Vec<f64>) -> Weighed {
        let width = self.mean.len() - own;
        let covariance = self.covariance.view((own, own), (width, width)).into_owned();
        let all = |of: &dyn Fn(&Terms) -> Vec<f64>| -> Vec<f64> {
            terms.iter().flat_map(|one| of(one)).collect()
        };
        let believed = all(&|one| one.believed.clone());
        let mean = DVector::from_fn(width, |k, _| self.mean[own + k] + believed[k]);
        let lowest = all(&|one| one.lowest.clone());
        let (factors, gained) = bounded(&mean, &covariance, &lowest, &believed);
        // own parameters follow the factors that bounds move
        let moved = &factors - &mean;
        let mut of_model = self.mean.rows(0, own).into_owned();
        if moved.norm_squared() > 0.0 {
            let across = self.covariance.view((0, own), (own, width));
            if let Some(solved) = covariance.clone().cholesky().map(|own| own.solve(&moved)) {
                of_model += across * solved;
            }
        }
        let factors = factors.as_slice().to_vec();
        Weighed {
            log_evidence: evidence + gained,
            variances,
            own: of_model.as_slice().to_vec(),
            step: factors.clone(),
            factors,
            covariance,
        }
    }

    /// Adds the part of curved factors to what was found with their values.
    fn curve(&self, terms: &[&Terms], own: usize, weighed: &mut Weighed) {
        let curved: Vec<bool> = terms.iter().flat_map(|one| one.is_curved.clone()).collect();
        let believed: Vec<f64> = terms.iter().flat_map(|one| one.believed.clone()).collect();
        let width = curved.len();
        let mut linear = weighed.factors.iter();
        weighed.factors = curved
            .iter()
            .map(|is_curved| if *is_curved { 0.0 } else { *linear.next().expect("one of each") })
            .collect();
        let covariance = self.covariance.view((own, own), (width, width)).into_owned();
        let step: Vec<f64> = (0..width).map(|k| self.mean[own + k] + believed[k]).collect();
        let places: Vec<usize> = (0..width).filter(|&k| curved[k]).collect();
        let of_curved = DMatrix::from_fn(places.len(), places.len(), |a, b| {
            covariance[(places[a], places[b])] + if a == b { 1e-14 } else { 0.0 }
        });
        let of_prior: f64 = places.iter().map(|&k| 0.5 * believed[k].powi(2)).sum();
        if let Some(factor) = of_curved.cholesky() {
            let narrower: f64 = (0..places.len()).map(|k| factor.l_dirty()[(k, k)].ln()).sum();
            weighed.log_evidence += narrower - of_prior;
        }
        (weighed.covariance, weighed.step) = (covariance, step);
    }
}

/// The factor of a sum of squares and 1. What huge columns lose by rounding was beyond their
/// digits; where numbers are not finite nothing is known.
pub(crate) fn positive(normal: DMatrix<f64>) -> Cholesky<f64, Dyn> {
    let size = normal.nrows();
    let identity = || DMatrix::<f64>::identity(size, size);
    let largest = normal.diagonal().max();
    let mut more = 0.0;
    for _ in 0..ROUNDINGS {
        if let Some(factor) = (&normal + identity() * more).cholesky() {
            return factor;
        }
        more = (more * 100.0).max(largest * f64::EPSILON);
    }
    identity().cholesky().expect("ones are positive")
}

/// How often more is added to a matrix whose digits are lost, a hundred times as much each time.
const ROUNDINGS: usize = 7;
