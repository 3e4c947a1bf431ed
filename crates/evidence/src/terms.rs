//! What one effect adds to a model, near some values of its parameters.

use crate::filtered::Filtered;
use crate::layout::Spectrum;
use crate::unpredicted::Unpredicted;

/// A known part and columns whose factors are unknown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Terms {
    /// What the effect does with all factors 0.
    pub known: Spectrum,
    /// For each parameter what a factor of 1 adds: one deviation of what is believed of it.
    pub columns: Vec<Spectrum>,
    /// For each factor the lowest value that it may have; minus infinity of one that is free.
    pub lowest: Vec<f64>,
    /// For each factor whether the effect is not linear in it, so that it is right near 0 alone.
    pub is_curved: Vec<bool>,
    /// For each factor what it would be by what is believed alone: columns begin at the values
    /// where the effect was linearised.
    pub believed: Vec<f64>,
    /// What the effect says nothing of.
    pub unpredicted: Unpredicted,
    /// The channels that the effect filters.
    pub filtered: Vec<Filtered>,
}

impl Terms {
    /// Columns whose factors may be anything.
    pub fn free(columns: Vec<Spectrum>) -> Self {
        let count = columns.len();
        let (lowest, believed) = (vec![f64::NEG_INFINITY; count], vec![0.0; count]);
        Self { columns, lowest, is_curved: vec![false; count], believed, ..Self::default() }
    }

    /// Number of factors.
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// Whether nothing is unknown.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// These terms and others, as those of one effect. Rows that either says nothing of are left
    /// out of account.
    pub fn beside(&self, other: &Self) -> Self {
        let mut both = self.clone();
        both.known.resize(both.known.len().max(other.known.len()), Vec::new());
        for (sum, own) in both.known.iter_mut().zip(&other.known) {
            sum.resize(sum.len().max(own.len()), 0.0);
            sum.iter_mut().zip(own).for_each(|(sum, entry)| *sum += entry);
        }
        both.columns.extend(other.columns.iter().cloned());
        both.lowest.extend(&other.lowest);
        both.is_curved.extend(&other.is_curved);
        both.believed.extend(&other.believed);
        both.filtered.extend(other.filtered.iter().cloned());
        both
    }

    /// The terms without the columns that are curved.
    pub(crate) fn linear(&self) -> Self {
        let places = (0..self.len()).filter(|&k| !self.is_curved[k]);
        let mut linear = Self {
            known: self.known.clone(),
            unpredicted: self.unpredicted.clone(),
            filtered: self.filtered.clone(),
            ..Self::default()
        };
        for k in places {
            linear.columns.push(self.columns[k].clone());
            linear.lowest.push(self.lowest[k]);
            linear.is_curved.push(false);
            linear.believed.push(self.believed[k]);
        }
        linear
    }

    /// What the effect does with factors.
    pub fn torque(&self, factors: &[f64]) -> Spectrum {
        let mut sum = self.known.clone();
        for (column, factor) in self.columns.iter().zip(factors) {
            sum.resize(sum.len().max(column.len()), Vec::new());
            for (sum, column) in sum.iter_mut().zip(column) {
                sum.resize(sum.len().max(column.len()), 0.0);
                sum.iter_mut().zip(column).for_each(|(sum, entry)| *sum += factor * entry);
            }
        }
        sum
    }

    /// Whether the effect acts on a channel.
    pub(crate) fn touches(&self, channel: usize) -> bool {
        let acts = |spectrum: &Spectrum| spectrum.get(channel).is_some_and(|one| !one.is_empty());
        acts(&self.known) || self.columns.iter().any(acts)
    }
}
