//! Effects of the catalogue as laws on the torques of a robot's joints.

use super::floor::rms;
use super::given::Belief;
use super::law::{Asked, Law, Motion, OnlyOne, Response};
use crate::policy::joint_law::{ALL_GIVEN, OF_NOISE};
use denavit_codegen::effect::{Channel, EffectSite, SpringSide};
use denavit_evidence::Unpredicted;
use denavit_measure::JointIndex;
use denavit_plants::effect::{
    AddedTorques, EffectLaw, JointSamples, LawParameter, Moves, RobotEffect,
};

/// How a law of a joint meets what was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Acts {
    /// It adds to the torque of its joint, or of a pair, or changes the log of a torque.
    Torque,
    /// It is beside a series spring: what it passes on the spring need not.
    Spring,
    /// It makes a drive give another torque than is logged: what was demanded of it.
    Demand,
    /// It delays the torque that is logged.
    Delay,
    /// It makes a drive follow the torque that is logged.
    Followed,
    /// It is a transmission with play (`drive_law.rs`).
    Play,
    /// The same without.
    Elastic,
    /// It stands between a position or velocity and its log (`reading_law.rs`).
    Reading,
    /// The same, of a joint that crosses a gap behind its drive (`behind_law.rs`).
    Gap,
    /// The same, of a joint that a spring without a gap holds behind its drive.
    Sprung,
}

/// An effect on one joint, or on a pair.
pub(super) struct JointLaw {
    /// The law.
    pub(super) law: EffectLaw,
    /// Its joint.
    pub(super) joint: JointIndex,
    /// The other joint, for laws of a pair.
    other: Option<JointIndex>,
    acts: Acts,
    /// What the model says of its parameters.
    pub(super) beliefs: Vec<Belief>,
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
        tau_load: &motion.torques.load[joint.0],
        tau_load_rate: &motion.torques.load_rate[joint.0],
        tau: &motion.total[joint.0],
        ..JointSamples::default()
    };
    if let Some(other) = other {
        samples.q_2 = &signals.q[other.0];
        [samples.qd_2, samples.qdd_2] = signals.of_drive(other).map(Vec::as_slice);
        samples.tau_load_2 = &motion.torques.load[other.0];
        samples.tau_load_rate_2 = &motion.torques.load_rate[other.0];
    }
    samples
}

impl JointLaw {
    /// A law as it acts on the torques of a log.
    pub(super) fn new(law: EffectLaw, joint: JointIndex, other: Option<JointIndex>) -> Self {
        let acts = match law.channel() {
            None if law.at == EffectSite::Spring => Acts::Spring,
            Some(Channel::Position) if law.has_play() => Acts::Gap,
            Some(Channel::Position) if law.is_transmission() => Acts::Sprung,
            Some(Channel::Torque) if law.has_play() => Acts::Play,
            Some(Channel::Torque) if law.is_transmission() => Acts::Elastic,
            Some(Channel::Torque) if law.follows_log() => Acts::Followed,
            Some(Channel::Torque) if law.is_inverse() => Acts::Demand,
            Some(Channel::Torque) if law.is_delay() => Acts::Delay,
            None | Some(Channel::Torque) => Acts::Torque,
            Some(Channel::Position | Channel::Rate) => Acts::Reading,
        };
        Self { law, joint, other, acts, beliefs: Vec::new() }
    }

    /// What it adds to torques.
    fn added(&self, motion: &Motion<'_>, values: &[f64]) -> Response {
        let mut response = Response::default();
        let mut add = |law: &EffectLaw, joint: JointIndex, other: Option<JointIndex>| {
            let mut samples = samples(motion, joint, other);
            let creep = motion.signals.creeping(joint);
            samples.creep = &creep;
            let mut equations = vec![joint.0];
            if let Some(spring) = motion.nominal.spring_equation(joint)
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
            let (torque, gradient) = law.torque_and_gradient(&samples, values);
            response.gradient.resize(gradient.len(), Vec::new());
            let all = response.gradient.iter_mut().zip(gradient);
            all.for_each(|(own, column)| own.extend(vec![column; equations.len()]));
            response.torque.extend(vec![torque; equations.len()]);
            response.equations.extend(equations);
        };
        add(&self.law, self.joint, self.other);
        if let (Some(law), Some(other)) = (self.law.on_second(), self.other) {
            add(law, other, Some(self.joint));
        }
        response
    }

