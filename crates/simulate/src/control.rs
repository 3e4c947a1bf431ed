//! Controllers: from what is measured to the torque that is commanded.

use super::planner::Planning;
use denavit_plants::trajectory::{Reference, Setpoint};
use denavit_plants::{Plant, PlantModel};

/// The control of one joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointControl {
    /// What it follows; none leaves feedback out.
    pub reference: Option<Reference>,
    /// [N m/rad, N/m]; with computed torque [1/s^2].
    pub stiffness: f64,
    /// [N m s/rad, N s/m]; with computed torque [1/s].
    pub damping: f64,
    /// What the damping acts on.
    pub damped: Damped,
    /// Factor of both gains, a function of time: a leg that stands is held otherwise than one that
    /// swings; none is 1.
    pub gain_factor: Option<Reference>,
    /// Torque that is added, a function of time: feed-forward, or a log [N m, N].
    pub feed_forward: Option<Reference>,
}

/// What damping acts on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Damped {
    /// The rate of the reference less that of the joint.
    #[default]
    Error,
    /// The rate of the joint: a velocity loop in a position loop.
    Rate,
}

/// What is added to the feedback of the joints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compensation {
    /// Nothing.
    #[default]
    None,
    /// The torque that holds the robot where it is, for the controlled joints.
    Gravity,
    /// D (r'' + kd e' + kp e) + bias: inverse dynamics of the model. Joints without a reference
    /// count as unaccelerated.
    ComputedTorque,
}

/// Where the joints are measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Feedback {
    /// At the joints.
    #[default]
    Joint,
    /// At the motors of series elastic joints, as the joint angle that a relaxed spring would give:
    /// feedback around the spring is stable where feedback through it is not.
    Motor,
}

/// The law of control.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Control {
    /// One entry for each joint of the plant.
    pub joints: Vec<JointControl>,
    /// What the model adds.
    pub compensation: Compensation,
    /// Where the joints are measured.
    pub feedback: Feedback,
    /// Commands are cut at the torque limits of the model.
    pub saturates: bool,
    /// Commands are computed at multiples of this period from delayed, quantised and noisy
    /// measurements, and held in between; none controls continuously.
    pub period_s: Option<f64>,
    /// What plans references during a run; the event-driven scheme alone has it.
    pub planning: Option<Planning>,
}

impl Control {
    /// No torque anywhere.
    pub fn passive(joints: usize) -> Self {
        Self { joints: vec![JointControl::default(); joints], ..Self::default() }
    }

    /// PD control of every joint that has a reference.
    pub fn proportional(references: Vec<Option<Reference>>, stiffness: f64, damping: f64) -> Self {
        let joint =
            |reference| JointControl { reference, stiffness, damping, ..JointControl::default() };
        Self { joints: references.into_iter().map(joint).collect(), ..Self::default() }
    }

    /// What a joint follows at a time; none if it follows nothing.
    pub fn setpoint(&self, joint: usize, t_s: f64) -> Option<Setpoint> {
        self.joints[joint].reference.as_ref().map(|reference| reference.at(t_s))
    }

    /// The first time after `t_s` at which a reference or a feed-forward may jump.
    pub fn next_break(&self, t_s: f64) -> Option<f64> {
        let followed = |joint: &JointControl| {
            let all = [&joint.reference, &joint.feed_forward, &joint.gain_factor];
            all.into_iter().flatten().filter_map(|r| r.next_break(t_s)).reduce(f64::min)
        };
        self.joints.iter().filter_map(followed).reduce(f64::min)
    }

    /// Torque per rate that feedback of the measured rate makes: none where the command is at its
    /// limit, and none of computed torque, whose gains are accelerations.
    pub(super) fn rate_gain(
        &self,
        model: &PlantModel,
        joint: usize,
        t_s: f64,
        command: f64,
    ) -> f64 {
        let law = &self.joints[joint];
        let is_feedback = law.reference.is_some()
            && model.joints[joint].drivable
            && self.compensation != Compensation::ComputedTorque;
        let limited = self.limits(model, joint).is_some_and(|[low, high]| {
            // the command has been cut
            command <= low || command >= high
        });
        if !is_feedback || limited {
            return 0.0;
        }
        law.gain_factor.as_ref().map_or(1.0, |factor| factor.at(t_s).position) * law.damping
    }

    /// The torques at which commands of a joint are cut.
    pub(super) fn limits(&self, model: &PlantModel, joint: usize) -> Option<[f64; 2]> {
        let limits = model.joints[joint].torque_limits.filter(|_| self.saturates);
        limits.map(|[low, high]| [low, high.max(low)])
    }

    /// Commanded torques, joint side [N m, N].
    pub(super) fn command(
        &self,
        plant: &mut dyn Plant,
        t_s: f64,
        q: &[f64],
        qd: &[f64],
        scratch: &mut ControlMemory,
        command: &mut [f64],
    ) {
        match self.compensation {
            Compensation::None => command.fill(0.0),
            Compensation::Gravity => {
                scratch.zero.resize(q.len(), 0.0);
                plant.bias(q, &scratch.zero, command);
            }
            Compensation::ComputedTorque => plant.bias(q, qd, command),
        }
        scratch.wanted.clear();
        for (index, joint) in self.joints.iter().enumerate() {
            let feedback = joint.reference.as_ref().map_or(0.0, |reference| {
                let target = reference.at(t_s);
                let forward = match self.compensation {
                    Compensation::ComputedTorque => target.acceleration,
                    _ => 0.0,
                };
                let factor =
                    joint.gain_factor.as_ref().map_or(1.0, |factor| factor.at(t_s).position);
                let gains = [joint.stiffness, joint.damping].map(|gain| factor * gain);
                let wanted_rate = match joint.damped {
                    Damped::Error => target.rate,
                    Damped::Rate => 0.0,
                };
                forward
                    + gains[0] * (target.position - q[index])
                    + gains[1] * (wanted_rate - qd[index])
            });
            scratch.wanted.push(feedback);
        }
        if self.compensation == Compensation::ComputedTorque {
            let n = q.len();
            scratch.mass.resize(n * n, 0.0);
            plant.mass_matrix(q, &mut scratch.mass);
            for (row, entry) in scratch.mass.chunks_exact(n).zip(command.iter_mut()) {
                *entry += row.iter().zip(&scratch.wanted).map(|(d, a)| d * a).sum::<f64>();
            }
        } else {
            command.iter_mut().zip(&scratch.wanted).for_each(|(entry, add)| *entry += add);
        }
        self.finish(plant.model(), t_s, command);
    }

    fn finish(&self, model: &PlantModel, t_s: f64, command: &mut [f64]) {
        for (index, (joint, entry)) in self.joints.iter().zip(command).enumerate() {
            let is_driven = joint.reference.is_some() || joint.feed_forward.is_some();
            if !is_driven || !model.joints[index].drivable {
                *entry = 0.0;
                continue;
            }
            *entry += joint.feed_forward.as_ref().map_or(0.0, |torque| torque.at(t_s).position);
            if let Some([low, high]) = self.limits(model, index) {
                *entry = entry.clamp(low, high);
            }
        }
    }
}

/// Memory of a controller, so that a call allocates nothing.
#[derive(Clone, Debug, Default)]
pub(super) struct ControlMemory {
    wanted: Vec<f64>,
    mass: Vec<f64>,
    zero: Vec<f64>,
}
