//! What the rows of a reading say: the evidence of a model whose values are known more or less.

use super::policy;
use super::sample::JointRows;
use crate::estimate::{is_of_joints, nominal_values};
use denavit_codegen::model::JointEntry;
use denavit_evidence::policy::{NOISE_LEVEL, SIZE};
use denavit_evidence::{Condensed, Told};
use denavit_plants::regression::RegressionModel;
use nalgebra::{DMatrix, DVector};

/// The share of each joint's torque that is left, as roots of mean squares; none where none was
/// measured.
pub(super) type Shares = Vec<Option<f64>>;

/// What no joint has less of than nothing.
const POSITIVE: [JointEntry; 3] =
    [JointEntry::Viscous, JointEntry::Coulomb, JointEntry::RotorInertia];

/// What is believed of phi before the logs are looked at.
pub(super) struct Beliefs {
    /// Values that are given; none if there are none.
    pub(super) values: Option<DVector<f64>>,
    /// The places of each joint's columns in phi.
    pattern: Vec<Vec<usize>>,
    /// By how much an entry is off if all are off as much as they are; none if nothing is known.
    scale: Vec<Option<f64>>,
    /// The errors of values; none of the model's own.
    errors: Option<Vec<f64>>,
    /// Whether it cannot be below 0.
    is_positive: Vec<bool>,
}

/// What is known of the noise of a column of torque.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    /// How many of its samples are independent of each other.
    pub(super) independent: f64,
    /// The share of the torque, as root of mean square, that noise of the positions makes.
    pub(super) share: f64,
}

/// Values of phi that are given in place of the model's own: an estimate from other logs.
#[derive(Clone, Copy, Debug)]
pub struct GivenValues<'a> {
    /// The values.
    pub phi: &'a [f64],
    /// Their standard errors.
    pub errors: &'a [f64],
}

/// How far values that are given are believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Trust {
    /// They are off by as much as one of [`policy::VALUES_OFF`], the first being the errors of
    /// values if these have any.
    Near(usize),
    /// They say nothing.
    Nothing,
}

/// What rows say if values are believed so far.
pub(super) struct Believed {
    /// The log evidence, with the log odds of values that are so much off.
    pub(super) log_evidence: f64,
    pub(super) phi: DVector<f64>,
    /// The size of a line and its error, in deviations of what is believed of it.
    pub(super) more: Option<(f64, f64)>,
}

/// The log evidence of all of them together.
pub(super) fn together(all: &[Believed]) -> f64 {
    let most = all.iter().map(|one| one.log_evidence).fold(f64::NEG_INFINITY, f64::max);
    most + all.iter().map(|one| (one.log_evidence - most).exp()).sum::<f64>().ln()
}

impl Beliefs {
    /// With values of phi in place of the model's own.
    pub(super) fn new(model: &RegressionModel, values: Option<GivenValues<'_>>) -> Self {
        let is_positive = |at: usize| {
            let is_positive = |&(member, factor): &(usize, f64)| {
                let owner = model.standard[member].owner.as_ref();
                let is_own = |prefix| POSITIVE.iter().any(|entry| entry.prefix() == prefix);
                factor > 0.0 && owner.is_some_and(|(_, prefix)| is_own(*prefix))
            };
            model.axes[at].members.iter().all(is_positive)
        };
        let own = values.map(|own| own.phi.to_vec()).or_else(|| nominal_values(model));
        // friction is what it is on a day, and a sum of what cancels has errors of its terms
        let scale = |at: usize| {
            let own = own.as_ref().filter(|_| !is_of_joints(model, &model.axes[at]))?;
            let alike = |other: &usize| model.axes[*other].unit == model.axes[at].unit;
            let largest = (0..model.rank()).filter(alike).map(|at| own[at].abs());
            Some(own[at].abs() + policy::LITTLE * largest.fold(0.0, f64::max))
        };
        Self {
            scale: (0..model.rank()).map(scale).collect(),
            errors: values.map(|own| own.errors.to_vec()),
            values: own.map(DVector::from_vec),
            pattern: model.pattern().to_vec(),
            is_positive: (0..model.rank()).map(is_positive).collect(),
        }
    }

    /// How far values may be believed, that they say nothing being the last.
    pub(super) fn trusts(&self) -> Vec<Trust> {
        let near = self.values.as_ref().map_or(0, |_| policy::VALUES_OFF.len());
        (0..near).map(Trust::Near).chain([Trust::Nothing]).collect()
    }

    /// Weighs rows with the noise of each torque.
    pub(super) fn weigh(&self, rows: &[Option<JointRows>], noise: &[Noise]) -> Vec<Believed> {
        let with = |trust: Trust| self.weigh_with(rows, noise, None, trust);
        self.trusts().into_iter().map(with).collect()
    }

