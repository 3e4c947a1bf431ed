//! Constant errors: zeros of positions, offsets and gains of torques, as parameters beside the
//! others.
//!
//! What a constant does to the torques may be less than their noise, and yet move parameters by
//! many of their errors. An estimate sees it if it is many of its own errors large, and nothing
//! but noise is left with it: else it stands for something that the model lacks.

use super::Misreading;
use crate::estimate::condensed::Condensed;
use crate::estimate::errors::{Errors, Problem};
use crate::estimate::least_squares::Estimate;
use crate::estimate::left_out::LeftOut;
use crate::estimate::rows::{Block, BlockMaker};
use crate::estimate::solve::{Solution, solve};
use crate::estimate::triangle::Triangle;
use crate::estimate::weights::ByLog;
use denavit_measure::condition::{Butterworth, Conditioned, Piece};
use denavit_plants::regression::RegressionModel;
use std::borrow::Cow;

/// Samples of all logs that are looked at, before decimation.
const SAMPLES: usize = 40_000;

/// Standard errors by which a constant is surely not 0.
const SURE: f64 = 5.0;

/// Constants that are found, at most.
const MOST: usize = 3;

/// The largest zero that is told, half a turn [rad, m]: torques that hardly depend on a position,
/// as that of a vertical axis, would have any.
const LARGEST_ZERO: f64 = std::f64::consts::PI;

/// Half the difference of positions that a slope is found with [rad, m].
const STEP: f64 = 1e-3;

/// How much what is left may still be like itself so many periods of the filter's cutoff later,
/// after which noise is another one.
const ALIKE: f64 = 0.3;
const PERIODS: f64 = 2.0;

/// A share of a direction that counts for nothing.
const NOTHING: f64 = 1e-6;

/// The share of a constant's column, as root of mean square, that no other columns make, at least:
/// what is less hangs on how a filter smears the sign of a rate.
const OWN: f64 = 0.01;

/// Times that gains are found anew, beside the parameters that follow from them, and the change of
/// a gain that is none.
const ROUNDS: usize = 8;
const SETTLED: f64 = 2e-3;

/// The least gain that is told.
const LEAST_GAIN: f64 = 0.01;

/// The constant errors that an estimate sees, each with its size in standard errors.
pub(super) fn constant_errors(
    model: &RegressionModel,
    logs: &[Conditioned],
    found: &Estimate,
) -> Vec<(Misreading, f64)> {
    let (mut pieces, left_out, log_of_piece) = pieces(logs, &found.left_out);
    let weights = found.condensed.reciprocal(&found.noise, &found.condensed.whole());
    let weights: ByLog = log_of_piece.iter().map(|&log| weights[log].clone()).collect();
    let mut phi = found.solution.phi.as_slice().to_vec();
    // a gain is to first order beside the parameters as they were: it is taken out, and again
    let mut gains: Vec<Gain> = Vec::new();
    for _ in 0..ROUNDS {
        let mut columns = Columns::new(model, &pieces, &phi);
        let rows = (&pieces[..], &left_out);
        let extended = Extended::new(model, rows, (weights.clone(), &mut columns));
        let (chosen, sizes) = extended.chosen(&columns.lines);
        if chosen.is_empty() && gains.is_empty() {
            return Vec::new();
        }
        let (_, solution, _) = extended.solved(&chosen);
        phi = solution.phi.as_slice()[..model.rank()].to_vec();
        let all = chosen.iter().map(|&line| columns.lines[line]).zip(sizes);
        let all: Vec<(Line, Size)> = all.collect();
        let gain = all.iter().find_map(|(line, size)| match *line {
            Line::Gain(joint) if size.value.abs() > SETTLED => Some((joint, *size)),
            _ => None,
        });
        let Some((joint, size)) = gain else {
            let size = |line: &Line| {
                let own = all.iter().find(|(one, _)| one == line);
                own.map_or(0.0, |(_, size)| size.value)
            };
            let sizes: Vec<f64> = columns.lines.iter().map(size).collect();
            if !columns.is_noise(rows, (&phi, &sizes)) {
                return Vec::new();
            }
            return told(&gains, &all);
        };
        let factor = 1.0 + size.value;
        if factor <= 0.0 {
            return Vec::new();
        }
        for torque in pieces.iter_mut().filter_map(|piece| piece.torque[joint].as_mut()) {
            torque.iter_mut().for_each(|torque| *torque /= factor);
        }
        match gains.iter_mut().find(|one| one.joint == joint) {
            Some(one) => one.factor *= factor,
            None => gains.push(Gain { joint, factor, of_error: size.of_error() }),
        }
    }
    Vec::new() // no gain settles
}

