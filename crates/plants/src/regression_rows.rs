//! Rows of a regression, a block of samples at once.

use super::native::NativeBatch;
use crate::error::{Cause, Error};
use denavit_codegen::program::EvaluateBatch;
use denavit_runtime::Transcendental;

/// How Coulomb friction depends on the rate of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum CoulombLaw {
    /// Its sign.
    #[default]
    Sign,
    /// The hyperbolic tangent of the rate over this one [rad/s, m/s]: the law of the simulation, a
    /// steep line through 0.
    Tanh(f64),
}

impl CoulombLaw {
    /// Friction of size 1 at a rate.
    pub fn of(self, rate: f64) -> f64 {
        match self {
            Self::Sign if rate == 0.0 => 0.0,
            Self::Sign => rate.signum(),
            Self::Tanh(width) => (rate / width).hyperbolic_tangent(),
        }
    }
}

/// Numbers in a line of the cache.
const LINE: usize = 8;

/// Computes rows of tau - known = Y phi for many samples at once.
#[derive(Clone, Debug)]
pub struct RegressionEvaluator {
    batch: NativeBatch,
    widths: Vec<usize>,
    known: Vec<usize>,
    law: CoulombLaw,
    /// Joint and place of each column that is a sign of the joint's rate.
    coulomb: Vec<(usize, usize)>,
}

/// The entries of Y that can differ from 0, and what is known, for a block of samples.
#[derive(Clone, Debug, Default)]
pub struct RegressionRows {
    samples: usize,
    /// Distance of the columns: were it a power of two, all of them would share few lines of the
    /// cache.
    stride: usize,
    /// Where the columns of each joint begin; one more for the end.
    first: Vec<usize>,
    known: Vec<usize>,
    values: Vec<f64>,
}

impl RegressionRows {
    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// The entries of one joint's rows in the `place`-th column of its
    /// [pattern](super::regression::RegressionModel::pattern), one for each sample.
    pub fn column(&self, joint: usize, place: usize) -> &[f64] {
        let at = (self.first[joint] + place) * self.stride;
        &self.values[at..at + self.samples]
    }

    /// The same, to be written.
    pub fn column_mut(&mut self, joint: usize, place: usize) -> &mut [f64] {
        let at = (self.first[joint] + place) * self.stride;
        &mut self.values[at..at + self.samples]
    }

    /// What the torque of a joint has besides unknowns [N m, N], one for each sample; none where
    /// that is nothing.
    pub fn known(&self, joint: usize) -> Option<&[f64]> {
        let place = self.known.iter().position(|&known| known == joint)?;
        let at = (self.first[self.first.len() - 1] + place) * self.stride;
        Some(&self.values[at..at + self.samples])
    }

    /// The number of columns of a joint.
    pub fn width(&self, joint: usize) -> usize {
        self.first[joint + 1] - self.first[joint]
    }

    /// Y phi + known of a joint, one for each sample; `phi` are the values of the columns of its
    /// pattern.
    pub fn torque(&self, joint: usize, phi: &[f64], torque: &mut [f64]) {
        match self.known(joint) {
            Some(known) => torque.copy_from_slice(known),
            None => torque.fill(0.0),
        }
        for (place, &factor) in phi.iter().enumerate() {
            for (sum, entry) in torque.iter_mut().zip(self.column(joint, place)) {
                *sum += factor * entry;
            }
        }
    }
}

impl RegressionEvaluator {
    pub(super) fn new(batch: NativeBatch, widths: Vec<usize>, known: &[usize]) -> Self {
        let (law, coulomb) = (CoulombLaw::Sign, Vec::new());
        Self { batch, widths, known: known.to_vec(), law, coulomb }
    }

    /// With another law in the columns of Coulomb friction, each given by its joint and place.
    pub(super) fn with_law(mut self, law: CoulombLaw, coulomb: &[(usize, usize)]) -> Self {
        (self.law, self.coulomb) = (law, coulomb.to_vec());
        self
    }

    /// The rows of samples. `motion` are 3 n columns, q of every joint, then qd, then qdd [rad, m;
    /// per s; per s^2], all of one length. `rows` is used again from call to call.
    pub fn evaluate(&mut self, motion: &[&[f64]], rows: &mut RegressionRows) -> Result<(), Error> {
        let expected = 3 * self.widths.len();
        let samples = motion.first().map_or(0, |column| column.len());
        let is_even = motion.iter().all(|column| column.len() == samples);
        if motion.len() != expected || !is_even {
            return Err(Cause::Motion { expected, found: motion.len() }.into());
        }
        rows.first.clear();
        let mut total = 0;
        rows.first.push(0);
        for width in &self.widths {
            total += width;
            rows.first.push(total);
        }
        rows.known.clone_from(&self.known);
        rows.samples = samples;
        // an odd number of lines
        rows.stride = LINE * (samples.div_ceil(LINE) | 1);
        rows.values.resize((total + self.known.len()) * rows.stride, 0.0);
        if samples == 0 {
            return Ok(());
        }
        let mut columns: Vec<&mut [f64]> = rows
            .values
            .chunks_exact_mut(rows.stride)
            .map(|column| &mut column[..samples])
            .collect();
        self.batch.evaluate(motion, &mut columns).expect("the shapes were compared before");
        if self.law != CoulombLaw::Sign {
            for &(joint, place) in &self.coulomb {
                let rates = motion[self.widths.len() + joint];
                let column = &mut columns[rows.first[joint] + place];
                for (entry, rate) in column.iter_mut().zip(rates) {
                    // a sign, times the factor that it has
                    *entry *= self.law.of(rate.abs());
                }
            }
        }
        Ok(())
    }
}
