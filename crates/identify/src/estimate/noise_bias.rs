//! The bias that noise of the positions makes of least squares, whose columns have it (errors in
//! variables).
//!
//! Of W = Y(x + n) and y = Y(x) phi the estimate is C W^T y, with C = (W^T W)^+, and in the mean
//! phi - C N phi, with N = E[W^T (W - Y(x))]. The noise is made once more, as it comes out of
//! encoders, filter and differences, added to the motion and taken from it: the mean of both has
//! what is of second order in it, which is N, and nothing of first order, which standard errors
//! show.

use super::condensed::{RowFactors, Rows};
use super::least_squares::Estimate;
use super::left_out::{LeftOut, NumberedLog};
use super::rows::{Block, BlockMaker};
use super::validate::validate;
use denavit_measure::condition::{Conditioned, Piece};
use denavit_measure::{JointIndex, LogIndex, SampleIndex};
use denavit_numerics::Random;
use denavit_numerics::least_squares::{Solution, solve};
use denavit_plants::regression::{RegressionJoint, RegressionModel};
use nalgebra::{DMatrix, DVector};

/// Samples of all logs that are looked at, before decimation.
const SAMPLES: usize = 60_000;

/// Samples in a block.
const BLOCK: usize = 512;

/// What the noise begins with: the same log has the same answer.
const SEED: u64 = 1;

/// What noise of the positions makes.
pub(super) struct NoiseBias {
    /// The bias of phi.
    pub(super) bias: DVector<f64>,
    /// The largest share of noise in what W says of a direction of phi, from 0 to 1.
    pub(super) share: f64,
    /// What each log does by itself.
    pub(super) of_logs: Vec<NoiseOfLog>,
}

/// What noise of the positions of one log does.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseOfLog {
    /// Its part of the bias of phi.
    pub bias: DVector<f64>,
    /// The largest share of noise in what this log alone says of a direction of phi, from 0 to 1.
    pub share: f64,
}

/// What noise makes of phi, rows weighted as they are, by factors too, if there are any. `given` is
/// phi of the model's values.
pub(super) fn noise_bias(
    model: &RegressionModel,
    given: &[f64],
    (logs, left_out): Rows<'_>,
    found: &Estimate,
    factors: Option<RowFactors<'_>>,
) -> NoiseBias {
    let mut random = Random::new(SEED);
    let longest = SAMPLES / logs.len();
    let of_log = |(number, log): (usize, &Conditioned)| {
        let (own, weights) =
            (NumberedLog { number: LogIndex(number), log }, &found.weights[number]);
        Noise::of_log(model, own, left_out, weights, longest, factors, &mut random)
    };
    let of_logs: Vec<Noise> = logs.iter().enumerate().map(of_log).collect();
    let all = Noise(of_logs.iter().map(|one| &one.0).sum());
    let solution = &found.solution;
    let bias = all.bias(solution);
    let phi = &solution.phi - &bias;
    let triangles = found.condensed.whole();
    let of_log = |(log, noise): (usize, &Noise)| {
        let (own, weights) = (&triangles[log..=log], &found.weights[log..=log]);
        let bias = noise.lost(solution, &phi);
        if noise.0.amax() == 0.0 {
            // a log whose rows are all left out shows nothing
            let is_empty = triangles[log].iter().all(|one| one.rows() == 0);
            let share = f64::from(u8::from(is_empty));
            return NoiseOfLog { bias, share };
        }
        let own = solve(&found.condensed.system(own, weights, &[]), given);
        NoiseOfLog { bias, share: noise.share(&own) }
    };
    let of_logs = of_logs.iter().enumerate().map(of_log).collect();
    NoiseBias { bias, share: all.share(solution), of_logs }
}

