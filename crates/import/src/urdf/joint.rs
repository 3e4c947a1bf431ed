//! Joints of a file as joints of the tree: one, or several for those with several freedoms.

use super::raw::{Kind, Raw, RawJoint, RawLink};
use super::values::{is_endless, number_or_zero, positive};
use crate::exact::{decimal, written};
use crate::fault::{Cause, Faults, clip};
use crate::options::{Mimic, Options};
use crate::place::{Angle, Pose, Turn, direction};
use crate::tree::{Motion, Tree, TreeDrive, TreeJoint, TreeLimits, TreeLink};
use crate::xml::Element;
use denavit_codegen::number::Rational;
use num_traits::{One, Signed, Zero};

/// Adds the link that a joint carries, with steps before it where the joint has several freedoms.
pub(crate) fn push(
    tree: &mut Tree,
    joint: &RawJoint<'_>,
    link: &RawLink<'_>,
    parent: usize,
    raw: &Raw<'_>,
    options: &Options,
    faults: &mut Faults,
) {
    let (axis, is_snapped) = direction(&joint.axis).unwrap_or_default();
    let mimic = joint.element.first("mimic").filter(|_| joint.kind != Kind::Fixed);
    let before = vec![joint.origin.clone()];
    let fixed = |before: Vec<Pose>| TreeLink {
        body: link.body.clone(),
        ..TreeLink::fixed(link.name.text, Some(parent), before)
    };
    match (joint.kind, mimic, options.mimic) {
        (Kind::Fixed, ..) => tree.links.push(fixed(before)),
        (_, Some(mimic), Mimic::Refuse) => {
            let leader = mimic.get("joint").map_or("another one", |leader| leader.text);
            let said = format!("joint `{}` follows `{}`", clip(joint.name.text), clip(leader));
            let hint = "an import with `options.mimic=lock` fixes it where it is at 0, with \
                    `options.mimic=free` \
                        makes it a joint of its own";
            faults.push(mimic.at(), Cause::with_hint(said, hint));
        }
        (_, Some(mimic), Mimic::Lock) => {
            let offset = mimic.get("offset").map_or("0", |offset| offset.text).trim();
            let held = held(joint.kind, axis, offset);
            let Some(held) = held else {
                faults.push(
                    mimic.at(),
                    Cause::new(format!("the offset `{}` is no number", clip(offset))),
                );
                return;
            };
            tree.notes.push(format!(
                "joint {} is fixed where it is when the one it follows is at 0",
                clip(joint.name.text)
            ));
            tree.links.push(fixed([before, held].concat()));
        }
        (kind, mimic, _) => {
            if let Some(leader) = mimic.and_then(|mimic| mimic.get("joint")) {
                let names = [joint.name.text, leader.text].map(clip);
                tree.notes.push(format!(
                    "joint {} is a joint of its own and does not follow {}",
                    names[0], names[1]
                ));
            }
            if is_snapped {
                tree.notes.push(format!(
                    "the axis of joint {} is within rounding of a coordinate axis or plane, and \
                     lies there",
                    clip(joint.name.text)
                ));
            }
            let drive = drive(joint, raw, tree, faults);
            let limits = limits(joint, tree, faults);
            let steps = steps(kind, joint.name.text, axis);
            push_steps(tree, steps, link, parent, before, limits, drive);
        }
    }
}

/// A joint that is held at an offset, as poses.
fn held(kind: Kind, axis: Vec<Turn>, offset: &str) -> Option<Vec<Pose>> {
    let there = Pose::turned(axis);
    let back = there.inverse();
    let moved = match kind {
        Kind::Prismatic => {
            let zero = Rational::zero;
            Pose::moved([zero(), zero(), decimal(offset)?])
        }
        _ => Pose::turned(vec![Turn::new(2, Angle::radians(offset)?.angle)]),
    };
    Some([vec![there, moved], back].concat())
}

/// What a joint is made of: joints with a name each, and the pose after the last of them.
struct Steps {
    joints: Vec<TreeJoint>,
    /// Turns before the first, and back after the last.
    frame: Vec<Turn>,
}

