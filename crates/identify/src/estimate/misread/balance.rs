//! How much of the torques is left under a reading of the columns: of those that the model's own
//! values make of the motion, and of an estimate, whatever its values.

use super::reading::Reading;
use super::window::Window;
use crate::estimate::rows::{Coulomb, coulomb};
use crate::estimate::solve::{solve, stacked};
use crate::estimate::triangle::Triangle;
use denavit_measure::condition::Conditioned;
use denavit_plants::regression::{
    RegressionEvaluator, RegressionModel, RegressionParameter, RegressionRows,
};
use nalgebra::DMatrix;

/// Samples that are looked at in all, of robots with many joints, of which there are many readings,
/// fewer; in blocks of so many, and blocks of each log.
const SAMPLES: [usize; 2] = [1024, 4096];
const ALL_READINGS: usize = 600_000;
const BLOCK: usize = 256;
const BLOCKS: usize = 8;

/// Shares below this are alike: rounding, digits of the log.
pub(super) const LEAST: f64 = 1e-3;

/// The share of each joint's torque that is left, as roots of mean squares; none where none was
/// measured.
pub(super) type Shares = Vec<Option<f64>>;

/// The model's own values of phi; what it does not say of joints (friction, rotors, offsets) is
/// taken for 0. None if it does not say all of its bodies.
pub(crate) fn nominal_values(model: &RegressionModel) -> Option<Vec<f64>> {
    let is_of_joint = |parameter: &RegressionParameter| {
        parameter.members.iter().all(|&(at, _)| model.standard[at].is_of_joint())
    };
    let value = |parameter: &RegressionParameter| {
        parameter.value.or_else(|| is_of_joint(parameter).then_some(0.0))
    };
    model.axes.iter().map(value).collect()
}

/// Some samples of logs, to be read in one way or another.
pub(super) struct Balance<'a> {
    model: &'a RegressionModel,
    evaluator: RegressionEvaluator,
    rows: RegressionRows,
    windows: Vec<Window<'a>>,
    /// Columns that jump with the rate: they pass the filter of the torque.
    coulomb: Vec<Coulomb>,
    /// Values of each joint's columns that need no estimate: those of the model, or of an estimate
    /// from other logs; none if one is missing.
    own: Option<Vec<Vec<f64>>>,
}

/// What is left under a reading.
pub(super) struct Left {
    /// By values that are given; none if there are none.
    pub(super) own: Option<Shares>,
    /// By an estimate; none if it was not asked for.
    pub(super) fit: Option<Fitted>,
}

/// What an estimate finds, and leaves.
pub(super) struct Fitted {
    pub(super) phi: Vec<f64>,
    pub(super) left: Shares,
}

