//! Effects of the catalogue as laws on the torques of a robot's joints.

use super::floor::rms;
use super::law::{Law, Motion, Response};
use crate::policy::joint_law::{ALL_GIVEN, OF_NOISE};
use denavit_codegen::effect::SpringSide;
use denavit_evidence::Unpredicted;
use denavit_measure::JointIndex;
use denavit_plants::effect::{AddedTorques, EffectLaw, JointSamples, LawParameter, RobotEffect};

/// An effect that adds to the torque of one joint, or of a pair, or changes the log of a torque.
pub(super) struct JointLaw {
    /// The law.
    pub(super) law: EffectLaw,
    /// Its joint.
    pub(super) joint: JointIndex,
    /// The other joint, for laws of a pair.
    pub(super) other: Option<JointIndex>,
}

/// The samples of a joint in a motion: of its drive, which may be before a spring.
pub(super) fn samples<'m>(
    motion: &Motion<'m>,
    joint: JointIndex,
    other: Option<JointIndex>,
) -> JointSamples<'m> {
    let signals = motion.signals;
    let [qd, qdd] = signals.of_drive(joint);
    let mut samples = JointSamples {
        t: &signals.t,
        q: &signals.q[joint.0],
        qd,
        qdd,
        tau_load: &motion.load[joint.0],
        tau_load_rate: &motion.load_rate[joint.0],
        tau: &motion.total[joint.0],
        ..JointSamples::default()
    };
    if let Some(other) = other {
        samples.q_2 = &signals.q[other.0];
        [samples.qd_2, samples.qdd_2] = signals.of_drive(other).map(Vec::as_slice);
        samples.tau_load_2 = &motion.load[other.0];
        samples.tau_load_rate_2 = &motion.load_rate[other.0];
    }
    samples
}

impl Law for JointLaw {
    fn parameters(&self) -> &[LawParameter] {
        &self.law.parameters
    }

    fn follows_accelerations(&self) -> bool {
        self.law.follows_accelerations()
    }

    fn response(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        let mut response = Response::default();
        let mut add = |law: &EffectLaw, joint: JointIndex, other: Option<JointIndex>| {
            let mut samples = samples(&motion, joint, other);
            let creep = motion.signals.creeping(joint);
            samples.creep = &creep;
            let mut equations = vec![joint.0];
            if let Some(spring) = motion.model.0.spring_equation(joint)
                && law.channel().is_none()
                && law.side == SpringSide::Link
            {
                let signals = motion.signals;
                (samples.qd, samples.qdd) = (&signals.qd[joint.0], &signals.qdd[joint.0]);
                samples.creep = samples.qd;
                if let Some(other) = other {
                    (samples.qd_2, samples.qdd_2) = (&signals.qd[other.0], &signals.qdd[other.0]);
                }
                // What the link feels the spring passes on.
                equations.push(spring);
            }
            let (torque, gradient) = (law.torque(&samples, values), law.gradient(&samples, values));
            response.gradient.resize(gradient.len(), Vec::new());
            for equation in equations {
                response.equations.push(equation);
                response.torque.push(torque.clone());
                let all = response.gradient.iter_mut().zip(&gradient);
                all.for_each(|(of_parameter, column)| of_parameter.push(column.clone()));
            }
        };
        add(&self.law, self.joint, self.other);
        if let (Some(law), Some(other)) = (self.law.on_second(), self.other) {
            add(law, other, Some(self.joint));
        }
        response
    }
}

/// An effect beside a series spring: what it passes on the spring need not.
pub(super) struct SpringLaw {
    /// The law.
    pub(super) law: EffectLaw,
    /// The joint of the spring.
    pub(super) joint: JointIndex,
}

impl Law for SpringLaw {
    fn parameters(&self) -> &[LawParameter] {
        &self.law.parameters
    }

    fn response(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        let Motion { model: (nominal, _), signals, .. } = motion;
        let both = nominal.spring_equation(self.joint).zip(signals.deflection(self.joint));
        let Some((equation, [q, qd])) = both else {
            return Response { gradient: vec![Vec::new(); values.len()], ..Response::default() };
        };
        let samples = JointSamples { t: &signals.t, q: &q, qd: &qd, ..JointSamples::default() };
        let less = |column: Vec<f64>| vec![column.iter().map(|torque| -torque).collect()];
        Response {
            equations: vec![equation],
            torque: less(self.law.torque(&samples, values)),
            gradient: self.law.gradient(&samples, values).into_iter().map(less).collect(),
        }
    }
}

