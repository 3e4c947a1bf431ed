//! Weighings and held postures (thesis 3.2.1), joined with logs.

use super::statics_file::read_statics;
use super::{Identified, IdentifyOptions, identify, regression};
use crate::error::{Cause, Error};
use crate::logs::Logs;
use crate::observer::Observer;
use crate::robot_file::RobotFile;
use denavit_identify::Identification;
use denavit_numerics::{Consequences, Equations};
use denavit_plants::regression::RegressionModel;
use denavit_statics::{add_estimate, check_units, static_knowledge};

/// What follows from measurements at rest.
#[derive(Debug)]
pub struct StaticsFound {
    /// Parameters and their columns.
    pub model: RegressionModel,
    /// The equations.
    pub knowledge: Equations,
    /// What follows from them.
    pub found: Consequences,
    /// What was noticed of the logs.
    pub remarks: Vec<String>,
    /// What these say by themselves, if there are any.
    pub of_logs: Option<Box<Identification>>,
    /// Why less follows than might.
    pub reasons: Vec<&'static str>,
    /// Whether the observer stopped the work on the logs, as [`Identified::is_stopped`] says.
    pub is_stopped: bool,
}

impl StaticsFound {
    /// Whether something follows, and nothing contradicts it.
    pub fn is_good(&self) -> bool {
        !self.found.combinations.is_empty() && !self.found.contradicts()
    }
}

/// Says which parameters, or sums of them, follow from the measurements at rest of a file, given as
/// its name and bytes; joined with the logs for the estimate if there are any.
///
/// # Errors
/// All that is wrong with the file or the logs, or why they do not suit the robot.
pub fn identify_statics(
    robot: &RobotFile,
    name: &str,
    bytes: &[u8],
    logs: &Logs,
    options: &IdentifyOptions,
    observer: &mut dyn Observer,
) -> Result<StaticsFound, Error> {
    if let Some(law) = robot.apart.laws.first() {
        return Err(Cause::Effect(robot.whole.name.clone(), law.law.name.clone()).into());
    }
    let model = regression(&robot.apart.robot, options)?;
    let measured = read_statics(name, bytes, &model).map_err(Cause::Scenario)?;
    let wrong = |error| Cause::Statics(name.to_owned(), error);
    if !logs.accepts_suspicious {
        check_units(&model, &measured).map_err(wrong)?;
    }
    let mut knowledge = static_knowledge(&model, &measured).map_err(wrong)?;
    let (mut remarks, mut reasons) = (Vec::new(), Vec::new());
    let (mut of_logs, mut is_stopped) = (None, false);
    if !logs.train.is_empty() {
        let identified = identify(robot, logs, options, observer)?;
        is_stopped = identified.is_stopped;
        remarks.extend(identified.remarks.iter().map(|(file, one)| format!("{file}: {one}")));
        reasons.extend(join(&model, &identified, &mut knowledge));
        of_logs = Some(Box::new(identified.found));
    }
    let found = knowledge.consequences();
    reasons.extend(nothing_follows(&knowledge, &found));
    Ok(StaticsFound { model, knowledge, found, remarks, of_logs, reasons, is_stopped })
}

/// Why nothing follows, if nothing does.
fn nothing_follows(knowledge: &Equations, found: &Consequences) -> Option<&'static str> {
    match (knowledge.count(), found.combinations.len()) {
        (0, _) => Some(
            "Nothing follows: the file has neither weighings nor torques of postures, and no log \
             says more. `denavit schema statics` prints what it may have.",
        ),
        (_, 0) => Some(
            "Nothing follows: no equation has an unknown parameter in it. What is on the scale, or \
             weighs on the joints, is known, or the joints that were held carry nothing.",
        ),
        _ => None,
    }
}

/// Adds what logs say; a remark if only a part of it can be added.
fn join(
    model: &RegressionModel,
    identified: &Identified,
    knowledge: &mut Equations,
) -> Option<&'static str> {
    let estimate = &identified.found.estimate;
    let phi = estimate.solution.phi.as_slice();
    let is_joined = add_estimate(knowledge, model, phi, &estimate.covariance);
    (!is_joined).then_some(
        "The logs leave directions of the parameters open: they are not joined with the \
         measurements at rest.",
    )
}