impl<'a> Balance<'a> {
    /// Of logs, whose signals are read up to so many samples late, with values of phi that need no
    /// estimate.
    pub(super) fn new(
        model: &'a RegressionModel,
        (logs, latest): (&[&'a Conditioned], isize),
        own: Option<&[f64]>,
    ) -> Self {
        let n = model.joints.len();
        let readings = 3 * n * n / 2 + 20 * n + 30;
        let samples = (ALL_READINGS / readings).clamp(SAMPLES[0], SAMPLES[1]);
        let blocks = (samples / BLOCK / logs.len().max(1)).clamp(1, BLOCKS);
        let mut windows = Vec::new();
        for &log in logs {
            let samples = log.samples();
            let every = samples.div_ceil(BLOCK * blocks).max(1);
            for first in (0..samples).step_by(BLOCK * every) {
                let count = BLOCK.min(samples - first);
                windows.push(Window::new(log, [first, count], latest));
            }
        }
        let own = own.map(|phi| of_joints(model, phi));
        let (mut evaluator, rows) = (model.evaluator(), RegressionRows::default());
        let coulomb = coulomb(model, &mut evaluator);
        Self { model, evaluator, rows, windows, coulomb, own }
    }

    /// Samples of each torque that are looked at and independent of each other.
    pub(super) fn independent(&self) -> f64 {
        self.windows.iter().map(Window::independent).sum()
    }

    /// Whether a joint moves in some of the logs.
    pub(super) fn moves(&self, joint: usize) -> bool {
        self.windows.iter().any(|window| window.log().resting.get(joint) != Some(&true))
    }

    /// Makes the rows of a window under a reading.
    fn read(&mut self, window: usize, reading: &Reading) {
        let n = self.model.joints.len();
        let window = &mut self.windows[window];
        let column = |at: usize| window.motion(&reading.positions[at % n], at / n, reading.time);
        let motion: Vec<Vec<f64>> = (0..3 * n).map(column).collect();
        let motion: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
        self.evaluator.evaluate(&motion, &mut self.rows).expect("every joint has its columns");
        for one in &self.coulomb {
            let law = window.law(&reading.positions[one.joint], reading.time, self.model.law);
            let column = self.rows.column_mut(one.joint, one.place).iter_mut();
            column.zip(law).for_each(|(entry, law)| *entry = one.factor * law);
        }
    }

    /// The torque that was measured of a joint, and what values leave of it, of the rows that were
    /// made last.
    fn residual(
        &self,
        (window, reading): (usize, &Reading),
        (joint, values): (usize, &[f64]),
    ) -> Option<[Vec<f64>; 2]> {
        let measured = self.windows[window].torque(&reading.torques[joint])?;
        let mut left = vec![0.0; measured.len()];
        self.rows.torque(joint, values, &mut left);
        left.iter_mut().zip(&measured).for_each(|(left, measured)| *left = measured - *left);
        Some([measured, left])
    }

    /// What is left under a reading, with an estimate or without.
    pub(super) fn left(&mut self, reading: &Reading, estimates: bool) -> Left {
        let n = self.model.joints.len();
        let (mut missed, mut sizes) = (vec![0.0; n], vec![0.0; n]);
        let none: Vec<Vec<f64>> =
            self.model.pattern().iter().map(|places| vec![0.0; places.len()]).collect();
        let own = self.own.clone();
        let mut triangles: Vec<Triangle> =
            self.model.pattern().iter().map(|places| Triangle::new(places.len())).collect();
        let square = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
        for window in 0..self.windows.len() {
            self.read(window, reading);
            for joint in 0..n {
                let values = own.as_ref().unwrap_or(&none)[joint].as_slice();
                let here = (window, reading);
                let Some([measured, left]) = self.residual(here, (joint, values)) else { continue };
                sizes[joint] += square(&measured);
                missed[joint] += square(&left);
                if estimates {
                    let mut target = measured;
                    if let Some(known) = self.rows.known(joint) {
                        target.iter_mut().zip(known).for_each(|(target, known)| *target -= known);
                    }
                    let places = 0..self.rows.width(joint);
                    let columns = places.map(|place| self.rows.column(joint, place));
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
        let fit = estimates.then(|| {
            let phi = self.fitted(&triangles, &sizes);
            let of_joints = triangles.iter().zip(of_joints(self.model, &phi));
            let squares: Vec<f64> =
                of_joints.map(|(triangle, own)| triangle.squares(&own)).collect();
            Fitted { phi, left: shares(&squares) }
        });
        Left { own: self.own.is_some().then(|| shares(&missed)), fit }
    }

    /// An estimate with each joint weighted by the size of its torque.
    fn fitted(&self, triangles: &[Triangle], sizes: &[f64]) -> Vec<f64> {
        let rank = self.model.rank();
        let weight = |size: &f64| if *size > 0.0 { 1.0 / size.sqrt() } else { 0.0 };
        let weights: Vec<f64> = sizes.iter().map(weight).collect();
        let r = stacked(&[(triangles, &weights)], self.model.pattern(), &[], rank);
        solve(&r, &vec![0.0; rank]).phi.as_slice().to_vec()
    }

    /// Of each line of readings, given by two of them on either side of `reading`, the share of
    /// the squares that an estimate leaves which a step along it would explain, to first order,
    /// the parameters following; 0 if they follow all the way, so that nothing is seen of it. Each
    /// joint counts alike.
    pub(super) fn explained(
        &mut self,
        (reading, found): (&Reading, &Fitted),
        lines: &[[Reading; 2]],
    ) -> Vec<f64> {
        let (n, rank) = (self.model.joints.len(), self.model.rank());
        if rank == 0 || lines.is_empty() {
            return vec![0.0; lines.len()];
        }
        let values = of_joints(self.model, &found.phi);
        let pattern: Vec<Vec<usize>> = self.model.pattern().to_vec();
        let width = |joint: usize| pattern[joint].len() + lines.len();
        let mut triangles: Vec<Triangle> =
            (0..n).map(|joint| Triangle::new(width(joint))).collect();
        for window in 0..self.windows.len() {
            let mut slopes: Vec<Vec<Vec<f64>>> = vec![Vec::new(); n];
            for line in lines {
                let [plus, minus] = line.each_ref().map(|one| {
                    self.read(window, one);
                    let of = |joint: usize| self.residual((window, one), (joint, &values[joint]));
                    (0..n).map(|joint| of(joint).map(|[_, left]| left)).collect::<Vec<_>>()
                });
                for (slopes, both) in slopes.iter_mut().zip(plus.into_iter().zip(minus)) {
                    let (Some(mut slope), Some(minus)) = both else { continue };
                    slope.iter_mut().zip(minus).for_each(|(plus, minus)| *plus -= minus);
                    slopes.push(slope);
                }
            }
            self.read(window, reading);
            for joint in 0..n {
                let of = self.residual((window, reading), (joint, &values[joint]));
                let Some([_, left]) = of else { continue };
                let own = (0..pattern[joint].len()).map(|place| self.rows.column(joint, place));
                let slopes = slopes[joint].iter().map(Vec::as_slice);
                let columns: Vec<&[f64]> = own.chain(slopes).chain([left.as_slice()]).collect();
                triangles[joint].push(&columns);
            }
        }
        let weight = |(triangle, share): (&Triangle, &Option<f64>)| {
            let size = triangle.squares(&vec![0.0; triangle.width()]).sqrt();
            // rounding counts for nothing
            let counts = (share.unwrap_or(0.0) / LEAST).min(1.0);
            if size > 0.0 { counts / size } else { 0.0 }
        };
        let weights: Vec<f64> = triangles.iter().zip(&found.left).map(weight).collect();
        let places = |own: &Vec<usize>| -> Vec<usize> {
            own.iter().copied().chain(rank..rank + lines.len()).collect()
        };
        let pattern: Vec<Vec<usize>> = pattern.iter().map(places).collect();
        let r = stacked(&[(&triangles, &weights)], &pattern, &[], rank + lines.len());
        explained(&r, rank)
    }
}

/// phi by joint, in the order of its columns.
fn of_joints(model: &RegressionModel, phi: &[f64]) -> Vec<Vec<f64>> {
    let of = |places: &Vec<usize>| places.iter().map(|&at| phi[at]).collect();
    model.pattern().iter().map(of).collect()
}

/// A column that the others make up but for this share of its square is none of its own, and one
/// that is shorter than this share of the longest has no direction.
const ALIAS: f64 = 1e-6;
const NOTHING: f64 = 1e-9;

/// Of R of [W | L | e] for each column of L the share of what is left of e beside W that it
/// explains, taken alone.
fn explained(r: &DMatrix<f64>, rank: usize) -> Vec<f64> {
    let last = r.ncols() - 1;
    let mut w = r.columns(0, rank).into_owned();
    let longest = w.column_iter().map(|column| column.norm()).fold(0.0, f64::max);
    for mut column in w.column_iter_mut() {
        let length = column.norm();
        column /= if length > NOTHING * longest { length } else { f64::INFINITY };
    }
    let svd = w.svd(true, false);
    let u = svd.u.expect("it was asked for");
    let largest = svd.singular_values.max();
    let sigma = svd.singular_values.iter().enumerate();
    let kept: Vec<usize> =
        sigma.filter(|(_, sigma)| **sigma > NOTHING * largest).map(|(at, _)| at).collect();
    let u = u.select_columns(&kept);
    let beside = |at: usize| {
        let column = r.column(at).into_owned();
        let along = u.tr_mul(&column);
        &column - &u * along
    };
    let left = beside(last);
    let of = |at: usize| {
        let (all, own) = (r.column(at).norm_squared(), beside(at));
        let (size, both) = (own.norm_squared(), own.dot(&left));
        let share = both * both / (size * left.norm_squared());
        if size > ALIAS * all && share.is_finite() { share } else { 0.0 }
    };
    (rank..last).map(of).collect()
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
    /// The least and the largest ratio of a joint.
    pub(super) ratios: [f64; 2],
}

/// The least change of a joint's share, as a logarithm, that is one.
const CHANGED: f64 = 0.1;

impl Change {
    pub(super) fn of(before: &Shares, after: &Shares) -> Self {
        let (mut sum, mut count, mut squares) = (0.0, 0, [0.0; 2]);
        let mut ratios: [f64; 2] = [1.0; 2];
        let measured = before.iter().flatten().count();
        for (before, after) in before.iter().zip(after) {
            let (Some(before), Some(after)) = (before, after) else { continue };
            let change = (after.max(LEAST) / before.max(LEAST)).ln();
            ratios = [ratios[0].min(change.exp()), ratios[1].max(change.exp())];
            if change.abs() > CHANGED {
                sum += change;
                count += 1;
                squares[0] += before * before;
                squares[1] += after * after;
            }
        }
        let joints = f64::from(count) / measured.max(1) as f64;
        let count = f64::from(count.max(1));
        let left = squares.map(|sum| (sum / count).sqrt());
        Self { joints, ratio: (sum / count).exp(), left, ratios }
    }
}

/// Root of the mean square of shares.
pub(super) fn root_mean_square(shares: &Shares) -> f64 {
    let measured: Vec<f64> = shares.iter().copied().flatten().collect();
    let squares: f64 = measured.iter().map(|share| share * share).sum();
    (squares / measured.len().max(1) as f64).sqrt()
}
