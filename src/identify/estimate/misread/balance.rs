//! How much of the torques is left under a reading of the columns: of those that the model's own
//! values make of the motion, and of an estimate, whatever its values.

use super::reading::Reading;
use crate::identify::condition::Conditioned;
use crate::identify::estimate::solve::{solve, stacked};
use crate::identify::estimate::triangle::Triangle;
use crate::plants::regression::{
    RegressionEvaluator, RegressionModel, RegressionParameter, RegressionRows,
};

/// Samples that are looked at in all, of robots with many joints, of which there are many readings,
/// fewer; in blocks of so many, and blocks of each log.
const SAMPLES: [usize; 2] = [1024, 4096];
const ALL_READINGS: usize = 600_000;
const BLOCK: usize = 256;
const BLOCKS: usize = 8;

/// Shares below this are alike: rounding, digits of the log.
const LEAST: f64 = 1e-3;

/// The share of each joint's torque that is left, as roots of mean squares; none where none was
/// measured.
pub(super) type Shares = Vec<Option<f64>>;

/// Prefixes of the names of parameters of joints.
const OF_JOINTS: [&str; 4] = ["fv", "fc", "Ia", "off"];

/// The model's own values of phi; what it does not say of joints (friction, rotors, offsets) is
/// taken for 0. None if it does not say all of its bodies.
pub(in crate::identify) fn nominal_values(model: &RegressionModel) -> Option<Vec<f64>> {
    let is_of_joint = |parameter: &RegressionParameter| {
        let owner = |at: usize| model.standard[at].owner.as_ref();
        let mut members = parameter.members.iter();
        members.all(|&(at, _)| owner(at).is_some_and(|(_, prefix)| OF_JOINTS.contains(prefix)))
    };
    let value = |parameter: &RegressionParameter| {
        parameter.value.or_else(|| is_of_joint(parameter).then_some(0.0))
    };
    model.axes.iter().map(value).collect()
}

/// Samples of a log.
struct Window<'a> {
    log: &'a Conditioned,
    first: usize,
    count: usize,
    /// q, qd and qdd of every joint.
    motion: Vec<Vec<f64>>,
}

impl Window<'_> {
    /// The torque of a column, so many samples late.
    fn torque(&self, column: usize, late: isize) -> Option<Vec<f64>> {
        let torque = self.log.torque[column].as_ref()?;
        let range = &self.log.range;
        let at = |place: usize| {
            let there = place.saturating_add_signed(late);
            torque[there.clamp(range.start, range.end - 1)]
        };
        Some(self.log.places(self.first, self.count).map(at).collect())
    }
}

/// Some samples of logs, to be read in one way or another.
pub(super) struct Balance<'a> {
    model: &'a RegressionModel,
    evaluator: RegressionEvaluator,
    windows: Vec<Window<'a>>,
    /// The model's own values of each joint's columns; none if it lacks one.
    own: Option<Vec<Vec<f64>>>,
}

/// What is left under a reading.
pub(super) struct Left {
    /// By the model's own values; none if it lacks one.
    pub(super) own: Option<Shares>,
    /// By an estimate; none if it was not asked for.
    pub(super) fit: Option<Shares>,
}

impl<'a> Balance<'a> {
    pub(super) fn new(model: &'a RegressionModel, logs: &'a [Conditioned]) -> Self {
        let n = model.joints.len();
        let readings = 3 * n * n / 2 + 20 * n + 30;
        let samples = (ALL_READINGS / readings).clamp(SAMPLES[0], SAMPLES[1]);
        let blocks = (samples / BLOCK / logs.len().max(1)).clamp(1, BLOCKS);
        let mut windows = Vec::new();
        for log in logs {
            let samples = log.samples();
            let every = samples.div_ceil(BLOCK * blocks).max(1);
            for first in (0..samples).step_by(BLOCK * every) {
                let count = BLOCK.min(samples - first);
                let mut motion = Vec::new();
                log.motion_at(first, count, &mut motion);
                windows.push(Window { log, first, count, motion });
            }
        }
        let own = |phi: Vec<f64>| {
            let of = |places: &Vec<usize>| places.iter().map(|&at| phi[at]).collect();
            model.pattern().iter().map(of).collect()
        };
        let own = nominal_values(model).map(own);
        Self { model, evaluator: model.evaluator(), windows, own }
    }

