//! Joints whose torque the parameters do not explain: in all logs, in one of them, in one for
//! validation, or while a joint rests; and what is left that is no noise.
//!
//! That nothing explains a torque is a model, too: it is noise of its own size. It is compared
//! with the parameters by the density that both give the rows. Noise of torques is as large in
//! either half of the filter's band; what is more in the lower half, by more than chance, is none.

use super::compared::{Compared, Spectra};
use super::policy;
use crate::estimate::{BlockMaker, Estimate, Left, samples_of};
use denavit_evidence::policy::NAMED;
use denavit_measure::condition::Conditioned;
use denavit_plants::regression::RegressionModel;
use std::collections::VecDeque;
use std::fmt;
use std::ops::Range;

/// A joint of whose torque nearly all is left, or much that is no noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Unexplained {
    /// The joint.
    pub joint: String,
    /// The log, if it is one of several and not all are like it.
    pub file: Option<String>,
    /// Root of the mean square of the residual over that of the torque, without samples near
    /// reversals.
    pub share: f64,
    /// The longest time that the joint rests in between \[s\], if it is that of which it is left;
    /// all of the log if it never moves.
    pub rest_s: Option<[f64; 2]>,
    /// What is left of it in the logs for the estimate, if it is that beside which too much is
    /// left in a log for validation.
    pub beside: Option<f64>,
}

impl fmt::Display for Unexplained {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (joint, percent) = (&self.joint, 100.0 * self.share);
        write!(f, "The torque of {joint} is not explained: {percent:.0} % of it is left")?;
        if let Some(file) = &self.file {
            write!(f, " in {file}")?;
        }
        match (self.beside, self.rest_s) {
            (Some(share), _) => write!(
                f,
                ", without what is near reversals, and {:.1} % in the logs for the estimate: far \
                 more than noise and errors of the parameters make. The unit of its time or of \
                 another column may be another, or the robot, or it shows a law that the model \
                 lacks; it does not confirm what was found.",
                100.0 * share
            ),
            (None, None) => write!(
                f,
                ", although the joint moves. Its column may be another quantity, in another unit, \
                 or noise, or the zero of a position may be off, or the model's geometry; what was \
                 found is not to be believed."
            ),
            (None, Some([from, to])) => write!(
                f,
                ", although the joint rests, from {from:.2} to {to:.2} s, and its friction holds \
                 less. The column of its position may be stuck while it moves, or stiction or a \
                 brake holds it, which no equation knows; what was found is not to be believed."
            ),
        }
    }
}

/// What joints are judged by: logs as they are filtered, those for the estimate first, and the
/// parameters that were found of them.
#[derive(Clone, Copy)]
pub(crate) struct Judged<'a> {
    pub(crate) model: &'a RegressionModel,
    pub(crate) compared: &'a Compared<'a>,
    pub(crate) found: &'a Estimate,
    /// What it leaves of all logs.
    pub(crate) spectra: &'a Spectra,
    /// Logs for the estimate of which noise of the positions does not make most.
    pub(crate) shown: &'a [usize],
    /// Logs for validation; none if there are none.
    pub(crate) held_out: &'a [usize],
}

