//! Estimates that belong to no bodies that exist.

use crate::policy::no_bodies::FAR;

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
