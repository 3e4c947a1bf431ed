//! Effects together, weighed.

use super::candidate::Candidate;
use super::state::Taken;
use super::weighing::Placed;
use denavit_evidence::{Spectrum, Terms, Weighed};

/// An effect where it is placed, with its terms.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) placed: Placed,
    pub(super) terms: Terms,
}

impl Part {
    /// The factors by which curved parameters go to other values; 0 of all others.
    pub(super) fn steps_to(&self, values: &[f64]) -> Vec<f64> {
        let Placed { values: now, deviations, .. } = &self.placed;
        let all = values.iter().zip(now).zip(deviations).zip(&self.terms.is_curved);
        let step = |(((value, now), deviation), is_curved): (((&f64, &f64), &f64), &bool)| {
            if *is_curved && *deviation > 0.0 { (value - now) / deviation } else { 0.0 }
        };
        all.map(step).collect()
    }
}

/// Effects together, weighed.
#[derive(Clone)]
pub(super) struct Hypothesis {
    pub(super) parts: Vec<Part>,
    pub(super) weighed: Weighed,
    /// Log of evidence and prior odds.
    pub(super) posterior: f64,
    /// The model's own numbers beside which it was weighed, if these are not those of its search.
    pub(super) elsewhere: Option<Vec<f64>>,
}

impl Hypothesis {
    /// Its effects but the one in a place.
    pub(super) fn without(&self, place: usize) -> Vec<Part> {
        [&self.parts[..place], &self.parts[place + 1..]].concat()
    }

    /// The numbers of the effects' candidates.
    pub(super) fn candidates(&self) -> Vec<usize> {
        self.parts.iter().map(|part| part.placed.candidate).collect()
    }

    /// The same in order.
    pub(super) fn names(&self) -> Vec<usize> {
        let mut names = self.candidates();
        names.sort_unstable();
        names
    }

    /// The factors of each part.
    fn factors(&self) -> Vec<&[f64]> {
        self.by_parts(&self.weighed.factors)
    }

    pub(super) fn by_parts<'f>(&self, factors: &'f [f64]) -> Vec<&'f [f64]> {
        let mut rest = factors;
        let of = |part: &Part| {
            let (own, others) = rest.split_at(part.terms.len());
            rest = others;
            own
        };
        self.parts.iter().map(of).collect()
    }

    /// Whether all effects are linearised where they have a shape.
    pub(super) fn is_shaped(&self) -> bool {
        let is_flat = |column: &Spectrum| column.iter().flatten().all(|entry| *entry == 0.0);
        self.parts.iter().all(|part| {
            let all = part.terms.columns.iter().zip(&part.terms.is_curved);
            all.filter(|(_, is_curved)| **is_curved).all(|(column, _)| !is_flat(column))
        })
    }

    /// The spectrum of what an effect does.
    pub(super) fn torque(&self, place: usize) -> Spectrum {
        self.parts[place].terms.torque(self.factors()[place])
    }

    /// The values of an effect's parameters.
    pub(super) fn values(&self, place: usize) -> Vec<f64> {
        let Placed { values, deviations, .. } = &self.parts[place].placed;
        let moved = values.iter().zip(deviations).zip(self.factors()[place]);
        moved.map(|((value, deviation), factor)| value + deviation * factor).collect()
    }

    /// The effects with values of their parameters that they may have.
    pub(super) fn all_taken(&self, candidates: &[Candidate]) -> Vec<Taken> {
        (0..self.parts.len()).map(|place| self.taken(place, candidates)).collect()
    }

    /// An effect with values of its parameters that it may have.
    pub(super) fn taken(&self, place: usize, candidates: &[Candidate]) -> Taken {
        let candidate = self.parts[place].placed.candidate;
        let values = self.values(place).into_iter().zip(candidates[candidate].law.parameters());
        let values = values.map(|(value, one)| value.clamp(one.bounds[0], one.bounds[1]));
        Taken { candidate, values: values.collect() }
    }

    /// The standard deviations of an effect's parameters.
    pub(super) fn deviations(&self, place: usize) -> Vec<f64> {
        let before: usize = self.parts[..place].iter().map(|part| part.terms.len()).sum();
        let of = |(k, deviation): (usize, &f64)| {
            let at = before + k;
            deviation * self.weighed.covariance[(at, at)].max(0.0).sqrt()
        };
        self.parts[place].placed.deviations.iter().enumerate().map(of).collect()
    }
}