/// The factor that a joint's torque seems to be too large by, and its first size in errors.
struct Gain {
    joint: usize,
    factor: f64,
    of_error: f64,
}

fn told(gains: &[Gain], constants: &[(Line, Size)]) -> Vec<(Misreading, f64)> {
    let large = gains.iter().filter(|gain| (gain.factor - 1.0).abs() > LEAST_GAIN);
    let gains =
        large.map(|gain| (Misreading::TorqueGain(gain.joint, 1.0 / gain.factor), gain.of_error));
    let of = |(line, size): &(Line, Size)| match *line {
        Line::Zero(joint) => Some((Misreading::Zero(joint, size.value), size.of_error())),
        // what is to be added is what is too little
        Line::Offset(joint) => {
            Some((Misreading::TorqueOffset(joint, -size.value), size.of_error()))
        }
        Line::Gain(_) => None,
    };
    gains.chain(constants.iter().filter_map(of)).collect()
}

/// Pieces all along the logs, as logs, with the rows of them that do not count, and their logs.
fn pieces(logs: &[Conditioned], left_out: &LeftOut) -> (Vec<Conditioned>, LeftOut, Vec<usize>) {
    let most = SAMPLES / logs.len();
    let of = |(number, log): (usize, &Conditioned)| -> Vec<(usize, Piece)> {
        log.pieces(most).into_iter().map(|piece| (number, piece)).collect()
    };
    let all: Vec<(usize, Piece)> = logs.iter().enumerate().flat_map(of).collect();
    let pieces = all.iter().map(|&(number, piece)| logs[number].piece(piece)).collect();
    let log_of_piece = all.iter().map(|(number, _)| *number).collect();
    (pieces, left_out.of_pieces(logs, &all), log_of_piece)
}

/// A constant that may be off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Line {
    Zero(usize),
    Offset(usize),
    /// A torque that is scaled.
    Gain(usize),
}

/// A constant and its standard error.
#[derive(Clone, Copy, Debug)]
struct Size {
    value: f64,
    std: f64,
}

impl Size {
    fn of_error(self) -> f64 {
        if self.std > 0.0 { self.value / self.std } else { 0.0 }
    }
}

/// The columns of constants beside those of a regressor.
struct Columns<'a> {
    model: &'a RegressionModel,
    lines: Vec<Line>,
    /// phi by joint.
    own: Vec<Vec<f64>>,
    /// For each piece and zero the piece with the position above and below.
    shifted: Vec<Vec<[Shifted; 2]>>,
}

/// A piece with other positions, and its last block.
struct Shifted {
    log: Conditioned,
    first: Option<usize>,
    block: Block,
}

impl<'a> Columns<'a> {
    fn new(model: &'a RegressionModel, pieces: &[Conditioned], phi: &[f64]) -> Self {
        let joints = (0..model.joints.len()).filter(|&joint| !model.joints[joint].is_base);
        let moves = |joint: &usize| pieces.iter().any(|log| log.resting.get(*joint) != Some(&true));
        let is_measured = |joint: &usize| pieces.iter().any(|log| log.torque[*joint].is_some());
        let zeros: Vec<usize> = joints.clone().filter(moves).collect();
        let shifted = |log: &Conditioned| {
            let by = |joint: usize, step: f64| {
                let mut log = log.clone();
                log.q[joint].iter_mut().for_each(|q| *q += step);
                Shifted { log, first: None, block: Block::default() }
            };
            zeros.iter().map(|&joint| [STEP, -STEP].map(|step| by(joint, step))).collect()
        };
        let of_joint = |places: &Vec<usize>| places.iter().map(|&at| phi[at]).collect();
        let offsets = joints.clone().filter(is_measured).map(Line::Offset);
        // the gain of the only torque is that of all parameters
        let measured = (0..model.joints.len()).filter(is_measured).count();
        let gains = joints.filter(is_measured).filter(|_| measured > 1).map(Line::Gain);
        let zeros_of = zeros.iter().map(|&joint| Line::Zero(joint));
        Self {
            model,
            lines: zeros_of.chain(offsets).chain(gains).collect(),
            own: model.pattern().iter().map(of_joint).collect(),
            shifted: pieces.iter().map(shifted).collect(),
        }
    }

