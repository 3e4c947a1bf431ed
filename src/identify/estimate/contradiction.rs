//! Logs that contradict the others: parameters of their own would explain what those of all do not.
//!
//! A log of another payload, of another gain of its torques or with an offset is as smooth as the
//! others: it is not its noise that tells it, but that its own estimate leaves much less (a test
//! of equal parameters, Chow 1960, with samples as independent as the filter leaves them).

use super::condensed::Condensed;
use super::least_squares::Estimate;
use super::rows::BlockMaker;
use super::solve::solve;
use super::triangle::Triangle;
use crate::identify::condition::Conditioned;
use crate::plants::regression::RegressionModel;
use std::fmt;

/// What own parameters explain must be this share of a joint's torque, as root of mean square, and
/// so many times what they leave, which noise of the positions may have made them follow,
const OF_TORQUE: f64 = 0.03;
const OF_OWN: f64 = 1.5;

/// and this many times what chance explains with as many parameters, in variance.
const OF_CHANCE: f64 = 25.0;

/// Times that the weights of a log's own estimate are found anew.
const REWEIGHTING: usize = 3;

/// What a constant or a factor leaves of the squares of what it is told for, at most.
const ALIKE: f64 = 0.25;

/// A log that contradicts the others.
#[derive(Clone, Debug, PartialEq)]
pub struct ContradictingLog {
    /// Its name.
    pub file: String,
    /// The joints that tell it.
    pub joints: Vec<ContradictingJoint>,
    /// Whether the logs that agree are more, and longer together, than those that contradict them.
    pub is_of_few: bool,
}

/// A joint whose torques in a log contradict those in the others.
#[derive(Clone, Debug, PartialEq)]
pub struct ContradictingJoint {
    /// The joint.
    pub joint: String,
    /// The share of its torque that is left, as root of mean square,
    pub left: f64,
    /// and that own parameters of the log would leave.
    pub own: f64,
    /// What is left is like this.
    pub like: Option<Likeness>,
}

/// What is left of a torque beside that of other logs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Likeness {
    /// A constant more, in this unit.
    Constant(f64, &'static str),
    /// So many times as large.
    Factor(f64),
}

impl fmt::Display for ContradictingLog {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, joints, is_of_few } = self;
        let of = |one: &ContradictingJoint| {
            let ContradictingJoint { joint, left, own, like } = one;
            let like = match like {
                None => String::new(),
                Some(Likeness::Constant(by, unit)) => format!(", as if {by:+.3} {unit} were added"),
                Some(Likeness::Factor(by)) => format!(", as if it were {by:.3} times as large"),
            };
            let [left, own] = [left, own].map(|share| 100.0 * share);
            format!("{left:.1} % of the torque of {joint} is left, {own:.1} % by its own{like}")
        };
        let joints: Vec<String> = joints.iter().map(of).collect();
        write!(
            f,
            "{file} contradicts the other logs, which no parameters explain together with it: {}. \
             It may be of another payload, gain, offset or robot, or show a law that the model \
             lacks. ",
            joints.join("; ")
        )?;
        match is_of_few {
            true => write!(f, "Parameters are those of the others; leave it out."),
            false => write!(
                f,
                "The logs that agree are not both more and longer together than those that do \
                 not: which of them are right cannot be told, and what was found is not to be \
                 believed. Look at each log by itself."
            ),
        }
    }
}

/// The logs that contradict the others, of some.
pub(in crate::identify) fn contradicting_logs(
    model: &RegressionModel,
    logs: &[Conditioned],
    (found, shown): (&Estimate, &[usize]),
) -> Vec<ContradictingLog> {
    let condensed = &found.condensed;
    if shown.len() < 2 || condensed.rank != model.rank() {
        return Vec::new();
    }
    let triangles = condensed.whole();
    let phi = found.solution.phi.as_slice();
    let of = |&log: &usize| -> Option<(usize, Vec<ContradictingJoint>)> {
        let told = condensed.contradicting((log, &triangles[log]), (phi, &found.weights[log]));
        let named = |(joint, [left, own]): (usize, [f64; 2])| ContradictingJoint {
            joint: model.joints[joint].name.clone(),
            left,
            own,
            like: likeness(model, &logs[log], (joint, phi)),
        };
        let joints: Vec<ContradictingJoint> = told.into_iter().map(named).collect();
        (!joints.is_empty()).then_some((log, joints))
    };
    let told: Vec<(usize, Vec<ContradictingJoint>)> = shown.iter().filter_map(of).collect();
    let time_s = |log: usize| logs[log].range.len() as f64 * logs[log].step_s;
    let [all, few] = [
        shown.iter().map(|&log| time_s(log)).sum::<f64>(),
        told.iter().map(|(log, _)| time_s(*log)).sum(),
    ];
    let is_of_few = 2 * told.len() < shown.len() && 2.0 * few < all;
    let of = |(log, joints): (usize, Vec<ContradictingJoint>)| ContradictingLog {
        file: logs[log].file.clone(),
        joints,
        is_of_few,
    };
    told.into_iter().map(of).collect()
}

