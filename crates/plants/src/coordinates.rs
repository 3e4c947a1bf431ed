//! Coordinates of all that a model's parameters can be: bodies that exist, friction and rotor
//! inertia that are not negative. No step along them leaves those.
//!
//! Masses and moments of inertia that a model's file writes as expressions have [`Bounds`]: none
//! may be negative. Numbers of the file that are masses or moments themselves have coordinates that
//! cannot leave what is allowed; of a moment that is a sum of unknowns, each may have either sign.

use super::body::{log_cholesky, of_log_cholesky};
use super::regression::RegressionModel;
use denavit_codegen::model::Role;
use nalgebra::{DMatrix, DVector};

/// The least share of its value in the file that a positive number of it keeps: logarithms need one
/// above 0, and no log tells a millionth from nothing.
const LEAST_OF: f64 = 1e-6;

/// The least share of its size that an entry which is an expression keeps.
const LEAST: f64 = 1e-3;

/// Coordinates of a model's parameters, theta0 in the order of [`RegressionModel::standard`].
pub struct Coordinates<'a> {
    model: &'a RegressionModel,
    /// What they stand for, each piece after the place of its first one.
    pieces: Vec<(usize, Piece)>,
    count: usize,
}

impl<'a> Coordinates<'a> {
    /// Those of a model.
    pub fn new(model: &'a RegressionModel) -> Self {
        let mut coordinates = Self { model, pieces: Vec::new(), count: 0 };
        let mut place = 0;
        while let Some(parameter) = model.standard.get(place) {
            match &parameter.owner {
                // The ten parameters of a body stand beside each other.
                Some((_, "m")) => {
                    coordinates.push(Piece::Body(place), 10);
                    place += 9;
                }
                Some((_, "fv" | "fc" | "Ia")) => coordinates.push(Piece::NotNegative(place), 1),
                Some(_) => coordinates.push(Piece::Free(place), 1),
                None => {}
            }
            place += 1;
        }
        let has_own = model.standard.iter().any(|one| one.owner.is_none());
        for place in (0..model.parameters.len()).filter(|place| has_own && !is_owned(model, *place))
        {
            coordinates.push(Piece::Own(place), 1);
        }
        coordinates
    }

    fn push(&mut self, piece: Piece, count: usize) {
        self.pieces.push((self.count, piece));
        self.count += count;
    }

    /// The coordinates that stand for numbers of the file, with the places of these.
    pub fn own(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.pieces.iter().filter_map(|(at, piece)| match *piece {
            Piece::Own(place) => Some((*at, place)),
            _ => None,
        })
    }

    /// The numbers of the file that coordinates stand for.
    pub fn own_values(&self, eta: &DVector<f64>) -> Vec<(usize, f64)> {
        let value = |(at, place): (usize, usize)| {
            let is_positive = self.model.parameters[place].is_positive;
            let least = LEAST_OF * self.model.parameters[place].value.abs();
            (place, if is_positive { eta[at] * eta[at] + least } else { eta[at] })
        };
        self.own().map(value).collect()
    }

    /// The numbers of the file: those that coordinates stand for, and the others as they were.
    pub fn file_values(&self, eta: &DVector<f64>) -> Vec<f64> {
        let mut values: Vec<f64> = self.model.parameters.iter().map(|one| one.value).collect();
        for (place, value) in self.own_values(eta) {
            values[place] = value;
        }
        values
    }

    /// Coordinates of given parameters, moved into the bodies that exist.
    pub fn of_start(&self, start: &[f64]) -> DVector<f64> {
        let mut eta = Vec::new();
        for (_, piece) in &self.pieces {
            match *piece {
                Piece::NotNegative(place) => eta.push(start[place].max(1e-8).sqrt()),
                Piece::Free(place) => eta.push(start[place]),
                Piece::Own(place) => {
                    let own = &self.model.parameters[place];
                    let above = (1.0 - LEAST_OF) * own.value;
                    eta.push(if own.is_positive { above.max(1e-5).sqrt() } else { own.value });
                }
                Piece::Body(place) => {
                    eta.extend(log_cholesky(&start[place..place + 10]));
                }
            }
        }
        DVector::from_vec(eta)
    }

