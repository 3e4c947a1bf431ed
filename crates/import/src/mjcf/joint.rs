//! Joints of MJCF: hinges and slides as they are, balls and free bodies as hinges and slides.

use super::frame::angle_of;
use super::settings::{Attributes, Settings};
use crate::exact::written;
use crate::fault::{Cause, Faults, clip};
use crate::place::{Angle, Pose, Turn, direction};
use crate::tree::{Motion, TreeDrive, TreeJoint, TreeLimits};
use denavit_codegen::number::{Rational, integer};
use num_traits::{Signed, Zero};

/// A joint with the poses before and after it.
pub(crate) struct Freedom {
    pub(crate) before: Vec<Pose>,
    pub(crate) joint: TreeJoint,
    pub(crate) after: Vec<Pose>,
    /// Whether an angle of it was within rounding of a quarter turn.
    pub(crate) is_snapped: bool,
}

impl Freedom {
    fn of(joint: TreeJoint) -> Self {
        Self { before: Vec::new(), joint, after: Vec::new(), is_snapped: false }
    }
}

/// The joints that make one of the file; nothing but faults if it is wrong.
pub(crate) fn joint(
    name: &str,
    attributes: &Attributes<'_>,
    is_free: bool,
    is_driven: bool,
    settings: &Settings<'_>,
    faults: &mut Faults,
) -> Vec<Freedom> {
    let kind = attributes.get("type").map_or("hinge", |kind| kind.text);
    if is_free {
        refuse_forces(name, "free joint", attributes, faults);
        let slides =
            [("x", 0), ("y", 1), ("z", 2)].map(|(end, k)| part(name, end, Motion::Slides, k));
        return slides.into_iter().chain(turns(name)).map(Freedom::of).collect();
    }
    let at =
        attributes.numbers("pos", faults).unwrap_or_else(|| std::array::from_fn(|_| integer(0)));
    let there = Pose::moved(at);
    let back = there.inverse();
    let mut made: Vec<Freedom> = match kind {
        "hinge" => single(name, Motion::Turns, attributes, is_driven, settings, faults)
            .into_iter()
            .collect(),
        "slide" => single(name, Motion::Slides, attributes, is_driven, settings, faults)
            .into_iter()
            .collect(),
        "ball" => {
            refuse_forces(name, "ball", attributes, faults);
            turns(name).map(Freedom::of).into_iter().collect()
        }
        other => {
            let said = format!("no joint has the type \"{}\"", clip(other));
            faults.push(attributes.at, Cause::with_hint(said, "it is hinge, slide, ball or free"));
            Vec::new()
        }
    };
    if let Some(first) = made.first_mut() {
        first.before.push(there);
    }
    if let Some(last) = made.last_mut() {
        last.after.extend(back);
    }
    made
}

/// What acts in all directions alike in a ball does not act alike in three hinges.
fn refuse_forces(name: &str, what: &str, attributes: &Attributes<'_>, faults: &mut Faults) {
    for key in ["stiffness", "damping", "armature", "frictionloss"] {
        if attributes.nonzero(key, faults).is_some() {
            let said =
                format!("the {what} `{}` has {key}, which three hinges have not", clip(name));
            let hint = "a model file has hinges and slides; remove it, or make hinges of the joint";
            faults.push(attributes.at, Cause::with_hint(said, hint));
        }
    }
}

fn turns(name: &str) -> [TreeJoint; 3] {
    [("yaw", 2), ("pitch", 1), ("roll", 0)].map(|(end, k)| part(name, end, Motion::Turns, k))
}

fn part(name: &str, end: &str, motion: Motion, axis: usize) -> TreeJoint {
    let turns = match axis {
        0 => vec![Turn::new(1, Angle::quarter(1))],
        1 => vec![Turn::new(0, Angle::quarter(3))],
        _ => Vec::new(),
    };
    TreeJoint::new(&format!("{name}_{end}"), motion, turns)
}

fn single(
    name: &str,
    motion: Motion,
    attributes: &Attributes<'_>,
    is_driven: bool,
    settings: &Settings<'_>,
    faults: &mut Faults,
) -> Option<Freedom> {
    let axis = match attributes.get("axis") {
        None => [0, 0, 1].map(integer),
        Some(_) => attributes.numbers("axis", faults)?,
    };
    let Some((axis, mut is_snapped)) = direction(&axis) else {
        let said = format!("the axis of joint `{}` has no direction", clip(name));
        faults.push(attributes.at, Cause::new(said));
        return None;
    };
    if attributes.get("springdamper").is_some() {
        let said = format!("joint `{}` has a springdamper", clip(name));
        faults.push(attributes.at, Cause::with_hint(said, "give stiffness and damping"));
    }
    let mut joint = TreeJoint::new(name, motion, axis);
    if let Some(zero) = attributes.get("ref").zip(attributes.nonzero("ref", faults)) {
        match motion {
            Motion::Slides => joint.zero.1 = -zero.1,
            Motion::Turns => {
                let Some(made) = angle_of(zero.0.text.trim(), &zero.1, settings) else {
                    crate::urdf::wrong(zero.0, "`ref`", "an angle", faults);
                    return None;
                };
                is_snapped |= made.is_snapped;
                joint.zero.0 = made.angle.negated();
            }
        }
    }
    joint.limits = limits(motion, attributes, settings, faults);
    joint.drive = drive(motion, attributes, is_driven, settings, faults);
    Some(Freedom { is_snapped, ..Freedom::of(joint) })
}

/// A position of a joint as the model file writes it.
fn position(value: &Rational, motion: Motion, settings: &Settings<'_>) -> String {
    let text = written(value);
    match motion {
        Motion::Turns if settings.degrees && !value.is_zero() => format!("{text}*pi/180"),
        _ => text,
    }
}

fn limits(
    motion: Motion,
    attributes: &Attributes<'_>,
    settings: &Settings<'_>,
    faults: &mut Faults,
) -> TreeLimits {
    let mut ranged = |range: &str, limited: &str| {
        let holds = match attributes.get(limited).map(|word| word.text) {
            Some("true") => true,
            Some("false") => false,
            _ => settings.autolimits,
        };
        let range = attributes.numbers::<2>(range, faults).filter(|_| holds);
        range.filter(|[low, high]| low < high)
    };
    let range = ranged("range", "limited");
    let torque = ranged("actuatorfrcrange", "actuatorfrclimited");
    TreeLimits {
        position: range.map(|ends| ends.each_ref().map(|end| position(end, motion, settings))),
        velocity: None,
        torque: torque.map(|ends| ends.each_ref().map(written)),
    }
}

fn drive(
    motion: Motion,
    attributes: &Attributes<'_>,
    is_driven: bool,
    settings: &Settings<'_>,
    faults: &mut Faults,
) -> TreeDrive {
    let mut given = |key: &str| {
        let found = attributes.nonzero(key, faults)?;
        if found.is_negative() {
            faults.push(attributes.at, Cause::new(format!("`{key}` is negative")));
            return None;
        }
        Some(found)
    };
    let [rotor, viscous, coulomb, stiffness] =
        ["armature", "damping", "frictionloss", "stiffness"].map(&mut given);
    let angle = attributes.nonzero("springref", faults);
    let plain = |value: Option<Rational>| value.map(|value| written(&value));
    TreeDrive {
        is_driven,
        gear_ratio: None,
        rotor_inertia: plain(rotor),
        viscous: plain(viscous),
        coulomb: plain(coulomb),
        spring_angle: angle
            .filter(|_| stiffness.is_some())
            .map(|angle| position(&angle, motion, settings)),
        stiffness: plain(stiffness),
    }
}
