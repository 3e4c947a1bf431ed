//! The checked model: a [`Robot`] cannot be wrong, so no later stage looks for faults.
//!
//! All expressions live in the robot's own [`Dag`]. Frames follow the declared [`Convention`];
//! everything is in coherent SI units.

use super::parameter::{Parameter, ParameterId};
use super::tree::Tree;
use crate::arena::{Handle, PrimaryMap};
use crate::expr::{Dag, ExprId};

crate::handle!(
    /// A link of a [`Robot`], in file order (the generated links of a floating base come first).
    pub LinkId,
    "l"
);
crate::handle!(
    /// A contact point of a [`Robot`], in file order.
    pub ContactId,
    "c"
);

/// How a row of the Denavit-Hartenberg table is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Convention {
    /// `Rz(theta) Tz(d) Tx(a) Rx(alpha)` (thesis 2.18): link frame at the far end of the link.
    Standard,
    /// `Rx(alpha) Tx(a) Rz(theta) Tz(d)` (Khalil, Craig): link frame on the joint axis.
    Modified,
}

/// What the first joints of a robot stand on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Base {
    /// Frame 0 is bolted to the world.
    Fixed,
    /// Six generated massless joints `base_z`, `base_x`, `base_y`, `base_yaw`, `base_roll`,
    /// `base_pitch`: the virtual chain of thesis figure 2.3.
    Floating,
    /// Three generated joints `base_z`, `base_x`, `base_pitch`: motion in the world x-z plane.
    PlanarFloating,
}

impl Base {
    /// Number of joints, and links, that are generated before those of the file.
    pub const fn generated_joints(self) -> usize {
        match self {
            Self::Fixed => 0,
            Self::Floating => 6,
            Self::PlanarFloating => 3,
        }
    }
}

/// Which side of the gear the torques of a log stand on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TorqueSide {
    /// Torque about the joint axis.
    Joint,
    /// Torque of the motor shaft, before the gear.
    Motor,
}

/// The terms that the model has; all of them unless the file says otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Terms {
    /// `D qdd`.
    pub inertia: bool,
    /// `C qd`.
    pub coriolis: bool,
    /// `G`.
    pub gravity: bool,
    /// Viscous and Coulomb friction, joint damping.
    pub friction: bool,
    /// Reflected rotor inertia.
    pub rotor: bool,
    /// Springs across joints.
    pub spring: bool,
}

impl Terms {
    /// Every term.
    pub const ALL: Self = Self {
        inertia: true,
        coriolis: true,
        gravity: true,
        friction: true,
        rotor: true,
        spring: true,
    };
}

/// The kind of a joint; its axis is z_(i-1) (standard) or z_i (modified).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JointKind {
    /// The variable adds to theta.
    Revolute,
    /// The variable adds to d.
    Prismatic,
    /// No variable: the row is a constant transform.
    Fixed,
}

/// The symbols of a moving joint, named `q_LINK`, `qd_LINK`, `qdd_LINK`, `tau_LINK`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JointVariables {
    /// Position (rad, m).
    pub q: ExprId,
    /// Rate (rad/s, m/s).
    pub qd: ExprId,
    /// Acceleration (rad/s^2, m/s^2).
    pub qdd: ExprId,
    /// Torque or force along the joint axis (N m, N).
    pub tau: ExprId,
}

/// A linear spring across a joint, with torque `-stiffness (q - angle)` on the joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JointSpring {
    /// Stiffness (N m/rad, N/m), `ks_LINK`.
    pub stiffness: ExprId,
    /// Position without torque (rad, m), `qs_LINK`.
    pub angle: ExprId,
}

/// A row of the table. The entries are the constant parts: the variable of a moving joint adds to
/// `theta` (revolute) or to `d` (prismatic).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Joint {
    /// Which entry varies.
    pub kind: JointKind,
    /// Link length (m).
    pub a: ExprId,
    /// Link twist (rad).
    pub alpha: ExprId,
    /// Constant part of the link offset (m).
    pub d: ExprId,
    /// Constant part of the joint angle (rad).
    pub theta: ExprId,
    /// The joint's symbols; none for a fixed joint.
    pub variables: Option<JointVariables>,
    /// A spring across the joint, of passive and driven joints alike.
    pub spring: Option<JointSpring>,
    /// Viscous damping of a joint without a drive (N m s/rad, N s/m), `fv_LINK`.
    pub damping: Option<ExprId>,
}

/// The point about which an inertia tensor is taken; its axes are always those of the link frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum About {
    /// The centre of mass.
    Com,
    /// The origin of the link frame.
    Origin,
}

/// Mass properties in the link frame of the robot's convention.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Body {
    /// Mass (kg).
    pub mass: ExprId,
    /// Centre of mass (m).
    pub com: [ExprId; 3],
    /// Tensor entries xx, yy, zz, xy, xz, yz (kg m^2); xy = -integral of x y dm.
    pub inertia: [ExprId; 6],
    /// The point of the tensor.
    pub about: About,
}

