//! The estimates: one loop of weighting and solving, by method.

use super::condensed::{Condensed, Rows};
use super::errors::{Errors, FEWEST_PARTS, Problem};
use super::half_cutoff::{HalfCutoff, widen};
use super::instruments;
use super::left_out::{LeftOut, SlowRows};
use super::likelihood;
use super::noise_bias::{NoiseBias, NoiseOfLog, noise_bias};
use super::robust::{Loss, influences, scales};
use super::rows::Block;
use super::total;
use super::weights::{ByLog, MAX_REWEIGHTING, SETTLED, Settled, moved};
use crate::error::{Error, ErrorKind};
use crate::policy::least_squares::{FEWEST_DEGREES, MOVES_LITTLE};
use denavit_measure::condition::Conditioned;
use denavit_measure::{JointIndex, LogIndex};
use denavit_numerics::least_by_chance;
use denavit_numerics::least_squares::{PriorRow, Solution, Triangle, solve};
use denavit_plants::regression::RegressionModel;
use nalgebra::{DMatrix, DVector};

/// Samples that are independent of each other which a parameter needs, at least: with fewer,
/// residuals are far smaller than errors and standard errors say nothing.
const ROWS_OF_ONE: usize = 3;

/// Rounds in which robust scales are found anew.
const ROUNDS_OF_SCALES: usize = 10;

/// Parts of logs that say by themselves how large errors are: with fewer, errors are also at least
/// those that the filter's correlation makes, less what chance may show less of them.
const ENOUGH_PARTS: usize = 48;

const NOTHING_LEFT: &str = "no joint is ever as fast as `options.slow` asks: no sample of the logs \
                            remains\n  hint: a lower velocity, or `options.slow=biasing`, which is \
                            the default";

/// How base parameters are estimated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Method {
    /// Least squares, all torques alike.
    Ordinary,
    /// Least squares, each joint in each log weighted by its noise.
    #[default]
    Weighted,
    /// Weighted, and outliers lose weight.
    Robust(Loss),
    /// Total least squares: every column as noisy as the torques, relative to its length.
    Total,
    /// Instrumental variables: what is correlated with the motion of other logs, free of noise,
    /// sample by sample.
    Instrumental,
    /// Weighted sample by sample with what noise of the positions does to each row.
    Likelihood,
}

/// Everything about an estimate but its data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// How.
    pub method: Method,
    /// How standard errors are found.
    pub errors: Errors,
    /// What is known beforehand.
    pub prior: Vec<PriorRow>,
    /// Standard deviation of the measured positions of each joint before filtering [rad, m]; used
    /// by [`Method::Likelihood`] and [`SlowRows::Noise`].
    pub position_noise: Vec<f64>,
    /// Which rows are left out.
    pub slow: SlowRows,
}

/// Base parameters on the joint axes, with their errors.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Solution and conditions.
    pub solution: Solution,
    /// Covariance of phi.
    pub covariance: DMatrix<f64>,
    /// Degrees of freedom of the errors of the listed parameters.
    pub degrees_of_freedom: DVector<f64>,
    /// What noise of the positions adds to phi in the mean; 0 of instrumental variables.
    pub noise_bias: DVector<f64>,
    /// The largest share of noise of the positions in what the columns say of a direction of phi.
    pub noise_share: f64,
    /// How listed parameters change with half the cutoff of the filter; none where that cannot be
    /// told.
    pub change: Option<Vec<HalfCutoff>>,
    /// What noise of the positions of each log does by itself; nothing of instrumental variables.
    pub noise_of_logs: Vec<NoiseOfLog>,
    /// For each log the standard deviation of each joint's residuals [N m, N]; 0 where no torque
    /// was measured.
    pub noise: Vec<Vec<f64>>,
    /// The rows, as they were weighted last.
    pub condensed: Condensed,
    /// For each log what each joint's rows count.
    pub weights: Vec<Vec<f64>>,
    /// Rows that do not count.
    pub(super) left_out: LeftOut,
}

