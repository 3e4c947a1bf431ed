//! The second gap: models in motion. A model that gives the right torques for a motion need not
//! move as the robot does; so each is simulated in short windows from measured states under
//! measured torques, before and after. Drives whose motors were measured before their springs begin
//! with angle and rate of these, and are moved by the motors' torques.

use super::candidate::Candidate;
use super::nominal::{Nominal, NominalAt};
use super::state::{Effects, Taken};
use crate::policy::simulated::LONGEST_S;
use denavit_codegen::effect::{Effect, EffectSite, read_estimated_model, read_model};
use denavit_codegen::model::{LinkId, ModelError, Robot};
use denavit_codegen::number::parse_decimal;
use denavit_identify::forward::{Forward, MotionLog, Windows, in_windows};
use denavit_identify::{undo_logged_torques, undo_readings};
use denavit_measure::Split;
use denavit_measure::condition::Filter;
use denavit_measure::log::MeasuredLog;
use denavit_plants::effect::apart;
use denavit_plants::model_text::{
    EffectValues, NewEffect, NewPlace, NewValue, with_effects, with_values,
};
use denavit_plants::{PlantModel, plant_of};
use std::fmt;

/// How far simulated motions run away from measured ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionGap {
    /// sqrt(mean over joints of (rms error of position / rms of how far it went)^2).
    pub all: f64,
    /// For each joint; none of one that does not move.
    pub per_joint: Vec<Option<f64>>,
    /// For each window the squares of it, all joints together.
    pub windows: Vec<f64>,
    /// Whether laws have states: those that the measured motion led to begin each window.
    pub has_states: bool,
    /// Whether the numbers are those that were estimated: they may make no body together.
    pub is_estimated: bool,
}

/// The gaps of the models before and after.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionGaps {
    /// Of the logs that were searched: before, after.
    pub train: [MotionGap; 2],
    /// Of those that judge.
    pub held_out: [MotionGap; 2],
}

/// Why a model is not moved.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum NotMoved {
    /// Its file has no place for what was estimated; holds its name.
    NoPlace(String),
    /// Its file with what was found is not that of a model.
    Unsound(Box<ModelError>),
    /// It cannot be simulated.
    Plant(denavit_plants::Error),
    /// A law lacks a value or a place.
    Law(String),
    /// A log cannot be filtered; holds its name.
    Condition(String, denavit_measure::Error),
    /// A log cannot be simulated again; holds its name.
    Forward(String, denavit_identify::Error),
    /// The motor of a joint is in the logs, and the model gives the spring behind it no stiffness:
    /// holds the joint.
    NoStiffness(String),
    /// The same of the rotor before that spring, which nothing moves then.
    NoRotor(String),
}

impl fmt::Display for NotMoved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoPlace(model) => write!(f, "{model}: no place for what was estimated"),
            Self::Unsound(error) => write!(f, "{error}"),
            Self::Plant(error) => write!(f, "{error}"),
            Self::Law(error) => write!(f, "{error}"),
            Self::Condition(file, error) => write!(f, "{file}: {error}"),
            Self::Forward(file, error) => write!(f, "{file}: {error}"),
            Self::NoStiffness(joint) => {
                write!(f, "the model has no stiffness of the spring behind the motor of `{joint}`")
            }
            Self::NoRotor(joint) => {
                write!(f, "the model has no rotor before the spring of `{joint}`")
            }
        }
    }
}

/// A model as a file, with the logs that it is moved along.
pub struct Moved<'a> {
    /// The text of the model's file.
    pub source: &'a str,
    /// All definitions of effects.
    pub effects: &'a [Effect],
    /// For each effect that the model has beside its equations its number in the file.
    pub numbers: &'a [usize],
    /// The logs that are searched, and those that judge.
    pub logs: Split<Vec<MeasuredLog>>,
}

/// Windows of all logs of a set: of so many the least costs are known well enough to be paired.
const MOST_WINDOWS: usize = 40;

