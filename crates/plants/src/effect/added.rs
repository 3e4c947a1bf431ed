//! The effects that a model has, apart: what moves the robot stays in its equations; laws of joints
//! and of what is logged stand beside them.

use super::{EffectLaw, LawParameter};
use crate::error::{Cause, Error};
use denavit_codegen::effect::{Effect, Law, SpringSide, find, place_name};
use denavit_codegen::model::{AddedEffect, EffectPlace, LinkId, Robot};
use denavit_codegen::program::constant_values;

/// A law that a model has beside its equations, with the values that the model gives.
#[derive(Clone, Debug)]
pub struct AddedLaw {
    /// Its number among the effects of the model.
    pub number: usize,
    /// What it is, in words.
    pub title: String,
    /// Its place: the joint, or `joint with joint`.
    pub at: String,
    /// On which side of the joint's series spring, if the model says that.
    pub side: Option<SpringSide>,
    /// The row of its joint.
    pub joint: usize,
    /// The row of the second joint of a pair.
    pub second: Option<usize>,
    /// The law.
    pub law: EffectLaw,
    /// The values of its parameters.
    pub values: Vec<f64>,
    /// Their standard deviations, where the model states them.
    pub deviations: Vec<Option<f64>>,
}

impl AddedLaw {
    /// The rows of its joint and of the second one of a pair; its own twice where there is none.
    pub fn joints(&self) -> [usize; 2] {
        [self.joint, self.second.unwrap_or(self.joint)]
    }
}

/// A model with effects, apart.
#[derive(Clone, Debug)]
pub struct ApartEffects {
    /// The robot with what moves it and with its terms, at the values that the model gives: these
    /// are known there. It has no effects and no laws.
    pub robot: Robot,
    /// What its equations took up: effect and place.
    pub taken_up: Vec<[String; 2]>,
    /// The others.
    pub laws: Vec<AddedLaw>,
}

/// Takes apart a robot that was read with its effects; `own` are definitions that stand before the
/// shipped ones.
///
/// # Errors
/// [`Error`] where a law of a joint lacks a value.
pub fn apart(robot: &Robot, own: &[Effect]) -> Result<ApartEffects, Error> {
    let (mut taken_up, mut laws) = (Vec::new(), Vec::new());
    for (number, added) in robot.effects.iter().enumerate() {
        let at = place_name(robot, added.at);
        let known = own.iter().find(|effect| effect.name == added.effect);
        let effect = known.or_else(|| find(&added.effect));
        let effect = effect.expect("a robot that was read has effects that are defined");
        match effect.law {
            Law::Moves(_) | Law::Term(_) => taken_up.push([added.effect.clone(), at]),
            Law::Torque(_) | Law::Measured(_) => {
                laws.push(law_of(robot, number, added, effect, at)?);
            }
        }
    }
    let bare = robot.clone();
    let robot = Robot { effects: Vec::new(), laws: Vec::new(), spring_laws: Vec::new(), ..bare };
    Ok(ApartEffects { robot, taken_up, laws })
}

fn law_of(
    robot: &Robot,
    number: usize,
    added: &AddedEffect,
    effect: &Effect,
    at: String,
) -> Result<AddedLaw, Error> {
    let row = |link: LinkId| {
        let row = robot.joints().position(|(joint, _)| joint == link);
        row.expect("an effect of a joint acts on one that moves")
    };
    let (link, second) = match added.at {
        EffectPlace::Pair(link, second) => (link, Some(row(second))),
        EffectPlace::Link(link) => (link, None),
        EffectPlace::Contact(_) | EffectPlace::Model => {
            unreachable!("laws were attached to joints")
        }
    };
    let kind = robot.links[link].joint.kind;
    let law = EffectLaw::new(&effect.on_side(added.side), kind)
        .map_err(|error| Cause::Law(added.effect.clone(), error))?;
    let (mut values, mut deviations) = (Vec::new(), Vec::new());
    for LawParameter { name, .. } in &law.parameters {
        let Some(given) = added.parameters.iter().find(|given| given.name == *name) else {
            let (effect, parameter) = (added.effect.clone(), name.clone());
            return Err(Cause::NoEffectValue { effect, at, parameter }.into());
        };
        values.push(constant_values(&robot.dag, &[given.value])[0]);
        deviations.push(given.std.map(|std| constant_values(&robot.dag, &[std])[0]));
    }
    let (title, joint) = (effect.title.clone(), row(link));
    let side = added.side;
    Ok(AddedLaw { number, title, at, side, joint, second, law, values, deviations })
}
