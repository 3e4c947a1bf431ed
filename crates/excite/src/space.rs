//! Spaces of trajectories: samples joined by a spline (thesis 3.8), finite Fourier series (3.9,
//! 3.10), polynomials (3.11, 3.12).
//!
//! Each is a span of functions of time, phi_1 .. phi_m, the same for every joint. What is asked of
//! the ends (rest, no acceleration, the same position) is linear in the coefficients, so that the
//! trajectories which have it are again a span: coefficients are P y, with the projection P onto
//! the null space of the conditions, or an orthonormal basis N of it. Series of free frequencies
//! have their frequencies as coordinates too, and P depends on them.

use crate::policy::space::ROUNDING;
use denavit_plants::trajectory::{Bezier, CubicSpline, EndCondition, Fourier, Reference, Setpoint};
use denavit_runtime::Scalar;
use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// The functions of time that a trajectory is a sum of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// A constant, and sines and cosines of the multiples of 2 pi / duration.
    Fourier {
        /// How many multiples.
        harmonics: usize,
    },
    /// The same with frequencies that are chosen too, of each joint its own.
    FreeFourier {
        /// How many frequencies.
        terms: usize,
    },
    /// Polynomials, in Bernstein's form, whose coefficients are in the range of the positions.
    Polynomial {
        /// Their degree.
        degree: usize,
    },
    /// Positions at even times, joined by a cubic spline.
    Samples {
        /// How many, both ends included.
        knots: usize,
    },
}

impl Family {
    /// Number of functions.
    fn functions(self) -> usize {
        match self {
            Self::Fourier { harmonics: terms } | Self::FreeFourier { terms } => 1 + 2 * terms,
            Self::Polynomial { degree } => degree + 1,
            Self::Samples { knots } => knots,
        }
    }

    /// Number of frequencies that are coordinates.
    fn frequencies(self) -> usize {
        if let Self::FreeFourier { terms } = self { terms } else { 0 }
    }
}

/// What is asked of start and end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ends {
    /// No velocity.
    pub at_rest: bool,
    /// No acceleration.
    pub unaccelerated: bool,
    /// The same position: laps can follow each other.
    pub closed: bool,
}

/// Position, rate and acceleration at the times of a grid.
pub(super) type Curve = [Vec<f64>; 3];

/// Derivatives of a curve by the coordinates of its joint: times x coordinates, for each order.
pub(super) type Slopes = [DMatrix<f64>; 3];

/// A space of trajectories of one joint; every joint has coordinates of its own in it.
#[derive(Clone, Debug)]
pub struct Space {
    family: Family,
    duration_s: f64,
    ends: Ends,
    /// Coefficients of coordinates; none for free frequencies, where it depends on these.
    basis: Option<DMatrix<f64>>,
    times: Vec<f64>,
    /// The derivatives by the coordinates, where these are the same everywhere.
    slopes: Option<Slopes>,
}

/// Lowest and highest of free frequencies, over 2 pi / duration, for a number of terms.
fn frequency_range(terms: usize) -> [f64; 2] {
    [0.5, 2.0 * terms as f64]
}

impl Space {
    /// The space of a family over a duration \[s\], with so many steps of its grid of times.
    pub fn new(family: Family, duration_s: f64, ends: Ends, steps: usize) -> Self {
        let times = (0..=steps).map(|k| duration_s * k as f64 / steps as f64).collect();
        let mut space = Self { family, duration_s, ends, basis: None, times, slopes: None };
        if family.frequencies() == 0 {
            let basis = null_space(&space.projection(&[]));
            let functions = space.functions(&[]);
            space.slopes = Some(functions.map(|values| values * &basis));
            space.basis = Some(basis);
        }
        space
    }

    /// Number of coordinates of a joint.
    pub fn coordinates(&self) -> usize {
        let linear = self.basis.as_ref().map_or(self.family.functions(), DMatrix::ncols);
        linear + self.family.frequencies()
    }

    /// Whether there is more than resting trajectories in the space.
    pub fn moves(&self) -> bool {
        let terms = self.family.frequencies();
        let frequencies: Vec<f64> = (1..=terms).map(|k| k as f64 + 0.25).collect();
        // the trace of a projection is the dimension of what it leaves: the constant, and more
        self.projection(&frequencies).trace() > 1.5
    }