    /// What a spring need not pass on.
    fn beside_spring(&self, motion: &Motion<'_>, values: &[f64]) -> Response {
        let Motion { nominal, signals, .. } = motion;
        let both = nominal.spring_equation(self.joint).zip(signals.deflection(self.joint));
        let Some((equation, [q, qd])) = both else { return Response::default() };
        let samples = JointSamples { t: &signals.t, q: &q, qd: &qd, ..JointSamples::default() };
        let less = |column: Vec<f64>| column.iter().map(|torque| -torque).collect();
        let (torque, gradient) = self.law.torque_and_gradient(&samples, values);
        Response::of(equation, less(torque), gradient.into_iter().map(less))
    }

    /// What was demanded more than was given.
    ///
    /// It changes what was measured and not what is computed, so that the law has no torque where
    /// nothing was measured. A clip of what was measured has what the model lacks in it only as far
    /// as that is beyond the clip, and what is left is then that of the model at the clip. Of what
    /// was demanded beyond a clip it says nothing.
    fn demanded(&self, motion: &Motion<'_>, values: &[f64]) -> Response {
        let mut response = self.followed(motion, values);
        let lacks: Vec<f64> = response.torque[0].iter().copied().filter(|l| *l != 0.0).collect();
        let noise = motion.signals.torque_noise[self.joint.0];
        if rms(&lacks) < OF_NOISE * noise {
            let columns = response.torque.iter_mut().chain(response.gradient.iter_mut().flatten());
            columns.for_each(|column| column.fill(0.0));
        }
        response
    }

    /// What was measured more than a drive gives that follows it.
    fn followed(&self, motion: &Motion<'_>, values: &[f64]) -> Response {
        let measured = self.measured(motion);
        let samples = JointSamples { tau: &measured, ..samples(motion, self.joint, None) };
        let (torque, gradient) = self.law.torque_and_gradient(&samples, values);
        Response::of(self.joint.0, torque, gradient)
    }

    fn measured(&self, motion: &Motion<'_>) -> Vec<f64> {
        let measured = motion.signals.measured_within(self.joint);
        measured.unwrap_or_else(|| vec![0.0; motion.signals.samples()])
    }

    /// What was measured, moved back to its time, and not what is computed: all that the model is
    /// not sure of would have to be late as well.
    fn undelayed(&self, motion: &Motion<'_>, values: &[f64]) -> Option<Response> {
        let (delay_s, gradient) = self.law.delay(values)?;
        let [added, rate] = motion.signals.undelayed_within(self.joint, delay_s)?;
        let by = |slope: &f64| rate.iter().map(|rate| -slope * rate).collect();
        Some(Response::of(self.joint.0, added, gradient.iter().map(by)))
    }

    /// Its torque, with derivatives if these are asked for or come with it.
    fn response_of(&self, motion: &Motion<'_>, values: &[f64], asked: Asked) -> Response {
        let nothing = || {
            let none = vec![0.0; motion.signals.samples()];
            Response::of(self.joint.0, none.clone(), values.iter().map(|_| none.clone()))
        };
        let found = match (self.acts, asked) {
            (Acts::Torque, _) => Some(self.added(motion, values)),
            (Acts::Spring, _) => Some(self.beside_spring(motion, values)),
            (Acts::Demand, _) => Some(self.demanded(motion, values)),
            (Acts::Delay, _) => {
                self.undelayed(motion, values).or_else(|| Some(self.added(motion, values)))
            }
            (Acts::Followed, _) => Some(self.followed(motion, values)),
            (Acts::Play | Acts::Elastic, _) => self.through(motion, values, asked),
            (Acts::Reading, _) => Some(self.read(motion, values)),
            (Acts::Gap | Acts::Sprung, Asked::Gradient) => self.behind(motion, values),
            (Acts::Gap | Acts::Sprung, Asked::Torque) => self.behind_torque(motion, values),
        };
        let mut found = found.unwrap_or_else(nothing);
        if matches!(self.acts, Acts::Delay | Acts::Followed) {
            motion.signals.unbalanced(self.joint, &mut found);
        }
        if self.law.channel() != Some(Channel::Torque) || self.law.is_transmission() {
            motion.torques.beside.logged(&mut found);
        }
        found
    }
}