impl Moved<'_> {
    /// The robot with effects at their values, and with the nominal model's numbers moved by z;
    /// whether they are.
    fn robot(
        &self,
        at: NominalAt<'_>,
        Effects { candidates, taken }: Effects<'_>,
    ) -> Result<(Robot, bool), NotMoved> {
        let NominalAt { nominal, z } = at;
        let (given, found) = taken.split_at(self.numbers.len().min(taken.len()));
        let values = |one: &Taken| -> Vec<(String, f64)> {
            let parameters = candidates[one.candidate].law.parameters().iter();
            parameters.map(|one| one.name.clone()).zip(one.values.iter().copied()).collect()
        };
        let given: Vec<(usize, Vec<(String, f64)>)> =
            given.iter().zip(self.numbers).map(|(one, &number)| (number, values(one))).collect();
        let found: Vec<(&Candidate, Vec<(String, f64)>)> =
            found.iter().map(|one| (&candidates[one.candidate], values(one))).collect();
        fn shown(values: &[(String, f64)]) -> EffectValues<'_> {
            values.iter().map(|(name, value)| (name.as_str(), *value, None)).collect()
        }
        let new: Vec<NewEffect<'_>> = found
            .iter()
            .map(|(own, values)| NewEffect {
                effect: &own.effect,
                at: self.place(own),
                parameters: shown(values),
            })
            .collect();
        let changed: Vec<(usize, EffectValues<'_>)> =
            given.iter().map(|(number, values)| (*number, shown(values))).collect();
        let name = || nominal.model.model.clone();
        let with = with_effects(self.source, &new, &changed);
        let with = with.ok_or_else(|| NotMoved::NoPlace(name()))?;
        let moved = moved_numbers(nominal, z, &with).ok_or_else(|| NotMoved::NoPlace(name()))?;
        let name = "the model";
        let moved = read_estimated_model(name, moved.as_bytes(), self.effects).ok();
        let moved = moved.and_then(|robot| with_springs(robot, at));
        if let Some(moved) = moved {
            return Ok((moved, true));
        }
        // Numbers that make no body together, or no spring, stay as they were.
        let as_it_was = read_model(name, with.as_bytes(), self.effects);
        as_it_was.map(|robot| (robot, false)).map_err(|error| NotMoved::Unsound(Box::new(error)))
    }

    fn place<'c>(&self, own: &'c Candidate) -> NewPlace<'c> {
        let known = self.effects.iter().find(|effect| effect.name == own.effect);
        match (known.map(|effect| effect.at), own.at.split_once(" with ")) {
            (Some(EffectSite::Model), _) => NewPlace::Model,
            (_, Some((joint, second))) => NewPlace::Pair(joint, second),
            _ => NewPlace::Link(&own.at),
        }
    }

    /// The gap of a set of logs, with a filter of a cutoff \[Hz\].
    pub(super) fn gap(
        &self,
        logs: &[MeasuredLog],
        cutoff_hz: f64,
        at: NominalAt<'_>,
        effects: Effects<'_>,
    ) -> Result<MotionGap, NotMoved> {
        let (mut robot, is_estimated) = self.robot(at, effects)?;
        let model = at.nominal.model;
        let zeros = drive_by_motors(&mut robot, at, logs)?;
        let laws = apart(&robot, self.effects).map_err(|error| NotMoved::Law(error.to_string()))?;
        let of_springs = robot.spring_laws.iter().flat_map(|own| &own.law.states);
        let has_states = robot.law_states().chain(of_springs).next().is_some()
            || laws.laws.iter().any(|law| law.law.is_transmission());
        let mut plant = plant_of(&robot, &[]).map_err(NotMoved::Plant)?;
        if let (Some(joint), true) = (lacks_rotor(plant.model(), logs), zeros.is_some()) {
            return Err(NotMoved::NoRotor(joint));
        }
        let names: Vec<String> = model.joints.iter().map(|joint| joint.name.clone()).collect();
        let mut joined: Option<Forward> = None;
        let mut lengths = Vec::new();
        let windows =
            Windows { most: MOST_WINDOWS.div_ceil(logs.len().max(1)), ..Windows::default() };
        for log in logs {
            let mut log = log.head((LONGEST_S / log.step_s) as usize + 1);
            undo_readings(&mut log, &laws.laws);
            let filter = Some(Filter { order: 4, cutoff_hz });
            let motion = match &zeros {
                Some(zeros) => MotionLog::with_drives(&log, &names, filter, zeros),
                None => MotionLog::new(&log, &names, filter),
            };
            let file = log.file.clone();
            let mut motion = motion.map_err(|error| NotMoved::Condition(file.clone(), error))?;
            undo_logged_torques(&mut motion, model, &laws.laws);
            let one = in_windows(plant.as_mut(), &motion, windows)
                .map_err(|error| NotMoved::Forward(file, error))?;
            let length = ((windows.length_s / log.step_s).round() as usize).max(1);
            lengths.extend(std::iter::repeat_n(length, one.t_s.len() / length));
            match &mut joined {
                Some(joined) => joined.append(one),
                None => joined = Some(one),
            }
        }
        let gap = joined.map(|forward| MotionGap::new(&forward, &names, &lengths));
        Ok(MotionGap { has_states, is_estimated, ..gap.unwrap_or_default() })
    }
}