    /// Weighs rows with one of their lines, whose deviation is given, or without any, if values are
    /// believed so far.
    pub(super) fn weigh_with(
        &self,
        rows: &[Option<JointRows>],
        noise: &[Noise],
        line: Option<(usize, f64)>,
        trust: Trust,
    ) -> Believed {
        let rank = self.scale.len();
        let of_joint = |(joint, rows): (usize, &Option<JointRows>)| {
            Some(self.of_phi(joint, rows.as_ref()?, line.map(|(line, _)| line)))
        };
        let products: Vec<Option<DMatrix<f64>>> = rows.iter().enumerate().map(of_joint).collect();
        let sizes: Vec<f64> =
            rows.iter().map(|rows| rows.as_ref().map_or(0.0, JointRows::square)).collect();
        let units = self.units(&products, &sizes);
        let (far, odds) = match trust {
            Trust::Near(place) => {
                let [far, odds] = [place - usize::from(self.errors.is_some() && place > 0), place];
                (policy::VALUES_OFF[far].0, policy::VALUES_OFF[odds].1)
            }
            Trust::Nothing => (f64::INFINITY, policy::VALUES_IDLE),
        };
        let mean = |at: usize| match (&self.values, self.scale[at], trust) {
            (Some(values), Some(_), Trust::Near(_)) => values[at],
            _ => 0.0,
        };
        let mut mean: Vec<f64> = (0..rank).map(mean).collect();
        mean.extend(line.map(|_| 0.0));
        let deviation = |at: usize| match (self.scale[at], trust, &self.errors) {
            (Some(_), Trust::Near(0), Some(errors)) => policy::ERRORS_HOLD * errors[at],
            (Some(scale), Trust::Near(_), _) => far * scale,
            _ => units[at],
        };
        let deviations: Vec<f64> =
            (0..rank).map(deviation).chain(line.map(|(_, deviation)| deviation)).collect();
        let lowest = |at: usize| match at < rank && self.is_positive[at] {
            true => 0.0,
            false => f64::NEG_INFINITY,
        };
        let lowest: Vec<f64> = (0..mean.len()).map(lowest).collect();
        let factor = |(mean, deviation): (&f64, &f64)| match *deviation > 0.0 {
            true => mean / deviation,
            false => 0.0, // of a column that is 0
        };
        let believed: Vec<f64> = mean.iter().zip(&deviations).map(factor).collect();
        let scale = std::iter::once(1.0).chain(deviations.iter().copied());
        let scale = DMatrix::from_diagonal(&DVector::from_iterator(1 + mean.len(), scale));
        let of = |((products, size), noise): ((&Option<DMatrix<f64>>, &f64), &Noise)| {
            let products = &scale * products.as_ref()? * &scale / *size;
            let (rows, least) = (noise.independent, noise.share.powi(2));
            Some(Condensed { rows, expected: NOISE_LEVEL.powi(2), least, products })
        };
        let cells = products.iter().zip(&sizes).zip(noise).filter_map(of);
        let cells: Vec<Condensed> = cells.collect();
        let told = Told::of(&cells, &believed, &lowest, policy::WEIGHING_ROUNDS);
        Believed {
            log_evidence: odds + told.log_evidence,
            phi: DVector::from_fn(rank, |at, _| deviations[at] * told.factors[at]),
            more: line.map(|_| (told.factors[rank], told.deviations[rank])),
        }
    }

    /// The mean products of what is to be explained of a joint, of the columns of all of phi and of
    /// one line.
    fn of_phi(&self, joint: usize, rows: &JointRows, line: Option<usize>) -> DMatrix<f64> {
        let own = rows.of_columns();
        let rank = self.scale.len();
        let places = &self.pattern[joint];
        let mut from: Vec<usize> = (0..=places.len()).collect();
        let mut to: Vec<usize> = std::iter::once(0).chain(places.iter().map(|at| 1 + at)).collect();
        if let Some(line) = line {
            from.push(1 + places.len() + line);
            to.push(1 + rank);
        }
        let size = 1 + rank + usize::from(line.is_some());
        let mut all = DMatrix::zeros(size, size);
        for (&row, &to_row) in from.iter().zip(&to) {
            for (&column, &to_column) in from.iter().zip(&to) {
                all[(to_row, to_column)] = own[(row, column)];
            }
        }
        all
    }

    /// Of each entry of phi what makes a share of the torque that is much, of the joint where it
    /// makes most; 0 if it makes nothing of any.
    fn units(&self, products: &[Option<DMatrix<f64>>], sizes: &[f64]) -> Vec<f64> {
        let share = |at: usize| {
            let of = |(products, size): (&Option<DMatrix<f64>>, &f64)| {
                products.as_ref().map_or(0.0, |products| products[(1 + at, 1 + at)] / size)
            };
            products.iter().zip(sizes).map(of).fold(0.0, f64::max).sqrt()
        };
        let unit = |share: f64| if share > 0.0 { SIZE / share } else { 0.0 };
        (0..self.scale.len()).map(|at| unit(share(at))).collect()
    }
}