/// The squares that noise of the positions of a log makes of what phi leaves of each joint's
/// torque, of the rows that count.
pub(super) fn noise_squares(
    model: &RegressionModel,
    own: NumberedLog<'_>,
    left_out: &LeftOut,
    phi: &DVector<f64>,
) -> Vec<f64> {
    let log = own.log;
    let mut squares = vec![0.0; model.joints.len()];
    if log.position_noise.iter().all(|noise| *noise == 0.0) {
        return squares;
    }
    let of_joint = |joint: usize| model.of_joint(joint, phi.as_slice());
    let phi: Vec<Vec<f64>> = (0..squares.len()).map(of_joint).collect();
    let mut random = Random::new(SEED);
    with_noise(model, log, SAMPLES, &mut random, |first, block, noisy, of_all| {
        for (joint, sum) in squares.iter_mut().enumerate() {
            let (joint, phi) = (JointIndex(joint), &phi[joint]);
            let Some(clean) = block.residual(joint, phi) else { continue };
            let counts = left_out.counts(own, joint, first, block.samples);
            let counts = counts.unwrap_or_else(|| vec![true; clean.len()]);
            for noisy in noisy.iter().filter_map(|block| block.residual(joint, phi)) {
                let both = noisy.iter().zip(&clean).zip(&counts).filter(|(_, counts)| **counts);
                *sum += 0.5 * of_all * both.map(|((a, b), _)| (a - b).powi(2)).sum::<f64>();
            }
        }
    });
    squares
}

/// How much of each joint's torque in logs noise of their positions makes with phi, root of mean
/// square over root of mean square; 0 where none was measured.
pub(crate) fn noise_of_positions(
    model: &RegressionModel,
    logs: &[&Conditioned],
    phi: &[f64],
) -> Vec<f64> {
    let left = validate(model, phi, logs);
    let phi = DVector::from_column_slice(phi);
    let of_log = |log: &&Conditioned| {
        let all = LeftOut::none(std::slice::from_ref(*log));
        noise_squares(model, NumberedLog { number: LogIndex(0), log }, &all, &phi)
    };
    let noise: Vec<Vec<f64>> = logs.iter().map(of_log).collect();
    let share = |(joint, described): (usize, &RegressionJoint)| {
        let torque = left.joint(&described.name)?.torque_rms;
        let measured = logs.iter().filter(|log| log.torque[joint].is_some());
        let rows: usize = measured.map(|log| log.samples()).sum();
        let noise: f64 = noise.iter().map(|of_log| of_log[joint]).sum();
        (torque > 0.0).then(|| (noise / rows as f64).sqrt() / torque)
    };
    model.joints.iter().enumerate().map(|one| share(one).unwrap_or(0.0)).collect()
}

/// Calls `visit` with blocks of a log, of which so many samples are looked at before decimation:
/// the number of the first sample, the block as it is and with noise of its positions added and
/// subtracted, and how many blocks it stands for.
fn with_noise(
    model: &RegressionModel,
    log: &Conditioned,
    longest: usize,
    random: &mut Random,
    mut visit: impl FnMut(SampleIndex, &Block, [&Block; 2], f64),
) {
    let pieces = log.pieces(longest);
    let seen: usize = pieces.iter().map(|piece| piece.samples).sum();
    let of_all = log.samples() as f64 / seen.max(1) as f64;
    for piece in pieces {
        let Piece { first: SampleIndex(first), samples } = piece;
        let both = log.piece_with_noise(piece, random);
        let mut straight = BlockMaker::new(model, log);
        let mut makers = both.each_ref().map(|piece| BlockMaker::new(model, piece));
        for from in (0..samples).step_by(BLOCK) {
            let count = BLOCK.min(samples - from);
            let sample = SampleIndex(first + from);
            let block = straight.at(sample, count);
            let noisy = makers.each_mut().map(|maker| maker.at(SampleIndex(from), count));
            visit(sample, block, noisy, of_all);
        }
    }
}

/// E[W^T (noise of [W | y])]: N, and beside it what noise does to what is known, which makes less
/// of the target.
struct Noise(DMatrix<f64>);

