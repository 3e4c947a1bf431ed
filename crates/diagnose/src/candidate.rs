//! What may be missing: an effect of the catalogue in one place of the robot.

use super::law::Law;
use crate::policy::candidate::{LIMITS, PLACES};
use denavit_codegen::effect::{Effect, EffectSite, Occurrence};
use denavit_evidence::policy;
use denavit_measure::JointIndex;
use denavit_plants::effect::LawParameter;
use denavit_plants::model_text::NewPlace;
use std::f64::consts::TAU;

/// An effect in one place.
pub struct Candidate {
    /// The effect's name in the catalogue.
    pub effect: String,
    /// What it is, in words.
    pub title: String,
    /// The joint, link or pair of joints where it acts, or `model`.
    pub at: String,
    /// The joint that it acts on; none for what acts on the whole robot.
    pub joint: Option<JointIndex>,
    /// Whether that is on the link's side of its series spring, where others of the name are on
    /// the motor's.
    pub is_behind_spring: bool,
    /// Whether it adds to the inertial parameters of a body, as the model's numbers may be off.
    pub is_body: bool,
    /// How often such an effect is met before any log is looked at.
    pub occurrence: Occurrence,
    /// Effects that it is a finer form of, by name.
    pub refines: Vec<String>,
    /// What it does.
    pub law: Box<dyn Law>,
}

impl Candidate {
    /// How it is written: `stribeck at knee`, `stribeck at knee behind its spring`.
    pub fn name(&self) -> String {
        format!("{} at {}", self.effect, self.at_in_words())
    }

    /// Its place in words.
    pub fn at_in_words(&self) -> String {
        let behind = if self.is_behind_spring { " behind its spring" } else { "" };
        format!("{}{behind}", self.at)
    }

    /// Whether every drive has it.
    pub(super) fn is_standard(&self) -> bool {
        self.occurrence == Occurrence::Standard
    }

    /// Whether it is met more often than another one, or as often with fewer parameters.
    pub(super) fn is_plainer_than(&self, other: &Self) -> bool {
        let key = |of: &Self| (of.occurrence, of.law.parameters().len());
        key(self) < key(other)
    }

    /// Whether it is another one, but finer.
    pub(super) fn is_finer_than(&self, other: &Self) -> bool {
        let place = |of: &Self| (of.at.clone(), of.is_behind_spring);
        self.refines.contains(&other.effect) && place(self) == place(other)
    }

    /// Its place in the file of a model, by the definitions of effects.
    pub fn place(&self, effects: &[Effect]) -> NewPlace<'_> {
        let known = effects.iter().find(|effect| effect.name == self.effect);
        match (known.map(|effect| effect.at), self.at.split_once(" with ")) {
            (Some(EffectSite::Model), _) => NewPlace::Model,
            (_, Some((joint, second))) => NewPlace::Pair(joint, second),
            _ if self.is_behind_spring => NewPlace::BehindSpring(&self.at),
            _ => NewPlace::Link(&self.at),
        }
    }
}

/// Units of laws that repeat along a joint.
const PER_POSITION: [&str; 2] = ["1/rad", "1/m"];

/// Most points from which one law's parameters are searched: those of a backlash, which has twelve
/// gaps, stiff and soft sides, thin and thick grease, and friction on either side.
const MOST_STARTS: usize = 96;

/// Where the search of a law's parameters begins: their values, and how far each may be from that;
/// none of amplitudes, whose size is that of torques.
pub(super) type Start = Vec<(f64, Option<f64>)>;

/// Where searches of a law's parameters begin: what it is linear in, where it is off; every
/// combination of the values that the other parameters begin with, each within half the distance
/// to its neighbours. Positions without bounds begin within `range`, what the joint covers; one
/// over a limit of torques at limits below the `largest`.
pub(super) fn starts(
    parameters: &[LawParameter],
    range: Option<[f64; 2]>,
    largest: Option<f64>,
    is_of_motion: bool,
) -> Vec<Start> {
    let mut all: Vec<Start> = vec![Vec::new()];
    for parameter in parameters {
        let values = values_of(parameter, range, largest, is_of_motion);
        let longer = |start: &Start| -> Vec<Start> {
            values.iter().map(|own| [start.as_slice(), &[*own]].concat()).collect()
        };
        all = all.iter().flat_map(longer).collect();
    }
    // Thinned evenly, so that the same ones are left for the same law.
    let stride = all.len().div_ceil(MOST_STARTS).max(1);
    all.into_iter().step_by(stride).collect()
}

/// The values that one parameter begins with, and how far each may be off.
fn values_of(
    parameter: &LawParameter,
    range: Option<[f64; 2]>,
    largest: Option<f64>,
    is_of_motion: bool,
) -> Vec<(f64, Option<f64>)> {
    let [low, high] = parameter.bounds;
    let is_position = ["rad", "m"].contains(&parameter.unit.as_str());
    let is_anywhere = is_position && low.is_infinite() && high.is_infinite();
    let is_limit = !parameter.linear && ["1/(N m)", "1/N"].contains(&parameter.unit.as_str());
    let values: Vec<f64> = match (parameter.nominal, range, largest) {
        (Some(off), ..) if parameter.start.is_empty() => {
            return vec![(off, is_position.then_some(policy::ANGLE))];
        }
        (_, _, Some(largest)) if is_limit && largest > 0.0 => {
            LIMITS.iter().map(|share| 1.0 / (share * largest)).collect()
        }
        (None, Some([low, high]), _) if is_anywhere => {
            PLACES.iter().map(|share| low + share * (high - low)).collect()
        }
        (nominal, ..) if parameter.start.is_empty() => vec![nominal.unwrap_or(0.0)],
        _ => parameter.start.clone(),
    };
    // on less than some periods a law that repeats is like any function of the position
    let repeats = PER_POSITION.contains(&parameter.unit.as_str()) && is_of_motion;
    let least = range.map_or(0.0, |[low, high]| policy::PERIODS * TAU / (high - low));
    let has_enough = |value: &f64| !repeats || value.abs() >= least;
    let enough: Vec<f64> = values.iter().copied().filter(has_enough).collect();
    let values = if enough.is_empty() { values } else { enough };
    let span = range.map_or(0.0, |[low, high]| high - low);
    let alone = |value: f64| match (is_position, value == 0.0) {
        (true, _) => policy::LENGTH,
        (false, true) => 1.0,
        (false, false) => value.abs(),
    };
    let of = |value: &f64| {
        let gaps = |sign: f64| {
            let apart = values.iter().map(|other| sign * (other - value)).filter(|by| *by > 0.0);
            apart.min_by(f64::total_cmp)
        };
        let deviation = match (gaps(-1.0), gaps(1.0)) {
            (Some(below), Some(above)) => 0.25 * (below + above),
            // what is anywhere may be where the joint does not come
            (Some(_), None) | (None, Some(_)) if is_anywhere => 0.5 * span,
            (Some(gap), None) | (None, Some(gap)) => 0.5 * gap,
            (None, None) => alone(*value),
        };
        (*value, Some(deviation))
    };
    values.iter().map(of).collect()
}

#[cfg(test)]
#[path = "../tests/unit/candidate.rs"]
mod tests;
