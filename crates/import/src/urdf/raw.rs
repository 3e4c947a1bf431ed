//! The links and joints of a file, by name, before they are a tree.

use super::values::{Snapped, missing, name, number, number_or_zero, pose, vector};
use crate::body::{BodyNotes, GivenBody, body};
use crate::exact::Vector;
use crate::fault::{Cause, Faults, clip};
use crate::place::Pose;
use crate::tree::TreeBody;
use crate::xml::{Element, Text};
use denavit_codegen::number::{Rational, integer};
use num_traits::Zero;
use std::collections::BTreeMap;

/// A link.
pub(crate) struct RawLink<'s> {
    pub(crate) name: Text<'s>,
    pub(crate) element: Element<'s>,
    pub(crate) body: Option<TreeBody>,
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Revolute,
    Continuous,
    Prismatic,
    Fixed,
    Planar,
    Floating,
}

/// A joint.
pub(crate) struct RawJoint<'s> {
    pub(crate) name: Text<'s>,
    pub(crate) element: Element<'s>,
    pub(crate) kind: Kind,
    pub(crate) origin: Pose,
    pub(crate) axis: Vector,
    pub(crate) parent: Text<'s>,
    pub(crate) child: Text<'s>,
}

/// What a transmission says of a joint.
#[derive(Clone, Debug, Default)]
pub(crate) struct Transmission {
    pub(crate) reduction: Option<Rational>,
    pub(crate) rotor_inertia: Option<Rational>,
}

/// All of a file.
pub(crate) struct Raw<'s> {
    pub(crate) name: String,
    pub(crate) links: Vec<RawLink<'s>>,
    pub(crate) joints: Vec<RawJoint<'s>>,
    pub(crate) transmissions: BTreeMap<&'s str, Transmission>,
    pub(crate) bodies: BodyNotes,
    pub(crate) snapped: Snapped,
    /// Whether links or joints are at fault, so that the others are no tree.
    pub(crate) is_partial: bool,
}

const KINDS: [(&str, Kind); 6] = [
    ("revolute", Kind::Revolute),
    ("continuous", Kind::Continuous),
    ("prismatic", Kind::Prismatic),
    ("fixed", Kind::Fixed),
    ("planar", Kind::Planar),
    ("floating", Kind::Floating),
];

/// Elements of xacro that define something and do nothing.
const HARMLESS: [&str; 2] = ["property", "arg"];

/// Reads a file's elements.
pub(crate) fn read<'s>(robot: Element<'s>, faults: &mut Faults) -> Raw<'s> {
    let name = robot.get("name").map_or("robot", |name| name.text).to_owned();
    let mut raw = Raw {
        name,
        links: Vec::new(),
        joints: Vec::new(),
        transmissions: BTreeMap::new(),
        bodies: BodyNotes::default(),
        snapped: Snapped::default(),
        is_partial: false,
    };
    for element in robot.children() {
        if element.space().is_some_and(|space| space.contains("xacro")) {
            if !HARMLESS.contains(&element.name()) {
                let said = format!("<xacro:{}> has not been expanded", clip(element.name()));
                let hint = "run `xacro ROBOT.urdf.xacro -o ROBOT.urdf` first";
                faults.push(element.at(), Cause::with_hint(said, hint));
                raw.is_partial = true;
            }
            continue;
        }
        match element.name() {
            "link" => {
                let link = link(element, &mut raw, faults);
                raw.is_partial |= link.is_none();
                raw.links.extend(link);
            }
            "joint" => {
                let joint = joint(element, &mut raw.snapped, faults);
                raw.is_partial |= joint.is_none();
                raw.joints.extend(joint);
            }
            "transmission" => transmission(element, &mut raw.transmissions, faults),
            _ => {}
        }
    }
    raw
}

fn link<'s>(element: Element<'s>, raw: &mut Raw<'s>, faults: &mut Faults) -> Option<RawLink<'s>> {
    let name = name(element, "name", faults)?;
    let body = element.first("inertial").and_then(|inertial| {
        given_body(inertial, name.text, &mut raw.snapped, faults)
            .and_then(|given| body(given, &mut raw.bodies))
    });
    Some(RawLink { name, element, body })
}

