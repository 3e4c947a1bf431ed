//! Estimates that belong to no bodies that exist, and logs of another robot.

use crate::policy::no_bodies::{FAR, OTHER};

/// What it may mean that the nearest bodies are so many standard errors away; none if near.
pub(super) fn no_bodies(distance: f64) -> Option<String> {
    (distance > FAR).then(|| {
        format!(
            "What was found is {distance:.0} standard errors from the nearest bodies that exist, \
             over all parameters. The unit of the time or of another column may be another, or the \
             robot, or it shows an effect that the model lacks; what was found is not to be \
             believed."
        )
    })
}

/// What is to be said if the model's own values leave so many times the torques; none if few.
pub(super) fn other_robot(before: Option<f64>) -> Option<String> {
    let before = before.filter(|before| *before > OTHER)?;
    Some(format!(
        "With the model's own values {before:.0} times the torques are left: the log is of another \
         robot, or the values of the model are far off."
    ))
}
