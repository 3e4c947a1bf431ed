//! Weights that outliers lose (iteratively reweighted least squares; Huber 1964, Beaton and Tukey
//! 1974).

use super::rows::BlockMaker;
use crate::identify::condition::Conditioned;
use crate::plants::regression::RegressionModel;

/// Residuals that a scale is found from, at most.
const SCALE_SAMPLES: usize = 40_000;

/// How residuals lose weight as they grow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// Beyond 1.345 deviations they count by their size, not its square.
    Huber,
    /// Beyond 4.685 deviations they do not count.
    Bisquare,
}

impl Loss {
    /// The factor of both sides of a row whose residual is so many deviations.
    pub(super) fn factor(self, deviations: f64) -> f64 {
        let size = deviations.abs();
        match self {
            Self::Huber if size <= 1.345 => 1.0,
            Self::Huber => (1.345 / size).sqrt(),
            Self::Bisquare if size < 4.685 => 1.0 - (size / 4.685).powi(2),
            Self::Bisquare => 0.0,
        }
    }
}

/// The deviation of each joint's residuals, by their median, which outliers do not move; `sizes`
/// are the largest numbers that rounding leaves.
pub(super) fn scales(model: &RegressionModel, logs: &[Conditioned], phi: &[f64]) -> Vec<f64> {
    let samples: usize = logs.iter().map(Conditioned::samples).sum();
    let stride = samples.div_ceil(SCALE_SAMPLES).max(1);
    let mut found: Vec<Vec<f64>> = vec![Vec::new(); model.joints.len()];
    for log in logs {
        BlockMaker::new(model, log).for_each(|block| {
            for (joint, sizes) in found.iter_mut().enumerate() {
                let own: Vec<f64> = model.pattern()[joint].iter().map(|&at| phi[at]).collect();
                let residual = block.residual(joint, &own).unwrap_or_default();
                let offset = (stride - block.first % stride) % stride;
                sizes.extend(residual.iter().skip(offset).step_by(stride).map(|r| r.abs()));
            }
        });
    }
    let deviation = |mut sizes: Vec<f64>| {
        if sizes.is_empty() {
            return 0.0;
        }
        let middle = sizes.len() / 2;
        1.4826 * *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    found.into_iter().map(deviation).collect()
}
