//! What one effect adds to a model, near some values of its parameters.

use crate::layout::Spectrum;

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
    /// The share of the rows of which the effect says nothing but that the data are as they are.
    pub unpredicted: f64,
}

impl Terms {
    /// Number of factors.
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// Whether nothing is unknown.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// The terms without the columns that are curved.
    pub(crate) fn linear(&self) -> Self {
        let places = (0..self.len()).filter(|&k| !self.is_curved[k]);
        let (known, unpredicted) = (self.known.clone(), self.unpredicted);
        let mut linear = Self { known, unpredicted, ..Self::default() };
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