    /// The times of the grid \[s\].
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Length of a lap \[s\].
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// Whether laps can follow each other with position and rate continuous.
    pub fn is_periodic(&self) -> bool {
        let closes = self.ends.closed && self.ends.at_rest;
        closes || matches!(self.family, Family::Fourier { .. })
    }

    /// Bounds of the coordinates.
    pub fn bounds(&self) -> Vec<(f64, f64)> {
        let frequencies = self.family.frequencies();
        let linear = self.coordinates() - frequencies;
        let mut bounds = vec![(-1e3, 1e3); linear];
        let [low, high] = frequency_range(frequencies);
        bounds.resize(linear + frequencies, (low, high));
        bounds
    }

    /// Coordinates at random, from a source of numbers from 0 to 1: an even share for every
    /// function, frequencies spread over their range.
    pub fn random(&self, mut uniform: impl FnMut() -> f64) -> Vec<f64> {
        let frequencies = self.family.frequencies();
        let linear = self.coordinates() - frequencies;
        let mut coordinates: Vec<f64> = (0..linear).map(|_| 2.0 * uniform() - 1.0).collect();
        let spread = (1..=frequencies).map(|k| (k as f64 + 0.6 * (uniform() - 0.5)).max(0.5));
        coordinates.extend(spread);
        coordinates
    }

    /// Coordinates of the same trajectory with its linear part multiplied by a factor.
    pub fn scaled(&self, coordinates: &[f64], factor: f64) -> Vec<f64> {
        let linear = self.coordinates() - self.family.frequencies();
        let scale = |(at, x): (usize, &f64)| if at < linear { factor * x } else { *x };
        coordinates.iter().enumerate().map(scale).collect()
    }

    /// Position, rate and acceleration on the grid.
    pub fn curve(&self, coordinates: &[f64]) -> Curve {
        match &self.slopes {
            Some(slopes) => {
                let y = DVector::from_column_slice(coordinates);
                slopes.each_ref().map(|slope| (slope * &y).as_slice().to_vec())
            }
            None => {
                let c = DVector::from_vec(self.coefficients(coordinates));
                let functions = self.functions(self.split(coordinates).1);
                functions.map(|values| (values * &c).as_slice().to_vec())
            }
        }
    }

    /// Derivatives of the curve by the coordinates.
    pub fn slopes(&self, coordinates: &[f64]) -> Slopes {
        if let Some(slopes) = &self.slopes {
            return slopes.clone();
        }
        let (linear, frequencies) = self.split(coordinates);
        let projection = self.projection(frequencies);
        let of_linear = self.functions(frequencies).map(|values| values * &projection);
        let mut slopes = of_linear.map(|slope| slope.resize_horizontally(coordinates.len(), 0.0));
        for at in linear.len()..coordinates.len() {
            let step = 1e-5;
            let moved = [step, -step].map(|step| {
                let mut moved = coordinates.to_vec();
                moved[at] += step;
                self.curve(&moved)
            });
            for (order, slope) in slopes.iter_mut().enumerate() {
                for (row, entry) in slope.column_mut(at).iter_mut().enumerate() {
                    *entry = (moved[0][order][row] - moved[1][order][row]) / (2.0 * step);
                }
            }
        }
        slopes
    }

    /// The coordinates whose positions come closest to given ones on the grid; of free frequencies
    /// with those of the multiples.
    pub fn nearest(&self, positions: &[f64]) -> Vec<f64> {
        let terms = self.family.frequencies();
        let linear = self.coordinates() - terms;
        let frequencies: Vec<f64> = (1..=terms).map(|k| k as f64).collect();
        let mut coordinates = vec![0.0; linear];
        coordinates.extend(&frequencies);
        let slope = &self.slopes(&coordinates)[0];
        let slope = slope.columns(0, linear).into_owned();
        let target = DVector::from_column_slice(positions);
        let solved = slope.svd(true, true).solve(&target, 1e-10);
        if let Ok(solved) = solved {
            coordinates[..linear].copy_from_slice(solved.as_slice());
        }
        coordinates
    }

