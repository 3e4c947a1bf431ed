//! That what is left of torques is no noise: something is not as the model has it.

use super::estimate::{Estimate, ShownLogs, no_noise};
use crate::policy::lacking::{OTHER, SAID};
use denavit_plants::regression::RegressionModel;

/// The joints of whose torques, roots of mean squares [N m, N], something is left that is no noise,
/// with its share.
pub(super) fn lacking(
    model: &RegressionModel,
    logs: ShownLogs<'_>,
    found: &Estimate,
    torques: &[f64],
) -> Vec<(String, f64)> {
    let left = no_noise(model, logs, found).into_iter();
    left.filter(|&(joint, left)| left > SAID * torques[joint.0])
        .map(|(joint, left)| (model.joints[joint.0].name.clone(), left / torques[joint.0]))
        .collect()
}

/// What is to be said if the model's own values leave far more than there is.
pub(super) fn other_robot(before: Option<f64>) -> Option<String> {
    let before = before.filter(|before| *before > OTHER)?;
    Some(format!(
        "With the model's own values {before:.0} times the torques are left: the log is of another \
         robot, or the values of the model are far off."
    ))
}

/// What is to be said of it.
pub(super) fn said(lacking: &[(String, f64)]) -> Option<String> {
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
