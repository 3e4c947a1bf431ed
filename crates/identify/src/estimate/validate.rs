//! What a model leaves unexplained, joint by joint.

use super::rows::BlockMaker;
use denavit_measure::condition::Conditioned;
use denavit_numerics::extremes;
use denavit_plants::regression::RegressionModel;
use std::borrow::Borrow;
use std::collections::VecDeque;

/// Distances at which residuals are compared with themselves, in samples.
pub const LAGS: usize = 20;

/// Spans of time of which a picture shows the first, the last and the extreme samples.
const SPANS: usize = 500;

/// What is left of a joint's torque.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointResidual {
    /// The joint.
    pub name: String,
    /// Root of the mean square of the torque [N m, N].
    pub torque_rms: f64,
    /// That of the residual [N m, N].
    pub residual_rms: f64,
    /// Residual over torque.
    pub relative: f64,
    /// Correlation of the residual with itself 1, 2, ... samples later.
    pub autocorrelation: Vec<f64>,
    /// The largest residual [N m, N].
    pub largest: f64,
    /// Time, measured and computed torque, for pictures [s, N m, N]: of long logs the samples that
    /// stand out ([`extremes`]).
    pub drawn: Vec<[f64; 3]>,
}

/// What is left of all torques of some logs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Validation {
    /// The joints whose torque was measured.
    pub joints: Vec<JointResidual>,
    /// sqrt(mean over joints of (residual / torque)^2).
    pub relative: f64,
    /// Samples, after decimation.
    pub samples: usize,
}

#[derive(Clone, Default)]
struct Sums {
    torque: f64,
    residual: f64,
    rows: usize,
    largest: f64,
    recent: VecDeque<f64>,
    lagged: [f64; LAGS],
    drawn: Vec<[f64; 3]>,
    /// Rows of the span that is not at its end yet.
    span: Vec<[f64; 3]>,
}

impl Sums {
    /// Keeps a row for pictures; `span` is how many rows a span has.
    fn draw(&mut self, row: [f64; 3], span: usize) {
        self.span.push(row);
        if self.span.len() >= span {
            self.end_span();
        }
    }

    fn end_span(&mut self) {
        let rows = std::mem::take(&mut self.span);
        let residual = |row: &[f64; 3]| row[1] - row[2];
        let kept = extremes(rows.len(), 3, 1, |column, row| match column {
            0 => rows[row][1],
            1 => rows[row][2],
            _ => residual(&rows[row]),
        });
        self.drawn.extend(kept.into_iter().map(|row| rows[row]));
    }

    fn add(&mut self, residual: f64, torque: f64) {
        for (sum, before) in self.lagged.iter_mut().zip(&self.recent) {
            *sum += residual * before;
        }
        self.recent.push_front(residual);
        self.recent.truncate(LAGS);
        self.torque += torque * torque;
        self.residual += residual * residual;
        self.largest = self.largest.max(residual.abs());
        self.rows += 1;
    }
}

/// Compares the torques of logs with those of phi.
pub fn validate(
    model: &RegressionModel,
    phi: &[f64],
    logs: &[impl Borrow<Conditioned>],
) -> Validation {
    let mut sums = vec![Sums::default(); model.joints.len()];
    let logs = logs.iter().map(Borrow::borrow);
    let samples: usize = logs.clone().map(Conditioned::samples).sum();
    let span = samples.div_ceil(SPANS).max(1);
    for log in logs {
        sums.iter_mut().for_each(|sums| sums.recent.clear());
        BlockMaker::new(model, log).for_each_left(phi, |joint, sample, [torque, _, left]| {
            sums[joint.0].add(left, torque);
            sums[joint.0].draw([log.time_s(sample), torque, torque - left], span);
        });
        sums.iter_mut().for_each(Sums::end_span);
    }
    let measured = sums.into_iter().zip(&model.joints).filter(|(sums, _)| sums.rows > 0);
    let joints: Vec<JointResidual> = measured
        .map(|(sums, joint)| {
            let rms = |squares: f64| (squares / sums.rows as f64).sqrt();
            let (torque_rms, residual_rms) = (rms(sums.torque), rms(sums.residual));
            let relative = if torque_rms > 0.0 { residual_rms / torque_rms } else { 0.0 };
            let all = sums.residual;
            let correlation = |sum: &f64| if all > 0.0 { sum / all } else { 0.0 };
            JointResidual {
                name: joint.name.clone(),
                torque_rms,
                residual_rms,
                relative,
                autocorrelation: sums.lagged.iter().map(correlation).collect(),
                largest: sums.largest,
                drawn: sums.drawn,
            }
        })
        .collect();
    Validation::of_joints(joints, samples)
}

impl Validation {
    /// What is left of a joint's torque; none where none was measured.
    pub fn joint(&self, name: &str) -> Option<&JointResidual> {
        self.joints.iter().find(|one| one.name == name)
    }

    /// Of so many samples, of the joints whose torque was measured.
    pub(super) fn of_joints(joints: Vec<JointResidual>, samples: usize) -> Self {
        // a sum of nothing is -0, which would be shown
        let squares = joints.iter().map(|joint| joint.relative.powi(2)).fold(0.0, |a, b| a + b);
        let relative = (squares / joints.len().max(1) as f64).sqrt();
        Self { joints, relative, samples }
    }
}
