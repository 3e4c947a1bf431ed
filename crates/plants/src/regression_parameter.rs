//! Parameters of a regression: as they are reported, as columns, and as the model file has them.

use denavit_codegen::model::{JointEntry, Role};

/// A base parameter as it is reported: a kept column's, or one on a joint axis.
#[derive(Clone, Debug, PartialEq)]
pub struct RegressionParameter {
    /// The name of its column, or of the moment on the axis.
    pub name: String,
    /// The sum that it is, in the names of the standard parameters.
    pub expression: String,
    /// The same as LaTeX.
    pub latex: String,
    /// Its SI unit.
    pub unit: String,
    /// The standard parameters that it is the sum of, by their place, with factors.
    pub members: Vec<(usize, f64)>,
    /// The value that the model gives; none where the model gives none.
    pub value: Option<f64>,
    /// Whether it is one standard parameter by itself.
    pub is_alone: bool,
}

/// A column of R0: what the torques are linear in before columns are grouped.
#[derive(Clone, Debug, PartialEq)]
pub struct StandardParameter {
    /// `mx_LINK`, `fv_LINK`, or a product of the model's unknowns.
    pub name: String,
    /// Its SI unit.
    pub unit: String,
    /// The value that the model gives.
    pub value: Option<f64>,
    /// The link whose body or joint has it, and the prefix of its name; none for products.
    pub owner: Option<(String, &'static str)>,
}

impl StandardParameter {
    /// Whether a joint or its drive has it, not a rigid body: friction, rotor, offset.
    pub fn is_of_joint(&self) -> bool {
        let is_own = |prefix| JointEntry::ALL.iter().any(|entry| entry.prefix() == prefix);
        self.owner.as_ref().is_some_and(|(_, prefix)| is_own(*prefix))
    }
}

/// A number of the model file that identification may change.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelParameter {
    /// The symbol's name, `cx_LINK`.
    pub name: String,
    /// What it belongs to; none for a joint parameter that the model does not have yet, whose
    /// name says what it is.
    pub role: Option<Role>,
    /// The link that it belongs to.
    pub link: Option<String>,
    /// The value that the model gives, 0 where it gives none.
    pub value: f64,
    /// Its standard deviation, if the model states one.
    pub std: Option<f64>,
    /// Whether it is a mass or a moment of inertia, friction or the inertia of a rotor, which
    /// cannot be negative.
    pub is_positive: bool,
}
