//! Effects that the model has: they are not searched, but estimated again within what the model
//! says of their parameters.

use super::candidate::Candidate;
use super::joint_law::JointLaw;
use super::law::{Law, Motion, Response};
use super::state::Taken;
use crate::policy::given::MOST;
use crate::policy::nominal::JOINT;
use denavit_codegen::effect::{Channel, Occurrence};
use denavit_measure::JointIndex;
use denavit_plants::effect::{AddedLaw, LawParameter};

/// What a model says of a parameter of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Belief {
    /// Its value.
    pub value: f64,
    /// Its standard deviation; 0 of one that is certain.
    pub std: f64,
}

/// The law of an effect that the model has.
struct GivenLaw {
    law: JointLaw,
    /// Bounds are where the model believes them.
    parameters: Vec<LawParameter>,
    beliefs: Vec<Belief>,
}

impl Law for GivenLaw {
    fn parameters(&self) -> &[LawParameter] {
        &self.parameters
    }

    fn response(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        self.law.response(motion, values)
    }

    fn beliefs(&self) -> &[Belief] {
        &self.beliefs
    }

    fn follows_accelerations(&self) -> bool {
        self.law.follows_accelerations()
    }
}

/// The effects of a model as candidates that are taken already: those of logged rates are none,
/// since rates are derivatives of positions here. Where the model states no deviation, a parameter
/// may be off as those of joints.
pub fn given_candidates(laws: Vec<AddedLaw>) -> (Vec<Candidate>, Vec<Taken>) {
    let laws = laws.into_iter().filter(|one| one.law.channel() != Some(Channel::Rate));
    let of = |(candidate, one): (usize, AddedLaw)| {
        let AddedLaw { title, at, joint, second, law, values, deviations, .. } = one;
        let belief = |(&value, std): (&f64, &Option<f64>)| Belief {
            value,
            std: std.unwrap_or(JOINT * value.abs()),
        };
        let beliefs: Vec<Belief> = values.iter().zip(&deviations).map(belief).collect();
        let mut parameters = law.parameters.clone();
        for (parameter, Belief { value, std }) in parameters.iter_mut().zip(&beliefs) {
            let [low, high] = parameter.bounds;
            let within = |at: f64| at.clamp(low.min(*value), high.max(*value));
            parameter.bounds = [within(value - MOST * std), within(value + MOST * std)];
        }
        let effect = law.name.clone();
        let joint = JointIndex(joint);
        let law = Box::new(GivenLaw {
            law: JointLaw::new(law, joint, second.map(JointIndex)),
            parameters,
            beliefs,
        });
        let (joint, occurrence) = (Some(joint), Occurrence::default());
        (
            Candidate { effect, title, at, joint, is_body: false, occurrence, law },
            Taken { candidate, values },
        )
    };
    laws.enumerate().map(of).unzip()
}

/// Whether a parameter is where the model's belief ends: the logs would have it beyond.
pub(super) fn is_driven(belief: &Belief, value: f64) -> bool {
    belief.std > 0.0 && (value - belief.value).abs() >= MOST * belief.std * (1.0 - 1e-9)
}