    /// One column for each line, of the rows of a joint in a block of a piece.
    fn of(&mut self, piece: usize, block: &Block, joint: usize) -> Vec<Vec<f64>> {
        let mut columns = Vec::with_capacity(self.lines.len());
        for both in &mut self.shifted[piece] {
            let left = both.each_mut().map(|one| {
                if one.first != Some(block.first) {
                    let mut maker = BlockMaker::new(self.model, &one.log);
                    one.block = maker.at(block.first, block.samples).clone();
                    one.first = Some(block.first);
                }
                one.block.residual(joint, &self.own[joint]).unwrap_or_default()
            });
            let slope = |(above, below): (&f64, &f64)| (below - above) / (2.0 * STEP);
            columns.push(left[0].iter().zip(&left[1]).map(slope).collect());
        }
        for line in &self.lines[columns.len()..] {
            columns.push(match *line {
                Line::Offset(own) if own == joint => vec![1.0; block.samples],
                Line::Gain(own) if own == joint => self.torque(block, joint),
                _ => vec![0.0; block.samples],
            });
        }
        columns
    }

    /// The torque of a joint as phi makes it.
    fn torque(&self, block: &Block, joint: usize) -> Vec<f64> {
        let mut torque = vec![0.0; block.samples];
        for (column, phi) in block.columns[joint].iter().zip(&self.own[joint]) {
            torque.iter_mut().zip(column).for_each(|(sum, entry)| *sum += phi * entry);
        }
        torque
    }

    /// Whether what is left with phi and constants of these sizes is noise of all joints.
    fn is_noise(
        &mut self,
        (pieces, left_out): (&[Conditioned], &LeftOut),
        (phi, sizes): (&[f64], &[f64]),
    ) -> bool {
        let n = self.own.len();
        let mut sums = vec![[0.0; 4]; n];
        for (number, log) in pieces.iter().enumerate() {
            let cutoff = log.filter.as_ref().map_or(0.5, Butterworth::cutoff);
            let lag = (PERIODS / (cutoff * log.decimation.max(1) as f64)).ceil() as usize;
            BlockMaker::new(self.model, log).for_each(|block| {
                for (joint, sums) in sums.iter_mut().enumerate() {
                    let own: Vec<f64> =
                        self.model.pattern()[joint].iter().map(|&at| phi[at]).collect();
                    let Some(mut left) = block.residual(joint, &own) else { continue };
                    for (column, size) in self.of(number, block, joint).iter().zip(sizes) {
                        left.iter_mut().zip(column).for_each(|(left, by)| *left -= size * by);
                    }
                    let range = (block.first, block.samples);
                    let counts = left_out.counts((number, log), joint, range);
                    let counts = |at: usize| counts.as_ref().is_none_or(|counts| counts[at]);
                    for at in (0..left.len()).filter(|&at| counts(at)) {
                        sums[0] += left[at] * left[at];
                        sums[1] += 1.0;
                        if at >= lag && counts(at - lag) {
                            sums[2] += left[at] * left[at - lag];
                            sums[3] += 1.0;
                        }
                    }
                }
            });
        }
        let is_noise =
            |[squares, rows, lagged, pairs]: &[f64; 4]| lagged * rows < ALIKE * squares * pairs;
        sums.iter().filter(|sums| sums[3] > 0.0).all(is_noise)
    }
}

/// Logs condensed with the columns of all constants.
struct Extended {
    condensed: Condensed,
    weights: ByLog,
    /// Columns of the regressor of each joint, and of phi.
    own: Vec<Vec<usize>>,
    rank: usize,
}

