//! Trajectories within the limits of a robot, for who wants something else of them than a small
//! condition number.

use super::error::Error;
use super::model::Evaluators;
use super::{
    Check, ExciteOptions, ExcitedModel, Search, Space, Stack, prepared, references, trajectory_file,
};
use denavit_codegen::model::Robot;
use denavit_plants::trajectory::Reference;
use serde_json::Value;

/// The trajectories of a family that keep the limits of a robot.
pub struct Feasible {
    options: ExciteOptions,
    model: ExcitedModel,
    space: Space,
    stack: Stack,
    evaluators: Evaluators,
}

impl Feasible {
    /// Those of the family, the duration and the ends of `options`.
    ///
    /// # Errors
    /// As for [`excite`](super::excite): limits that are missing, options that contradict.
    pub fn new(robot: &Robot, options: &ExciteOptions) -> Result<Self, Error> {
        let (model, space, stack, evaluators) = prepared(robot, options)?;
        Ok(Self { options: options.clone(), model, space, stack, evaluators })
    }

    /// Coordinates of a trajectory at random, made smaller until it keeps all limits; none if even
    /// rest does not.
    pub fn random(&mut self, start: usize) -> Option<Vec<f64>> {
        let x = self.search().beginning(start);
        self.within(x)
    }

    /// A trajectory made smaller about its middle until it keeps all limits; none if rest does not.
    pub fn within(&mut self, x: Vec<f64>) -> Option<Vec<f64>> {
        let Self { options, model, space, stack, evaluators } = self;
        let search = Search { options, model, space, stack };
        let (x, _) = search.within_limits(x, evaluators);
        search.is_safe(&x, evaluators).then_some(x)
    }

    /// The use that a trajectory makes of the limits.
    pub fn check(&mut self, x: &[f64]) -> Check {
        let Self { options, model, space, stack, evaluators } = self;
        Search { options, model, space, stack }.judged(x, evaluators)
    }

    /// What the joints follow, in the order of q.
    pub fn references(&self, x: &[f64]) -> Vec<Reference> {
        references(&self.model, &self.space, x)
    }

    /// The trajectory file; remarks say how it was found.
    pub fn to_json(&self, x: &[f64], name: &str, remarks: &Value) -> Value {
        trajectory_file(&self.model, &self.space, x, name, remarks)
    }

    fn search(&self) -> Search<'_> {
        let Self { options, model, space, stack, .. } = self;
        Search { options, model, space, stack }
    }
}