    /// What follows center + scale * curve, as a reference.
    pub fn reference(
        &self,
        coordinates: &[f64],
        center: f64,
        scale: f64,
    ) -> Result<Reference, denavit_plants::Error> {
        let c = self.placed(coordinates, center, scale);
        let range = [0.0, self.duration_s];
        match self.family {
            Family::Fourier { .. } => {
                let [sines, cosines] = pairs(&c);
                Fourier::new(TAU / self.duration_s, c[0], sines, cosines).map(Reference::Fourier)
            }
            Family::FreeFourier { .. } => {
                let [sines, cosines] = pairs(&c);
                let frequencies = self.frequencies_rad_s(coordinates);
                Fourier::with_frequencies(frequencies, c[0], sines, cosines).map(Reference::Fourier)
            }
            Family::Polynomial { .. } => Bezier::new(range, c).map(Reference::Bezier),
            Family::Samples { .. } => {
                CubicSpline::new(self.knots(), c, self.spline_ends()).map(Reference::Cubic)
            }
        }
    }

    /// The same as a trajectory file has it.
    pub fn written(&self, coordinates: &[f64], center: f64, scale: f64) -> Value {
        let c = self.placed(coordinates, center, scale);
        match self.family {
            Family::Fourier { .. } => {
                let [sines, cosines] = pairs(&c);
                let frequency = TAU / self.duration_s;
                json!({ "fourier": {
                    "frequency_rad_s": frequency, "offset": c[0],
                    "sines": sines, "cosines": cosines,
                }})
            }
            Family::FreeFourier { .. } => {
                let [sines, cosines] = pairs(&c);
                json!({ "fourier": {
                    "frequencies_rad_s": self.frequencies_rad_s(coordinates), "offset": c[0],
                    "sines": sines, "cosines": cosines,
                }})
            }
            Family::Polynomial { .. } => {
                json!({ "bezier": { "times": [0.0, self.duration_s], "values": c } })
            }
            Family::Samples { .. } => match self.spline_ends() {
                [EndCondition::Rate(start), EndCondition::Rate(end)] => json!({ "cubic": {
                    "times": self.knots(), "values": c, "end_rates": [start, end],
                }}),
                _ => json!({ "cubic": { "times": self.knots(), "values": c } }),
            },
        }
    }

    fn placed(&self, coordinates: &[f64], center: f64, scale: f64) -> Vec<f64> {
        let mut c = self.coefficients(coordinates);
        c.iter_mut().for_each(|entry| *entry *= scale);
        match self.family {
            Family::Fourier { .. } | Family::FreeFourier { .. } => c[0] += center,
            // the functions add up to 1
            _ => c.iter_mut().for_each(|entry| *entry += center),
        }
        c
    }

