//! Pieces of a log: enough of a long one to see what is alike all along it.

use super::{Conditioned, Decimator, STENCIL};
use crate::SampleIndex;

/// Pieces of a log that is too long to be looked at as a whole.
const PIECES: usize = 12;

/// Samples that are left after decimation and follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    /// The first.
    pub first: SampleIndex,
    /// Their number.
    pub samples: usize,
}

impl Conditioned {
    /// Pieces all along a log with at most so many samples before decimation, or the whole.
    pub fn pieces(&self, most: usize) -> Vec<Piece> {
        let (samples, most) = (self.samples(), most / self.decimation.max(1));
        let length = most / PIECES;
        if samples <= most.max(PIECES) || length == 0 {
            return vec![Piece { first: SampleIndex(0), samples }];
        }
        let first = |piece: usize| SampleIndex(piece * (samples - length) / (PIECES - 1));
        (0..PIECES).map(|piece| Piece { first: first(piece), samples: length }).collect()
    }

    /// A piece as a log of its own, whose sample 0 is the piece's first one.
    pub fn piece(&self, Piece { first, samples }: Piece) -> Self {
        let edge = self.range.start;
        let start = first.0 * self.decimation;
        let inner = 2 * Decimator::reach_of(self.decimation) + (samples - 1) * self.decimation + 1;
        let end = (start + edge + inner + edge).min(self.q[0].len());
        let part = |column: &Vec<f64>| column[start..end].to_vec();
        let parts = |columns: &[Vec<f64>]| columns.iter().map(part).collect::<Vec<_>>();
        Self {
            file: self.file.clone(),
            start_s: self.start_s + self.step_s * start as f64,
            step_s: self.step_s,
            q: parts(&self.q),
            rates: self.rates.as_ref().map(|both| both.each_ref().map(|all| parts(all))),
            torque: self.torque.iter().map(|torque| torque.as_ref().map(part)).collect(),
            range: edge..edge + inner,
            decimation: self.decimation,
            filter: self.filter.clone(),
            resting: self.resting.clone(),
            position_noise: self.position_noise.clone(),
            encoders: self.encoders.clone(),
            laps: self.laps,
        }
    }

    /// A piece without more of its edges than a filter of half the cutoff leaves, as it is and
    /// after that filter; none if that leaves nothing.
    pub fn halved(&self, piece: Piece) -> Option<[Self; 2]> {
        let lower = self.filter.as_ref()?.halved()?;
        let mut own = self.piece(piece);
        let edge = lower.settling() + if own.rates.is_some() { 0 } else { STENCIL };
        own.range = edge..own.q[0].len().checked_sub(edge).filter(|end| *end > edge)?;
        if own.samples() == 0 {
            return None;
        }
        let mut halved = own.clone();
        let rates = halved.rates.iter_mut().flatten().flatten();
        let torques = halved.torque.iter_mut().flatten();
        for column in halved.q.iter_mut().chain(rates).chain(torques) {
            lower.zero_phase(column);
        }
        halved.filter = Some(lower);
        Some([own, halved])
    }
}
