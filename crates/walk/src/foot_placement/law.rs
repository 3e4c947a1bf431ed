//! The numbers of the law, and the walk that it is for.

use super::stepper::Stepper;
use crate::gait_plan::SpaceWalk;
use denavit_simulate::{PlanningLaw, ReferencePlanner};
use std::sync::Arc;

/// The numbers of the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootPlacement {
    /// Distance of looks at the state \[s\].
    pub period_s: f64,
    /// How far the divergent component may be from its plan before a new one is made \[m\].
    pub tolerance_m: f64,
    /// How far the centre of pressure goes beyond the divergent component, over how far that is
    /// from its plan: it returns with this times w.
    pub gain: f64,
    /// The centre of pressure stays inside the soles that stand by this \[m\].
    pub margin_m: f64,
    /// How far a landing is moved at most, in all \[m\].
    pub farthest_m: f64,
}

impl Default for FootPlacement {
    fn default() -> Self {
        Self { period_s: 0.01, tolerance_m: 5e-3, gain: 1.0, margin_m: 0.01, farthest_m: 0.3 }
    }
}

/// The law for a walk.
#[derive(Clone, Debug)]
pub(super) struct FootPlacementLaw {
    pub(super) numbers: FootPlacement,
    pub(super) walk: Arc<SpaceWalk>,
}

impl PlanningLaw for FootPlacementLaw {
    fn period_s(&self) -> f64 {
        self.numbers.period_s
    }

    fn begin(&self) -> Box<dyn ReferencePlanner> {
        Box::new(Stepper::new(self.clone()))
    }
}