    fn split<'c>(&self, coordinates: &'c [f64]) -> (&'c [f64], &'c [f64]) {
        coordinates.split_at(coordinates.len() - self.family.frequencies())
    }

    fn coefficients(&self, coordinates: &[f64]) -> Vec<f64> {
        let (linear, frequencies) = self.split(coordinates);
        let y = DVector::from_column_slice(linear);
        let c = match &self.basis {
            Some(basis) => basis * y,
            None => self.projection(frequencies) * y,
        };
        c.as_slice().to_vec()
    }

    fn frequencies_rad_s(&self, coordinates: &[f64]) -> Vec<f64> {
        let base = TAU / self.duration_s;
        match self.family {
            Family::Fourier { harmonics } => (1..=harmonics).map(|k| base * k as f64).collect(),
            _ => self.split(coordinates).1.iter().map(|factor| base * factor).collect(),
        }
    }

    fn knots(&self) -> Vec<f64> {
        let last = self.family.functions() - 1;
        (0..=last).map(|k| self.duration_s * k as f64 / last as f64).collect()
    }

    /// A natural spline has no acceleration at its ends.
    fn spline_ends(&self) -> [EndCondition; 2] {
        match self.ends.at_rest && !self.ends.unaccelerated {
            true => [EndCondition::Rate(0.0); 2],
            false => [EndCondition::Natural; 2],
        }
    }

    /// The functions at the grid's times: times x functions, for each order.
    fn functions(&self, frequencies: &[f64]) -> Slopes {
        self.functions_at(&self.times, frequencies)
    }

    fn functions_at(&self, times: &[f64], frequencies: &[f64]) -> Slopes {
        let count = self.family.functions();
        let mut values = [0; 3].map(|_| DMatrix::zeros(times.len(), count));
        let mut set = |row: usize, function: usize, point: Setpoint| {
            values[0][(row, function)] = point.position;
            values[1][(row, function)] = point.rate;
            values[2][(row, function)] = point.acceleration;
        };
        if let Family::Fourier { .. } | Family::FreeFourier { .. } = self.family {
            let own = self.frequencies_rad_s(frequencies);
            for (row, &t_s) in times.iter().enumerate() {
                set(row, 0, Setpoint { position: 1.0, rate: 0.0, acceleration: 0.0 });
                for (k, &w) in own.iter().enumerate() {
                    let (s, c) = (w * t_s).sincos();
                    let sine = Setpoint { position: s, rate: w * c, acceleration: -w * w * s };
                    let cosine = Setpoint { position: c, rate: -w * s, acceleration: -w * w * c };
                    set(row, 1 + 2 * k, sine);
                    set(row, 2 + 2 * k, cosine);
                }
            }
            return values;
        }
        for function in 0..count {
            let mut one = vec![0.0; count];
            one[function] = 1.0;
            let made = match self.family {
                Family::Samples { .. } => {
                    CubicSpline::new(self.knots(), one, self.spline_ends()).map(Reference::Cubic)
                }
                _ => Bezier::new([0.0, self.duration_s], one).map(Reference::Bezier),
            };
            let made = made.expect("the options of a space have been checked");
            for (row, &t_s) in times.iter().enumerate() {
                set(row, function, made.at(t_s.min(self.duration_s)));
            }
        }
        values
    }

    /// The projection of coefficients onto those with the wanted ends.
    fn projection(&self, frequencies: &[f64]) -> DMatrix<f64> {
        let count = self.family.functions();
        let at_ends = self.functions_at(&[0.0, self.duration_s], frequencies);
        let mut rows = Vec::new();
        for (order, wanted) in [(1, self.ends.at_rest), (2, self.ends.unaccelerated)] {
            if wanted {
                rows.extend([0, 1].map(|end| at_ends[order].row(end).into_owned()));
            }
        }
        if self.ends.closed {
            rows.push(at_ends[0].row(0) - at_ends[0].row(1));
        }
        // what is far below the terms it is made of is rounding
        let sizes = at_ends.each_ref().map(|values| values.amax());
        rows.retain(|row| row.amax() > ROUNDING * sizes[0].min(sizes[1]));
        let mut projection = DMatrix::identity(count, count);
        for direction in orthonormal(rows.into_iter().map(|row| row.normalize().transpose())) {
            projection -= &direction * direction.transpose();
        }
        projection
    }
}

/// Sines and cosines of coefficients that begin with a constant.
fn pairs(coefficients: &[f64]) -> [Vec<f64>; 2] {
    [1, 2].map(|first| coefficients.iter().skip(first).step_by(2).copied().collect())
}

/// An orthonormal basis of what a projection leaves alone.
fn null_space(projection: &DMatrix<f64>) -> DMatrix<f64> {
    let columns = projection.column_iter().map(|column| column.into_owned());
    DMatrix::from_columns(&orthonormal(columns))
}

/// An orthonormal basis of the span of vectors no longer than 1, by orthogonalisation twice; what
/// is left of a vector that depends on others is rounding.
fn orthonormal(vectors: impl Iterator<Item = DVector<f64>>) -> Vec<DVector<f64>> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for mut rest in vectors {
        for _ in 0..2 {
            for direction in &basis {
                let along = direction.dot(&rest);
                rest.axpy(-along, direction, 1.0);
            }
        }
        if rest.norm() > ROUNDING {
            basis.push(rest.normalize());
        }
    }
    basis
}