impl Judged<'_> {
    /// The joints whose torque is not explained: at rest, of all logs together that judge, or of
    /// one of them. Equations of a floating base are none of joints.
    pub(crate) fn unexplained(&self) -> Vec<Unexplained> {
        let judges = if self.held_out.is_empty() { self.shown } else { self.held_out };
        let is_one_of = self.compared.logs.len() > 1;
        let of_one = |log: usize| {
            let file = is_one_of.then(|| self.compared.logs[log].file.clone());
            move |one: Unexplained| Unexplained { file: file.clone(), ..one }
        };
        let mut all: Vec<Unexplained> = Vec::new();
        for &log in judges {
            let own = resting(self.model, self.compared.logs[log], self.found);
            all.extend(own.into_iter().map(of_one(log)));
        }
        // what a joint leaves at rest tells more than what it leaves in all
        let together = self.moving(judges, true);
        let together: Vec<Unexplained> =
            together.into_iter().filter(|one| all.iter().all(|at| at.joint != one.joint)).collect();
        all.extend(together);
        for &log in judges {
            let mut own = if judges.len() > 1 { self.moving(&[log], false) } else { Vec::new() };
            own.extend(
                self.held_out.contains(&log).then(|| self.exceeding(log)).into_iter().flatten(),
            );
            for one in own.into_iter().map(of_one(log)) {
                let is_same = |other: &Unexplained| {
                    other.joint == one.joint && (other.file.is_none() || other.file == one.file)
                };
                if !all.iter().any(is_same) {
                    all.push(one);
                }
            }
        }
        all
    }

    /// The joints of whose torque, in some logs in which they move, parameters explain nothing, or
    /// much is left that is no noise.
    fn moving(&self, logs: &[usize], may_be_nothing: bool) -> Vec<Unexplained> {
        let phi = &self.found.solution.phi;
        let of = |joint: usize| {
            let left = self.compared.left_of(logs, joint, phi)?;
            let no_noise = self.spectra.no_noise(logs, joint);
            let is_nothing = || {
                let all = [self.shown, self.held_out].concat();
                may_be_nothing
                    && left > self.compared.noise_of(logs, joint)
                    && self.compared.nothing(&all, (logs, joint)) > NAMED
            };
            let is_left = no_noise > policy::LEFT.powi(2) || is_nothing();
            is_left.then(|| self.one(joint, left))
        };
        self.joints().filter_map(of).collect()
    }

    /// The joints of whose torque parameters of a log's own leave far more than of those for the
    /// estimate is left.
    fn exceeding(&self, log: usize) -> Vec<Unexplained> {
        let compared = self.compared;
        let own = compared.shared(&[log], &[]).phi;
        let spectra = Spectra::new(compared, &[log], &own);
        let phi = &self.found.solution.phi;
        let of = |joint: usize| {
            let left = compared.left_of(&[log], joint, &own)?;
            let usual = compared.left_of(self.shown, joint, phi)?;
            let known = usual.max(compared.noise_of(&[log], joint));
            let no_noise = spectra.no_noise(&[0], joint);
            let is_much = no_noise > known + policy::BEYOND.powi(2)
                && compared.likelier((log, joint), [known, left]) > NAMED;
            is_much.then(|| Unexplained { beside: Some(usual.sqrt()), ..self.one(joint, left) })
        };
        self.joints().filter_map(of).collect()
    }

    /// The joints of whose torque in the logs for the estimate something is left that is no noise,
    /// with its share.
    pub(crate) fn lacking(&self) -> Vec<(String, f64)> {
        let of = |joint: usize| {
            let phi = &self.found.solution.phi;
            let no_noise = self.spectra.no_noise(self.shown, joint);
            let name = &self.model.joints[joint].name;
            let left = self.compared.left_of(self.shown, joint, phi)?;
            let is_said = 2.0 * no_noise > left.max(2.0 * policy::SAID.powi(2));
            is_said.then(|| (name.clone(), left.sqrt()))
        };
        (0..self.model.joints.len()).filter_map(of).collect()
    }

    fn joints(&self) -> impl Iterator<Item = usize> {
        (0..self.model.joints.len()).filter(|&joint| !self.model.joints[joint].is_base)
    }

    fn one(&self, joint: usize, left: f64) -> Unexplained {
        let joint = self.model.joints[joint].name.clone();
        Unexplained { joint, file: None, share: left.sqrt(), rest_s: None, beside: None }
    }
}

