//! Logs condensed to products, and the evidence of models that some of them share.

use super::super::columns::{JointRows, Reading, Sample, is_positive};
use super::super::policy;
use crate::estimate::noise_of_positions;
use denavit_evidence::policy::{NOISE_LEVEL, SIZE};
use denavit_evidence::{Condensed, Told};
use denavit_measure::condition::Conditioned;
use denavit_plants::regression::RegressionModel;
use nalgebra::{DMatrix, DVector};

/// Places of products before those of the columns of phi: the torque, and 1.
pub(super) const BEFORE: usize = 2;

/// The rows of a joint in a log.
struct OfJoint {
    /// Mean products of the torque, of 1 and of the columns of phi with each other.
    products: DMatrix<f64>,
    /// How many of the rows are independent of each other.
    independent: f64,
    /// The least mean square of their noise, of positions, over that of the torque.
    noise: f64,
}

impl OfJoint {
    /// The mean square of the torque.
    fn size(&self) -> f64 {
        self.products[(0, 0)]
    }

    /// The share of the torque, as mean square, that a combination of 1 and columns leaves.
    fn left(&self, factors: &DVector<f64>) -> f64 {
        let all = factors.clone().insert_row(0, -1.0);
        (all.dot(&(&self.products * &all)) / self.size()).max(0.0)
    }

    /// The same with as much more of another combination as explains most.
    fn left_along(&self, factors: &DVector<f64>, more: &DVector<f64>) -> f64 {
        let [all, more] =
            [(factors, -1.0), (more, 0.0)].map(|(one, y)| one.clone().insert_row(0, y));
        let made = &self.products * &more;
        let [both, square] = [all.dot(&made), more.dot(&made)];
        let explained = if square > 0.0 { both * both / square } else { 0.0 };
        (self.left(factors) - explained / self.size()).max(0.0)
    }
}

/// What the torque of one joint in one log has beside the parameters.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) log: usize,
    pub(super) joint: usize,
    /// How it is made of 1 and the columns of phi.
    pub(super) made_of: DVector<f64>,
    /// What is believed of its size: a deviation.
    pub(super) deviation: f64,
    pub(super) is_gain: bool,
}

/// What some logs say together.
#[derive(Clone)]
pub(super) struct Shared {
    pub(super) log_evidence: f64,
    pub(super) phi: DVector<f64>,
    /// The standard deviations of phi.
    pub(super) errors: DVector<f64>,
    /// The sizes of lines.
    pub(super) sizes: Vec<f64>,
}

/// Logs that are compared.
pub(super) struct Compared<'a> {
    pub(super) model: &'a RegressionModel,
    pub(super) logs: Vec<&'a Conditioned>,
    /// By log and joint; none where no torque was measured, or the joint rests: friction is
    /// anything there.
    rows: Vec<Vec<Option<OfJoint>>>,
    /// Of each entry of phi what makes a share of the torque that is much.
    units: Vec<f64>,
    lowest: Vec<f64>,
}