impl Noise {
    /// That of a log, of which so many samples are looked at before decimation.
    fn of_log(
        model: &RegressionModel,
        own: NumberedLog<'_>,
        left_out: &LeftOut,
        weights: &[f64],
        longest: usize,
        factors: Option<RowFactors<'_>>,
        random: &mut Random,
    ) -> Self {
        let NumberedLog { number, log } = own;
        let rank = model.rank();
        let mut noise = DMatrix::zeros(rank, rank + 1);
        if log.position_noise.iter().all(|noise| *noise == 0.0) {
            return Self(noise);
        }
        with_noise(model, log, longest, random, |first, block, noisy, of_all| {
            let count = block.samples;
            for (joint, weight) in weights.iter().enumerate().filter(|(_, one)| **one > 0.0) {
                let joint = JointIndex(joint);
                let mut squares = vec![weight * weight * of_all; count];
                if let Some(factors) = factors {
                    let factors = factors(number, block, joint);
                    squares.iter_mut().zip(factors).for_each(|(sq, by)| *sq *= by * by);
                }
                let counts = left_out.counts(own, joint, first, count);
                let all = squares.iter_mut().zip(counts.unwrap_or_default());
                all.filter(|(_, counts)| !counts).for_each(|(square, _)| *square = 0.0);
                add(&mut noise, model, joint, block, noisy, &squares);
            }
        });
        Self(noise)
    }

    /// The largest eigenvalue of F^T N F: 0 where no direction is determined, all where noise is
    /// beyond numbers.
    fn share(&self, solution: &Solution) -> f64 {
        let factor = &solution.factor;
        if factor.is_empty() {
            return 0.0;
        }
        let own = factor.tr_mul(&self.0.columns(0, factor.nrows())) * factor;
        let symmetric = (&own + own.transpose()) * 0.5;
        // eigenvalues of what is no number are looked for without end
        if symmetric.iter().any(|entry| !entry.is_finite()) {
            return 1.0;
        }
        symmetric.symmetric_eigenvalues().iter().copied().fold(0.0, f64::max).min(1.0)
    }

    /// C (known - N phi).
    fn lost(&self, solution: &Solution, phi: &DVector<f64>) -> DVector<f64> {
        let rank = self.0.nrows();
        let score = self.0.column(rank) - self.0.columns(0, rank) * phi;
        &solution.factor * solution.factor.tr_mul(&score)
    }

    /// phi^ - phi of phi^ = phi - C (N phi + known): where noise makes most of W, phi^ is a small
    /// part of phi.
    fn bias(&self, solution: &Solution) -> DVector<f64> {
        let rank = self.0.nrows();
        let share = &solution.factor * solution.factor.tr_mul(&self.0.columns(0, rank));
        let left = DMatrix::identity(rank, rank) - share;
        let off = self.lost(solution, &solution.phi);
        left.lu().solve(&off).unwrap_or(off)
    }
}

/// Adds the rows of a joint without the noise and with it, added and subtracted, which count as
/// these squares of weights.
fn add(
    sum: &mut DMatrix<f64>,
    model: &RegressionModel,
    joint: JointIndex,
    straight: &Block,
    both: [&Block; 2],
    squares: &[f64],
) {
    let Some(clean) = straight.with_target(joint) else { return };
    let places = &model.pattern()[joint.0];
    for noisy in both.into_iter().filter_map(|block| block.with_target(joint)) {
        for (at, (noise, clean)) in noisy.iter().zip(&clean).enumerate() {
            let place = places.get(at).copied().unwrap_or(model.rank());
            let rows = noise.iter().zip(*clean).zip(squares);
            let change: Vec<f64> =
                rows.map(|((noisy, clean), square)| 0.5 * square * (noisy - clean)).collect();
            for (&row, column) in places.iter().zip(&noisy) {
                let along = column.iter().zip(&change).map(|(a, b)| a * b);
                sum[(row, place)] += along.sum::<f64>();
            }
        }
    }
}
