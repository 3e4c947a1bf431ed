//! What no effect explains, as a formula without a name: a few terms of a general library that
//! explain most of what a joint leaves, judged by held-out logs.

use super::data::{Data, ModelTorques};
use super::signals::Signals;
use super::state::{Setting, State};
use crate::policy::structure::LEAST_SHARE;
use denavit_measure::JointIndex;
use nalgebra::{DMatrix, DVector};

/// What one joint leaves, described.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// The joint, or the spring of one.
    pub at: String,
    /// The terms with their coefficients [N m, N per unit of the term], the largest share first.
    pub terms: Vec<(String, f64)>,
    /// The share of the squares of held-out logs that they explain.
    pub share: f64,
}

impl Structure {
    /// The sum of its terms.
    pub fn formula(&self) -> String {
        let term = |(name, factor): &(String, f64)| format!("{factor:.3e} {name}");
        self.terms.iter().map(term).collect::<Vec<String>>().join(" + ").replace("+ -", "- ")
    }
}

/// Most terms of a formula.
const MOST_TERMS: usize = 4;

/// Describes what is left of a joint or spring; none if no term explains a twentieth of it.
pub(super) fn describe(setting: &Setting<'_>, state: &State, equation: usize) -> Option<Structure> {
    let State { torques, residual, .. } = state;
    let train = Rows::new(setting.data.train, &torques.train, equation, &residual.train);
    let held_out =
        Rows::new(setting.data.held_out, &torques.held_out, equation, &residual.held_out);
    let whole = held_out.left.norm_squared();
    let (mut places, mut found, mut least) = (Vec::new(), DVector::zeros(0), whole);
    while places.len() < MOST_TERMS {
        let tried = (0..train.names.len()).filter(|place| !places.contains(place));
        let fits = tried.filter_map(|place| {
            let all = [places.as_slice(), &[place]].concat();
            let (factors, cost) = train.fit(&all)?;
            Some((place, factors, cost))
        });
        let Some((place, factors, _)) = fits.min_by(|a, b| a.2.total_cmp(&b.2)) else { break };
        let all = [places.as_slice(), &[place]].concat();
        let cost = held_out.cost(&all, &factors);
        if least - cost < LEAST_SHARE * whole {
            break;
        }
        (places, found, least) = (all, factors, cost);
    }
    let terms = places.iter().zip(found.iter());
    let terms: Vec<(String, f64)> =
        terms.map(|(&place, &factor)| (train.names[place].clone(), factor)).collect();
    let at = setting.data.train.nominal.equation_name(equation);
    (!terms.is_empty()).then(|| Structure { at, terms, share: 1.0 - least / whole })
}

/// What a joint leaves and the library.
struct Rows {
    names: Vec<String>,
    columns: Vec<DVector<f64>>,
    left: DVector<f64>,
}

impl Rows {
    fn new(data: &Data<'_>, torques: &[ModelTorques], equation: usize, left: &[f64]) -> Self {
        let mut rows = Self { names: Vec::new(), columns: Vec::new(), left: DVector::zeros(0) };
        let (mut columns, mut all_left): (Vec<Vec<f64>>, Vec<f64>) = (Vec::new(), Vec::new());
        for stretch in data.stretches.iter().filter(|stretch| stretch.equation == equation) {
            let range = stretch.range();
            all_left.extend(&left[range]);
            let signals = &data.signals[stretch.log.0];
            let names = data.nominal.model.joints.iter().map(|one| one.name.as_str());
            let names: Vec<&str> = names.collect();
            let joint = stretch.joint;
            let library = library(signals, &torques[stretch.log.0].load[joint.0], joint, &names);
            columns.resize(library.len(), Vec::new());
            rows.names = library.iter().map(|(name, _)| name.clone()).collect();
            for (column, (_, values)) in columns.iter_mut().zip(&library) {
                column.extend(signals.rows_of(values));
            }
        }
        rows.columns = columns.into_iter().map(DVector::from_vec).collect();
        rows.left = DVector::from_vec(all_left);
        rows
    }

    fn matrix(&self, places: &[usize]) -> DMatrix<f64> {
        let columns: Vec<DVector<f64>> =
            places.iter().map(|&place| self.columns[place].clone()).collect();
        DMatrix::from_columns(&columns)
    }

