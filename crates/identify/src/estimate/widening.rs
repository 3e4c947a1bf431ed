//! How many rows near reversals are left out: more and more, until friction does not change.
//!
//! How wide the range of rates is in which friction is not its sign depends on the robot: a steep
//! line, stiction, creeping. Where the range that is left out is too small, friction changes with
//! the range by more than chance; the smallest that agrees with one of twice the rate is taken
//! (after Lepski 1990).

use super::errors::Errors;
use super::least_squares::{Estimate, Fit};
use super::left_out::{LeftOut, SlowRows, biased_frictions};
use crate::error::Error;
use crate::policy::widening::{LEAST, SURE};
use denavit_measure::JointIndex;
use denavit_measure::condition::Conditioned;
use denavit_plants::regression::RegressionModel;
use nalgebra::DMatrix;

/// Doublings of the rate below which rows are left out.
const MOST_DOUBLINGS: u32 = 5;

/// An estimate with the covariance that is compared.
struct Fitted {
    found: Estimate,
    covariance: DMatrix<f64>,
    left_out: LeftOut,
}

impl Fit<'_> {
    /// Least squares of the rows that count, with those that do not.
    pub(super) fn counted(
        &self,
        model: &RegressionModel,
        logs: &[Conditioned],
    ) -> Result<(Estimate, LeftOut), Error> {
        let mut fitted = self.fitted(model, logs, LeftOut::asked(model, logs, self.options))?;
        let mut tried = vec![false; model.joints.len()];
        if self.options.slow != SlowRows::Biasing {
            return Ok((fitted.found, fitted.left_out));
        }
        // without the bias of one friction errors are smaller, which may show that of another
        loop {
            let (phi, covariance) = (&fitted.found.solution.phi, &fitted.covariance);
            let biased = biased_frictions(model, logs, phi, covariance).into_iter();
            let joints = biased.map(|(joint, _)| joint).filter(|&joint| !tried[joint.0]);
            let joints: Vec<JointIndex> = joints.collect();
            if joints.is_empty() {
                return Ok((fitted.found, fitted.left_out));
            }
            joints.iter().for_each(|&joint| tried[joint.0] = true);
            fitted = self.widened(model, logs, fitted, joints);
        }
    }

    fn fitted(
        &self,
        model: &RegressionModel,
        logs: &[Conditioned],
        left_out: LeftOut,
    ) -> Result<Fitted, Error> {
        let found = self.plain(model, (logs, &left_out))?;
        let covariance = self.problem(&found).covariance(Errors::Correlated);
        Ok(Fitted { found, covariance, left_out })
    }

    /// Without rows near reversals of joints, as many as it takes.
    fn widened(
        &self,
        model: &RegressionModel,
        logs: &[Conditioned],
        mut fitted: Fitted,
        mut joints: Vec<JointIndex>,
    ) -> Fitted {
        for doublings in 0..=MOST_DOUBLINGS {
            let times = f64::from(1 << doublings);
            let mut left_out = fitted.left_out.clone();
            joints.retain(|&joint| left_out.widen(logs, joint, times));
            if joints.is_empty() {
                break;
            }
            let Ok(next) = self.fitted(model, logs, left_out) else { break };
            if next.found.solution.excited() < fitted.found.solution.excited() {
                break;
            }
            if doublings > 0 {
                joints.retain(|&joint| has_moved(model, joint, [&fitted, &next]));
                if joints.is_empty() {
                    break;
                }
            }
            fitted = next;
        }
        fitted
    }
}

/// Whether Coulomb friction of a joint changes by more than chance as more rows are left out.
fn has_moved(model: &RegressionModel, joint: JointIndex, [before, after]: [&Fitted; 2]) -> bool {
    let friction = model.coulomb().iter().find(|(of, _)| *of == joint.0);
    friction.is_some_and(|&(_, place)| {
        let at = model.pattern()[joint.0][place];
        let of = |one: &Fitted| (one.found.solution.phi[at], one.covariance[(at, at)].max(0.0));
        let ((value, variance), (other, larger)) = (of(before), of(after));
        let of_change = (larger - variance).max(LEAST * variance);
        (other - value).abs() > SURE * of_change.sqrt()
    })
}
