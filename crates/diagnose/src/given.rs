//! Effects that the model has: they are not searched, but estimated again within what the model
//! says of their parameters.

use super::candidate::Candidate;
use super::joint_law::JointLaw;
use super::state::{MOST_Z, Taken};
use crate::policy::nominal::JOINT;
use denavit_codegen::effect::{Channel, Occurrence, SpringSide};
use denavit_measure::JointIndex;
use denavit_plants::effect::AddedLaw;

/// What a model says of a parameter of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Belief {
    /// Its value.
    pub value: f64,
    /// Its standard deviation; 0 of one that is certain.
    pub std: f64,
}

/// The effects of a model as candidates that are taken already: those of logged rates are none,
/// since rates are derivatives of positions here. Where the model states no deviation, a parameter
/// may be off as those of joints.
pub fn given_candidates(laws: Vec<AddedLaw>) -> (Vec<Candidate>, Vec<Taken>) {
    let laws = laws.into_iter().filter(|one| one.law.channel() != Some(Channel::Rate));
    let of = |(candidate, one): (usize, AddedLaw)| {
        let AddedLaw { title, at, joint, second, law, values, deviations, side, .. } = one;
        let belief = |(&value, std): (&f64, &Option<f64>)| Belief {
            value,
            std: std.unwrap_or(JOINT * value.abs()),
        };
        let beliefs: Vec<Belief> = values.iter().zip(&deviations).map(belief).collect();
        let (effect, is_behind_spring) = (law.name.clone(), side == Some(SpringSide::Link));
        let mut law = JointLaw::new(law, JointIndex(joint), second.map(JointIndex));
        for (parameter, Belief { value, std }) in law.law.parameters.iter_mut().zip(&beliefs) {
            let [low, high] = parameter.bounds;
            let within = |at: f64| at.clamp(low.min(*value), high.max(*value));
            parameter.bounds = [within(value - MOST_Z * std), within(value + MOST_Z * std)];
        }
        law.beliefs = beliefs;
        let law = Box::new(law);
        let (joint, occurrence) = (Some(JointIndex(joint)), Occurrence::default());
        (
            Candidate {
                effect,
                title,
                at,
                joint,
                is_behind_spring,
                is_body: false,
                occurrence,
                refines: Vec::new(),
                law,
            },
            Taken { candidate, values },
        )
    };
    laws.enumerate().map(of).unzip()
}

/// Whether a parameter is where the model's belief ends: the logs would have it beyond.
pub(super) fn is_driven(belief: &Belief, value: f64) -> bool {
    belief.std > 0.0 && (value - belief.value).abs() >= MOST_Z * belief.std * (1.0 - 1e-9)
}
