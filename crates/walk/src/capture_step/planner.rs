//! What the controller does at each look: stand, plan to stand anew, or step.

use super::law::CaptureStepLaw;
use super::measured::Measured;
use super::motion::{Motion, Swing};
use super::pendulum::{Pendulum, Pressure};
use super::reach::Reach;
use denavit_plants::Plant;
use denavit_simulate::{JointPlan, ReferencePlanner, Sensed};

/// What the robot does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    /// Nothing is planned yet.
    Begins,
    /// Both feet stand; the pendulum that was planned at a time.
    Stands { since_s: f64, planned: Pendulum, pressure: Pressure },
    /// A foot swings since a time.
    Swings { since_s: f64, side: usize },
}

/// The controller of a run.
pub(super) struct CaptureStepper {
    law: CaptureStepLaw,
    stage: Stage,
}

/// Standing is planned for so long \[s\].
const STANDING_S: f64 = 1.5;
/// A capture point that is farther from the planned one makes a new plan of standing \[m\]; not
/// sooner than a time after the last one \[s\].
const APART_M: f64 = 5e-3;
const AGAIN_S: f64 = 0.05;
/// A foot that has swung for this share of the step time lands where it touches.
const SWUNG: f64 = 0.5;
/// A swing is planned for so long beyond the step time: the foot may be late \[s\].
const LATE_S: f64 = 0.15;
/// Feet that are nearer along x stand side by side \[m\].
const BESIDE_M: f64 = 5e-3;

impl CaptureStepper {
    pub(super) fn new(law: CaptureStepLaw) -> Self {
        Self { law, stage: Stage::Begins }
    }

    fn omega(&self) -> f64 {
        (self.law.walker.gravity / self.law.numbers.height_m).sqrt()
    }

    /// The range of the soles that stand, less the margin \[m\].
    fn range_m(&self, measured: &Measured, standing: [bool; 2]) -> [f64; 2] {
        let feet = measured.ankles_m().map(|ankle| [ankle, 0.0]);
        let [low, high] = self.law.walker.support_m(&feet, standing);
        [low + self.law.numbers.margin_m, high - self.law.numbers.margin_m]
    }

    /// Stands on both feet, or steps, as the capture point asks for.
    fn decide(&mut self, plant: &mut dyn Plant, measured: &Measured) -> Option<Vec<JointPlan>> {
        let [low, high] = self.range_m(measured, [true; 2]);
        let capture_m = measured.pendulum(self.omega()).capture_m;
        if capture_m > high {
            self.step(plant, measured, 1.0)
        } else if capture_m < low {
            self.step(plant, measured, -1.0)
        } else {
            self.stand(plant, measured)
        }
    }

    fn stand(&mut self, plant: &mut dyn Plant, measured: &Measured) -> Option<Vec<JointPlan>> {
        let range_m = self.range_m(measured, [true; 2]);
        let target_m = 0.5 * (range_m[0] + range_m[1]);
        let pressure = Pressure { omega: self.omega(), target_m, range_m };
        let planned = measured.pendulum(self.omega());
        self.stage = Stage::Stands { since_s: measured.t_s, planned, pressure };
        let motion = Motion {
            walker: &self.law.walker,
            measured,
            pressure,
            reach: Reach::of(plant, &self.law.walker, &measured.q),
            height_m: self.law.numbers.height_m,
            swing: None,
            duration_s: STANDING_S,
        };
        motion.plans(plant)
    }

    /// A step forward (1) or backward (-1).
    fn step(
        &mut self,
        plant: &mut dyn Plant,
        measured: &Measured,
        way: f64,
    ) -> Option<Vec<JointPlan>> {
        let (numbers, walker) = (self.law.numbers, &self.law.walker);
        let ankles_m = measured.ankles_m();
        // the left one of two that stand side by side
        let right_is_behind = way * (ankles_m[1] - ankles_m[0]) > BESIDE_M;
        let side = usize::from(!right_is_behind);
        let stance_m = ankles_m[1 - side];
        let standing = [0, 1].map(|foot| foot != side);
        let range_m = self.range_m(measured, standing);
        let target_m = stance_m + walker.middle_m();
        let pressure = Pressure { omega: self.omega(), target_m, range_m };
        let landed = measured.pendulum(self.omega()).after(&pressure, numbers.step_s);
        let wanted_m = landed.capture_m - walker.middle_m() - stance_m;
        let landing_m = stance_m + wanted_m.clamp(-numbers.longest_m, numbers.longest_m);
        self.stage = Stage::Swings { since_s: measured.t_s, side };
        let (step_s, lift_m) = (numbers.step_s, numbers.lift_m);
        let motion = Motion {
            walker: &self.law.walker,
            measured,
            pressure,
            reach: Reach::of(plant, &self.law.walker, &measured.q),
            height_m: numbers.height_m,
            swing: Some(Swing { side, landing_m, step_s, lift_m }),
            duration_s: step_s + LATE_S,
        };
        motion.plans(plant)
    }
}

impl ReferencePlanner for CaptureStepper {
    fn plan(&mut self, plant: &mut dyn Plant, sensed: &Sensed<'_>) -> Option<Vec<JointPlan>> {
        let measured = Measured::of(plant, &self.law.walker, sensed);
        match self.stage {
            Stage::Begins => self.stand(plant, &measured),
            Stage::Stands { since_s, planned, pressure } => {
                let elapsed_s = sensed.t_s - since_s;
                let [low, high] = self.range_m(&measured, [true; 2]);
                let capture_m = measured.pendulum(self.omega()).capture_m;
                let expected_m = planned.after(&pressure, elapsed_s.min(STANDING_S)).capture_m;
                let is_off = (capture_m - expected_m).abs() > APART_M && elapsed_s > AGAIN_S;
                let falls = capture_m < low || capture_m > high;
                (falls || is_off).then(|| self.decide(plant, &measured)).flatten()
            }
            Stage::Swings { since_s, side } => {
                let has_swung = sensed.t_s - since_s > SWUNG * self.law.numbers.step_s;
                let has_landed = has_swung && measured.touches[side];
                has_landed.then(|| self.decide(plant, &measured)).flatten()
            }
        }
    }
}
