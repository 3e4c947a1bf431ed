//! Joints whose columns seem to be exchanged, where neither rates nor references show it: the
//! torques that the model's own values make of the motion fit those of the log far better when
//! positions, torques, or both of two joints change places.

use crate::identify::condition::Conditioned;
use crate::plants::regression::{RegressionEvaluator, RegressionModel, RegressionRows};
use std::fmt;

/// Samples of each log that are looked at, in so many blocks.
const BLOCK: usize = 512;
const BLOCKS: usize = 4;

/// Less than this share of the torques (roots of mean squares, as all here) is not for exchanged
/// columns.
const SMALL: f64 = 0.05;

/// What is left must fall to this share of what was left before.
const BETTER: f64 = 0.5;

/// And to this share of the torques.
const LEFT: f64 = 0.63;

/// Which columns of two joints seem to be exchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExchangedColumns {
    /// Their positions.
    Positions,
    /// Their torques.
    Torques,
    /// Both: one joint has the name of the other.
    Both,
}

/// Two joints whose columns seem to be exchanged.
#[derive(Clone, Debug, PartialEq)]
pub struct ExchangedJoints {
    /// Their names.
    pub joints: [String; 2],
    /// What is exchanged.
    pub columns: ExchangedColumns,
    /// The share of the torques, as roots of mean squares, that the model's values leave, as the
    /// log is and with the columns exchanged.
    pub left: [f64; 2],
}

impl fmt::Display for ExchangedJoints {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { joints: [a, b], columns, left } = self;
        let what = match columns {
            ExchangedColumns::Positions => "the positions",
            ExchangedColumns::Torques => "the torques",
            ExchangedColumns::Both => "positions and torques",
        };
        write!(
            f,
            "{what} of {a} and {b} seem to be exchanged: the model's own values leave {:.0} % of \
             the torques, and {:.0} % the other way round",
            100.0 * left[0],
            100.0 * left[1]
        )
    }
}

/// Samples of a log.
pub(super) struct Window {
    /// q, qd and qdd of every joint.
    pub(super) motion: Vec<Vec<f64>>,
    pub(super) torque: Vec<Option<Vec<f64>>>,
}

/// Some windows of each log.
pub(super) fn windows(logs: &[Conditioned]) -> Vec<Window> {
    let mut all = Vec::new();
    for log in logs {
        let samples = log.samples();
        let every = samples.div_ceil(BLOCK * BLOCKS).max(1);
        for first in (0..samples).step_by(BLOCK * every) {
            let count = BLOCK.min(samples - first);
            let mut motion = Vec::new();
            log.motion_at(first, count, &mut motion);
            let places = log.places(first, count);
            let taken = |torque: &Vec<f64>| places.clone().map(|place| torque[place]).collect();
            let torque = log.torque.iter().map(|torque| torque.as_ref().map(taken)).collect();
            all.push(Window { motion, torque });
        }
    }
    all
}

/// The squares of what each joint's torque differs by from each other's, for the joints that are
/// compared: misses\[joint of the model\]\[joint of the log\].
struct Balance<'a> {
    model: &'a RegressionModel,
    evaluator: RegressionEvaluator,
    windows: Vec<Window>,
    /// The model's values of each joint's columns.
    own: Vec<Vec<f64>>,
    /// Sum of squares of each joint's torque; 0 where none was measured.
    sizes: Vec<f64>,
}

impl Balance<'_> {
    /// Sums of squares of measured torques of joint `from[j]` less the computed ones of joint j,
    /// with the positions of two joints exchanged.
    fn misses(&mut self, exchanged: Option<[usize; 2]>, from: &[usize]) -> Vec<f64> {
        let n = self.model.joints.len();
        let mut sums = vec![0.0; n];
        let mut rows = RegressionRows::default();
        for window in &self.windows {
            let mut columns: Vec<&[f64]> = window.motion.iter().map(Vec::as_slice).collect();
            if let Some([a, b]) = exchanged {
                (0..3).for_each(|order| columns.swap(order * n + a, order * n + b));
            }
            self.evaluator.evaluate(&columns, &mut rows).expect("every joint has its columns");
            for (joint, sum) in sums.iter_mut().enumerate() {
                let Some(measured) = &window.torque[from[joint]] else { continue };
                let mut torque = vec![0.0; measured.len()];
                rows.torque(joint, &self.own[joint], &mut torque);
                *sum += measured.iter().zip(&torque).map(|(m, t)| (m - t).powi(2)).sum::<f64>();
            }
        }
        sums
    }

    /// The shares that are left before and after an exchange of two joints. Torques of others are
    /// looked at only where positions change.
    fn left(&mut self, [a, b]: [usize; 2], columns: ExchangedColumns) -> [f64; 2] {
        use ExchangedColumns::{Positions, Torques};
        let n = self.sizes.len();
        let straight: Vec<usize> = (0..n).collect();
        let mut crossed = straight.clone();
        crossed.swap(a, b);
        let positions = (columns != Torques).then_some([a, b]);
        let from = if columns == Positions { &straight } else { &crossed };
        let both = [self.misses(None, &straight), self.misses(positions, from)];
        let pair = 0.5 * (self.sizes[a] + self.sizes[b]);
        let is_looked_at = |joint: &usize| {
            self.sizes[*joint] > 0.0 && (columns != Torques || [a, b].contains(joint))
        };
        let joints: Vec<usize> = (0..n).filter(is_looked_at).collect();
        let share = |misses: &[f64]| {
            let of_joint = |joint: &usize| {
                let size = if [a, b].contains(joint) { pair } else { self.sizes[*joint] };
                misses[*joint] / size
            };
            (joints.iter().map(of_joint).sum::<f64>() / joints.len().max(1) as f64).sqrt()
        };
        [share(&both[0]), share(&both[1])]
    }
}

/// The two joints whose exchange makes the model's values fit the torques best, if that is far
/// better than as the logs are; none if the model lacks a value.
pub fn exchanged_joints(model: &RegressionModel, logs: &[Conditioned]) -> Option<ExchangedJoints> {
    let phi = model.model_axes()?;
    let own = |places: &Vec<usize>| places.iter().map(|&at| phi[at]).collect();
    let windows = windows(logs);
    let squares = |joint: usize| {
        let torques = windows.iter().filter_map(|window| window.torque[joint].as_ref());
        torques.flatten().map(|torque| torque * torque).sum::<f64>()
    };
    let mut balance = Balance {
        model,
        evaluator: model.evaluator(),
        own: model.pattern().iter().map(own).collect(),
        sizes: (0..model.joints.len()).map(squares).collect(),
        windows,
    };
    let mut best: Option<ExchangedJoints> = None;
    for b in 0..model.joints.len() {
        for a in 0..b {
            let pair = [&model.joints[a], &model.joints[b]];
            let is_alike = pair[0].slides == pair[1].slides;
            if !is_alike || pair.iter().any(|joint| joint.is_base) {
                continue;
            }
            if balance.sizes[a] == 0.0 || balance.sizes[b] == 0.0 {
                continue;
            }
            use ExchangedColumns::{Both, Positions, Torques};
            for columns in [Positions, Torques, Both] {
                let left @ [before, after] = balance.left([a, b], columns);
                let is_better = before > SMALL && after < LEFT.min(BETTER * before);
                if is_better && best.as_ref().is_none_or(|best| after < best.left[1]) {
                    let joints = pair.map(|joint| joint.name.clone());
                    best = Some(ExchangedJoints { joints, columns, left });
                }
            }
        }
    }
    best
}
