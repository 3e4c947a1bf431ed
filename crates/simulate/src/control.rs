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
        let ControlMemory { wanted, mass, asked, .. } = scratch;
        let asked = asked.at(&self.joints, t_s);
        wanted.clear();
        for (index, (joint, asked)) in self.joints.iter().zip(asked).enumerate() {
            let feedback = asked.target.map_or(0.0, |target| {
                let forward = match self.compensation {
                    Compensation::ComputedTorque => target.acceleration,
                    _ => 0.0,
                };
                let gains = [joint.stiffness, joint.damping].map(|gain| asked.factor * gain);
                let wanted_rate = match joint.damped {
                    Damped::Error => target.rate,
                    Damped::Rate => 0.0,
                };
                forward
                    + gains[0] * (target.position - q[index])
                    + gains[1] * (wanted_rate - qd[index])
            });
            wanted.push(feedback);
        }
        if self.compensation == Compensation::ComputedTorque {
            let n = q.len();
            mass.resize(n * n, 0.0);
            plant.mass_matrix(q, mass);
            for (row, entry) in mass.chunks_exact(n).zip(command.iter_mut()) {
                *entry += row.iter().zip(&*wanted).map(|(d, a)| d * a).sum::<f64>();
            }
        } else {
            command.iter_mut().zip(&*wanted).for_each(|(entry, add)| *entry += add);
        }
        self.finish(plant.model(), asked, command);
    }

    fn finish(&self, model: &PlantModel, asked: &[Asked], command: &mut [f64]) {
        for (index, (asked, entry)) in asked.iter().zip(command).enumerate() {
            let is_driven = asked.target.is_some() || asked.torque.is_some();
            if !is_driven || !model.joints[index].drivable {
                *entry = 0.0;
                continue;
            }
            *entry += asked.torque.unwrap_or(0.0);
            if let Some([low, high]) = self.limits(model, index) {
                *entry = entry.clamp(low, high);
            }
        }
    }
}

/// What functions of time ask of a joint at one time.
#[derive(Clone, Copy, Debug)]
struct Asked {
    target: Option<Setpoint>,
    /// Of both gains.
    factor: f64,
    torque: Option<f64>,
}

/// Memory of a controller, so that a call allocates nothing. It is that of one control: another
/// one, or other references, need a new one.
#[derive(Clone, Debug, Default)]
pub(super) struct ControlMemory {
    wanted: Vec<f64>,
    mass: Vec<f64>,
    zero: Vec<f64>,
    asked: AskedLately,
}

/// What was asked at the last few times: Newton's iteration comes back to those of its stages,
/// differences of the motion ask at one time again and again.
#[derive(Clone, Debug, Default)]
struct AskedLately {
    /// The time, and an entry for each joint.
    times: [(Option<f64>, Vec<Asked>); 4],
    /// The one that is overwritten next.
    oldest: usize,
}

impl AskedLately {
    fn at(&mut self, joints: &[JointControl], t_s: f64) -> &[Asked] {
        let known = self.times.iter().position(|(time, _)| *time == Some(t_s));
        let slot = known.unwrap_or_else(|| {
            let slot = self.oldest;
            self.oldest = (slot + 1) % self.times.len();
            let (time, asked) = &mut self.times[slot];
            *time = Some(t_s);
            asked.clear();
            asked.extend(joints.iter().map(|joint| Asked::of(joint, t_s)));
            slot
        });
        &self.times[slot].1
    }
}

impl Asked {
    fn of(joint: &JointControl, t_s: f64) -> Self {
        let at = |function: &Option<Reference>| function.as_ref().map(|known| known.at(t_s));
        Self {
            target: at(&joint.reference),
            factor: at(&joint.gain_factor).map_or(1.0, |factor| factor.position),
            torque: at(&joint.feed_forward).map(|torque| torque.position),
        }
    }
}