impl Law for JointLaw {
    fn parameters(&self) -> &[LawParameter] {
        &self.law.parameters
    }

    fn beliefs(&self) -> &[Belief] {
        &self.beliefs
    }

    fn follows_accelerations(&self) -> bool {
        match self.acts {
            Acts::Torque => self.law.follows_accelerations(),
            // What a spring holds is ahead or behind in proportion to a load, and to the noise of
            // that. How it falls through a gap is not; a torque that is moved was measured.
            acts => matches!(acts, Acts::Elastic | Acts::Reading | Acts::Sprung),
        }
    }

    fn is_gain(&self) -> bool {
        self.acts == Acts::Torque && self.law.is_gain()
    }

    fn is_of_motion(&self) -> bool {
        self.law.is_of_motion() && self.law.on_second().is_none_or(EffectLaw::is_of_motion)
    }

    fn only_one_of(&self) -> Option<(OnlyOne, JointIndex)> {
        let of = match self.law.channel()? {
            _ if self.law.is_transmission() => OnlyOne::Transmission,
            Channel::Torque | Channel::Position if self.law.is_timing() => OnlyOne::Lateness,
            _ => return None,
        };
        Some((of, self.joint))
    }

    fn factor(&self, motion: Motion<'_>, values: &[f64]) -> Option<(JointIndex, Vec<f64>)> {
        let factor = self.law.factor(&samples(&motion, self.joint, self.other), values)?;
        Some((self.joint, factor))
    }

    fn unpredicted(&self, motion: Motion<'_>, values: &[f64]) -> Unpredicted {
        if self.acts != Acts::Demand {
            return Unpredicted::default();
        }
        let measured = self.measured(&motion);
        let samples = JointSamples { tau: &measured, ..samples(&motion, self.joint, None) };
        let torque = self.law.torque(&samples, values);
        let is_cut = |(all, less): &(&f64, &f64)| less.abs() > ALL_GIVEN * all.abs();
        let cut = measured.iter().zip(&torque).filter(is_cut);
        let given: Vec<f64> = cut.map(|(all, less)| all - less).collect();
        let share = given.len() as f64 / measured.len().max(1) as f64;
        Unpredicted { share, left: rms(&given).powi(2) }
    }

    fn following(&self) -> Option<(JointIndex, &EffectLaw)> {
        (self.acts == Acts::Followed).then_some((self.joint, &self.law))
    }

    fn response(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        self.response_of(&motion, values, Asked::Gradient)
    }

    fn torque(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        Response { gradient: Vec::new(), ..self.response_of(&motion, values, Asked::Torque) }
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

    fn is_of_motion(&self) -> bool {
        self.effect.is_of_motion()
    }

    fn turns_numbers(&self) -> bool {
        self.effect.turns_numbers()
    }

    fn moves(&self, values: &[f64], numbers: &[f64]) -> Option<Moves> {
        (!self.is_of_drives).then(|| self.effect.moves(values, numbers))
    }

    fn response(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        let signals = motion.signals;
        let [q, qd, qdd] = [&signals.q, &signals.qd, &signals.qdd]
            .map(|all| all.iter().map(|one| one.as_slice()).collect::<Vec<&[f64]>>());
        let AddedTorques { mut torque, mut gradient } = self.effect.torques(
            [&q, &qd, &qdd],
            values,
            &motion.torques.numbers,
            &motion.torques.beside.moves,
        );
        // What moves the bodies is passed on by the springs.
        if !self.is_of_drives {
            for spring in &motion.nominal.springs {
                let all = gradient.iter_mut().chain([&mut torque]);
                all.for_each(|joints| joints.push(joints[spring.joint.0].clone()));
            }
        }
        let mut found = Response { equations: (0..torque.len()).collect(), torque, gradient };
        motion.torques.beside.logged(&mut found);
        found
    }
}
