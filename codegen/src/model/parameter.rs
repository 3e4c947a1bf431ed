//! The parameters of a robot: symbols whose values a user may set.

use super::robot::LinkId;
use super::unit::Unit;
use crate::expr::ExprId;

crate::handle!(
    /// A parameter of a robot, in the order of [`Robot::parameters`](super::Robot::parameters).
    pub ParameterId,
    "p"
);

/// The ten inertial entries of a body, in column order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // the names are the documentation
pub enum BodyEntry {
    Mass,
    ComX,
    ComY,
    ComZ,
    InertiaXx,
    InertiaYy,
    InertiaZz,
    InertiaXy,
    InertiaXz,
    InertiaYz,
}

impl BodyEntry {
    /// The entries, in column order.
    pub const ALL: [Self; 10] = [
        Self::Mass,
        Self::ComX,
        Self::ComY,
        Self::ComZ,
        Self::InertiaXx,
        Self::InertiaYy,
        Self::InertiaZz,
        Self::InertiaXy,
        Self::InertiaXz,
        Self::InertiaYz,
    ];

    /// The part of the symbol before `_LINK`.
    pub const fn prefix(self) -> &'static str {
        match self {
            Self::Mass => "m",
            Self::ComX => "cx",
            Self::ComY => "cy",
            Self::ComZ => "cz",
            Self::InertiaXx => "Ixx",
            Self::InertiaYy => "Iyy",
            Self::InertiaZz => "Izz",
            Self::InertiaXy => "Ixy",
            Self::InertiaXz => "Ixz",
            Self::InertiaYz => "Iyz",
        }
    }
}

/// The entries of a joint and its drive, in column order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // the names are the documentation
pub enum JointEntry {
    Viscous,
    Coulomb,
    RotorInertia,
    Offset,
    GearRatio,
    SeriesStiffness,
    MotorRadius,
    LoadRadius,
    ReturnStiffness,
    ReturnAngle,
    SpringStiffness,
    SpringAngle,
}

impl JointEntry {
    /// The entries, in column order.
    pub const ALL: [Self; 12] = [
        Self::Viscous,
        Self::Coulomb,
        Self::RotorInertia,
        Self::Offset,
        Self::GearRatio,
        Self::SeriesStiffness,
        Self::MotorRadius,
        Self::LoadRadius,
        Self::ReturnStiffness,
        Self::ReturnAngle,
        Self::SpringStiffness,
        Self::SpringAngle,
    ];

    /// The part of the symbol before `_LINK`.
    pub const fn prefix(self) -> &'static str {
        match self {
            Self::Viscous => "fv",
            Self::Coulomb => "fc",
            Self::RotorInertia => "Ia",
            Self::Offset => "off",
            Self::GearRatio => "N",
            Self::SeriesStiffness => "k",
            Self::MotorRadius => "rm",
            Self::LoadRadius => "rl",
            Self::ReturnStiffness => "kr",
            Self::ReturnAngle => "qr",
            Self::SpringStiffness => "ks",
            Self::SpringAngle => "qs",
        }
    }
}

/// What a parameter belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// A declared constant.
    Constant,
    /// A declared unknown.
    Unknown,
    /// An inertial entry of a link.
    Body(LinkId, BodyEntry),
    /// An entry of a joint or its drive.
    Joint(LinkId, JointEntry),
    /// Of an added effect, by its place in the file's list.
    Effect(usize),
}

/// A symbol whose value a user may set.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// The symbol's name: the file's own for constants and unknowns, else as `m_LINK`.
    pub name: String,
    /// The symbol.
    pub symbol: ExprId,
    /// What it belongs to.
    pub role: Role,
    /// Whether its value is taken as given (constants, gear ratios, pulley radii, and whatever is
    /// marked `known`), or is to be identified.
    pub known: bool,
    /// The value that the file gives, a symbol-free expression; none if it gives none.
    pub default: Option<ExprId>,
    /// Standard deviation of the value, symbol-free, if the file states it.
    pub std: Option<ExprId>,
    /// The unit, if the file states it or the role fixes it.
    pub unit: Option<Unit>,
    /// What the file says about it.
    pub doc: String,
}
