//! References one after the other.

use super::numbers::check_finite;
use super::{Reference, Setpoint};
use crate::error::{Cause, Error};

/// A reference that is followed for some time; its own time starts at 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// How long it is followed \[s\].
    pub duration_s: f64,
    /// What is followed.
    pub reference: Reference,
}

/// Parts one after the other from t = 0; at their limits position and rate may jump.
#[derive(Clone, Debug, PartialEq)]
pub struct Sequence {
    parts: Vec<Part>,
    /// The end of each part.
    ends: Vec<f64>,
    repeat: bool,
}

impl Sequence {
    /// The parts, in order, once or again and again.
    pub fn new(parts: Vec<Part>, repeat: bool) -> Result<Self, Error> {
        if parts.is_empty() {
            return Err(Cause::TooFew { needed: 1, found: 0 }.into());
        }
        let mut end = 0.0;
        let mut ends = Vec::new();
        for part in &parts {
            check_finite(&[part.duration_s])?;
            if part.duration_s <= 0.0 {
                return Err(Cause::NotPositive.into());
            }
            end += part.duration_s;
            ends.push(end);
        }
        Ok(Self { parts, ends, repeat })
    }

    /// The time after which it repeats itself, if it does \[s\].
    pub(super) fn period_s(&self) -> Option<f64> {
        self.repeat.then(|| self.period())
    }

    fn period(&self) -> f64 {
        self.ends[self.ends.len() - 1]
    }

    /// Number of whole periods before a time, and the time since the last of them. A time within
    /// rounding of a limit counts as past it, so that a step that ends there sees the next part.
    fn folded(&self, t_s: f64) -> (f64, f64) {
        let period = self.period();
        if !self.repeat || t_s < 0.0 {
            return (0.0, t_s);
        }
        let rounds = ((t_s + LIMIT_S) / period).floor();
        (rounds, (t_s - rounds * period).max(0.0))
    }

    fn part(&self, inside: f64) -> usize {
        let past = self.ends.partition_point(|end| *end <= inside + LIMIT_S);
        past.min(self.parts.len() - 1)
    }

    pub(super) fn at(&self, t_s: f64) -> Setpoint {
        let (_, inside) = self.folded(t_s);
        let index = self.part(inside);
        let start = if index == 0 { 0.0 } else { self.ends[index - 1] };
        self.parts[index].reference.at((inside - start).max(0.0))
    }

    pub(super) fn next_break(&self, t_s: f64) -> Option<f64> {
        let (rounds, inside) = self.folded(t_s);
        let base = rounds * self.period();
        let index = self.part(inside);
        let start = if index == 0 { 0.0 } else { self.ends[index - 1] };
        let own = self.parts[index].reference.next_break((inside - start).max(0.0));
        let own = own.map(|time| base + start + time);
        let over = !self.repeat && index + 1 == self.parts.len();
        let limit = (!over).then(|| base + self.ends[index]);
        [own, limit].into_iter().flatten().filter(|time| *time > t_s + LIMIT_S).reduce(f64::min)
    }
}

/// Times this close to a limit of a part are at the limit \[s\].
const LIMIT_S: f64 = 1e-12;
