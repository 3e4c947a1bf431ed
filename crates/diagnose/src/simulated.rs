//! The second gap: models in motion. A model that gives the right torques for a motion need not
//! move as the robot does; so each is simulated in short windows from measured states under
//! measured torques, before and after. Drives whose motors were measured before their springs begin
//! with angle and rate of these, and are moved by the motors' torques.

use super::error::Error;
use super::error::ErrorKind::NotMoved;
use super::nominal::Nominal;
use super::state::{Setting, State, Taken};
use denavit_codegen::effect::{Effect, read_estimated_model, read_model};
use denavit_codegen::model::{LinkId, Robot};
use denavit_codegen::number::parse_decimal;
use denavit_measure::condition::Filter;
use denavit_measure::log::MeasuredLog;
use denavit_measure::{JointIndex, Split};
use denavit_plants::effect::apart;
use denavit_plants::model_text::{EffectValues, NewEffect, NewValue, with_effects, with_values};
use denavit_plants::{PlantModel, plant_of};
use denavit_replay::{
    Forward, LONGEST_S, MotionLog, Windows, in_windows, undo_logged_torques, undo_readings,
};

/// How far simulated motions run away from measured ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionGap {
    /// sqrt(mean over joints of (rms error of position / rms of how far it went)^2).
    pub all: f64,
    /// For each joint; none of one that does not move.
    pub per_joint: Vec<Option<f64>>,
    /// Whether the numbers are those that were estimated: they may make no body together.
    pub is_estimated: bool,
}

/// The gaps of the models before and after.
pub type MotionGaps = Split<[MotionGap; 2]>;

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
    fn robot(&self, setting: &Setting<'_>, state: &State) -> Result<(Robot, bool), Error> {
        let (nominal, candidates) = (setting.data.train.nominal, setting.candidates);
        let State { taken, z, .. } = state;
        let values = |one: &Taken| -> EffectValues<'_> {
            let both = candidates[one.candidate].law.parameters().iter().zip(&one.values);
            both.map(|(parameter, value)| (parameter.name.as_str(), *value, None)).collect()
        };
        let (given, found) = taken.split_at(self.numbers.len().min(taken.len()));
        let changed: Vec<(usize, EffectValues<'_>)> =
            self.numbers.iter().copied().zip(given.iter().map(values)).collect();
        let new = found.iter().map(|one| {
            let own = &candidates[one.candidate];
            let (effect, at) = (own.effect.as_str(), own.place(self.effects));
            NewEffect { effect, at, parameters: values(one) }
        });
        let new: Vec<NewEffect<'_>> = new.collect();
        let no_place = format!("{}: no place for what was estimated", nominal.model.model);
        let no_place = || Error::new(NotMoved, no_place.as_str());
        let with = with_effects(self.source, &new, &changed).ok_or_else(no_place)?;
        let moved = moved_numbers(nominal, z, &with).ok_or_else(no_place)?;
        let name = "the model";
        let moved = read_estimated_model(name, moved.as_bytes(), self.effects).ok();
        let moved = moved.and_then(|robot| with_springs(robot, nominal, z));
        if let Some(moved) = moved {
            return Ok((moved, true));
        }
        // Numbers that make no body together, or no spring, stay as they were.
        let as_it_was = read_model(name, with.as_bytes(), self.effects);
        as_it_was.map(|robot| (robot, false)).map_err(|error| Error::of(NotMoved, error))
    }

    /// The gap of a set of logs, with a filter of a cutoff \[Hz\].
    pub(super) fn gap(
        &self,
        logs: &[MeasuredLog],
        cutoff_hz: f64,
        setting: &Setting<'_>,
        state: &State,
    ) -> Result<MotionGap, Error> {
        let (mut robot, is_estimated) = self.robot(setting, state)?;
        let nominal = setting.data.train.nominal;
        let model = nominal.model;
        let zeros = drive_by_motors(&mut robot, nominal, &state.z, logs)?;
        let laws = apart(&robot, self.effects).map_err(|error| Error::of(NotMoved, error))?;
        let mut plant = plant_of(&robot, &[]).map_err(|error| Error::of(NotMoved, error))?;
        if let (Some(joint), true) = (lacks_rotor(plant.model(), logs), zeros.is_some()) {
            let why = format!("the model has no rotor before the spring of `{joint}`");
            return Err(Error::new(NotMoved, why));
        }
        let names: Vec<String> = model.joints.iter().map(|joint| joint.name.clone()).collect();
        let mut joined: Option<Forward> = None;
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
            let mut motion =
                motion.map_err(|error| Error::of(NotMoved, error).in_log(&log.file))?;
            undo_logged_torques(&mut motion, model, &laws.laws);
            let one = in_windows(plant.as_mut(), &motion, windows)
                .map_err(|error| Error::of(NotMoved, error).in_log(&log.file))?;
            match &mut joined {
                Some(joined) => joined.append(one),
                None => joined = Some(one),
            }
        }
        let of = |forward: Forward| {
            let joint = |name: &String| forward.joints.iter().find(|joint| joint.name == *name);
            let gap = |name| Some(joint(name)?.position.relative);
            MotionGap {
                all: forward.relative(),
                per_joint: names.iter().map(gap).collect(),
                is_estimated,
            }
        };
        Ok(joined.map_or_else(|| MotionGap { is_estimated, ..MotionGap::default() }, of))
    }
}

/// The robot with the stiffness of its springs as z has it; none if that makes no spring.
fn with_springs(mut robot: Robot, nominal: &Nominal<'_>, z: &[f64]) -> Option<Robot> {
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
    nominal: &Nominal<'_>,
    z: &[f64],
    logs: &[MeasuredLog],
) -> Result<Option<Vec<f64>>, Error> {
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
                return Err(Error::new(NotMoved, nominal.lacks_stiffness(JointIndex(joint))));
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