    /// theta0 of coordinates, and its derivative.
    pub fn standard(&self, eta: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let size = self.model.standard.len();
        let mut theta = DVector::zeros(size);
        let mut slope = DMatrix::zeros(size, eta.len());
        self.products(eta, &mut theta, &mut slope);
        for (at, piece) in &self.pieces {
            let at = *at;
            match *piece {
                Piece::Own(_) => {}
                Piece::Free(place) => {
                    theta[place] = eta[at];
                    slope[(place, at)] = 1.0;
                }
                Piece::NotNegative(place) => {
                    theta[place] = eta[at] * eta[at];
                    slope[(place, at)] = 2.0 * eta[at];
                }
                Piece::Body(place) => {
                    let (own, slopes) = of_log_cholesky(&eta.as_slice()[at..at + 10]);
                    theta.rows_mut(place, 10).copy_from_slice(&own);
                    for (coordinate, own) in slopes.iter().enumerate() {
                        slope.view_mut((place, at + coordinate), (10, 1)).copy_from_slice(own);
                    }
                }
            }
        }
        (theta, slope)
    }

    /// Columns that are products of the model's own numbers, with their derivatives: polynomials of
    /// low degree, whose central differences are nearly exact.
    fn products(&self, eta: &DVector<f64>, theta: &mut DVector<f64>, slope: &mut DMatrix<f64>) {
        if self.own().next().is_none() {
            return;
        }
        let model = self.model;
        let mut values = self.file_values(eta);
        let products: Vec<usize> =
            (0..theta.len()).filter(|&row| model.standard[row].owner.is_none()).collect();
        let here = model.standard_values(&values);
        products.iter().for_each(|&row| theta[row] = here[row]);
        for (at, place) in self.own() {
            let value = values[place];
            let step = 1e-4 * value.abs().max(1e-2);
            values[place] = value + step;
            let above = model.standard_values(&values);
            values[place] = value - step;
            let below = model.standard_values(&values);
            values[place] = value;
            let inner = if model.parameters[place].is_positive { 2.0 * eta[at] } else { 1.0 };
            for &row in &products {
                slope[(row, at)] = inner * (above[row] - below[row]) / (2.0 * step);
            }
        }
    }
}

/// What coordinates stand for.
enum Piece {
    /// Ten coordinates of the body whose parameters begin at this place.
    Body(usize),
    /// The square root of a parameter that is not negative.
    NotNegative(usize),
    /// The parameter itself.
    Free(usize),
    /// A number of the model's file that columns without an owner are made of, or, of one that is
    /// positive, the square root of what it is above the least: its place in
    /// [`RegressionModel::parameters`].
    Own(usize),
}

/// Whether a number of the file has columns of its own, or goes into those of its link.
fn is_owned(model: &RegressionModel, place: usize) -> bool {
    let parameter = &model.parameters[place];
    let prefix = parameter.name.split('_').next().unwrap_or_default();
    let body = matches!(parameter.role, Some(Role::Body(..)));
    model.standard.iter().any(|one| {
        let Some((link, own)) = &one.owner else { return false };
        let is_of_link = parameter.link.as_ref() == Some(link);
        is_of_link && (body && *own == "m" || *own == prefix)
    })
}

/// Entries that are expressions, with what they may not fall below.
pub struct Bounds<'a> {
    model: &'a RegressionModel,
    /// The size of each.
    sizes: Vec<f64>,
}

impl<'a> Bounds<'a> {
    /// Those of a model; sizes are those of its own values.
    pub fn new(model: &'a RegressionModel) -> Self {
        let values: Vec<f64> = model.parameters.iter().map(|one| one.value).collect();
        let sizes = model.masses_and_moments(&values);
        Self { model, sizes: sizes.into_iter().map(|size| size.abs().max(1e-4)).collect() }
    }

    /// Number of entries.
    pub fn count(&self) -> usize {
        self.sizes.len()
    }

    /// What each entry falls short of, over its size, for the numbers of the file.
    pub fn short(&self, values: &[f64]) -> Vec<f64> {
        let entries = self.model.masses_and_moments(values);
        entries
            .iter()
            .zip(&self.sizes)
            .map(|(entry, size)| (LEAST - entry / size).max(0.0))
            .collect()
    }

    /// Whether all entries are above 0.
    pub fn hold(&self, values: &[f64]) -> bool {
        self.short(values).iter().all(|short| *short < 0.9 * LEAST)
    }
}
