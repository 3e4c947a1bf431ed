//! Logs that say the same, wholly or in part: one measurement, read twice.

use super::Conditioned;
use crate::policy::overlap::{MOVES, OVERLAP, SAME};

/// Samples that are looked at before all are.
const FIRST: usize = 64;

/// A signal of both logs with what it may differ by.
struct Pair<'a> {
    one: &'a [f64],
    other: &'a [f64],
    most: f64,
}

impl Pair<'_> {
    /// Whether the second is the first, so many samples later, at these places of the second.
    fn is_same(&self, shift: isize, places: impl Iterator<Item = usize>) -> bool {
        let (mut squares, mut count) = (0.0, 0.0);
        for place in places {
            let there = place.saturating_add_signed(shift);
            squares += (self.one[there] - self.other[place]).powi(2);
            count += 1.0;
        }
        squares <= self.most * self.most * count
    }
}

fn rms_about_mean(values: &[f64]) -> f64 {
    rms(values, values.iter().sum::<f64>() / values.len().max(1) as f64)
}

fn rms(values: &[f64], mean: f64) -> f64 {
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / values.len().max(1) as f64).sqrt()
}

impl Conditioned {
    /// Whether a part of another log is a part of this one, measured with the same noise, wherever
    /// it stands.
    pub fn overlaps(&self, other: &Self) -> bool {
        let is_alike = (self.step_s / other.step_s - 1.0).abs() < 1e-6
            && self.joints() == other.joints()
            && self.laps.is_some() == other.laps.is_some();
        if !is_alike || self.range.is_empty() || other.range.is_empty() {
            return false;
        }
        let inner = &other.range;
        let position = |joint: usize| {
            let own = &other.q[joint][inner.clone()];
            Pair {
                one: &self.q[joint],
                other: &other.q[joint],
                most: SAME * rms_about_mean(own) + 1e-12,
            }
        };
        let torque = |joint: usize| {
            let (one, other) = (self.torque[joint].as_ref()?, other.torque[joint].as_ref()?);
            let most = SAME * rms(&other[inner.clone()], 0.0) + 1e-12;
            Some(Pair { one, other, most })
        };
        let positions: Vec<Pair<'_>> = (0..self.joints()).map(position).collect();
        let torques: Vec<Pair<'_>> = (0..self.joints()).filter_map(torque).collect();
        if torques.is_empty() {
            return false;
        }
        let shortest = self.range.len().min(inner.len()) as f64;
        // a third and two thirds of the way: one of them is in what both have, if that is enough
        [1, 2].into_iter().any(|third| {
            let anchor = inner.start + third * inner.len() / 3;
            self.range.clone().any(|there| {
                let shift = there as isize - anchor as isize;
                let near = |pair: &Pair<'_>| {
                    (pair.one[there] - pair.other[anchor]).abs() < 4.0 * pair.most
                };
                if !positions.iter().all(near) {
                    return false;
                }
                let first = inner.start.max(self.range.start.saturating_add_signed(-shift));
                let end = inner.end.min(self.range.end.saturating_add_signed(-shift));
                let count = end.saturating_sub(first);
                if (count as f64) < OVERLAP * shortest {
                    return false;
                }
                let both = || positions.iter().chain(&torques);
                let step = count.div_ceil(FIRST);
                // few places first: where a robot dwells, many rows are near the anchor
                if !both().all(|pair| pair.is_same(shift, (first..end).step_by(step))) {
                    return false;
                }
                let inside = |pair: &Pair<'_>| rms_about_mean(&pair.other[first..end]);
                let moves = |pair: &Pair<'_>| inside(pair) * SAME > MOVES * pair.most;
                // all rests look alike
                positions.iter().any(moves) && both().all(|pair| pair.is_same(shift, first..end))
            })
        })
    }
}
