//! Logs that say the same, wholly or in part: one measurement, read twice.

use super::Conditioned;
use crate::policy::overlap::{MOVES, OVERLAP, PART, SAME};
use denavit_numerics::{rms, variance};
use std::ops::Range;

/// Samples that are looked at before all are.
const FIRST: usize = 64;

/// A signal of both logs with what it may differ by.
struct Pair<'a> {
    long: &'a [f64],
    short: &'a [f64],
    most: f64,
}

impl Pair<'_> {
    /// Whether the short one is the long one, so many samples later, at these places of its own.
    fn is_same(&self, shift: isize, places: impl ExactSizeIterator<Item = usize>) -> bool {
        let (mut squares, most) = (0.0, self.most * self.most * places.len() as f64);
        for place in places {
            let there = place.saturating_add_signed(shift);
            squares += (self.long[there] - self.short[place]).powi(2);
            if squares > most {
                return false;
            }
        }
        true
    }
}

impl Conditioned {
    /// Whether much of another log is in this one, measured with the same noise, wherever it
    /// stands: both together say little more than one.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.shares(other, OVERLAP)
    }

    /// Whether any part of another log is in this one, measured with the same noise, wherever it
    /// stands: it does not judge what this one says.
    pub fn shares_a_part(&self, other: &Self) -> bool {
        self.shares(other, PART)
    }

    /// Whether so much of the shorter log is in the longer one.
    fn shares(&self, other: &Self, least: f64) -> bool {
        let is_alike = (self.step_s / other.step_s - 1.0).abs() < 1e-6
            && self.joints() == other.joints()
            && self.laps.is_some() == other.laps.is_some();
        if !is_alike || self.range.is_empty() || other.range.is_empty() {
            return false;
        }
        let is_longer = self.range.len() >= other.range.len();
        let both = Both::new(if is_longer { [self, other] } else { [other, self] }, least);
        both.is_some_and(|both| both.share())
    }
}

/// Two logs: a longer one, and one of which a part may be in it.
struct Both<'a> {
    long: Range<usize>,
    short: Range<usize>,
    positions: Vec<Pair<'a>>,
    torques: Vec<Pair<'a>>,
    /// The fewest samples of the part.
    fewest: usize,
}

impl<'a> Both<'a> {
    /// None if they have no torque in common.
    fn new([long, short]: [&'a Conditioned; 2], least: f64) -> Option<Self> {
        let inner = &short.range;
        let position = |joint: usize| Pair {
            long: &long.q[joint],
            short: &short.q[joint],
            most: SAME * variance(&short.q[joint][inner.clone()]).sqrt() + 1e-12,
        };
        let torque = |joint: usize| {
            let (long, short) = (long.torque[joint].as_ref()?, short.torque[joint].as_ref()?);
            let most = SAME * rms(&short[inner.clone()]) + 1e-12;
            Some(Pair { long, short, most })
        };
        let torques: Vec<Pair<'_>> = (0..short.joints()).filter_map(torque).collect();
        (!torques.is_empty()).then(|| Self {
            long: long.range.clone(),
            short: inner.clone(),
            positions: (0..short.joints()).map(position).collect(),
            torques,
            fewest: (least * inner.len() as f64).ceil().max(1.0) as usize,
        })
    }

    fn share(&self) -> bool {
        // so near each other that one of them is in the part, wherever that is
        let mut anchors = self.short.clone().step_by(self.fewest);
        anchors.any(|anchor| {
            let near = |pair: &Pair<'_>, there: usize| {
                (pair.long[there] - pair.short[anchor]).abs() < 4.0 * pair.most
            };
            self.long.clone().any(|there| {
                self.positions.iter().all(|pair| near(pair, there))
                    && self.are_same(there as isize - anchor as isize)
            })
        })
    }

    /// Whether what both have is the same where the short one begins so many samples later.
    fn are_same(&self, shift: isize) -> bool {
        let first = self.short.start.max(self.long.start.saturating_add_signed(-shift));
        let end = self.short.end.min(self.long.end.saturating_add_signed(-shift));
        let count = end.saturating_sub(first);
        if count < self.fewest {
            return false;
        }
        let both = || self.positions.iter().chain(&self.torques);
        let step = count.div_ceil(FIRST);
        // few places first: where a robot dwells, many rows are near the anchor
        if !both().all(|pair| pair.is_same(shift, (first..end).step_by(step))) {
            return false;
        }
        let inside = |pair: &Pair<'_>| variance(&pair.short[first..end]).sqrt();
        let moves = |pair: &Pair<'_>| inside(pair) * SAME > MOVES * pair.most;
        // all rests look alike
        self.positions.iter().any(moves) && both().all(|pair| pair.is_same(shift, first..end))
    }
}
