//! Units that nothing but the model shows: time that runs ten times too fast, torques in mN m. The
//! model's own values make of the motion what is in the log when the unit is another one.

use super::exchanged::{Window, windows};
use crate::identify::condition::Conditioned;
use crate::plants::regression::{RegressionEvaluator, RegressionModel, RegressionRows};
use std::fmt;

/// Factors that are tried.
const FACTORS: [f64; 6] = [1e-3, 1e-2, 0.1, 10.0, 100.0, 1e3];

/// What is left must fall to this share of what was left before, and to less than this share of
/// the squares of torques.
const BETTER: f64 = 0.25;
const LEFT: f64 = 0.4;

/// A unit that seems to be another one.
#[derive(Clone, Debug, PartialEq)]
pub struct MistakenUnits {
    /// Whether it is that of the time; else that of all torques.
    pub of_time: bool,
    /// What the columns are to be multiplied with.
    pub factor: f64,
    /// The share of the squares of torques that the model's values leave, as the logs are and with
    /// the factor.
    pub left: [f64; 2],
}

impl fmt::Display for MistakenUnits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { of_time, factor, left: [before, after] } = self;
        let (what, column) = match of_time {
            true => ("the time", "t"),
            false => ("torques", "tau_JOINT"),
        };
        write!(
            f,
            "{what} seem{} to be in another unit: of the squares of torques the model's own values \
             leave {:.0} %, and {:.0} % with {factor} times {what}\n  hint: --columns with \
             {{\"{column}\": {{\"scale\": {factor}}}}} mends that",
            if *of_time { "s" } else { "" },
            100.0 * before,
            100.0 * after
        )
    }
}

/// The unit with which the model's values make far more of the torques, if there is one; none if
/// the model lacks a value.
pub fn mistaken_units(model: &RegressionModel, logs: &[Conditioned]) -> Option<MistakenUnits> {
    let phi = model.model_axes()?;
    let own = |places: &Vec<usize>| places.iter().map(|&at| phi[at]).collect();
    let mut balance = Balance {
        evaluator: model.evaluator(),
        own: model.pattern().iter().map(own).collect(),
        windows: windows(logs),
    };
    let before = balance.left(1.0, 1.0);
    let mut best: Option<MistakenUnits> = None;
    for factor in FACTORS {
        for of_time in [true, false] {
            let [time, torque] = if of_time { [factor, 1.0] } else { [1.0, factor] };
            let after = balance.left(time, torque);
            let is_better = after < LEFT.min(BETTER * before);
            if is_better && best.as_ref().is_none_or(|best| after < best.left[1]) {
                best = Some(MistakenUnits { of_time, factor, left: [before, after] });
            }
        }
    }
    best
}

struct Balance {
    evaluator: RegressionEvaluator,
    /// The model's values of each joint's columns.
    own: Vec<Vec<f64>>,
    windows: Vec<Window>,
}

impl Balance {
    /// The mean over joints of the share of squares of its torque that is left, with the time and
    /// all torques multiplied.
    fn left(&mut self, time: f64, factor: f64) -> f64 {
        let n = self.own.len();
        let (mut missed, mut sizes) = (vec![0.0; n], vec![0.0; n]);
        let mut rows = RegressionRows::default();
        for Window { motion, torque } in &self.windows {
            let scaled = |(at, column): (usize, &Vec<f64>)| -> Vec<f64> {
                let scale = time.powi(-((at / n) as i32));
                column.iter().map(|value| scale * value).collect()
            };
            let motion: Vec<Vec<f64>> = motion.iter().enumerate().map(scaled).collect();
            let motion: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
            self.evaluator.evaluate(&motion, &mut rows).expect("every joint has its columns");
            for joint in 0..n {
                let Some(measured) = &torque[joint] else { continue };
                let mut computed = vec![0.0; measured.len()];
                rows.torque(joint, &self.own[joint], &mut computed);
                for (measured, computed) in measured.iter().zip(&computed) {
                    missed[joint] += (factor * measured - computed).powi(2);
                    sizes[joint] += (factor * measured).powi(2);
                }
            }
        }
        let shares = missed.iter().zip(&sizes).filter(|(_, size)| **size > 0.0);
        let shares: Vec<f64> = shares.map(|(missed, size)| missed / size).collect();
        shares.iter().sum::<f64>() / shares.len().max(1) as f64
    }
}
