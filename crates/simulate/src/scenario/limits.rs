//! Limits of positions and speeds that a run went beyond: a simulation has no end stops.

use super::{RunScheme, Scenario};
use crate::integrate::{Accuracy, Method};
use crate::joint_record::Peak;
use crate::run::Run;
use denavit_codegen::model::Robot;
use denavit_codegen::program::constant_values;

/// What has a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limited {
    /// The position [rad, m].
    Position,
    /// The speed, either way [rad/s, m/s].
    Speed,
}

impl Limited {
    /// What texts call it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Speed => "speed",
        }
    }
}

/// A limit that a run went beyond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exceeded {
    /// The number of the joint in the plant.
    pub joint: usize,
    /// What had the limit.
    pub limited: Limited,
    /// The limit.
    pub limit: f64,
    /// What was farthest beyond it, and when.
    pub worst: Peak,
}

impl Exceeded {
    /// By how much.
    pub fn by(&self) -> f64 {
        (self.worst.value - self.limit).abs()
    }
}

/// The limits of speed of the joints that move.
pub(super) fn speed_limits(robot: &Robot) -> Vec<Option<f64>> {
    let limit = |link| robot.links[link].limits.velocity;
    let value = |limit| constant_values(&robot.dag, &[limit])[0];
    robot.joints().map(|(link, _)| limit(link).map(value)).collect()
}

impl Scenario {
    /// Limits of the model that a run went beyond, by more than the error of its integration.
    pub fn exceeded(&self, run: &Run) -> Vec<Exceeded> {
        let mut all = Vec::new();
        for (joint, record) in run.joints.iter().enumerate() {
            let limited = &self.plant.model().joints[joint];
            let [lowest, highest] = record.position;
            let mut check = |limited, limit: f64, worst: Peak, beyond: f64| {
                // written so that what is no number is beyond
                if beyond.is_nan() || beyond > self.error_at(limit) {
                    all.push(Exceeded { joint, limited, limit, worst });
                }
            };
            if let Some([low, high]) = limited.position_limits {
                check(Limited::Position, low, lowest, low - lowest.value);
                check(Limited::Position, high, highest, highest.value - high);
            }
            if let Some(limit) = self.speed_limits.get(joint).copied().flatten() {
                check(Limited::Speed, limit, record.speed, record.speed.value - limit);
            }
        }
        all
    }

    /// What the integration may miss at such a number; steps of fixed length say nothing of it.
    fn error_at(&self, value: f64) -> f64 {
        match (self.scheme, self.simulation.method) {
            (
                RunScheme::Event,
                Method::DormandPrince(Accuracy { relative, absolute, .. })
                | Method::Radau(Accuracy { relative, absolute, .. }),
            ) => absolute + relative * value.abs(),
            (RunScheme::Event, Method::RungeKutta { .. }) | (RunScheme::TimeStepping, _) => 0.0,
        }
    }
}