/// The robot with the stiffness of its springs as z has it; none if that makes no spring.
fn with_springs(mut robot: Robot, at: NominalAt<'_>) -> Option<Robot> {
    let NominalAt { nominal, z } = at;
    let links: Vec<LinkId> = robot.joints().map(|(link, _)| link).collect();
    for (spring, stiffness) in nominal.springs.iter().zip(nominal.phi(z).springs) {
        let share = stiffness / spring.stiffness;
        let exact = parse_decimal(&format!("{share:?}")).ok().filter(|_| share > 0.0)?;
        let drive = robot.links[links[spring.joint.0]].drive.as_mut()?;
        let elastic = drive.series_elastic.as_mut()?;
        let share = robot.dag.constant(exact);
        elastic.stiffness = robot.dag.mul(elastic.stiffness, share);
    }
    Some(robot)
}

/// Readies a robot for logs of motors before springs: what their zeros are by joint; none if there
/// are no such logs.
///
/// A drive without a rotor is none that moves by itself: so springs whose motors the logs lack pass
/// on the torque that was measured of them.
fn drive_by_motors(
    robot: &mut Robot,
    at: NominalAt<'_>,
    logs: &[MeasuredLog],
) -> Result<Option<Vec<f64>>, NotMoved> {
    let NominalAt { nominal, z } = at;
    let links: Vec<LinkId> = robot.joints().map(|(link, _)| link).collect();
    let is_measured = |joint: usize| logs.iter().any(|log| log.joints[joint].motor.is_some());
    if !(0..links.len()).any(is_measured) {
        return Ok(None);
    }
    let mut zeros = vec![0.0; links.len()];
    for (spring, zero) in nominal.springs.iter().zip(nominal.zeros_of_springs(z)) {
        zeros[spring.joint.0] = zero;
    }
    for (joint, link) in links.into_iter().enumerate() {
        let has_spring = nominal.springs.iter().any(|spring| spring.joint.0 == joint);
        let drive = robot.links[link].drive.as_mut();
        match drive.filter(|drive| drive.series_elastic.is_some()) {
            Some(drive) if !is_measured(joint) => drive.rotor_inertia = None,
            Some(_) if !has_spring => {
                return Err(NotMoved::NoStiffness(nominal.model.joints[joint].name.clone()));
            }
            _ => {}
        }
    }
    Ok(Some(zeros))
}

/// A joint whose motor was measured before a spring, and has no rotor that could be moved.
fn lacks_rotor(model: &PlantModel, logs: &[MeasuredLog]) -> Option<String> {
    let is_measured = |joint: &usize| logs.iter().any(|log| log.joints[*joint].motor.is_some());
    let lacks =
        |joint: &usize| model.joints[*joint].drive.is_none_or(|drive| drive.rotor_inertia <= 0.0);
    let joint = model.sprung_joints().find(|joint| is_measured(joint) && lacks(joint))?;
    Some(model.joints[joint].name.clone())
}

/// The text with the nominal model's numbers moved by z.
fn moved_numbers(nominal: &Nominal<'_>, z: &[f64], text: &str) -> Option<String> {
    let parameters = &nominal.model.parameters;
    let of = |(one, z): (&super::nominal::Uncertain, &f64)| {
        let parameter = parameters.iter().find(|own| own.name == one.name)?;
        let value = one.value + one.std * z;
        let value = if one.is_positive { value.max(0.0) } else { value };
        Some(NewValue { parameter, value, std: None })
    };
    let values: Vec<NewValue<'_>> = nominal.uncertain.iter().zip(z).filter_map(of).collect();
    with_values(text, &values)
}

impl MotionGap {
    /// `lengths` are the samples of each window.
    fn new(forward: &Forward, names: &[String], lengths: &[usize]) -> Self {
        let of = |name: &String| {
            let joint = forward.joints.iter().find(|joint| joint.name == *name);
            joint.map(|joint| joint.position.relative)
        };
        let mut windows = vec![0.0; lengths.len()];
        for joint in &forward.joints {
            let mut errors = joint.position.residual();
            for (window, &length) in windows.iter_mut().zip(lengths) {
                let squares = errors.by_ref().take(length).map(|error| error * error);
                *window += squares.sum::<f64>() / joint.position.size.powi(2);
            }
        }
        Self {
            all: forward.relative(),
            per_joint: names.iter().map(of).collect(),
            windows,
            has_states: false,
            is_estimated: true,
        }
    }
}