/// Estimates phi from logs. `instruments` are logs of the same samples, for
/// [`Method::Instrumental`]; `start` is where phi stays in directions that nothing is known of.
pub fn estimate(
    model: &RegressionModel,
    logs: &[Conditioned],
    instruments: &[Conditioned],
    options: &Options,
    start: &[f64],
) -> Result<Estimate, Error> {
    let fit = Fit { options, start };
    let (mut first, left_out) = fit.counted(model, logs)?;
    first.left_out = left_out.clone();
    let rows = (logs, &left_out);
    match options.method {
        Method::Ordinary | Method::Weighted => {}
        Method::Robust(loss) => first = fit.robust(model, rows, first, loss)?,
        Method::Likelihood => first = fit.likely(model, rows, first)?,
        Method::Total => total::total(&mut first),
        Method::Instrumental => {
            instruments::instrumental(model, rows, instruments, &mut first)?;
            let of_parts = (first.condensed.parts.len() as f64 - 1.0).max(1.0);
            let problem = fit.problem(&first);
            let degrees = problem.degrees_of_freedom(Errors::Correlated, model.to_listed());
            first.degrees_of_freedom = degrees.map(|degrees| degrees.min(of_parts));
            return Ok(first);
        }
    }
    let NoiseBias { bias, share, of_logs } = fit.noise_bias(model, rows, &first);
    (first.noise_bias, first.noise_share, first.noise_of_logs) = (bias, share, of_logs);
    let problem = fit.problem(&first);
    let covariance = match options.method {
        Method::Robust(loss) => {
            let (phi, scales) = (first.solution.phi.as_slice(), &first.noise);
            let influences = influences(model, rows, phi, scales, loss);
            problem.robust_covariance(options.errors, &influences)
        }
        _ => problem.covariance(options.errors),
    };
    let (mut covariance, degrees_of_freedom) = fit.errors(model, &first, covariance);
    let mut change = fit.change(model, rows, &first);
    if let Some(change) = &mut change {
        widen(change, model, &mut covariance);
    }
    Ok(Estimate { covariance, degrees_of_freedom, change, ..first })
}

/// Makes variances of listed parameters that parts of the logs say little of at least as large as
/// others, less what chance shows less of them. What lacks is added along what goes with an error
/// of the parameter: sums that are known well, although what they are of is not, stay so.
fn at_least(
    model: &RegressionModel,
    covariance: &mut DMatrix<f64>,
    other: &DMatrix<f64>,
    degrees_of_freedom: &DVector<f64>,
    parts: usize,
) {
    for (parameter, &degrees) in model.to_listed().row_iter().zip(degrees_of_freedom) {
        let share = match degrees {
            degrees if degrees < FEWEST_DEGREES => 1.0,
            degrees if parts < ENOUGH_PARTS => least_by_chance(degrees),
            _ => continue,
        };
        let goes_with = other * parameter.transpose();
        let variance = (parameter * &goes_with)[0];
        let lacks = share * variance - (parameter * &*covariance * parameter.transpose())[0];
        if variance > 0.0 && lacks > 0.0 {
            *covariance += &goes_with * goes_with.transpose() * (lacks / (variance * variance));
        }
    }
}

/// Samples of all torques that are independent of each other.
fn independent(logs: &[Conditioned]) -> f64 {
    let torques = |log: &Conditioned| log.torque.iter().flatten().count() as f64;
    logs.iter().map(|log| log.independent() * torques(log)).sum()
}

/// Whether logs have enough samples for an estimate.
pub(crate) fn long_enough(logs: &[Conditioned], found: &Estimate) -> Result<(), Error> {
    let independent = independent(logs) as usize;
    let parameters = found.solution.excited();
    let needed = ROWS_OF_ONE * parameters;
    if independent >= needed {
        return Ok(());
    }
    let text = format!(
        "the logs are too short: all torques have about {independent} samples that are independent \
         of each other after the filter, and {parameters} parameters need {needed}\n  hint: more \
         of the motion, or a higher cutoff (`conditions.filter`) if the log has little noise"
    );
    Err(Error::new(ErrorKind::TooShort, text))
}

/// The factors of both sides of rows: log, block, joint.
type Factors = Box<dyn Fn(LogIndex, &Block, JointIndex) -> Vec<f64>>;

/// What estimates have in common.
pub(super) struct Fit<'a> {
    pub(super) options: &'a Options,
    pub(super) start: &'a [f64],
}

