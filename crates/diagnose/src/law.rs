//! What an effect does to the torques of a log: its law on numbers.

use super::data::ModelTorques;
use super::given::Belief;
use super::load_slopes::LoadSlopes;
use super::nominal::Nominal;
use super::rows::{PerJoint, of_axes, torques};
use super::signals::Signals;
use denavit_evidence::Unpredicted;
use denavit_measure::JointIndex;
use denavit_plants::effect::{EffectLaw, LawParameter, Moves};
use std::rc::Rc;

/// What a law may depend on: the motion of a log and the torques that the model gives it; those
/// that were measured only where a law cuts them.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// The nominal model.
    pub nominal: &'a Nominal<'a>,
    /// Positions, rates and accelerations at the full rate.
    pub signals: &'a Signals,
    /// What the model gives the motion.
    pub torques: &'a ModelTorques,
    /// All of that without effects, or the part that a gain is asked of [N m, N].
    pub total: &'a PerJoint,
}

impl Motion<'_> {
    /// What loads change by where a joint moves a little otherwise.
    pub(super) fn load_slopes(&self, joint: JointIndex) -> Rc<LoadSlopes> {
        let Self { nominal, signals, torques: ModelTorques { phi, slopes, .. }, .. } = self;
        let last = slopes.borrow().clone().filter(|slopes| slopes.joint == joint);
        last.unwrap_or_else(|| {
            let own = Rc::new(LoadSlopes::new(nominal, signals, phi, joint));
            slopes.replace(Some(Rc::clone(&own)));
            own
        })
    }

    /// What accelerations ask for of all torques, or the rest of them [N m, N].
    pub(super) fn part(&self, is_asked: bool) -> PerJoint {
        let of_joint = |joint: usize| {
            let (inertia, [_, qdd]) =
                (self.torques.drives[joint].inertia, self.signals.of_drive(JointIndex(joint)));
            let load = self.own_load(joint).zip(qdd);
            let asked = load.map(|(load, qdd)| load + inertia * qdd);
            let both = asked.zip(&self.total[joint]);
            both.map(|(asked, total)| if is_asked { asked } else { total - asked }).collect()
        };
        (0..self.torques.drives.len()).map(of_joint).collect()
    }

    /// Torques of the model's own bodies [N m, N].
    fn own_load(&self, joint: usize) -> impl Iterator<Item = f64> {
        let more = self.torques.beside.loads.get(joint).into_iter().flatten();
        let more = more.copied().chain(std::iter::repeat(0.0));
        self.torques.load[joint].iter().zip(more).map(|(load, more)| load - more)
    }

    /// What bodies ask of all equations more in another motion, whose drives move as in this one
    /// [N m, N].
    pub(super) fn loads_beyond(&self, signals: &Signals) -> PerJoint {
        let nominal = self.nominal;
        let mut loads = of_axes(nominal, signals, &self.torques.phi.loads, true);
        for (joint, load) in loads.iter_mut().enumerate() {
            load.iter_mut().zip(self.own_load(joint)).for_each(|(load, own)| *load -= own);
        }
        let sprung = nominal.springs.iter().map(|spring| loads[spring.joint.0].clone());
        loads.extend(sprung.collect::<PerJoint>());
        loads
    }

    /// The inertia of the bodies about a joint where all joints are at 0 [kg m^2, kg].
    pub(super) fn inertia_at_zero(&self, joint: JointIndex) -> f64 {
        let (model, ModelTorques { phi, drives, .. }) = (self.nominal.model, self.torques);
        let joints = model.joints.len();
        let mut both = vec![vec![0.0; 2]; 3 * joints];
        both[2 * joints + joint.0][1] = 1.0;
        let torques = model.torques(&both, &phi.axes).swap_remove(joint.0);
        torques[1] - torques[0] - drives[joint.0].inertia
    }

    /// The torques that the model without effects gives another motion [N m, N].
    pub fn torques_of(&self, signals: &Signals) -> PerJoint {
        torques(self.nominal, signals, &self.torques.phi)
    }
}

