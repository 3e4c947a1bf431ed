//! The rows of a regression, block by block, after both sides went through the same decimator.

use denavit_measure::condition::{Conditioned, Decimator};
use denavit_measure::{JointIndex, SampleIndex};
use denavit_plants::regression::{RegressionEvaluator, RegressionModel, RegressionRows};

/// Samples in a block.
const BLOCK: usize = 512;

/// Rows of samples that follow each other.
#[derive(Clone, Debug, Default)]
pub struct Block {
    /// The number of the first sample among those that are left after decimation.
    pub first: SampleIndex,
    /// Number of samples.
    pub samples: usize,
    /// For each joint its columns, as its pattern lists them, one entry for each sample.
    pub columns: Vec<Vec<Vec<f64>>>,
    /// For each joint the torque that was measured, and that less what is known; none where none
    /// was measured.
    pub torque: Vec<Option<[Vec<f64>; 2]>>,
}

impl Block {
    /// The columns of a joint and what they are to give.
    pub fn with_target(&self, joint: JointIndex) -> Option<Vec<&[f64]>> {
        let [_, target] = self.torque[joint.0].as_ref()?;
        let columns = self.columns[joint.0].iter().map(Vec::as_slice);
        Some(columns.chain([target.as_slice()]).collect())
    }

    /// Target - Y phi of a joint, one for each sample; none where no torque was measured.
    pub fn residual(&self, joint: JointIndex, phi: &[f64]) -> Option<Vec<f64>> {
        let [_, target] = self.torque[joint.0].as_ref()?;
        let mut residual = target.clone();
        for (column, factor) in self.columns[joint.0].iter().zip(phi) {
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
    /// Columns that jump with the rate: they pass the filter of the torque.
    coulomb: Vec<Coulomb>,
    block: Block,
}

/// A column of Coulomb friction.
pub(crate) struct Coulomb {
    pub(crate) joint: JointIndex,
    pub(crate) place: usize,
    /// Times the law of the rate.
    pub(crate) factor: f64,
}

/// The columns of Coulomb friction, as they are at rates of 1.
pub(crate) fn coulomb(
    model: &RegressionModel,
    evaluator: &mut RegressionEvaluator,
) -> Vec<Coulomb> {
    let n = model.joints.len();
    let motion: Vec<[f64; 1]> =
        (0..3 * n).map(|at| [if at / n == 1 { 1.0 } else { 0.0 }]).collect();
    let motion: Vec<&[f64]> = motion.iter().map(<[f64; 1]>::as_slice).collect();
    let mut rows = RegressionRows::default();
    evaluator.evaluate(&motion, &mut rows).expect("there is a column for each joint");
    let at_one = model.law.of(1.0);
    let of = |&(joint, place): &(usize, usize)| Coulomb {
        joint: JointIndex(joint),
        place,
        factor: rows.column(joint, place)[0] / at_one,
    };
    model.coulomb().iter().map(of).collect()
}

impl<'a> BlockMaker<'a> {
    /// Blocks of conditioned data of the model's robot.
    pub fn new(model: &'a RegressionModel, data: &'a Conditioned) -> Self {
        let mut evaluator = model.evaluator();
        Self {
            model,
            coulomb: coulomb(model, &mut evaluator),
            evaluator,
            decimator: data.decimator(),
            data,
            motion: Vec::new(),
            rows: RegressionRows::default(),
            block: Block::default(),
        }
    }

    /// The Coulomb friction of a joint by phi \[N m, N\].
    pub(super) fn coulomb_friction(&self, joint: JointIndex, phi: &[f64]) -> f64 {
        let of_joint = self.coulomb.iter().filter(|one| one.joint == joint);
        let at = |one: &Coulomb| phi[self.model.pattern()[joint.0][one.place]];
        of_joint.map(|one| (one.factor * at(one)).abs()).sum()
    }

    /// Calls `visit` with every block, in order.
    pub fn for_each(&mut self, mut visit: impl FnMut(&Block)) {
        let samples = self.data.samples();
        for first in (0..samples).step_by(BLOCK) {
            visit(self.at(SampleIndex(first), BLOCK.min(samples - first)));
        }
    }

    /// Calls `visit` with joint, sample, torque, the same less what is known, and what phi leaves
    /// of that, of every row that was measured.
    pub(crate) fn for_each_left(
        &mut self,
        phi: &[f64],
        mut visit: impl FnMut(JointIndex, SampleIndex, [f64; 3]),
    ) {
        let joints = self.model.joints.len();
        let own: Vec<Vec<f64>> = (0..joints).map(|at| self.model.of_joint(at, phi)).collect();
        self.for_each(|block| {
            for (joint, own) in own.iter().enumerate() {
                let Some([torque, target]) = &block.torque[joint] else { continue };
                let left = block.residual(JointIndex(joint), own).unwrap_or_default();
                for (at, left) in left.into_iter().enumerate() {
                    let sample = SampleIndex(block.first.0 + at);
                    visit(JointIndex(joint), sample, [torque[at], target[at], left]);
                }
            }
        });
    }

    /// The block of given samples.
    pub(super) fn at(&mut self, first: SampleIndex, samples: usize) -> &Block {
        self.fill(first, samples);
        &self.block
    }

    fn fill(&mut self, first: SampleIndex, samples: usize) {
        let (factor, reach) = (self.decimator.factor(), self.decimator.reach());
        let start = self.data.range.start + first.0 * factor;
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
        for joint in 0..self.model.joints.len() {
            block.columns[joint].resize(rows.width(joint), Vec::new());
            for (place, column) in block.columns[joint].iter_mut().enumerate() {
                column.resize(samples, 0.0);
                let friction =
                    self.coulomb.iter().find(|one| (one.joint.0, one.place) == (joint, place));
                match friction {
                    None => decimator.apply(rows.column(joint, place), column),
                    Some(one) => {
                        let law = |rate: f64| one.factor * self.model.law.of(rate);
                        decimator.apply(&self.data.of_rate(one.joint, range.clone(), law), column);
                    }
                }
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
