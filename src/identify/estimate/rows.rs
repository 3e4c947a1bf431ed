//! The rows of a regression, block by block, after both sides went through the same decimator.

use crate::identify::condition::{Conditioned, Decimator};
use crate::plants::regression::{RegressionEvaluator, RegressionModel, RegressionRows};

/// Samples in a block.
const BLOCK: usize = 512;

/// Rows of samples that follow each other.
#[derive(Clone, Debug, Default)]
pub struct Block {
    /// The number of the first sample among those that are left after decimation.
    pub first: usize,
    /// Number of samples.
    pub samples: usize,
    /// For each joint its columns, as its pattern lists them, one entry for each sample.
    pub columns: Vec<Vec<Vec<f64>>>,
    /// For each joint the torque that was measured, and that less what is known; none where none
    /// was measured.
    pub torque: Vec<Option<[Vec<f64>; 2]>>,
    /// For each joint which of its rows count; none where all do.
    pub counts: Vec<Option<Vec<bool>>>,
}

impl Block {
    /// The columns of a joint and what they are to give.
    pub fn with_target(&self, joint: usize) -> Option<Vec<&[f64]>> {
        let [_, target] = self.torque[joint].as_ref()?;
        let columns = self.columns[joint].iter().map(Vec::as_slice);
        Some(columns.chain([target.as_slice()]).collect())
    }

    /// Target - Y phi of a joint, one for each sample; none where no torque was measured.
    pub fn residual(&self, joint: usize, phi: &[f64]) -> Option<Vec<f64>> {
        let [_, target] = self.torque[joint].as_ref()?;
        let mut residual = target.clone();
        for (column, factor) in self.columns[joint].iter().zip(phi) {
            for (sum, entry) in residual.iter_mut().zip(column) {
                *sum -= factor * entry;
            }
        }
        Some(residual)
    }
}

/// Makes blocks of rows.
pub struct BlockMaker<'a> {
    model: &'a RegressionModel,
    evaluator: RegressionEvaluator,
    decimator: Decimator,
    data: &'a Conditioned,
    motion: Vec<Vec<f64>>,
    rows: RegressionRows,
    block: Block,
}

impl<'a> BlockMaker<'a> {
    /// Blocks of conditioned data of the model's robot.
    pub fn new(model: &'a RegressionModel, data: &'a Conditioned) -> Self {
        Self {
            model,
            evaluator: model.evaluator(),
            decimator: Decimator::new(data.decimation),
            data,
            motion: Vec::new(),
            rows: RegressionRows::default(),
            block: Block::default(),
        }
    }

    /// Calls `visit` with every block, in order.
    pub fn for_each(&mut self, mut visit: impl FnMut(&Block)) {
        let samples = self.data.samples();
        for first in (0..samples).step_by(BLOCK) {
            self.fill(first, BLOCK.min(samples - first));
            visit(&self.block);
        }
    }

    /// The block of given samples.
    pub(super) fn at(&mut self, first: usize, samples: usize) -> &Block {
        self.fill(first, samples);
        &self.block
    }

    fn fill(&mut self, first: usize, samples: usize) {
        let (factor, reach) = (self.decimator.factor(), self.decimator.reach());
        let start = self.data.range.start + first * factor;
        let range = start..start + (samples - 1) * factor + 2 * reach + 1;
        self.data.motion(range.clone(), &mut self.motion);
        let motion: Vec<&[f64]> = self.motion.iter().map(Vec::as_slice).collect();
        self.evaluator
            .evaluate(&motion, &mut self.rows)
            .expect("conditioned data have a column for each joint of the model");
        let (block, decimator, rows) = (&mut self.block, &self.decimator, &self.rows);
        (block.first, block.samples) = (first, samples);
        block.columns.resize(self.model.joints.len(), Vec::new());
        block.torque.resize(self.model.joints.len(), None);
        let slow = self.data.slow.as_deref();
        block.counts.clear();
        for joint in 0..self.model.joints.len() {
            let rates = &self.motion[self.model.joints.len() + joint];
            let counted = |slowest: f64| {
                let windows = rates.windows(2 * reach + 1).step_by(factor);
                windows.map(|rates| is_fast(rates, slowest)).collect()
            };
            block.counts.push(slow.map(|slow| counted(slow[joint])));
            block.columns[joint].resize(rows.width(joint), Vec::new());
            for (place, column) in block.columns[joint].iter_mut().enumerate() {
                column.resize(samples, 0.0);
                decimator.apply(rows.column(joint, place), column);
            }
            let Some(measured) = &self.data.torque[joint] else { continue };
            let [torque, target] = block.torque[joint].get_or_insert_default();
            torque.resize(samples, 0.0);
            decimator.apply(&measured[range.clone()], torque);
            target.clone_from(torque);
            if let Some(known) = rows.known(joint) {
                let mut decimated = vec![0.0; samples];
                decimator.apply(known, &mut decimated);
                target.iter_mut().zip(decimated).for_each(|(target, known)| *target -= known);
            }
        }
    }
}

/// Whether a joint moves one way, faster than this.
fn is_fast(rates: &[f64], slowest: f64) -> bool {
    rates.iter().all(|rate| *rate > slowest) || rates.iter().all(|rate| *rate < -slowest)
}
