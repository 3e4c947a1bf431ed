//! What was measured, joint by joint.

use super::{LogFault, LogFaults, LogOf, LogRemark, Suspicion, Timing};
use crate::resolution::JointResolution;

/// What was measured of a joint, one entry for each sample.
///
/// Torques are those that the joint needs, positive along its axis. A log has them so; or as those
/// of the motors of stiff drives, if its header says `torque_side: motor`, or if it says nothing
/// and the model's `torque_side` is the motor's. [`super::read_log`] is the one place where gear
/// ratios count.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointSignals {
    /// Position [rad, m].
    pub q: Vec<f64>,
    /// Rate, if it was logged [rad/s, m/s].
    pub qd: Option<Vec<f64>>,
    /// Acceleration, if it was logged [rad/s^2, m/s^2].
    pub qdd: Option<Vec<f64>>,
    /// Torque [N m, N].
    pub tau: Option<Vec<f64>>,
    /// Reference position [rad, m].
    pub reference: Option<Vec<f64>>,
    /// Angle of the motor before a spring, before the gear \[rad\].
    pub motor: Option<Vec<f64>>,
    /// Torque of that motor, before the gear \[N m\].
    pub motor_torque: Option<Vec<f64>>,
    /// The step of the position's staircase, of its encoder and of printing, if it has one
    /// [rad, m].
    pub step: Option<f64>,
    /// The same of the motor \[rad\].
    pub motor_step: Option<f64>,
    /// What the raw cells of each channel tell apart; none of logs that were not read.
    pub resolution: JointResolution,
}

/// A log at equal distances of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredLog {
    /// The name of the file.
    pub file: String,
    /// What the log says of itself.
    pub header: Vec<(String, String)>,
    /// The time of the first sample \[s\].
    pub start_s: f64,
    /// The distance of samples \[s\].
    pub step_s: f64,
    /// How its time stamps scatter about that.
    pub timing: Timing,
    /// The joints, in the order of the model.
    pub joints: Vec<JointSignals>,
    /// Forces of contacts in the world \[N\], x, y, z of each point of the model that the log has.
    pub contacts: Vec<(String, [Vec<f64>; 3])>,
    /// What was found and repaired.
    pub remarks: Vec<LogRemark>,
}

impl MeasuredLog {
    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.joints.first().map_or(0, |joint| joint.q.len())
    }
}

impl MeasuredLog {
    /// The first samples alone.
    pub fn head(&self, samples: usize) -> Self {
        let head = |values: &Vec<f64>| values[..values.len().min(samples)].to_vec();
        let some = |values: &Option<Vec<f64>>| values.as_ref().map(head);
        let joint = |own: &JointSignals| JointSignals {
            q: head(&own.q),
            qd: some(&own.qd),
            qdd: some(&own.qdd),
            tau: some(&own.tau),
            reference: some(&own.reference),
            motor: some(&own.motor),
            motor_torque: some(&own.motor_torque),
            step: own.step,
            motor_step: own.motor_step,
            resolution: own.resolution,
        };
        let contacts = self.contacts.iter();
        Self {
            file: self.file.clone(),
            header: self.header.clone(),
            start_s: self.start_s,
            step_s: self.step_s,
            timing: self.timing,
            joints: self.joints.iter().map(joint).collect(),
            contacts: contacts
                .map(|(name, axes)| (name.clone(), axes.each_ref().map(head)))
                .collect(),
            remarks: self.remarks.clone(),
        }
    }

    /// Sees to it that no joint behind a spring has the torque of its motor alone, which is not
    /// what the joint gets: a fault, or, where suspicions are accepted, a remark, and the motor's
    /// torque is taken for the joint's.
    pub fn require_joint_torques(&mut self, robot: LogOf<'_>) -> Result<(), LogFaults> {
        let mut faults = Vec::new();
        for (own, joint) in self.joints.iter_mut().zip(robot.joints) {
            let (None, Some(command)) = (&own.tau, &own.motor_torque) else { continue };
            let suspicion = Suspicion::CommandOfSpring { joint: joint.name.clone() };
            if robot.accepts_suspicious {
                let factor = joint.gear_ratio;
                own.tau = Some(command.iter().map(|torque| factor * torque).collect());
                self.remarks.push(LogRemark::Accepted(suspicion));
            } else {
                faults.push(LogFault::Suspicion(suspicion));
            }
        }
        if faults.is_empty() { Ok(()) } else { Err(LogFaults { file: self.file.clone(), faults }) }
    }
}