fn given_body<'n>(
    inertial: Element<'_>,
    link: &'n str,
    snapped: &mut Snapped,
    faults: &mut Faults,
) -> Option<GivenBody<'n>> {
    let before = faults.count();
    let place = pose(inertial.first("origin"), link, snapped, faults);
    let mass = match inertial.first("mass") {
        None => Some(Rational::zero()),
        Some(mass) => match mass.get("value") {
            Some(value) => number(value, "the mass", faults),
            None => {
                missing(mass, "value", faults);
                None
            }
        },
    };
    let tensor = inertial.first("inertia");
    let inertia = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"].map(|key| match tensor {
        None => Some(Rational::zero()),
        Some(tensor) => number_or_zero(tensor, key, faults),
    });
    if faults.count() > before {
        return None;
    }
    let place = place?;
    let at = tensor.map_or(inertial.at(), |tensor| tensor.at());
    let inertia = inertia.map(Option::unwrap_or_default);
    Some(GivenBody { link, mass: mass?, com: place.at, inertia, turns: place.turns, at })
}

fn joint<'s>(
    element: Element<'s>,
    snapped: &mut Snapped,
    faults: &mut Faults,
) -> Option<RawJoint<'s>> {
    let name_found = name(element, "name", faults);
    let owner = name_found.map_or("a joint", |name| name.text);
    let kind = kind(element, faults);
    let origin = pose(element.first("origin"), owner, snapped, faults);
    let axis = match element.first("axis").filter(|axis| axis.get("xyz").is_some()) {
        None => Some([1, 0, 0].map(integer)),
        Some(axis) => {
            let found = vector(axis, "xyz", faults);
            let moves = kind.is_none_or(|kind| !matches!(kind, Kind::Fixed | Kind::Floating));
            if moves && found.as_ref().is_some_and(|axis| axis.iter().all(Zero::is_zero)) {
                let said = format!("the axis of joint `{}` has no direction", clip(owner));
                faults.push(axis.at(), Cause::new(said));
            }
            found
        }
    };
    let mut end = |key: &'static str| match element.first(key) {
        Some(end) => name(end, "link", faults),
        None => {
            let said = format!("joint `{}` has no <{key}>", clip(owner));
            faults.push(element.at(), Cause::new(said));
            None
        }
    };
    let (parent, child) = (end("parent"), end("child"));
    Some(RawJoint {
        name: name_found?,
        element,
        kind: kind?,
        origin: origin?,
        axis: axis?,
        parent: parent?,
        child: child?,
    })
}

fn kind(element: Element<'_>, faults: &mut Faults) -> Option<Kind> {
    let Some(found) = element.get("type") else {
        missing(element, "type", faults);
        return None;
    };
    let known = KINDS.iter().find(|(word, _)| *word == found.text.trim());
    if known.is_none() {
        let words: Vec<&str> = KINDS.iter().map(|(word, _)| *word).collect();
        let said = format!("no joint has the type \"{}\"", clip(found.text));
        faults.push(found.at, Cause::with_hint(said, format!("it is one of {}", words.join(", "))));
    }
    known.map(|(_, kind)| *kind)
}

/// The reduction of a joint, and the inertia of its rotor where the file states it.
fn transmission<'s>(
    element: Element<'s>,
    known: &mut BTreeMap<&'s str, Transmission>,
    faults: &mut Faults,
) {
    let joints: Vec<Element<'s>> = element.all("joint").collect();
    // several joints on one transmission are coupled: no reduction is that of one of them
    let [joint] = joints[..] else { return };
    let Some(name) = joint.get("name") else { return };
    let mut found = Transmission::default();
    for part in element.everything() {
        let value = part.get("value").map_or(part.content(), |value| value.text);
        let text = Text { text: value, at: part.at(), length: 0 };
        let wanted = match part.name() {
            "mechanicalReduction" | "mechanical_reduction" | "gear_ratio" => &mut found.reduction,
            "rotorInertia" | "rotor_inertia" | "motorInertia" | "motor_inertia" => {
                &mut found.rotor_inertia
            }
            _ => continue,
        };
        if !value.is_empty() {
            *wanted = number(text, part.name(), faults);
        }
    }
    known.insert(name.text, found);
}