fn steps(kind: Kind, name: &str, axis: Vec<Turn>) -> Steps {
    let along = |k: usize| match k {
        0 => vec![Turn::new(1, Angle::quarter(1))],
        1 => vec![Turn::new(0, Angle::quarter(3))],
        _ => Vec::new(),
    };
    let make =
        |ending: &str, motion, k| TreeJoint::new(&format!("{name}_{ending}"), motion, along(k));
    use Motion::{Slides, Turns};
    let (joints, frame) = match kind {
        Kind::Planar => {
            (vec![make("x", Slides, 0), make("y", Slides, 1), make("yaw", Turns, 2)], axis)
        }
        Kind::Floating => {
            let slides = [("x", 0), ("y", 1), ("z", 2)].map(|(name, k)| make(name, Slides, k));
            let turns =
                [("yaw", 2), ("pitch", 1), ("roll", 0)].map(|(name, k)| make(name, Turns, k));
            (slides.into_iter().chain(turns).collect(), Vec::new())
        }
        Kind::Prismatic => (vec![TreeJoint::new(name, Slides, axis)], Vec::new()),
        _ => (vec![TreeJoint::new(name, Turns, axis)], Vec::new()),
    };
    Steps { joints, frame }
}

fn push_steps(
    tree: &mut Tree,
    steps: Steps,
    link: &RawLink<'_>,
    parent: usize,
    before: Vec<Pose>,
    limits: TreeLimits,
    drive: TreeDrive,
) {
    let frame = Pose::turned(steps.frame);
    let count = steps.joints.len();
    let (mut parent, mut before) = (parent, before);
    before.push(frame.clone());
    for (at, mut joint) in steps.joints.into_iter().enumerate() {
        let is_last = at + 1 == count;
        if count == 1 {
            (joint.limits, joint.drive) = (limits.clone(), drive.clone());
        }
        tree.links.push(TreeLink {
            name: is_last.then(|| link.name.text.to_owned()),
            parent: Some(parent),
            before: std::mem::take(&mut before),
            joint: Some(joint),
            after: if is_last { frame.inverse() } else { Vec::new() },
            body: link.body.clone().filter(|_| is_last),
            is_joined: false,
        });
        parent = tree.links.len() - 1;
    }
}

fn drive(joint: &RawJoint<'_>, raw: &Raw<'_>, tree: &mut Tree, faults: &mut Faults) -> TreeDrive {
    let element = joint.element;
    let effort = element.first("limit").and_then(|limit| limit.get("effort"));
    let is_idle =
        effort.is_some_and(|effort| decimal(effort.text.trim()).is_some_and(|e| e.is_zero()));
    let mut drive = TreeDrive { is_driven: !is_idle, ..TreeDrive::default() };
    let dynamics = element.first("dynamics");
    let mut given = |key| dynamics.and_then(|dynamics| positive(dynamics, key, faults));
    let [viscous, coulomb] = ["damping", "friction"].map(&mut given);
    let known = raw.transmissions.get(joint.name.text);
    let rotor =
        known.and_then(|known| known.rotor_inertia.clone()).filter(|rotor| !rotor.is_zero());
    let Some(rotor) = rotor else {
        drive.viscous = viscous.map(|value| written(&value));
        drive.coulomb = coulomb.map(|value| written(&value));
        return drive;
    };
    let ratio = known.and_then(|known| known.reduction.clone()).filter(|ratio| !ratio.is_zero());
    let ratio = ratio.unwrap_or_else(Rational::one);
    tree.notes.push(format!(
        "friction of joint {} is that of the motor's shaft, since its rotor is",
        clip(joint.name.text)
    ));
    drive.rotor_inertia = Some(written(&rotor));
    drive.viscous = viscous.map(|value| written(&(value / (&ratio * &ratio))));
    drive.coulomb = coulomb.map(|value| written(&(value / ratio.abs())));
    drive.gear_ratio = Some(written(&ratio));
    drive
}

fn limits(joint: &RawJoint<'_>, tree: &mut Tree, faults: &mut Faults) -> TreeLimits {
    let Some(limit) = joint.element.first("limit") else { return TreeLimits::default() };
    let position = match joint.kind {
        Kind::Continuous => None,
        _ => position(limit, joint.name.text, tree, faults),
    };
    let velocity = positive(limit, "velocity", faults).map(|speed| written(&speed));
    let torque = positive(limit, "effort", faults).map(|most| [written(&-&most), written(&most)]);
    TreeLimits { position, velocity, torque }
}

fn position(
    limit: Element<'_>,
    joint: &str,
    tree: &mut Tree,
    faults: &mut Faults,
) -> Option<[String; 2]> {
    let ends = ["lower", "upper"].map(|key| limit.get(key));
    if ends.iter().all(Option::is_none) || ends.iter().flatten().any(|end| is_endless(end.text)) {
        return None;
    }
    let [low, high] = ["lower", "upper"].map(|key| number_or_zero(limit, key, faults));
    let (low, high) = (low?, high?);
    if low > high {
        tree.notes.push(format!(
            "the limits of joint {} are left out: the lower one is above the upper one",
            clip(joint)
        ));
        return None;
    }
    Some([written(&low), written(&high)])
}