impl Fit<'_> {
    /// Least squares, weighted if that is wanted, of the rows that count.
    pub(super) fn plain(&self, model: &RegressionModel, rows: Rows<'_>) -> Result<Estimate, Error> {
        let (logs, _) = rows;
        let has_torque = logs.iter().any(|log| log.torque.iter().any(Option::is_some));
        self.of_condensed(Condensed::counted(model, rows), has_torque)
    }

    /// The same of rows that are condensed, of logs with or without torques.
    pub(super) fn of_condensed(
        &self,
        condensed: Condensed,
        has_torque: bool,
    ) -> Result<Estimate, Error> {
        let count: usize = condensed.parts.iter().flatten().map(Triangle::rows).sum();
        match count {
            0 if has_torque => Err(Error::new(ErrorKind::TooShort, NOTHING_LEFT)),
            0 => Err(Error::new(ErrorKind::MissingColumn, "no torque was measured")),
            rows if rows < condensed.rank => {
                let text = format!("{rows} rows are too few for {} parameters", condensed.rank);
                Err(Error::new(ErrorKind::TooShort, text))
            }
            _ => Ok(self.by_noise(condensed, self.options.method != Method::Ordinary)),
        }
    }

    /// The covariance of phi, of which parts of the logs say this, and the degrees of freedom of
    /// the listed parameters.
    pub(super) fn errors(
        &self,
        model: &RegressionModel,
        found: &Estimate,
        mut covariance: DMatrix<f64>,
    ) -> (DMatrix<f64>, DVector<f64>) {
        let (problem, Options { method, errors, .. }) = (self.problem(found), self.options);
        let mut degrees_of_freedom = problem.degrees_of_freedom(*errors, model.to_listed());
        match errors {
            Errors::Correlated => {
                let (wider, free) = found.widened_by_filter(*method);
                let parts = found.condensed.parts.len();
                if parts < FEWEST_PARTS {
                    // too few parts to say more
                    covariance *= wider;
                    degrees_of_freedom.fill(free);
                } else {
                    let by_filter = found.solution.covariance() * wider;
                    at_least(model, &mut covariance, &by_filter, &degrees_of_freedom, parts);
                }
            }
            Errors::Classical if *method == Method::Ordinary => {
                covariance *= found.sum_of_squares() / problem.free_rows();
            }
            _ => {}
        }
        (covariance, degrees_of_freedom)
    }

    pub(super) fn problem<'a>(&'a self, found: &'a Estimate) -> Problem<'a> {
        Problem {
            condensed: &found.condensed,
            weights: &found.weights,
            prior: &self.options.prior,
            solution: &found.solution,
        }
    }

    pub(super) fn solved(
        &self,
        condensed: &Condensed,
        triangles: &[Vec<Triangle>],
        weights: &[Vec<f64>],
    ) -> Solution {
        solve(&condensed.system(triangles, weights, &self.options.prior), self.start)
    }

    /// Least squares, rows weighted by the noise of their joint in their log if that is wanted.
    fn by_noise(&self, condensed: Condensed, is_weighted: bool) -> Estimate {
        let Settled { solution, weights, noise } = self.settled(&condensed, is_weighted);
        Estimate {
            solution,
            covariance: DMatrix::zeros(0, 0),
            degrees_of_freedom: DVector::zeros(0),
            noise_bias: DVector::zeros(condensed.rank),
            noise_share: 0.0,
            noise_of_logs: Vec::new(),
            change: None,
            noise,
            condensed,
            weights,
            left_out: LeftOut::none(&[]),
        }
    }

    fn robust(
        &self,
        model: &RegressionModel,
        rows: Rows<'_>,
        found: Estimate,
        loss: Loss,
    ) -> Result<Estimate, Error> {
        self.reweighting(model, rows, found, |found, round| {
            // medians jump: with scales that stay the weights settle
            if round < ROUNDS_OF_SCALES {
                found.noise = scales(model, rows, found.solution.phi.as_slice());
            }
            (Box::new(factors_of_loss(found, loss)), found.noise.clone())
        })
    }

    fn likely(
        &self,
        model: &RegressionModel,
        rows: Rows<'_>,
        found: Estimate,
    ) -> Result<Estimate, Error> {
        self.reweighting(model, rows, found, |found, _| {
            let ones = vec![vec![1.0; found.condensed.pattern.len()]; rows.0.len()];
            (Box::new(self.factors_of_noise(model, rows.0, found)), ones)
        })
    }

    /// Weighs rows one by one and solves, again and again, until phi settles. `weigh` gives from
    /// what was found, and the number of the round, the factors of rows and each joint's deviation.
    fn reweighting(
        &self,
        model: &RegressionModel,
        rows: Rows<'_>,
        mut found: Estimate,
        mut weigh: impl FnMut(&mut Estimate, usize) -> (Factors, ByLog),
    ) -> Result<Estimate, Error> {
        let mut change = f64::INFINITY;
        for round in 0..MAX_REWEIGHTING {
            let (factors, deviations) = weigh(&mut found, round);
            let condensed = Condensed::weighted(model, rows, &factors);
            let weights = condensed.reciprocal(&deviations, &condensed.whole());
            change = self.reweighted(&mut found, condensed, weights);
            if change < SETTLED {
                break;
            }
        }
        settled(found, change)
    }

    /// Solves with other weights, and says how far phi moves, in its standard errors.
    fn reweighted(&self, found: &mut Estimate, condensed: Condensed, weights: ByLog) -> f64 {
        let next = self.solved(&condensed, &condensed.whole(), &weights);
        let change = moved(&found.solution, &next);
        (found.weights, found.condensed, found.solution) = (weights, condensed, next);
        change
    }

    /// 1 over the deviation of each row, of noise of torques and positions.
    fn factors_of_noise(
        &self,
        model: &RegressionModel,
        logs: &[Conditioned],
        found: &Estimate,
    ) -> impl Fn(LogIndex, &Block, JointIndex) -> Vec<f64> + use<> {
        let (phi, deviations) = (found.solution.phi.as_slice(), &self.options.position_noise[..]);
        let variance = likelihood::Variance::new(model, logs, phi, deviations);
        let noise = variance.torque_noise(&found.noise);
        move |log, block, joint| variance.factors(log, joint, block, &noise)
    }

    /// The bias of an estimate, with the weights of its rows.
    fn noise_bias(&self, model: &RegressionModel, rows: Rows<'_>, found: &Estimate) -> NoiseBias {
        let given = self.start;
        match self.options.method {
            Method::Robust(loss) => {
                noise_bias(model, given, rows, found, Some(&factors_of_loss(found, loss)))
            }
            Method::Likelihood => {
                let factors = self.factors_of_noise(model, rows.0, found);
                noise_bias(model, given, rows, found, Some(&factors))
            }
            _ => noise_bias(model, given, rows, found, None),
        }
    }
}