impl Extended {
    fn new(
        model: &RegressionModel,
        rows: (&[Conditioned], &LeftOut),
        (weights, columns): (ByLog, &mut Columns<'_>),
    ) -> Self {
        let (own, rank) = (model.pattern().to_vec(), model.rank());
        let count = columns.lines.len();
        let with = |places: &Vec<usize>| places.iter().copied().chain(rank..rank + count).collect();
        let pattern = own.iter().map(with).collect();
        let mut of = |piece: usize, block: &Block, joint: usize| -> Option<Vec<Vec<f64>>> {
            block.torque[joint].as_ref()?;
            Some(columns.of(piece, block, joint))
        };
        let condensed =
            Condensed::of_rows(model, rows, (pattern, rank + count), &mut |piece, block, joint| {
                let mut all: Vec<Cow<'_, [f64]>> =
                    block.with_target(joint)?.into_iter().map(Cow::Borrowed).collect();
                let target = all.pop()?;
                all.extend(of(piece, block, joint)?.into_iter().map(Cow::Owned));
                all.push(target);
                Some(all)
            });
        Self { condensed, weights, own, rank }
    }

    /// The same with some of the constants alone.
    fn with(&self, chosen: &[usize]) -> Condensed {
        let of_joint = |joint: usize, triangle: &Triangle| {
            let width = self.own[joint].len();
            let constants = chosen.iter().map(|line| width + line);
            triangle.with_columns(&(0..width).chain(constants).collect::<Vec<_>>())
        };
        let rank = self.rank + chosen.len();
        let with =
            |places: &Vec<usize>| places.iter().copied().chain(self.rank..rank).collect::<Vec<_>>();
        let of_part = |part: &Vec<Triangle>| {
            part.iter().enumerate().map(|(joint, one)| of_joint(joint, one)).collect()
        };
        Condensed {
            pattern: self.own.iter().map(with).collect(),
            parts: self.condensed.parts.iter().map(of_part).collect(),
            log_of_part: self.condensed.log_of_part.clone(),
            end_s: self.condensed.end_s.clone(),
            independent: self.condensed.independent.clone(),
            row_s: self.condensed.row_s.clone(),
            rank,
        }
    }

    /// The constants that are surely not 0, one after the other beside those before, and their
    /// sizes.
    fn chosen(&self, lines: &[Line]) -> (Vec<usize>, Vec<Size>) {
        let (mut chosen, mut sizes): (Vec<usize>, Vec<Size>) = Default::default();
        while chosen.len() < MOST {
            let with = |line: usize| [&chosen[..], &[line]].concat();
            let seen = |line: usize| {
                let own = self.sizes(&with(line), Errors::Classical)?[chosen.len()];
                let is_zero = matches!(lines[line], Line::Zero(_));
                let is_any = is_zero && own.value.abs() > LARGEST_ZERO;
                (!is_any).then_some((line, own.of_error().abs()))
            };
            let others = (0..lines.len()).filter(|line| !chosen.contains(line));
            let surest = others.filter_map(seen).max_by(|a, b| a.1.total_cmp(&b.1));
            let next = surest.map_or_else(Vec::new, |(line, _)| with(line));
            let own = self.sizes(&next, Errors::Correlated).unwrap_or_default();
            if own.last().is_none_or(|last| last.of_error().abs() < SURE) {
                break;
            }
            (chosen, sizes) = (next, own);
        }
        (chosen, sizes)
    }

    /// phi with the constants that are chosen behind it, and the lengths of all columns.
    fn solved(&self, chosen: &[usize]) -> (Condensed, Solution, Vec<f64>) {
        let condensed = self.with(chosen);
        let (rank, triangles) = (condensed.rank, condensed.whole());
        let r = condensed.system(&triangles, &self.weights, &[]);
        let lengths = r.column_iter().map(|column| column.norm()).collect();
        (condensed, solve(&r, &vec![0.0; rank]), lengths)
    }

    /// The constants that are chosen; none if the others make up for one of them.
    fn sizes(&self, chosen: &[usize], errors: Errors) -> Option<Vec<Size>> {
        let (condensed, solution, lengths) = self.solved(chosen);
        let (condensed, solution, weights) = (&condensed, &solution, &self.weights[..]);
        let problem = Problem { condensed, weights, prior: &[], solution };
        let covariance = problem.covariance(errors);
        let of = |at: usize| {
            let [dead, alive] = [&solution.dead, &solution.factor].map(|one| one.row(at).norm());
            let std = covariance[(at, at)].max(0.0).sqrt();
            let is_seen =
                alive > 0.0 && dead <= NOTHING * alive && alive * lengths[at] * OWN <= 1.0;
            is_seen.then_some(Size { value: solution.phi[at], std })
        };
        (self.rank..condensed.rank).map(of).collect()
    }
}
