//! The catalogue in all places of a robot.

use super::candidate::Candidate;
use super::elastic::Spring;
use super::joint_law::{JointLaw, RobotLaw};
use denavit_codegen::effect::{
    Channel, Effect, EffectSite, Law as EffectKindLaw, ModelTerm, SpringSide, with_term,
};
use denavit_codegen::model::{EffectPlace, JointKind, Robot};
use denavit_measure::JointIndex;
use denavit_plants::effect::{EffectLaw, RobotEffect};
use denavit_plants::regression::{RegressionJoint, RegressionModel};

/// Every effect in every place of a robot where it can act.
pub fn candidates(effects: &[Effect], robot: &Robot, model: &RegressionModel) -> Vec<Candidate> {
    let joints = &model.joints;
    let mut all = Vec::new();
    for effect in effects {
        if matches!(effect.law, EffectKindLaw::Moves(_) | EffectKindLaw::Term(_)) {
            all.extend(on_robot(effect, robot, model));
            continue;
        }
        for (place, described) in joints.iter().enumerate().filter(|(_, joint)| !joint.is_base) {
            let joint = JointIndex(place);
            match effect.at {
                EffectSite::Joint => all.extend(on_joint(effect, described, joint, None)),
                EffectSite::JointPair => {
                    // What couples joints is in the wrist or belt between neighbours.
                    let before = place.checked_sub(1).filter(|_| !effect.has_no_order());
                    let beside = [before, Some(place + 1)].into_iter().flatten();
                    let beside = beside.filter(|&other| other < joints.len());
                    all.extend(beside.filter_map(|other| {
                        on_joint(
                            effect,
                            described,
                            joint,
                            Some((JointIndex(other), &joints[other])),
                        )
                    }));
                }
                // springs are not the model's any more: they have candidates of their own
                EffectSite::Spring => {}
                EffectSite::Link | EffectSite::Contact | EffectSite::Model => {}
            }
        }
    }
    all
}

/// Every effect on a series spring in every spring whose balance is measured, and all friction of
/// bearings on the link's side of those: the balance tells on which side it is.
pub fn spring_candidates(
    effects: &[Effect],
    springs: &[Spring],
    model: &RegressionModel,
) -> Vec<Candidate> {
    let is_asked = |one: &&Effect| one.at == EffectSite::Spring || one.is_of_any_bearing();
    let of = |(effect, joint): (&Effect, JointIndex)| {
        let is_behind_spring = effect.at != EffectSite::Spring;
        let effect = effect.on_side(is_behind_spring.then_some(SpringSide::Link));
        let found = on_joint(&effect, &model.joints[joint.0], joint, None)?;
        Some(Candidate { is_behind_spring, ..found })
    };
    let of_effect = |effect| springs.iter().map(move |spring| (effect, spring.joint));
    effects.iter().filter(is_asked).flat_map(of_effect).filter_map(of).collect()
}

/// An effect that changes the model: on each moving link, or on the whole.
fn on_robot(effect: &Effect, robot: &Robot, model: &RegressionModel) -> Vec<Candidate> {
    let joints = &model.joints;
    let numbers: Vec<String> = model.parameters.iter().map(|one| one.name.clone()).collect();
    let places: Vec<(EffectPlace, String, Option<JointIndex>)> = match effect.at {
        EffectSite::Model => vec![(EffectPlace::Model, "model".to_owned(), None)],
        EffectSite::Joint | EffectSite::Link => {
            let moving = robot.joints().map(|(link, _)| {
                let name = robot.links[link].name.clone();
                let joint = joints.iter().position(|joint| joint.name == name);
                (EffectPlace::Link(link), name, joint.map(JointIndex))
            });
            moving.collect()
        }
        EffectSite::Spring | EffectSite::JointPair | EffectSite::Contact => Vec::new(),
    };
    // A term that the model has is not missing; a place without what is moved has no such effect.
    let has_term = |term| with_term(robot.terms, term, true) == robot.terms;
    if matches!(effect.law, EffectKindLaw::Term(term) if has_term(term)) {
        return Vec::new();
    }
    let is_of_drives =
        matches!(effect.law, EffectKindLaw::Term(ModelTerm::Rotor | ModelTerm::Friction));
    let of = |(at, name, joint): (EffectPlace, String, Option<JointIndex>)| {
        let law = RobotEffect::new(robot, effect, at, &numbers).ok()?;
        Some(Candidate {
            effect: effect.name.clone(),
            title: effect.title.clone(),
            at: name,
            joint,
            is_behind_spring: false,
            is_body: effect.at == EffectSite::Link && matches!(effect.law, EffectKindLaw::Moves(_)),
            occurrence: effect.occurrence,
            refines: effect.refines.clone(),
            law: Box::new(RobotLaw { effect: law, is_of_drives }),
        })
    };
    places.into_iter().filter_map(of).collect()
}

fn on_joint(
    effect: &Effect,
    described: &RegressionJoint,
    joint: JointIndex,
    other: Option<(JointIndex, &RegressionJoint)>,
) -> Option<Candidate> {
    let kind = if described.slides { JointKind::Prismatic } else { JointKind::Revolute };
    let law = EffectLaw::new(effect, kind).ok()?;
    // Rates are derivatives of positions here, never those of the log.
    if law.channel() == Some(Channel::Rate) {
        return None;
    }
    let law = Box::new(JointLaw::new(law, joint, other.map(|(other, _)| other)));
    let at = match other {
        Some((_, other)) => format!("{} with {}", described.name, other.name),
        None => described.name.clone(),
    };
    Some(Candidate {
        effect: effect.name.clone(),
        title: effect.title.clone(),
        at,
        joint: Some(joint),
        is_behind_spring: false,
        is_body: false,
        occurrence: effect.occurrence,
        refines: effect.refines.clone(),
        law,
    })
}
