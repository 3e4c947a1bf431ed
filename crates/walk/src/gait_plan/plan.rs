//! What a planner makes: joint references, a start, and every knot with its residual.

use super::curve::JointPath;
use crate::error::{Error, PlanError};
use crate::scenario_file::ContactFriction;
use denavit_plants::PlantModel;
use denavit_plants::trajectory::Reference;

/// Margins that miss what is asked for by less are as asked for \[m\]: postures are found to 1e-11.
pub(super) const ROUNDING_M: f64 = 1e-9;

/// Gains of all driven joints, and the friction of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointGains {
    /// Stiffness [N m/rad].
    pub kp: f64,
    /// Damping [N m s/rad].
    pub kd: f64,
    /// Friction of the ground.
    pub friction: ContactFriction,
}

impl Default for JointGains {
    fn default() -> Self {
        Self { kp: 2000.0, kd: 40.0, friction: ContactFriction::Fallback(0.8) }
    }
}

/// A time at which the plan was checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Knot {
    /// Since the beginning \[s\].
    pub t_s: f64,
    /// The posture, or the phase.
    pub name: String,
    /// All coordinates [rad, m].
    pub q: Vec<f64>,
    /// Whether joint positions were solved for here; else the curves pass through here.
    pub is_solved: bool,
    /// Where solved for, the largest error of a condition [m, rad]; else how far soles are from
    /// where they stand, or below the ground \[m\].
    pub residual: f64,
    /// Of the centre of mass to the edge of the support polygon; negative outside \[m\].
    pub static_margin_m: f64,
    /// Of the planned centre of pressure \[m\]; none where none is planned.
    pub pressure_margin_m: Option<f64>,
}

/// A planned gait.
#[derive(Clone, Debug, PartialEq)]
pub struct GaitPlan {
    /// Time of a step \[s\].
    pub step_s: f64,
    /// Length of a step \[m\].
    pub step_length_m: f64,
    /// Steps that the scenario walks.
    pub steps: usize,
    /// The time of the scenario \[s\].
    pub duration_s: f64,
    /// How far the robot goes in it \[m\].
    pub distance_m: f64,
    /// What each driven joint follows.
    pub paths: Vec<JointPath>,
    /// Whether they repeat.
    pub repeats: bool,
    /// All coordinates at the beginning, where the robot rests [rad, m].
    pub start: Vec<f64>,
    /// The laws of the joints.
    pub gains: JointGains,
    /// Knots in the order of time: of one step where the gait repeats itself, else of all.
    pub knots: Vec<Knot>,
}

/// Joined curves leave what is asked for by at most this between knots: feet that stand give way so
/// far [m, rad].
const BETWEEN: f64 = 0.01;

impl GaitPlan {
    /// The plan, if its curves keep near to what is asked for between the knots, too.
    ///
    /// # Errors
    /// The time at which they leave it most.
    pub(super) fn joined(self) -> Result<Self, Error> {
        match self.worst(false) {
            Some(knot) if knot.residual > BETWEEN || knot.residual.is_nan() => {
                let (posture, t_s, residual) = (knot.name.clone(), knot.t_s, knot.residual);
                Err(PlanError::Between { posture, t_s, residual }.into())
            }
            _ => Ok(self),
        }
    }

    /// The references of all joints, none where nothing drives.
    ///
    /// # Errors
    /// Knots that make no curve.
    pub fn references(&self, model: &PlantModel) -> Result<Vec<Option<Reference>>, Error> {
        let mut references = vec![None; model.joints.len()];
        for path in &self.paths {
            references[path.joint] = Some(path.reference(self.repeats)?);
        }
        Ok(references)
    }

    /// Mean speed over the scenario [m/s].
    pub fn speed_m_s(&self) -> f64 {
        self.distance_m / self.duration_s
    }

    /// The knot with the largest residual among those that were solved for, or among those
    /// between.
    pub fn worst(&self, is_solved: bool) -> Option<&Knot> {
        let own = self.knots.iter().filter(|knot| knot.is_solved == is_solved);
        own.reduce(|worst, knot| if knot.residual > worst.residual { knot } else { worst })
    }

    /// The knot with the least static margin.
    pub fn least_static(&self) -> Option<&Knot> {
        let least = |worst, knot: &'_ Knot| -> bool { knot.static_margin_m < worst };
        self.knots
            .iter()
            .reduce(|worst, knot| if least(worst.static_margin_m, knot) { knot } else { worst })
    }

    /// The knot with the least margin of the planned centre of pressure.
    pub fn least_pressure(&self) -> Option<&Knot> {
        let planned = self.knots.iter().filter(|knot| knot.pressure_margin_m.is_some());
        planned.reduce(
            |worst, knot| {
                if knot.pressure_margin_m < worst.pressure_margin_m { knot } else { worst }
            },
        )
    }
}