/// An effect that makes a drive give another torque than is logged: what was demanded of it.
///
/// It changes what was measured and not what is computed, so that the law has no torque where
/// nothing was measured. A clip of what was measured has what the model lacks in it only as far as
/// that is beyond the clip, and what is left is then that of the model at the clip. Of what was
/// demanded beyond a clip it says nothing.
pub(super) struct DemandLaw {
    /// The law.
    pub(super) law: EffectLaw,
    /// Its joint.
    pub(super) joint: JointIndex,
}

impl DemandLaw {
    fn measured(&self, motion: &Motion<'_>) -> Vec<f64> {
        let measured = motion.signals.measured_within(self.joint);
        measured.unwrap_or_else(|| vec![0.0; motion.signals.samples()])
    }
}

impl Law for DemandLaw {
    fn parameters(&self) -> &[LawParameter] {
        &self.law.parameters
    }

    fn unpredicted(&self, motion: Motion<'_>, values: &[f64]) -> Unpredicted {
        let measured = self.measured(&motion);
        let samples = JointSamples { tau: &measured, ..samples(&motion, self.joint, None) };
        let torque = self.law.torque(&samples, values);
        let is_cut = |(all, less): &(&f64, &f64)| less.abs() > ALL_GIVEN * all.abs();
        let cut = measured.iter().zip(&torque).filter(is_cut);
        let given: Vec<f64> = cut.map(|(all, less)| all - less).collect();
        let share = given.len() as f64 / measured.len().max(1) as f64;
        Unpredicted { share, left: rms(&given).powi(2) }
    }

    fn response(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        let measured = self.measured(&motion);
        let samples = JointSamples { tau: &measured, ..samples(&motion, self.joint, None) };
        let mut torque = self.law.torque(&samples, values);
        let mut gradient = self.law.gradient(&samples, values);
        let lacks: Vec<f64> = torque.iter().copied().filter(|lack| *lack != 0.0).collect();
        let noise = motion.signals.torque_noise[self.joint.0];
        if rms(&lacks) < OF_NOISE * noise {
            torque.fill(0.0);
            gradient.iter_mut().for_each(|column| column.fill(0.0));
        }
        Response {
            equations: vec![self.joint.0],
            torque: vec![torque],
            gradient: gradient.into_iter().map(|column| vec![column]).collect(),
        }
    }
}

/// A delay of the torque that is logged.
///
/// What was measured is moved back to its time, and not what is computed: all that the model is
/// not sure of would have to be late as well.
pub(super) struct DelayLaw {
    /// The law.
    pub(super) law: JointLaw,
}

impl Law for DelayLaw {
    fn parameters(&self) -> &[LawParameter] {
        self.law.parameters()
    }

    fn follows_accelerations(&self) -> bool {
        true
    }

    fn response(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        let joint = self.law.joint;
        let delay = self.law.law.delay(values);
        let undone = delay.and_then(|(delay_s, gradient)| {
            let [added, rate] = motion.signals.undelayed_within(joint, delay_s)?;
            let by = |slope: &f64| vec![rate.iter().map(|rate| -slope * rate).collect()];
            let gradient = gradient.iter().map(by).collect();
            Some(Response { equations: vec![joint.0], torque: vec![added], gradient })
        });
        undone.unwrap_or_else(|| self.law.response(motion, values))
    }
}

/// An effect that moves what the model says, or a term that it lacks: it acts on all joints.
pub(super) struct RobotLaw {
    /// What it adds.
    pub(super) effect: RobotEffect,
    /// Whether that is before springs: rotors and friction.
    pub(super) is_of_drives: bool,
}

impl Law for RobotLaw {
    fn parameters(&self) -> &[LawParameter] {
        &self.effect.parameters
    }

    fn follows_accelerations(&self) -> bool {
        self.effect.follows_accelerations()
    }

    fn response(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        let signals = motion.signals;
        let [q, qd, qdd] = [&signals.q, &signals.qd, &signals.qdd]
            .map(|all| all.iter().map(Vec::as_slice).collect::<Vec<&[f64]>>());
        let AddedTorques { mut torque, mut gradient } =
            self.effect.torques([&q, &qd, &qdd], values, motion.numbers);
        // What moves the bodies is passed on by the springs.
        if !self.is_of_drives {
            for spring in &motion.model.0.springs {
                let all = gradient.iter_mut().chain([&mut torque]);
                all.for_each(|joints| joints.push(joints[spring.joint.0].clone()));
            }
        }
        Response { equations: (0..torque.len()).collect(), torque, gradient }
    }
}