impl<'a> Compared<'a> {
    pub(super) fn new(model: &'a RegressionModel, logs: &[&'a Conditioned]) -> Self {
        let lowest = |is_positive| if is_positive { 0.0 } else { f64::NEG_INFINITY };
        let lowest = is_positive(model).into_iter().map(lowest).collect();
        let logs = logs.to_vec();
        let mut compared = Self { model, logs, rows: Vec::new(), units: Vec::new(), lowest };
        let straight = Reading::straight(model.joints.len());
        let samples = policy::SAMPLES[1] / compared.logs.len().max(1);
        let sample = |&log: &&'a Conditioned| Sample::new(model, (&[log], 1), samples);
        let mut all: Vec<Sample<'_>> = compared.logs.iter().map(sample).collect();
        compared.rows = all.iter_mut().map(|one| compared.of_log(one, &straight)).collect();
        compared.units = compared.units();
        for (at, sample) in all.iter_mut().enumerate() {
            let phi = compared.shared(&[at], &[]).phi;
            let noise = noise_of_positions(model, &compared.logs[at..=at], phi.as_slice());
            let independent = sample.independent(&straight, &phi);
            let independent = by_joint(sample, &independent);
            for (joint, own) in compared.rows[at].iter_mut().enumerate() {
                let Some(own) = own else { continue };
                own.independent = independent[joint].min(own.independent);
                own.noise = policy::NOISE_KNOWN * noise[joint].powi(2);
            }
        }
        compared
    }

    /// The rows of a log, with as many independent ones as its filter leaves.
    fn of_log(&self, sample: &mut Sample<'_>, straight: &Reading) -> Vec<Option<OfJoint>> {
        let independent = by_joint(sample, &sample.independent_by_filter());
        let rows = sample.rows(straight);
        let of = |(joint, rows): (usize, Option<JointRows>)| {
            let products = self.of_phi(joint, &rows.filter(|_| sample.moves(joint))?);
            Some(OfJoint { products, independent: independent[joint], noise: 0.0 })
        };
        rows.into_iter().enumerate().map(of).collect()
    }

    /// Products with the columns of a joint at their places among all of phi.
    fn of_phi(&self, joint: usize, rows: &JointRows) -> DMatrix<f64> {
        let own = rows.with_constant();
        let places = &self.model.pattern()[joint];
        let place = |at: usize| at.checked_sub(BEFORE).map_or(at, |at| BEFORE + places[at]);
        let size = BEFORE + self.model.rank();
        let mut all = DMatrix::zeros(size, size);
        for row in 0..own.nrows() {
            for column in 0..own.ncols() {
                all[(place(row), place(column))] = own[(row, column)];
            }
        }
        all
    }

    fn units(&self) -> Vec<f64> {
        let share = |at: usize| {
            let all = self.rows.iter().flatten().flatten();
            let of = |own: &OfJoint| own.products[(BEFORE + at, BEFORE + at)] / own.size();
            all.map(of).fold(0.0, f64::max).sqrt()
        };
        let unit = |share: f64| if share > 0.0 { SIZE / share } else { 0.0 };
        (0..self.model.rank()).map(|at| unit(share(at))).collect()
    }

    /// What some logs say if they have one set of parameters, beside lines.
    pub(super) fn shared(&self, logs: &[usize], lines: &[Line]) -> Shared {
        self.with_faint((logs, None), lines)
    }

    /// What some logs say, and of what they do not show another one, whose rows hardly count.
    pub(super) fn shared_beside(&self, logs: &[usize], faint: usize) -> Shared {
        self.with_faint((logs, Some(faint)), &[])
    }

    fn with_faint(&self, (logs, faint): (&[usize], Option<usize>), lines: &[Line]) -> Shared {
        let rank = self.units.len();
        let deviations: Vec<f64> =
            self.units.iter().copied().chain(lines.iter().map(|line| line.deviation)).collect();
        let mut lowest = self.lowest.clone();
        lowest.resize(deviations.len(), f64::NEG_INFINITY);
        let counted = logs.iter().map(|&log| (log, 1.0));
        let all = counted.chain(faint.map(|log| (log, policy::FAINT)));
        let cells: Vec<Condensed> = all
            .flat_map(|(log, counts)| {
                let own = self.rows[log].iter().enumerate();
                own.filter_map(move |(joint, own)| Some((log, joint, own.as_ref()?, counts)))
            })
            .map(|(log, joint, own, counts)| {
                let columns = self.columns((log, joint), lines);
                Condensed {
                    rows: counts * own.independent,
                    expected: NOISE_LEVEL.powi(2),
                    least: own.noise,
                    products: columns.tr_mul(&(&own.products * &columns)) / own.size(),
                }
            })
            .collect();
        if cells.is_empty() {
            let zero = DVector::zeros(rank);
            let sizes = vec![0.0; lines.len()];
            return Shared { log_evidence: 0.0, phi: zero.clone(), errors: zero, sizes };
        }
        let believed = vec![0.0; deviations.len()];
        let told = Told::of(&cells, &believed, &lowest, policy::WEIGHING_ROUNDS);
        let sized = |of: &DVector<f64>| -> Vec<f64> {
            of.iter().zip(&deviations).map(|(factor, deviation)| factor * deviation).collect()
        };
        let (mut phi, mut errors) = (sized(&told.factors), sized(&told.deviations));
        let sizes = phi.split_off(rank);
        errors.truncate(rank);
        Shared {
            log_evidence: told.log_evidence,
            phi: DVector::from_vec(phi),
            errors: DVector::from_vec(errors),
            sizes,
        }
    }

    /// The torque and all columns of a model, made of what products are of: those of phi, and the
    /// lines of a joint in a log.
    fn columns(&self, (log, joint): (usize, usize), lines: &[Line]) -> DMatrix<f64> {
        let rank = self.units.len();
        let mut columns = DMatrix::zeros(BEFORE + rank, 1 + rank + lines.len());
        columns[(0, 0)] = 1.0;
        for (at, unit) in self.units.iter().enumerate() {
            columns[(BEFORE + at, 1 + at)] = *unit;
        }
        for (at, line) in lines.iter().enumerate() {
            if (line.log, line.joint) == (log, joint) {
                let mut column = columns.column_mut(1 + rank + at);
                column.rows_mut(1, 1 + rank).copy_from(&(&line.made_of * line.deviation));
            }
        }
        columns
    }

    /// The lines that a log may have beside phi: a constant and a gain of each torque.
    pub(super) fn lines(&self, log: usize, phi: &DVector<f64>) -> Vec<Line> {
        let rows = self.rows[log].iter().enumerate();
        let measured = rows.filter_map(|(joint, own)| Some((joint, own.as_ref()?)));
        let lines = measured.flat_map(|(joint, own)| {
            let constant = DVector::from_fn(1 + phi.len(), |at, _| f64::from(u8::from(at == 0)));
            let offset = policy::OFFSET * own.size().sqrt();
            let line =
                |is_gain, made_of, deviation| Line { log, joint, made_of, deviation, is_gain };
            [
                line(false, constant, offset),
                line(true, phi.clone().insert_row(0, 0.0), policy::GAIN),
            ]
        });
        lines.collect()
    }

    /// The nats that a line explains of what phi leaves, whatever it costs.
    pub(super) fn by_line(&self, line: &Line, phi: &DVector<f64>) -> f64 {
        let Some(own) = self.rows[line.log][line.joint].as_ref() else { return 0.0 };
        let factors = phi.clone().insert_row(0, 0.0);
        let left = [own.left_along(&factors, &line.made_of), own.left(&factors)];
        self.likelier((line.log, line.joint), left)
    }

    /// The share of a joint's torque in a log that phi and lines of sizes leave, as mean square;
    /// none where it does not count.
    pub(super) fn left(
        &self,
        (log, joint): (usize, usize),
        phi: &DVector<f64>,
        lines: (&[Line], &[f64]),
    ) -> Option<f64> {
        let mut factors = phi.clone().insert_row(0, 0.0);
        for (line, size) in lines.0.iter().zip(lines.1) {
            if (line.log, line.joint) == (log, joint) {
                factors += &line.made_of * *size;
            }
        }
        Some(self.rows[log][joint].as_ref()?.left(&factors))
    }

    /// The nats by which one share of a torque, as mean square, is likelier as noise than another.
    pub(super) fn likelier(&self, (log, joint): (usize, usize), [one, other]: [f64; 2]) -> f64 {
        self.rows[log][joint].as_ref().map_or(0.0, |own| {
            let variance = |left: f64| left.max(own.noise).max(NOISE_LEVEL.powi(2));
            0.5 * own.independent * (variance(other) / variance(one)).ln()
        })
    }

    /// Whether noise of the positions may be all that a log's own parameters leave of a torque.
    pub(super) fn is_noisy(&self, log: usize) -> bool {
        let phi = self.shared(&[log], &[]).phi;
        let is_noisy = |(joint, own): (usize, &Option<OfJoint>)| {
            let left = self.left((log, joint), &phi, (&[], &[]));
            own.as_ref().zip(left).is_some_and(|(own, left)| left < own.noise)
        };
        self.rows[log].iter().enumerate().any(is_noisy)
    }
}

/// What is known of each torque that is measured, by joint; 0 of others.
fn by_joint(sample: &Sample<'_>, measured: &[f64]) -> Vec<f64> {
    let mut measured = measured.iter();
    let of = |joint: usize| match sample.is_measured(joint) {
        true => measured.next().copied().unwrap_or(0.0),
        false => 0.0,
    };
    (0..sample.model.joints.len()).map(of).collect()
}
