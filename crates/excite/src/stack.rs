//! From motion to the stacked regressor W, and back: from derivatives by the entries of W to
//! derivatives by the motion.

use super::model::{Columns, Evaluators, ExcitedModel};
use crate::policy::stack::SIGN_WIDTH;
use denavit_numerics::Random;
use denavit_runtime::Transcendental;
use nalgebra::DMatrix;

/// How signs of rates are taken: exactly, or as tanh(rate / width), whose derivative is finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Signs {
    Exact,
    Smooth,
}

/// The columns of W, in the columns that are computed.
#[derive(Clone, Debug)]
pub struct Stack {
    /// Names of the columns of W.
    pub names: Vec<String>,
    /// Columns that no motion of the joints that move tells apart from those before them.
    pub left_out: Vec<String>,
    /// Computed columns x columns of W.
    combine: DMatrix<f64>,
    /// Joints whose rows are measured.
    measured: Vec<usize>,
    /// For each joint, the places in its pattern that have the sign of its rate.
    signs: Vec<Vec<usize>>,
}

impl Stack {
    /// The columns that the joints that move can excite.
    pub(super) fn new(model: &ExcitedModel, evaluators: &mut Evaluators) -> Self {
        let regression = &model.regression;
        let rank = regression.rank();
        let (combine, parameters) = match model.columns {
            Columns::Axes => (DMatrix::identity(rank, rank), &regression.axes),
            Columns::Kept => (regression.to_axes().clone(), &regression.listed),
        };
        let joints = 0..model.joints.len();
        let mut stack = Self {
            names: parameters.iter().map(|parameter| parameter.name.clone()).collect(),
            left_out: Vec::new(),
            combine,
            measured: joints.clone().filter(|&joint| model.weights[joint] > 0.0).collect(),
            signs: joints.map(|joint| model.sign_columns(joint)).collect(),
        };
        if stack.measured.is_empty() {
            stack.names.clear();
            return stack;
        }
        let samples = 8 + 3 * rank / stack.measured.len();
        let motion = any_motion(model, samples);
        let columns: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
        let w = stack.w(model, evaluators, &columns, Signs::Exact);
        stack.keep(&independent(&w));
        stack
    }

    fn keep(&mut self, kept: &[usize]) {
        let is_kept = |at: &usize| kept.contains(at);
        let all = 0..self.names.len();
        self.left_out = all.filter(|at| !is_kept(at)).map(|at| self.names[at].clone()).collect();
        self.names = kept.iter().map(|&at| self.names[at].clone()).collect();
        self.combine = self.combine.select_columns(kept);
    }

    /// W of 3 n columns of motion: rows joint by joint, each with its weight.
    pub(super) fn w(
        &self,
        model: &ExcitedModel,
        evaluators: &mut Evaluators,
        motion: &[&[f64]],
        signs: Signs,
    ) -> DMatrix<f64> {
        let Evaluators { regressor, rows, .. } = evaluators;
        regressor.evaluate(motion, rows).expect("the motion has three columns for each joint");
        let (samples, n) = (rows.samples(), model.joints.len());
        let mut y = DMatrix::zeros(self.measured.len() * samples, self.combine.nrows());
        for (block, &joint) in self.measured.iter().enumerate() {
            let weight = model.weights[joint];
            for (place, &phi) in model.regression.pattern()[joint].iter().enumerate() {
                let smooth = signs == Signs::Smooth && self.signs[joint].contains(&place);
                let rates = smooth.then(|| motion[n + joint]);
                for (sample, entry) in rows.column(joint, place).iter().enumerate() {
                    let share = rates.map_or(1.0, |rates| share(model, joint, rates[sample]));
                    y[(block * samples + sample, phi)] = weight * share * entry;
                }
            }
        }
        y * &self.combine
    }

    /// For each sample, <A, dW/dy> along the difference of two motions: A is a matrix like W, the
    /// motions are those a step forth and a step back. What is given is added to `sums`.
    pub(super) fn along(
        &self,
        model: &ExcitedModel,
        evaluators: &mut Evaluators,
        a: &DMatrix<f64>,
        [forth, back]: [&[&[f64]]; 2],
    ) -> Vec<f64> {
        let samples = forth.first().map_or(0, |column| column.len());
        let mut sums = vec![0.0; samples];
        let n = model.joints.len();
        for (motion, sign) in [(forth, 1.0), (back, -1.0)] {
            let Evaluators { regressor, rows, .. } = &mut *evaluators;
            regressor.evaluate(motion, rows).expect("the motion has three columns for each joint");
            for (block, &joint) in self.measured.iter().enumerate() {
                let weight = sign * model.weights[joint];
                for (place, &phi) in model.regression.pattern()[joint].iter().enumerate() {
                    let factors = a.view((block * samples, phi), (samples, 1));
                    let is_sign = self.signs[joint].contains(&place);
                    let rates = is_sign.then(|| motion[n + joint]);
                    let entries = rows.column(joint, place).iter().zip(factors.iter());
                    for (sample, (entry, factor)) in entries.enumerate() {
                        let share = rates.map_or(1.0, |rates| share(model, joint, rates[sample]));
                        sums[sample] += weight * share * factor * entry;
                    }
                }
            }
        }
        sums
    }

    /// A in the columns that are computed.
    pub(super) fn in_computed(&self, a: &DMatrix<f64>) -> DMatrix<f64> {
        a * self.combine.transpose()
    }
}

/// What is left of the size of a sign that is taken smoothly.
pub(super) fn share(model: &ExcitedModel, joint: usize, rate: f64) -> f64 {
    let width = SIGN_WIDTH * model.joints[joint].velocity;
    if width > 0.0 { (rate.abs() / width).hyperbolic_tangent() } else { 1.0 }
}

/// A motion that visits everything within the limits of the joints that move.
fn any_motion(model: &ExcitedModel, samples: usize) -> Vec<Vec<f64>> {
    let mut random = Random::new(0x5eed);
    let mut motion = Vec::new();
    for order in 0..3 {
        for joint in &model.joints {
            let reach = [joint.half(), joint.velocity, joint.acceleration][order];
            let middle = if order == 0 { joint.middle() } else { 0.0 };
            let reach = if joint.held.is_some() { 0.0 } else { reach };
            let column = (0..samples).map(|_| middle + reach * (2.0 * random.uniform() - 1.0));
            motion.push(column.collect());
        }
    }
    motion
}

/// The columns that do not depend on those before them, by orthogonalisation twice.
fn independent(w: &DMatrix<f64>) -> Vec<usize> {
    let mut kept = Vec::new();
    let mut basis: Vec<nalgebra::DVector<f64>> = Vec::new();
    for (at, column) in w.column_iter().enumerate() {
        let length = column.norm();
        let mut rest = column.into_owned();
        for _ in 0..2 {
            for direction in &basis {
                let along = direction.dot(&rest);
                rest.axpy(-along, direction, 1.0);
            }
        }
        if length > 0.0 && rest.norm() > 1e-9 * length {
            basis.push(rest.normalize());
            kept.push(at);
        }
    }
    kept
}