impl Condensed {
    /// The joints of a log of whose torque an estimate of its own leaves much less than phi does,
    /// each with both shares.
    fn contradicting(
        &self,
        (log, triangles): (usize, &[Triangle]),
        (phi, weights): (&[f64], &[f64]),
    ) -> Vec<(usize, [f64; 2])> {
        let independent = self.independent[log];
        let mut weights = weights.to_vec();
        // for each joint |W phi - y|^2, the parameters that it decides, and the variance of a row
        let mut own = Vec::new();
        for _ in 0..=REWEIGHTING {
            let r = self.system(&[triangles.to_vec()], &[weights.clone()], &[]);
            let solution = solve(&r, phi);
            let of = |(joint, triangle): (usize, &Triangle)| {
                let pattern = &self.pattern[joint];
                let r = triangle.matrix().view((0, 0), (pattern.len(), pattern.len()));
                let factor = solution.factor.select_rows(pattern);
                let decided = weights[joint].powi(2) * (r * factor).norm_squared();
                let squares = triangle.squares(&self.of_joint(joint, solution.phi.as_slice()));
                let free = (independent * triangle.rows() as f64 - decided).max(f64::MIN_POSITIVE);
                [squares, decided, squares * independent / free]
            };
            own = triangles.iter().enumerate().map(of).collect();
            let weight = |[_, _, variance]: &[f64; 3]| {
                if *variance > 0.0 { variance.powf(-0.5) } else { 0.0 }
            };
            weights = own.iter().map(weight).collect();
        }
        let of = |(joint, triangle): (usize, &Triangle)| {
            let ([squares, decided, variance], rows) = (own[joint], triangle.rows() as f64);
            let all = triangle.target_squares();
            let left = triangle.squares(&self.of_joint(joint, phi));
            let explained = (left - squares).max(0.0);
            let is_much = explained > OF_TORQUE.powi(2) * all
                && explained > OF_OWN.powi(2) * variance * rows
                && independent * explained > OF_CHANCE * decided.max(1.0) * variance;
            is_much.then(|| (joint, [left, variance * rows].map(|one| (one / all).sqrt())))
        };
        triangles.iter().enumerate().filter_map(of).collect()
    }
}

/// Whether what phi leaves of a joint's torque in a log is nearly a constant, or as if the torque
/// were so many times as large.
fn likeness(
    model: &RegressionModel,
    log: &Conditioned,
    (joint, phi): (usize, &[f64]),
) -> Option<Likeness> {
    let own: Vec<f64> = model.pattern()[joint].iter().map(|&at| phi[at]).collect();
    // rows, sums of what is left and of its squares, its products with the computed torque, whose
    // squares
    let mut sums = [0.0; 5];
    BlockMaker::new(model, log).for_each(|block| {
        let (Some(left), Some([torque, _])) = (block.residual(joint, &own), &block.torque[joint])
        else {
            return;
        };
        for (left, torque) in left.into_iter().zip(torque) {
            let computed = torque - left;
            let own = [1.0, left, left * left, left * computed, computed * computed];
            sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        }
    });
    let [rows, sum, squares, both, computed] = sums;
    let unit = if model.joints[joint].slides { "N" } else { "N m" };
    let constant = (squares - sum * sum / rows, Likeness::Constant(sum / rows, unit));
    let factor = (squares - both * both / computed, Likeness::Factor(1.0 + both / computed));
    let best = if constant.0 < factor.0 { constant } else { factor };
    (best.0 < ALIKE * squares).then_some(best.1)
}