/// Motor and gear of a joint (thesis 3.14-3.24). With a gear ratio, rotor inertia and friction are
/// those of the motor shaft: on the joint side they count N^2, N^2 and |N| fold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Drive {
    /// Motor turns per joint turn, `N_LINK`.
    pub gear_ratio: Option<ExprId>,
    /// Rotor inertia (kg m^2; kg for a prismatic joint without gear), `Ia_LINK`.
    pub rotor_inertia: Option<ExprId>,
    /// Viscous friction (N m s/rad), `fv_LINK`.
    pub viscous: Option<ExprId>,
    /// Coulomb friction (N m), `fc_LINK`.
    pub coulomb: Option<ExprId>,
    /// Constant torque that the joint needs besides everything else (N m), `off_LINK`; joint side.
    pub offset: Option<ExprId>,
    /// A spring between gear and joint.
    pub series_elastic: Option<SeriesElastic>,
    /// A spring that pushes one way only.
    pub return_spring: Option<ReturnSpring>,
}

/// Spring and pulleys between gear and joint (thesis 3.18-3.24).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SeriesElastic {
    /// Stiffness of the spring (N/m), `k_LINK`.
    pub stiffness: ExprId,
    /// Radius of the pulley on the gear side (m), `rm_LINK`.
    pub motor_radius: ExprId,
    /// Radius of the pulley on the joint side (m), `rl_LINK`.
    pub load_radius: ExprId,
}

/// A one-sided spring across a joint: torque `-stiffness (q - angle)` on the joint while q is on
/// the given side of `angle`, none on the other side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReturnSpring {
    /// Stiffness (N m/rad), `kr_LINK`.
    pub stiffness: ExprId,
    /// Where the spring begins to act (rad), `qr_LINK`.
    pub angle: ExprId,
    /// The side on which it acts.
    pub side: Side,
}

/// A side of an angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// Where q is larger.
    Above,
    /// Where q is smaller.
    Below,
}

/// Bounds of a joint, symbol-free expressions; none where the file gives none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Limits {
    /// Lowest and highest position (rad, m).
    pub position: Option<[ExprId; 2]>,
    /// Largest speed, either way (rad/s, m/s).
    pub velocity: Option<ExprId>,
    /// Largest acceleration, either way (rad/s^2, m/s^2).
    pub acceleration: Option<ExprId>,
    /// Lowest and highest torque of the drive on the joint side (N m, N); `[0, x]` for a drive
    /// that can pull one way only.
    pub torque: Option<[ExprId; 2]>,
}

/// A link with the joint that carries it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// The name of link and joint.
    pub name: String,
    /// The link that carries it; none if it stands on frame 0.
    pub parent: Option<LinkId>,
    /// The row of the table.
    pub joint: Joint,
    /// Bounds of the joint.
    pub limits: Limits,
    /// Mass properties; a link without body is massless.
    pub body: Option<Body>,
    /// Motor and gear; a joint without drive is passive.
    pub drive: Option<Drive>,
}

/// A point fixed in a link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contact {
    /// The point's name.
    pub name: String,
    /// The link that carries it.
    pub link: LinkId,
    /// Its place in the link frame (m).
    pub position: [ExprId; 3],
}

/// A body whose touching the ground is a fall: a point, or a capsule, all points within a radius of
/// the straight way between two places in a link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FallBody {
    /// The body's name.
    pub name: String,
    /// The link that carries it.
    pub link: LinkId,
    /// The ends in the link frame: one or two (m).
    pub ends: Vec<[ExprId; 3]>,
    /// The radius (m).
    pub radius: ExprId,
}

/// The ground: the half space below a plane in frame 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ground {
    /// A point of the plane (m).
    pub point: [ExprId; 3],
    /// The direction away from the ground, of any length but 0.
    pub normal: [ExprId; 3],
}

/// Where an added effect acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffectPlace {
    /// On one joint or link.
    Link(LinkId),
    /// On one joint, depending on a second one.
    Pair(LinkId, LinkId),
    /// At one contact point.
    Contact(ContactId),
    /// On the whole model.
    Model,
}

/// An effect that a diagnosis, or a person, added to the model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AddedEffect {
    /// The name of the effect's definition.
    pub effect: String,
    /// Where it acts.
    pub at: EffectPlace,
    /// On which side of the joint's series spring, if the file says that.
    pub side: Option<SpringSide>,
    /// Its parameters.
    pub parameters: Vec<AddedValue>,
    /// Where the file says so: byte offset.
    pub place: usize,
}

/// A value that a file gives a parameter of an effect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AddedValue {
    /// The parameter's name in the effect's definition.
    pub name: String,
    /// Its value, without symbols.
    pub value: ExprId,
    /// Its standard deviation, if it is stated.
    pub std: Option<ExprId>,
}

/// A state of a law.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LawState {
    /// The symbol's name, `z_dahl_knee`.
    pub name: String,
    /// The symbol.
    pub symbol: ExprId,
    /// Its derivative with respect to time.
    pub rate: ExprId,
    /// Its value at the beginning, of the motion there.
    pub initial: ExprId,
}

