//! What URDF and MJCF have in common: a tree of links, each with a joint, in exact numbers.

use crate::exact::Vector;
use crate::place::{Angle, Pose, Turn};
use denavit_codegen::model::Unphysical;
use denavit_codegen::number::Rational;
use num_traits::Signed;

/// Most links of a robot.
pub(crate) const MAX_LINKS: usize = 5000;

/// A robot.
#[derive(Debug)]
pub(crate) struct Tree {
    pub(crate) name: String,
    /// Which file it is, and what it says of itself.
    pub(crate) description: String,
    /// Acceleration of free fall \[m/s^2\].
    pub(crate) gravity: Vector,
    /// Whether the first link floats.
    pub(crate) floats: bool,
    /// The links, parents first; the first one is what the robot stands on.
    pub(crate) links: Vec<TreeLink>,
    /// What its author should know.
    pub(crate) notes: Vec<String>,
    /// Points that may touch the ground.
    pub(crate) contacts: Vec<TreeContact>,
}

/// A point that may touch the ground.
#[derive(Debug)]
pub(crate) struct TreeContact {
    pub(crate) name: String,
    /// The link that it is on.
    pub(crate) link: usize,
    /// Its place in the frame of the link.
    pub(crate) at: Vector,
}

/// A link, or a step between two joints of one link.
#[derive(Debug)]
pub(crate) struct TreeLink {
    /// Its name; none for a step between two joints.
    pub(crate) name: Option<String>,
    pub(crate) parent: Option<usize>,
    /// From the parent's frame to that of the joint.
    pub(crate) before: Vec<Pose>,
    /// What moves; none if the link is fixed to its parent.
    pub(crate) joint: Option<TreeJoint>,
    /// From the frame of the joint, as it has moved, to that of the link.
    pub(crate) after: Vec<Pose>,
    pub(crate) body: Option<TreeBody>,
    /// Whether bodies of other links are part of its body.
    pub(crate) is_joined: bool,
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    Turns,
    Slides,
}

/// A joint.
#[derive(Clone, Debug)]
pub(crate) struct TreeJoint {
    pub(crate) name: String,
    pub(crate) motion: Motion,
    /// The turns that bring z onto its axis.
    pub(crate) axis: Vec<Turn>,
    /// Where its variable is 0, in its frame: an angle, or a length.
    pub(crate) zero: (Angle, Rational),
    pub(crate) limits: TreeLimits,
    pub(crate) drive: TreeDrive,
}

/// Bounds of a joint, as expressions of the model file.
#[derive(Clone, Debug, Default)]
pub(crate) struct TreeLimits {
    pub(crate) position: Option<[String; 2]>,
    pub(crate) velocity: Option<String>,
    pub(crate) torque: Option<[String; 2]>,
}

/// What acts in a joint, as expressions of the model file.
#[derive(Clone, Debug, Default)]
pub(crate) struct TreeDrive {
    /// Whether a motor drives it.
    pub(crate) is_driven: bool,
    pub(crate) gear_ratio: Option<String>,
    pub(crate) rotor_inertia: Option<String>,
    pub(crate) viscous: Option<String>,
    pub(crate) coulomb: Option<String>,
    pub(crate) stiffness: Option<String>,
    pub(crate) spring_angle: Option<String>,
}

/// Mass properties in the link's frame; the tensor about the centre of mass.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TreeBody {
    pub(crate) mass: Rational,
    pub(crate) com: Vector,
    /// xx, yy, zz, xy, xz, yz.
    pub(crate) inertia: [Rational; 6],
    /// Why no body has them, if none has.
    pub(crate) fault: Option<Unphysical>,
    /// Its place in the file.
    pub(crate) at: usize,
}

impl TreeBody {
    /// Whether a model file may have it.
    pub(crate) fn is_possible(&self) -> bool {
        !self.mass.is_negative() && self.fault.as_ref().is_none_or(Unphysical::can_be_accepted)
    }
}

impl TreeLink {
    /// A link that is fixed to its parent.
    pub(crate) fn fixed(name: &str, parent: Option<usize>, before: Vec<Pose>) -> Self {
        let name = Some(name.to_owned());
        Self { name, parent, before, joint: None, after: Vec::new(), body: None, is_joined: false }
    }
}

impl TreeJoint {
    /// A joint about or along an axis, with nothing in it.
    pub(crate) fn new(name: &str, motion: Motion, axis: Vec<Turn>) -> Self {
        let zero = (Angle::zero(), num_traits::Zero::zero());
        let (limits, drive) = (TreeLimits::default(), TreeDrive::default());
        Self { name: name.to_owned(), motion, axis, zero, limits, drive }
    }
}
