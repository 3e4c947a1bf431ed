//! Logs that are looked at beside a run of the same robot.

use crate::error::Error;
use crate::logs::{LogSource, Logs};
use denavit_codegen::model::TorqueSide;
use denavit_plants::regression::RegressionJoint;
use denavit_plants::{JointModel, PlantModel};

/// What was measured, beside a run.
#[derive(Clone, Debug)]
pub struct LogBeside {
    /// The log.
    pub file: String,
    /// The time of its first sample, and the distance of samples \[s\].
    pub start_s: f64,
    /// See above.
    pub step_s: f64,
    /// Positions of all joints of the plant [rad, m].
    pub q: Vec<Vec<f64>>,
    /// Their torques, on their side of the gears, where these were measured [N m, N].
    pub torque: Vec<Option<Vec<f64>>>,
    /// What was noticed of it.
    pub remarks: Vec<String>,
}

impl LogBeside {
    /// Reads a log of a plant's joints. It is looked at, and nothing is computed from it: what
    /// looks wrong is a remark.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub fn read(plant: &PlantModel, logs: &Logs, source: &LogSource) -> Result<Self, Error> {
        let joints: Vec<RegressionJoint> = plant.joints.iter().map(joint).collect();
        let log = logs.of_joints(source, &plant.name, &joints)?;
        Ok(Self {
            file: source.to_string(),
            start_s: log.start_s,
            step_s: log.step_s,
            q: log.joints.iter().map(|joint| joint.q.clone()).collect(),
            torque: log.joints.iter().map(|joint| joint.tau.clone()).collect(),
            remarks: log.remarks.iter().map(ToString::to_string).collect(),
        })
    }

    /// The time of its last sample \[s\].
    pub fn end_s(&self) -> f64 {
        let samples = self.q.first().map_or(0, Vec::len);
        self.start_s + self.step_s * samples.saturating_sub(1) as f64
    }

    /// A signal of it at a time, on straight ways between samples; none outside of it.
    pub fn at(&self, signal: &[f64], t_s: f64) -> Option<f64> {
        // a time is a sum of steps, each of which is rounded
        let slack = 1e-6 * self.step_s;
        let inside = t_s >= self.start_s - slack && t_s <= self.end_s() + slack;
        let place = ((t_s - self.start_s) / self.step_s).max(0.0);
        let low = (place.floor() as usize).min(signal.len().saturating_sub(1));
        let first = *signal.get(low).filter(|_| inside)?;
        let next = signal.get(low + 1).copied().unwrap_or(first);
        Some(first + (place - low as f64).clamp(0.0, 1.0) * (next - first))
    }
}

/// A joint of a plant, as logs are read of it.
fn joint(own: &JointModel) -> RegressionJoint {
    let drive = own.drive.as_ref();
    RegressionJoint {
        name: own.name.clone(),
        slides: own.slides,
        is_base: !own.drivable,
        position_limits: own.position_limits,
        velocity_limit: None,
        acceleration_limit: None,
        torque_limits: own.torque_limits,
        gear_ratio: drive.map_or(1.0, |drive| drive.gear_ratio),
        torque_side: TorqueSide::Joint,
        is_driven: drive.is_some(),
        is_elastic: drive.is_some_and(|drive| drive.series_elastic.is_some()),
        spring: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_are_met_between_samples_and_nowhere_else() {
        let log = LogBeside {
            file: "log".to_owned(),
            start_s: 1.0,
            step_s: 0.1,
            q: vec![vec![0.0, 1.0, 3.0]],
            torque: vec![None],
            remarks: Vec::new(),
        };
        let at = |t_s| log.at(&log.q[0], t_s);
        assert!((log.end_s() - 1.2).abs() < 1e-12);
        assert_eq!((at(0.9), at(1.3)), (None, None));
        assert_eq!(at(1.0), Some(0.0));
        assert!((at(1.05).expect("inside") - 0.5).abs() < 1e-9);
        assert!((at(1.175).expect("inside") - 2.5).abs() < 1e-9);
        assert!((at(1.2).expect("the last") - 3.0).abs() < 1e-9);
    }
}
