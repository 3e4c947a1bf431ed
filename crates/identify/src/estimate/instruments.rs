//! Instrumental variables: estimates that noise of the motion does not bias.
//!
//! In closed loop the noise of a torque finds its way into the motion, and so into W. Columns Z of
//! a motion without that noise, simulated with a model that is nearly right or taken from the
//! references, are correlated with W and not with it: Z^T W phi = Z^T y (Janot, Vandanjon, Gautier
//! 2014). With [Z | W | y] = Q R the equation is the upper block of R, and no square is formed.

use super::condensed::{Condensed, Rows};
use super::least_squares::Estimate;
use super::rows::BlockMaker;
use crate::error::{Error, ErrorKind};
use crate::policy::instruments::{MOVES, OTHER};
use denavit_measure::condition::Conditioned;
use denavit_numerics::least_squares::Triangle;
use denavit_numerics::{long_run, products};
use denavit_plants::regression::RegressionModel;
use nalgebra::{DMatrix, DVector};
use std::borrow::Cow;

/// Replaces phi and its covariance by those of instruments, joints weighted as they are.
pub(super) fn instrumental(
    model: &RegressionModel,
    rows: Rows<'_>,
    instruments: &[Conditioned],
    found: &mut Estimate,
) -> Result<(), Error> {
    let (logs, _) = rows;
    let fits = |(log, instrument): (&Conditioned, &Conditioned)| {
        log.samples() == instrument.samples() && log.decimation == instrument.decimation
    };
    if logs.len() != instruments.len() || !logs.iter().zip(instruments).all(fits) {
        return Err(unlike());
    }
    for (number, (log, instrument)) in logs.iter().zip(instruments).enumerate() {
        let differ = other_motion(log, instrument);
        if differ > OTHER {
            let percent = (100.0 * differ).min(1e6) as usize;
            let text = format!(
                "instruments must be of the motion of their log, without its noise: in log {} \
                 positions of a joint differ by {percent} % of its variance",
                number + 1
            );
            return Err(Error::new(ErrorKind::Unsuitable, text));
        }
    }
    let condensed = paired(model, rows, instruments);
    let system = System::new(&condensed, &condensed.whole(), &found.weights[..]);
    let solved = system.solve().ok_or_else(unlike)?;
    found.solution.phi = solved;
    found.covariance = system.covariance(&condensed, found).ok_or_else(unlike)?;
    Ok(())
}

fn unlike() -> Error {
    let text = "instruments must be as many logs as there are for training, each with as many \
                samples";
    Error::new(ErrorKind::Unsuitable, text)
}

/// The largest share of a joint's variance by which positions differ from sample to sample.
fn other_motion(log: &Conditioned, instrument: &Conditioned) -> f64 {
    let of_joint = |(q, other): (&Vec<f64>, &Vec<f64>)| {
        let (q, other) = (&q[log.range.clone()], &other[instrument.range.clone()]);
        (products(q, q)[1], q.iter().zip(other).map(|(q, other)| (q - other).powi(2)).sum::<f64>())
    };
    let all: Vec<(f64, f64)> = log.q.iter().zip(&instrument.q).map(of_joint).collect();
    let most = all.iter().map(|(variance, _)| *variance).fold(0.0, f64::max);
    let moving = all.iter().filter(|(variance, _)| *variance > MOVES * most);
    moving.map(|(variance, differ)| differ / variance).fold(0.0, f64::max)
}

/// Rows of Z and W beside each other: columns of Z come first.
fn paired(model: &RegressionModel, rows: Rows<'_>, instruments: &[Conditioned]) -> Condensed {
    let rank = model.rank();
    let beside = |places: &Vec<usize>| places.iter().map(|at| at + rank).collect::<Vec<usize>>();
    let pattern = model.pattern().iter().map(|places| [&places[..], &beside(places)].concat());
    let pattern: Vec<Vec<usize>> = pattern.collect();
    let mut makers: Vec<BlockMaker<'_>> =
        instruments.iter().map(|log| BlockMaker::new(model, log)).collect();
    Condensed::of_rows(model, rows, pattern, 2 * rank, &mut |log, block, joint| {
        let columns = block.with_target(joint)?;
        let other = makers[log.0].at(block.first, block.samples);
        let z = other.columns[joint.0].iter().map(|column| Cow::Owned(column.clone()));
        Some(z.chain(columns.into_iter().map(Cow::Borrowed)).collect())
    })
}

/// R of [Z | W | y], all joints weighted.
struct System {
    rank: usize,
    r: DMatrix<f64>,
}

impl System {
    fn new(condensed: &Condensed, triangles: &[Vec<Triangle>], weights: &[Vec<f64>]) -> Self {
        Self { rank: condensed.rank / 2, r: condensed.system(triangles, weights, &[]) }
    }

    /// Q^T W of the rows that Z spans.
    fn matrix(&self) -> DMatrix<f64> {
        self.r.view((0, self.rank), (self.rank, self.rank)).into_owned()
    }

    fn solve(&self) -> Option<DVector<f64>> {
        let target = self.r.view((0, 2 * self.rank), (self.rank, 1)).column(0).into_owned();
        let phi = self.matrix().lu().solve(&target)?;
        phi.iter().all(|entry| entry.is_finite()).then_some(phi)
    }

    /// The long-run covariance of what parts do to phi: left out, a part p with A_p = Z_p^T W_p
    /// changes it by (A - A_p)^-1 Z_p^T (y - W phi), since the estimate has adapted to it.
    fn covariance(&self, condensed: &Condensed, found: &Estimate) -> Option<DMatrix<f64>> {
        let rank = self.rank;
        let z = self.r.view((0, 0), (rank, rank)).into_owned();
        // Z^T W = R_z^T Q^T W
        let whole = z.transpose() * self.matrix();
        let inverse = whole.clone().try_inverse()?;
        let phi = found.solution.phi.as_slice();
        let count = condensed.parts.len();
        let scores: Vec<DVector<f64>> = (0..count)
            .map(|part| {
                let (triangles, log) =
                    (&condensed.parts[part..=part], condensed.log_of_part[part].0);
                let own = Self::new(condensed, triangles, &found.weights[log..=log]);
                let fitted = |row: usize| {
                    (0..rank).map(|place| own.r[(row, rank + place)] * phi[place]).sum::<f64>()
                };
                let residual =
                    DVector::from_fn(own.r.nrows(), |row, _| own.r[(row, 2 * rank)] - fitted(row));
                let own_z = own.r.columns(0, rank).transpose();
                let score = &own_z * residual;
                let without = &whole - own_z * own.r.columns(rank, rank);
                // what one part alone determines cannot be compared with the others
                without.lu().solve(&score).unwrap_or_else(|| &inverse * score)
            })
            .collect();
        let sum = long_run(&scores, &condensed.log_of_part);
        Some(sum * (count as f64 / (count as f64 - 1.0).max(1.0)))
    }
}
