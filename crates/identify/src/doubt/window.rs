//! Samples of a log under a reading of its columns.

use super::policy::SIGNED as LEAST;
use super::reading::Source;
use denavit_measure::condition::Conditioned;
use denavit_measure::{JointIndex, SampleIndex};
use denavit_plants::regression::CoulombLaw;
use std::ops::Range;

/// Samples of a log.
pub(super) struct Window<'a> {
    log: &'a Conditioned,
    first: SampleIndex,
    count: usize,
    /// q, qd and qdd of every joint.
    motion: Vec<Vec<f64>>,
    /// The places that are read, with those that are late.
    span: Range<usize>,
    /// Coulomb friction of size 1 of some joints.
    laws: Vec<Law>,
    /// For each joint whether samples count; none where all do.
    counts: Vec<Option<Vec<bool>>>,
}

/// Whether samples of a joint in [`Conditioned::range`] count: those in which the sign of its rate
/// is known, and its friction with it. None where all do, or too few would.
pub(super) fn with_sign(log: &Conditioned, joint: JointIndex) -> Option<Vec<bool>> {
    let both = [log.near_reversals(joint, 1.0), log.unsure_signs(joint)];
    let mut counts = vec![true; log.range.len()];
    for unsure in both.iter().flatten() {
        counts.iter_mut().zip(unsure).for_each(|(counts, unsure)| *counts &= !unsure);
    }
    let kept = counts.iter().filter(|counts| **counts).count() as f64;
    (kept < counts.len() as f64 && kept > LEAST * counts.len() as f64).then_some(counts)
}

/// Coulomb friction of size 1, at the places that are read.
struct Law {
    /// The column of the position.
    column: usize,
    /// By which its rate is multiplied.
    scale: f64,
    values: Vec<f64>,
}

impl<'a> Window<'a> {
    /// So many samples of a log, from one on, that are read up to `latest` samples late; for each
    /// joint those of the log that count.
    pub(super) fn new(
        log: &'a Conditioned,
        all: &[Option<Vec<bool>>],
        first: SampleIndex,
        count: usize,
        latest: isize,
    ) -> Self {
        let mut motion = Vec::new();
        log.motion_at(first, count, &mut motion);
        let (laws, counts) = (Vec::new(), Vec::new());
        let mut window = Self { log, first, count, motion, span: 0..0, laws, counts };
        let counts = |all: &Option<Vec<bool>>| -> Option<Vec<bool>> {
            let all = all.as_ref()?;
            Some(window.places(0).map(|place| all[place - log.range.start]).collect())
        };
        window.counts = all.iter().map(counts).collect();
        let last = window.places(latest).last().unwrap_or(log.range.start);
        let first = window.places(-latest).next().unwrap_or(last);
        window.span = first..last + 1;
        window
    }

    pub(super) fn log(&self) -> &'a Conditioned {
        self.log
    }

    /// Whether samples of a joint count; none where all do.
    pub(super) fn counts(&self, joint: JointIndex) -> Option<&[bool]> {
        self.counts[joint.0].as_deref()
    }

    /// Samples that are independent of each other.
    pub(super) fn independent(&self) -> f64 {
        self.log.independent() * self.count as f64 / self.log.samples() as f64
    }

    /// Its places, so many samples later.
    fn places(&self, late: isize) -> impl Iterator<Item = usize> {
        let (first, last) = (self.log.range.start, self.log.range.end - 1);
        let places = self.log.places(self.first, self.count);
        places.map(move |place| place.saturating_add_signed(late).clamp(first, last))
    }

    pub(super) fn torque(&self, source: &Source) -> Option<Vec<f64>> {
        let torque = self.log.torque[source.column].as_ref()?;
        let at = |place: usize| source.factor * torque[place] + source.offset;
        Some(self.places(source.late).map(at).collect())
    }

    /// A position, its rate or its acceleration.
    pub(super) fn motion(&self, source: &Source, order: usize, time: f64) -> Vec<f64> {
        let scale = source.factor * time.powi(-(order as i32));
        let offset = if order == 0 { source.offset } else { 0.0 };
        if source.late == 0 {
            let column = &self.motion[order * self.log.joints() + source.column];
            return column.iter().map(|value| scale * value + offset).collect();
        }
        let at =
            |place: usize| scale * self.log.moved(JointIndex(source.column), order, place) + offset;
        self.places(source.late).map(at).collect()
    }

    /// Coulomb friction of size 1, as the filter of the torque leaves it: where joints turn round,
    /// what it smears over is more of a torque than a mistake leaves that is to be told.
    pub(super) fn law(&mut self, source: &Source, time: f64, law: CoulombLaw) -> Vec<f64> {
        let (column, factor) = (source.column, source.factor / time);
        // of signs the size of the rate says nothing
        let scale = if law == CoulombLaw::Sign { 1.0 } else { factor.abs() };
        let is_known = |one: &Law| one.column == column && one.scale == scale;
        let known = self.laws.iter().position(is_known).unwrap_or_else(|| {
            let of_rate = |rate: f64| law.of(scale * rate);
            let values = self.log.of_rate(JointIndex(column), self.span.clone(), of_rate);
            self.laws.push(Law { column, scale, values });
            self.laws.len() - 1
        });
        let values = &self.laws[known].values;
        let places = self.places(source.late);
        places.map(|place| factor.signum() * values[place - self.span.start]).collect()
    }
}