    /// The best factors of some terms and what they leave; none if they depend on each other.
    fn fit(&self, places: &[usize]) -> Option<(DVector<f64>, f64)> {
        let matrix = self.matrix(places);
        let lengths: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
        if lengths.iter().any(|length| *length <= 0.0) {
            return None;
        }
        let scaled =
            DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |r, c| matrix[(r, c)] / lengths[c]);
        let normal = scaled.tr_mul(&scaled);
        let factor = normal
            .cholesky()
            .filter(|factor| factor.l_dirty().diagonal().iter().all(|pivot| *pivot > 1e-3))?;
        let solved = factor.solve(&scaled.tr_mul(&self.left));
        let factors = DVector::from_fn(lengths.len(), |k, _| solved[k] / lengths[k]);
        let cost = self.cost(places, &factors);
        Some((factors, cost))
    }

    fn cost(&self, places: &[usize], factors: &DVector<f64>) -> f64 {
        (&self.left - self.matrix(places) * factors).norm_squared()
    }
}

/// General functions of a joint's motion and of its neighbours', at the samples of the motion.
fn library(
    signals: &Signals,
    load: &[f64],
    joint: JointIndex,
    names: &[&str],
) -> Vec<(String, Vec<f64>)> {
    let mut all: Vec<(String, Vec<f64>)> = Vec::new();
    let of_one = |values: &[f64], of: &dyn Fn(f64) -> f64| -> Vec<f64> {
        values.iter().map(|value| of(*value)).collect()
    };
    let product = |a: &[f64], b: &[f64], of: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
        a.iter().zip(b).map(|(a, b)| of(*a, *b)).collect()
    };
    let [rates, accelerations] = signals.of_drive(joint);
    let (q, name) = (&signals.q[joint.0], names[joint.0]);
    all.push(("1".to_owned(), vec![1.0; q.len()]));
    let powers: [(&str, &dyn Fn(f64) -> f64); 5] = [
        ("q", &|q| q),
        ("q^2", &|q| q * q),
        ("q^3", &|q| q * q * q),
        ("sin q", &f64::sin),
        ("cos q", &f64::cos),
    ];
    all.extend(powers.map(|(text, of)| (format!("{text}_{name}"), of_one(q, of))));
    let of_rates: [(&str, &dyn Fn(f64) -> f64); 6] = [
        ("qd", &|v| v),
        ("|qd|", &f64::abs),
        ("sgn qd", &f64::signum),
        ("qd |qd|", &|v| v * v.abs()),
        ("qd^3", &|v| v * v * v),
        ("sgn qd |qd|^1/2", &|v| v.signum() * v.abs().sqrt()),
    ];
    all.extend(of_rates.map(|(text, of)| (format!("{text}_{name}"), of_one(rates, of))));
    all.push((format!("qdd_{name}"), accelerations.clone()));
    all.push((format!("load_{name}"), load.to_vec()));
    let with_sign: &dyn Fn(f64, f64) -> f64 = &|a, v| a * v.signum();
    all.push((format!("|load| sgn qd_{name}"), product(load, rates, &|a, v| a.abs() * v.signum())));
    all.push((format!("q sgn qd_{name}"), product(q, rates, with_sign)));
    all.push((format!("q qd_{name}"), product(q, rates, &|a, v| a * v)));
    all.push(("t".to_owned(), signals.t.clone()));
    all.push((format!("t sgn qd_{name}"), product(&signals.t, rates, with_sign)));
    for other in (0..names.len()).filter(|other| *other != joint.0) {
        let [v, a] = signals.of_drive(JointIndex(other));
        let text = names[other];
        all.push((format!("q_{text}"), signals.q[other].to_vec()));
        all.push((format!("qd_{text}"), v.clone()));
        all.push((format!("qd_{text}^2"), of_one(v, &|v| v * v)));
        all.push((format!("sgn qd_{text}"), of_one(v, &f64::signum)));
        all.push((format!("qd_{name} qd_{text}"), product(rates, v, &|a, b| a * b)));
        all.push((format!("qdd_{text}"), a.clone()));
    }
    all
}
