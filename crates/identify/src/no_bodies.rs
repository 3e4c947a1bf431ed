//! Estimates that belong to no bodies that exist.

/// Standard errors between an estimate and the nearest bodies from which on what it is from is
/// doubted: good logs have next to none, misread ones any number.
const FAR: f64 = 20.0;

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