    /// What is left under a reading, with an estimate or without.
    pub(super) fn left(&mut self, reading: &Reading, estimates: bool) -> Left {
        let n = self.model.joints.len();
        let (mut missed, mut sizes) = (vec![0.0; n], vec![0.0; n]);
        let mut triangles: Vec<Triangle> =
            self.model.pattern().iter().map(|places| Triangle::new(places.len())).collect();
        let mut rows = RegressionRows::default();
        for window in &self.windows {
            let column = |at: usize| -> Vec<f64> {
                let (from, factor) = reading.positions[at % n];
                let order = at / n;
                let scale = factor * reading.time.powi(-(order as i32));
                window.motion[order * n + from].iter().map(|value| scale * value).collect()
            };
            let motion: Vec<Vec<f64>> = (0..3 * n).map(column).collect();
            let motion: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
            self.evaluator.evaluate(&motion, &mut rows).expect("every joint has its columns");
            for joint in 0..n {
                let (from, factor) = reading.torques[joint];
                let Some(mut target) = window.torque(from, reading.late) else { continue };
                target.iter_mut().for_each(|torque| *torque *= factor);
                sizes[joint] += target.iter().map(|torque| torque * torque).sum::<f64>();
                if let Some(own) = &self.own {
                    let mut computed = vec![0.0; target.len()];
                    rows.torque(joint, &own[joint], &mut computed);
                    let both = target.iter().zip(&computed);
                    missed[joint] += both.map(|(m, t)| (m - t).powi(2)).sum::<f64>();
                }
                if estimates {
                    if let Some(known) = rows.known(joint) {
                        target.iter_mut().zip(known).for_each(|(target, known)| *target -= known);
                    }
                    let columns = (0..rows.width(joint)).map(|place| rows.column(joint, place));
                    let columns: Vec<&[f64]> = columns.chain([target.as_slice()]).collect();
                    triangles[joint].push(&columns);
                }
            }
        }
        let shares = |squares: &[f64]| -> Shares {
            let share =
                |(squares, size): (&f64, &f64)| (*size > 0.0).then(|| (squares / size).sqrt());
            squares.iter().zip(&sizes).map(share).collect()
        };
        Left {
            own: self.own.is_some().then(|| shares(&missed)),
            fit: estimates.then(|| shares(&self.fitted(&triangles, &sizes))),
        }
    }

    /// The squares of each joint's torque that an estimate leaves, each joint weighted by its size.
    fn fitted(&self, triangles: &[Triangle], sizes: &[f64]) -> Vec<f64> {
        let rank = self.model.rank();
        let weight = |size: &f64| if *size > 0.0 { 1.0 / size.sqrt() } else { 0.0 };
        let weights: Vec<f64> = sizes.iter().map(weight).collect();
        let r = stacked(triangles, self.model.pattern(), &weights, &[], rank);
        let phi = solve(&r, &vec![0.0; rank]).phi;
        let of_joint = |(triangle, places): (&Triangle, &Vec<usize>)| {
            let own: Vec<f64> = places.iter().map(|&at| phi[at]).collect();
            triangle.squares(&own)
        };
        triangles.iter().zip(self.model.pattern()).map(of_joint).collect()
    }
}

/// How shares differ, over the joints whose share does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Change {
    /// Geometric mean of after over before; 1 where none differs.
    pub(super) ratio: f64,
    /// Root of mean square before and after.
    pub(super) left: [f64; 2],
    /// The share of joints whose share differs.
    pub(super) joints: f64,
}

/// The least change of a joint's share, as a logarithm, that is one.
const CHANGED: f64 = 0.1;

impl Change {
    pub(super) fn of(before: &Shares, after: &Shares) -> Self {
        let (mut sum, mut count, mut squares) = (0.0, 0, [0.0; 2]);
        let measured = before.iter().flatten().count();
        for (before, after) in before.iter().zip(after) {
            let (Some(before), Some(after)) = (before, after) else { continue };
            let change = (after.max(LEAST) / before.max(LEAST)).ln();
            if change.abs() > CHANGED {
                sum += change;
                count += 1;
                squares[0] += before * before;
                squares[1] += after * after;
            }
        }
        let joints = f64::from(count) / measured.max(1) as f64;
        let count = f64::from(count.max(1));
        Self { joints, ratio: (sum / count).exp(), left: squares.map(|sum| (sum / count).sqrt()) }
    }
}

/// Root of the mean square of shares.
pub(super) fn root_mean_square(shares: &Shares) -> f64 {
    let measured: Vec<f64> = shares.iter().copied().flatten().collect();
    let squares: f64 = measured.iter().map(|share| share * share).sum();
    (squares / measured.len().max(1) as f64).sqrt()
}