/// An estimate whose last weights changed an entry of phi by so many standard errors, at most.
fn settled(found: Estimate, change: f64) -> Result<Estimate, Error> {
    match change < MOVES_LITTLE {
        true => Ok(found),
        false => Err(Error::new(ErrorKind::NotSettled, "the weights do not settle")),
    }
}

/// What rows count by the loss of their residuals, whose deviations are the estimate's noise.
fn factors_of_loss(
    found: &Estimate,
    loss: Loss,
) -> impl Fn(LogIndex, &Block, JointIndex) -> Vec<f64> + use<> {
    let own = |joint: JointIndex| found.condensed.of_joint(joint, found.solution.phi.as_slice());
    let phi: Vec<Vec<f64>> = (0..found.condensed.pattern.len()).map(JointIndex).map(own).collect();
    let scales = found.noise.clone();
    move |log, block, joint| {
        let residual = block.residual(joint, &phi[joint.0]).unwrap_or_default();
        let scale = scales[log.0][joint.0].max(f64::MIN_POSITIVE);
        residual.iter().map(|residual| loss.factor(residual / scale)).collect()
    }
}

impl Estimate {
    /// By how much the filter's correlation of residuals makes variances larger than independent
    /// residuals would, and the degrees of freedom that are left.
    fn widened_by_filter(&self, method: Method) -> (f64, f64) {
        let rows = self.condensed.counted_rows();
        let used = self.solution.excited() as f64;
        let left = (rows - used).max(1.0);
        let free = (self.condensed.independent_rows().min(rows) - used).max(1.0);
        let of_noise = match method {
            Method::Ordinary => self.sum_of_squares() / left,
            _ => 1.0,
        };
        (of_noise * left / free, free)
    }

    /// |W phi - y|^2 of all rows.
    fn sum_of_squares(&self) -> f64 {
        let triangles = self.condensed.whole();
        let squares = self.condensed.squares(&triangles, self.solution.phi.as_slice());
        squares.iter().flatten().sum()
    }

    /// What rows of each joint count by its noise in all logs; 0 where no torque was measured.
    pub(crate) fn weights_of_joints(&self) -> Vec<f64> {
        let weight = |noise: f64| if noise > 0.0 { 1.0 / noise } else { 0.0 };
        self.noise_of_joints().into_iter().map(weight).collect()
    }

    /// The deviation of each joint's residuals in all logs; 0 where no torque was measured.
    pub fn noise_of_joints(&self) -> Vec<f64> {
        self.condensed.noise_of_joints(&self.noise)
    }
}
