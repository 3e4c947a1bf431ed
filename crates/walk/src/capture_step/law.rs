//! The numbers of the law, and the robot that it is for.

use super::planner::CaptureStepper;
use crate::capturability::StepLimits;
use crate::error::{Error, PlanError};
use crate::gait_plan::{Height, Pose, Sought, Walker};
use denavit_plants::Plant;
use denavit_simulate::{PlanningLaw, ReferencePlanner};

/// The numbers of the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CaptureStep {
    /// Height of the centre of mass above the ground \[m\].
    pub height_m: f64,
    /// From the decision to step to the landing \[s\].
    pub step_s: f64,
    /// The longest step from ankle to ankle, forward and backward \[m\].
    pub longest_m: f64,
    /// Height of the swing foot in the middle of its way \[m\].
    pub lift_m: f64,
    /// Capture point and centre of pressure stay inside the sole by this \[m\].
    pub margin_m: f64,
    /// Distance of looks at the state \[s\].
    pub period_s: f64,
}

/// What suits the shipped planar biped.
impl Default for CaptureStep {
    fn default() -> Self {
        Self {
            height_m: 0.57,
            step_s: 0.3,
            longest_m: 0.3,
            lift_m: 0.03,
            margin_m: 0.02,
            period_s: 0.005,
        }
    }
}

impl CaptureStep {
    /// What a robot with this law can do: its soles less the margin.
    pub fn limits(&self, walker: &Walker) -> StepLimits {
        let foot = walker.feet[0];
        StepLimits {
            gravity_m_s2: walker.gravity,
            height_m: self.height_m,
            heel_m: foot.heel_to_ankle_m - self.margin_m,
            toe_m: foot.ankle_to_toe_m - self.margin_m,
            step_s: self.step_s,
            longest_m: [self.longest_m; 2],
        }
    }
}

/// The law for a robot.
#[derive(Clone, Debug)]
pub struct CaptureStepLaw {
    /// Its numbers.
    pub numbers: CaptureStep,
    pub(super) walker: Walker,
}

/// A law, and where its robot starts.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The law.
    pub law: CaptureStepLaw,
    /// All coordinates: both feet side by side, the middle of the soles under the centre of mass
    /// [rad, m].
    pub start: Vec<f64>,
}

/// The law for a robot, and its posture at the start.
///
/// # Errors
/// Robots that are no planar walkers, postures out of reach, a margin that leaves nothing of the
/// sole.
pub fn capture_step(plant: &mut dyn Plant, numbers: &CaptureStep) -> Result<Prepared, Error> {
    let walker = Walker::of(plant)?;
    let foot = walker.feet[0];
    let half_m = 0.5 * (foot.heel_to_ankle_m + foot.ankle_to_toe_m);
    if numbers.margin_m >= half_m {
        return Err(PlanError::Margin {
            point: "middle of the sole",
            posture: "start".to_owned(),
            t_s: 0.0,
            margin_m: half_m,
            least_m: numbers.margin_m,
        }
        .into());
    }
    let pose = Pose {
        feet_m: [[0.0; 2]; 2],
        center_m: walker.middle_m(),
        height: Height::CenterOfMass(numbers.height_m),
        pitch_rad: 0.0,
    };
    let start = walker.first(plant, &pose, Sought { name: "start", t_s: 0.0 })?.q;
    Ok(Prepared { law: CaptureStepLaw { numbers: *numbers, walker }, start })
}

impl CaptureStepLaw {
    /// The coordinates that it drives.
    pub fn driven(&self) -> &[usize] {
        &self.walker.driven
    }

    /// What the robot can do under it.
    pub fn limits(&self) -> StepLimits {
        self.numbers.limits(&self.walker)
    }
}

impl PlanningLaw for CaptureStepLaw {
    fn period_s(&self) -> f64 {
        self.numbers.period_s
    }

    fn begin(&self) -> Box<dyn ReferencePlanner> {
        Box::new(CaptureStepper::new(self.clone()))
    }
}