/// On which side of a series spring a law of a joint acts, where there is such a spring.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SpringSide {
    /// On that of the motor: friction of the drive, its gear, its torque.
    #[default]
    Motor,
    /// On that of the link: stops, springs across the joint.
    Link,
}

/// The law of an effect that adds to the torque of a joint, in the symbols of the robot. The stage
/// `effect` makes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointLaw {
    /// The effect's name.
    pub effect: String,
    /// The effect in a few words.
    pub title: String,
    /// The joint.
    pub joint: LinkId,
    /// On which side of the joint's series spring it acts, if there is one.
    pub side: SpringSide,
    /// The torque that the joint needs besides [N m, N].
    pub torque: ExprId,
    /// Its states.
    pub states: Vec<LawState>,
    /// Joints whose rigid-body torque the law depends on, with the symbols of these torques.
    pub loads: Vec<(LinkId, ExprId)>,
    /// The time, if the law depends on it.
    pub time: Option<ExprId>,
}

/// The law of an effect beside the series spring of a joint: its torque is what is passed on from
/// the motor to the link besides that of the spring.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SpringLaw {
    /// The law, of the joint that has the spring.
    pub law: JointLaw,
    /// How far the motor is ahead of the joint, on the joint's side [rad, m].
    pub deflection: ExprId,
    /// The rate of that [rad/s, m/s].
    pub rate: ExprId,
}

/// A checked robot.
#[derive(Clone, Debug)]
pub struct Robot {
    /// The model's name, an identifier.
    pub name: String,
    /// What it is.
    pub description: String,
    /// Where its numbers come from.
    pub source: String,
    /// What was assumed where the source is silent.
    pub assumptions: Vec<String>,
    /// How rows are read.
    pub convention: Convention,
    /// What the first joints stand on.
    pub base: Base,
    /// Acceleration of free fall in frame 0 (m/s^2): P = -sum m g.o.
    pub gravity: [ExprId; 3],
    /// The terms that the model has.
    pub terms: Terms,
    /// On which side of the gear the torques of its logs stand.
    pub torque_side: TorqueSide,
    /// Holds all symbols and expressions of the robot.
    pub dag: Dag,
    /// Every parameter: constants, then unknowns, in file order; then by link the body entries in
    /// column order; then by link fv, fc, Ia, off and the other entries of joint and drive.
    pub parameters: PrimaryMap<ParameterId, Parameter>,
    /// The links; a parent always stands before its children.
    pub links: PrimaryMap<LinkId, Link>,
    /// Who carries whom.
    pub tree: Tree,
    /// The points that may touch the ground.
    pub contacts: PrimaryMap<ContactId, Contact>,
    /// The ground.
    pub ground: Ground,
    /// Bodies whose touching the ground is a fall (thesis 4.1).
    pub bodies_that_must_not_touch: Vec<FallBody>,
    /// What was added to the rigid-body model, as the file says it.
    pub effects: Vec<AddedEffect>,
    /// Laws of those effects that add to the torque of a joint.
    pub laws: Vec<JointLaw>,
    /// Laws of those effects that stand beside series springs: part of no function, since joint
    /// torques are those that springs pass on, whatever makes them.
    pub spring_laws: Vec<SpringLaw>,
    /// A number that changes when the content of the file changes, and not when only its
    /// whitespace, the order of keys or the writing of a number does.
    pub hash: u64,
}

impl Robot {
    /// The moving links with the symbols of their joints, in link order: row j of q, D, tau.
    pub fn joints(&self) -> impl Iterator<Item = (LinkId, &JointVariables)> {
        self.links
            .iter()
            .filter_map(|(id, link)| link.joint.variables.as_ref().map(|symbols| (id, symbols)))
    }

    /// Number of degrees of freedom.
    pub fn degrees_of_freedom(&self) -> usize {
        self.joints().count()
    }

    /// JSON pointer of a link in the model's file; none for the generated joints of a base.
    pub fn pointer(&self, link: LinkId) -> Option<String> {
        let index = link.index().checked_sub(self.base.generated_joints())?;
        Some(format!("/links/{index}"))
    }

    /// The link of that name.
    pub fn find_link(&self, name: &str) -> Option<LinkId> {
        self.links.iter().find(|(_, link)| link.name == name).map(|(id, _)| id)
    }

    /// Every symbol of the time that a law has: one, if there is any.
    pub fn time(&self) -> Option<ExprId> {
        self.laws.iter().find_map(|law| law.time)
    }

    /// The states of all laws of joints, in their order.
    pub fn law_states(&self) -> impl Iterator<Item = &LawState> {
        self.laws.iter().flat_map(|law| &law.states)
    }

    /// The parameter of that name.
    pub fn find_parameter(&self, name: &str) -> Option<ParameterId> {
        self.parameters.iter().find(|(_, parameter)| parameter.name == name).map(|(id, _)| id)
    }
}