/// Torques that a law adds at the samples of a motion, and their derivatives by its parameters.
#[derive(Clone, Debug, Default)]
pub struct Response {
    /// The equations that the law acts on: those of joints, then those of springs.
    pub equations: Vec<usize>,
    /// For each of them the torque [N m, N].
    pub torque: PerJoint,
    /// For each parameter and each of the equations the derivative.
    pub gradient: Vec<PerJoint>,
}

impl Response {
    /// A torque in one equation, with its derivative by each parameter.
    pub(super) fn of(
        equation: usize,
        torque: Vec<f64>,
        gradient: impl IntoIterator<Item = Vec<f64>>,
    ) -> Self {
        let gradient = gradient.into_iter().map(|column| vec![column]).collect();
        Self { equations: vec![equation], torque: vec![torque], gradient }
    }
}

/// The derivatives of torques by each parameter, from differences.
pub(super) fn differences(
    torques: impl Fn(&[f64]) -> PerJoint,
    at: &PerJoint,
    values: &[f64],
    step: impl Fn(usize) -> f64,
) -> Vec<PerJoint> {
    let by = |place: usize| {
        let (mut moved, step) = (values.to_vec(), step(place));
        moved[place] += step;
        let slope = |(a, b): (&f64, &f64)| (a - b) / step;
        let of = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(slope).collect();
        torques(&moved).iter().zip(at).map(of).collect()
    };
    (0..values.len()).map(by).collect()
}

/// What is asked of a law, where its derivatives take much longer than its torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Asked {
    Torque,
    Gradient,
}

/// What a joint has one of: what two laws of it do does not add up, or is not told apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnlyOne {
    /// What is between its drive and its link.
    Transmission,
    /// How late its torque is after its position.
    Lateness,
}

/// A law: torques as a function of motion and parameters.
pub trait Law {
    /// Its parameters.
    fn parameters(&self) -> &[LawParameter];

    /// What it adds to the torques of a motion.
    fn response(&self, motion: Motion<'_>, values: &[f64]) -> Response;

    /// The same without derivatives, for a first look: at least in the equation of its joint.
    fn torque(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        Response { gradient: Vec::new(), ..self.response(motion, values) }
    }

    /// Whether what it adds is made of accelerations, or of torques that answer them: beyond the
    /// frequencies that references drive these have the same noise as what they would explain.
    fn follows_accelerations(&self) -> bool {
        false
    }

    /// Whether it is in proportion to all that the model gives its joint: friction is known beyond
    /// these frequencies as well.
    fn is_gain(&self) -> bool {
        false
    }

    /// Whether it is a function of the motion alone: the same whatever the model's numbers are.
    fn is_of_motion(&self) -> bool {
        false
    }

    /// What a joint has one of, and the joint, of laws that are exchanged and never added.
    fn only_one_of(&self) -> Option<(OnlyOne, JointIndex)> {
        None
    }

    /// What it moves that other laws depend on, of a law that moves bodies or adds some.
    fn moves(&self, _values: &[f64], _numbers: &[f64]) -> Option<Moves> {
        None
    }

    /// Whether it turns what the model's own numbers do.
    fn turns_numbers(&self) -> bool {
        false
    }

    /// The joint whose torque it multiplies in a log, and by what.
    fn factor(&self, _motion: Motion<'_>, _values: &[f64]) -> Option<(JointIndex, Vec<f64>)> {
        None
    }

    /// The samples of which the law says nothing: it takes what was measured as it is.
    fn unpredicted(&self, _motion: Motion<'_>, _values: &[f64]) -> Unpredicted {
        Unpredicted::default()
    }

    /// The joint and the law of a drive that follows what was measured.
    fn following(&self) -> Option<(JointIndex, &EffectLaw)> {
        None
    }

    /// What the model says of its parameters; nothing of laws that the model does not have.
    fn beliefs(&self) -> &[Belief] {
        &[]
    }
}
