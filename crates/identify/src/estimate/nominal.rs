//! The model's own values of what is estimated.

use denavit_plants::regression::{RegressionModel, RegressionParameter};

/// The model's own values of phi; what it does not say of joints (friction, rotors, offsets) is
/// taken for 0. None if it does not say all of its bodies.
pub(crate) fn nominal_values(model: &RegressionModel) -> Option<Vec<f64>> {
    let value = |parameter: &RegressionParameter| {
        parameter.value.or_else(|| is_of_joints(model, parameter).then_some(0.0))
    };
    model.axes.iter().map(value).collect()
}

/// Whether joints or their drives alone have a parameter: friction, rotors, offsets.
pub(crate) fn is_of_joints(model: &RegressionModel, parameter: &RegressionParameter) -> bool {
    parameter.members.iter().all(|&(at, _)| model.standard[at].is_of_joint())
}