/// What is to be said of torques of which something is left that is no noise.
pub(crate) fn lacking_text(lacking: &[(String, f64)]) -> Option<String> {
    let of = |(joint, share): &(String, f64)| format!("{joint} ({:.2} %)", 100.0 * share);
    let listed: Vec<String> = lacking.iter().map(of).collect();
    (!listed.is_empty()).then(|| {
        format!(
            "What is left of the torque of {} is no noise: it is alike for longer than the filter \
             makes it. The model lacks something (denavit diagnose looks for it), has other \
             lengths or angles than the robot, or a column is scaled or late. Parameters are off \
             by what that is like, and errors count that only as far as it is like chance.",
            listed.join(", ")
        )
    })
}

/// The joints of whose torque something that is no noise is left while they rest, and more than
/// stiction holds.
fn resting(model: &RegressionModel, log: &Conditioned, found: &Estimate) -> Vec<Unexplained> {
    let rests = |joint: usize| match log.resting[joint] {
        _ if model.joints[joint].is_base || log.torque[joint].is_none() => Vec::new(),
        true => vec![true; log.range.len()],
        false => log.rests(joint),
    };
    let rests: Vec<Vec<bool>> = (0..model.joints.len()).map(rests).collect();
    if !rests.iter().flatten().any(|rests| *rests) {
        return Vec::new();
    }
    let first_s = log.start_s + log.step_s * log.range.start as f64;
    let of = |(joint, share): (usize, f64)| {
        let Range { start, end } = longest(&rests[joint]);
        (share > policy::LEFT_AT_REST).then(|| Unexplained {
            joint: model.joints[joint].name.clone(),
            file: None,
            share,
            rest_s: Some([start, end].map(|at| first_s + log.step_s * at as f64)),
            beside: None,
        })
    };
    shares_at_rest(model, log, (found, &rests)).into_iter().enumerate().filter_map(of).collect()
}

/// The share of each joint's torque that is left at rest beyond what stiction holds, of what is no
/// noise.
fn shares_at_rest(
    model: &RegressionModel,
    log: &Conditioned,
    (found, rests): (&Estimate, &[Vec<bool>]),
) -> Vec<f64> {
    let solution = &found.solution;
    // friction that is not shown holds nothing that is known
    let rows = solution.phi.iter().zip(solution.factor.row_iter());
    let shown: Vec<f64> =
        rows.map(|(phi, row)| if row.norm() > 0.0 { *phi } else { 0.0 }).collect();
    let mut maker = BlockMaker::new(model, log);
    let held: Vec<f64> = (0..rests.len())
        .map(|joint| policy::STICTION * maker.coulomb_friction(joint, &shown))
        .collect();
    let of_joint = |joint: usize| model.pattern()[joint].iter().map(|&at| solution.phi[at]);
    let own: Vec<Vec<f64>> = (0..rests.len()).map(|joint| of_joint(joint).collect()).collect();
    let mut all = vec![(Left::over(samples_of(log, 1.0)), 0.0, VecDeque::new()); rests.len()];
    maker.for_each(|block| {
        let places = || log.places(block.first, block.samples).map(|at| at - log.range.start);
        for (joint, (left, torques, recent)) in all.iter_mut().enumerate() {
            let Some(residual) = block.residual(joint, &own[joint]) else { continue };
            let Some([torque, _]) = &block.torque[joint] else { continue };
            *torques += torque.iter().map(|one| one * one).sum::<f64>() / log.samples() as f64;
            for (one, at) in residual.into_iter().zip(places()) {
                let beyond = (one.abs() - held[joint]).max(0.0).copysign(one);
                let rests = rests[joint].get(at) == Some(&true);
                left.add(rests.then_some(beyond), recent);
            }
        }
    });
    let share = |(left, torques, _): &(Left, f64, _)| match *torques > 0.0 {
        true => (left.without_noise() / torques).sqrt(),
        false => 0.0,
    };
    all.iter().map(share).collect()
}

/// The longest spell of samples.
fn longest(samples: &[bool]) -> Range<usize> {
    let mut longest = 0..0;
    let mut from = 0;
    for (at, is_in) in samples.iter().enumerate() {
        if !is_in {
            from = at + 1;
        } else if at + 1 - from > longest.len() {
            longest = from..at + 1;
        }
    }
    longest
}
