//! Hidden effects: what each is called, what answers name the same physics, and its size.

use super::robots::Robot;

/// A law that may be hidden in a plant, its sensors or its drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Law {
    Coulomb,
    Viscous,
    SmoothedCoulomb,
    AsymmetricCoulomb,
    AsymmetricViscous,
    Stribeck,
    Stiction,
    Dahl,
    LuGre,
    MaxwellSlip,
    LoadFriction,
    Capstan,
    GearEfficiency,
    QuadraticDrag,
    SublinearViscous,
    RotorInertia,
    JointElasticity,
    HystereticSpring,
    HardeningSpring,
    ReturnSpring,
    TorqueGain,
    TorqueOffset,
    JointZero,
    Cogging,
    TransmissionError,
    Damper,
    Backlash,
    Payload,
    LinkInertia,
    Coriolis,
    CouplingInertia,
    BaseTilt,
    TorqueDelay,
    ActuatorLag,
    Saturation,
    HardStop,
    ThermalFriction,
    CoupledFriction,
    ExternalForce,
    // outside the catalogue
    ProductCoupling,
    SineRate,
    Waveform,
    Chaos,
    Magnet,
    PostureDrag,
}

/// Where an effect acts, for the answer's joint to be right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Site {
    /// One joint.
    Joint,
    /// A joint and another that it is coupled with: either is right.
    Pair,
    /// A link: joints before it feel its inertia, so its joint or the one before is right.
    Link,
    /// The robot: no joint is asked for.
    Model,
}

/// What the battery knows of a law.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    pub law: Law,
    /// The catalogue's name; empty for what no catalogue has.
    pub name: &'static str,
    /// Other names of the same physics, or names that no data can tell from it, at some joints
    /// alone ([`Hidden::is_called`]).
    pub same: &'static [&'static str],
    pub site: Site,
    /// Name of the parameter that is the size, if law 0 has it in the catalogue's form; with a
    /// minus where the catalogue counts the other way, two with a comma where the size is the
    /// amplitude of a cosine and a sine. An answer with one parameter need not know it.
    pub parameter: &'static str,
    /// How many laws of this physics are implemented.
    pub variants: usize,
}

const fn entry(
    law: Law,
    name: &'static str,
    same: &'static [&'static str],
    site: Site,
    parameter: &'static str,
    variants: usize,
) -> Entry {
    Entry { law, name, same, site, parameter, variants }
}

/// The one table of names.
///
/// Same physics: laws of dry friction with memory stand for each other (each reduces to the others
/// where data do not show the shape of a loop), so do one-sided springs (a stop is a stiff one),
/// delay and lag (equal to first order), Stribeck friction and stiction (the plant's drives stick
/// with both, and the catalogue's stiction is Stribeck's curve with a bristle for its sign),
/// friction of load and of a cable (equal where the wrap does not change). Aliases: offset and
/// asymmetric Coulomb while a joint moves; the inertia of a rotor and of the first link; a payload
/// and the link that carries it; a zero error and a tilt or a displaced mass.
pub const TABLE: [Entry; 45] = [
    entry(
        Law::Coulomb,
        "coulomb",
        &["smoothed_coulomb", "arctangent_coulomb"],
        Site::Joint,
        "fc",
        2,
    ),
    entry(Law::Viscous, "viscous", &["shear_thinning"], Site::Joint, "fv", 2),
    entry(
        Law::SmoothedCoulomb,
        "smoothed_coulomb",
        &["coulomb", "arctangent_coulomb"],
        Site::Joint,
        "fc",
        3,
    ),
    entry(Law::AsymmetricCoulomb, "asymmetric_coulomb", &["torque_offset"], Site::Joint, "d", 1),
    entry(Law::AsymmetricViscous, "asymmetric_viscous", &[], Site::Joint, "d", 2),
    entry(
        Law::Stribeck,
        "stribeck",
        &["stribeck_exponential", "lugre", "stiction"],
        Site::Joint,
        "fs",
        3,
    ),
    entry(
        Law::Stiction,
        "stiction",
        &["breakaway", "stribeck", "stribeck_exponential", "lugre"],
        Site::Joint,
        "fs",
        2,
    ),
    entry(Law::Dahl, "dahl", &["lugre", "maxwell_slip", "bouc_wen"], Site::Joint, "fc", 2),
    entry(Law::LuGre, "lugre", &["dahl", "maxwell_slip"], Site::Joint, "fc", 2),
    entry(Law::MaxwellSlip, "maxwell_slip", &["dahl", "lugre", "bouc_wen"], Site::Joint, "", 2),
    entry(
        Law::LoadFriction,
        "load_friction",
        &["capstan", "capstan_posture", "gear_efficiency"],
        Site::Joint,
        "mu",
        2,
    ),
    entry(Law::Capstan, "capstan", &["capstan_posture", "load_friction"], Site::Joint, "", 2),
    entry(
        Law::GearEfficiency,
        "gear_efficiency",
        &["load_friction", "capstan"],
        Site::Joint,
        "",
        2,
    ),
    entry(Law::QuadraticDrag, "quadratic_drag", &[], Site::Joint, "c", 2),
    entry(
        Law::SublinearViscous,
        "shear_thinning",
        &["smoothed_coulomb", "arctangent_coulomb", "coulomb"],
        Site::Joint,
        "",
        2,
    ),
    entry(Law::RotorInertia, "rotor_inertia", &["link_parameters", "rotors"], Site::Joint, "Ia", 1),
    entry(Law::JointElasticity, "joint_elasticity", &["joint_compliance"], Site::Joint, "", 2),
    entry(Law::HystereticSpring, "bouc_wen", &["maxwell_slip", "dahl"], Site::Joint, "", 2),
    entry(Law::HardeningSpring, "hardening_spring", &[], Site::Joint, "", 2),
    entry(Law::ReturnSpring, "one_sided_spring", &["hard_stop"], Site::Joint, "k", 2),
    entry(Law::TorqueGain, "torque_gain", &[], Site::Joint, "g", 1),
    entry(Law::TorqueOffset, "torque_offset", &["asymmetric_coulomb"], Site::Joint, "c", 1),
    entry(Law::JointZero, "joint_zero", &["base_tilt", "link_parameters"], Site::Joint, "-dq", 1),
    entry(Law::Cogging, "cogging", &["transmission_error"], Site::Joint, "", 2),
    entry(
        Law::TransmissionError,
        "torque_ripple",
        &["transmission_error", "encoder_eccentricity", "cogging"],
        Site::Joint,
        "a,b",
        2,
    ),
    entry(Law::Damper, "damper", &[], Site::Joint, "d", 1),
    entry(Law::Backlash, "play", &["backlash"], Site::Joint, "", 2),
    entry(Law::Payload, "payload", &["payload_point", "link_parameters"], Site::Model, "m", 2),
    entry(
        Law::LinkInertia,
        "link_parameters",
        &["payload", "payload_point", "rotor_inertia"],
        Site::Link,
        "",
        2,
    ),
    entry(Law::Coriolis, "coriolis", &[], Site::Model, "", 1),
    entry(Law::CouplingInertia, "coupled_inertia", &[], Site::Pair, "m", 1),
    entry(Law::BaseTilt, "base_tilt", &["joint_zero"], Site::Model, "", 1),
    entry(
        Law::TorqueDelay,
        "torque_delay",
        &["torque_lag", "drive_lag", "position_delay"],
        Site::Joint,
        "T",
        2,
    ),
    entry(
        Law::ActuatorLag,
        "drive_lag",
        &["torque_lag", "torque_delay", "position_delay"],
        Site::Joint,
        "T",
        2,
    ),
    entry(Law::Saturation, "torque_saturation", &[], Site::Joint, "", 2),
    entry(Law::HardStop, "hard_stop", &["one_sided_spring"], Site::Joint, "k", 2),
    entry(Law::ThermalFriction, "cold_friction", &["cold_viscous"], Site::Joint, "c", 2),
    entry(Law::CoupledFriction, "coupled_viscous", &["coupled_coulomb"], Site::Pair, "", 2),
    entry(Law::ExternalForce, "external_force", &[], Site::Model, "", 2),
    entry(Law::ProductCoupling, "", &[], Site::Pair, "", 1),
    entry(Law::SineRate, "", &[], Site::Joint, "", 1),
    entry(Law::Waveform, "", &[], Site::Joint, "", 1),
    entry(Law::Chaos, "", &[], Site::Joint, "", 1),
    entry(Law::Magnet, "", &[], Site::Joint, "", 1),
    entry(Law::PostureDrag, "", &[], Site::Pair, "", 1),
];

impl Law {
    /// Its entry in the table.
    pub fn entry(self) -> &'static Entry {
        TABLE.iter().find(|entry| entry.law == self).expect("the table has every law")
    }

    /// Whether it is a term that the nominal model lacks: it has no size to scale.
    pub fn is_lacking(self) -> bool {
        matches!(self, Self::Coriolis | Self::RotorInertia)
    }

    /// Whether the nominal model keeps its Coulomb friction at the joint.
    pub fn keeps_coulomb(self) -> bool {
        !matches!(
            self,
            Self::Coulomb | Self::SmoothedCoulomb | Self::Dahl | Self::LuGre | Self::MaxwellSlip
        )
    }
}

/// An effect in a plant.
#[derive(Clone, Debug, PartialEq)]
pub struct Hidden {
    pub law: Law,
    /// Which law of its physics: 0 is the one that the catalogue prints.
    pub variant: usize,
    pub joint: usize,
    /// The other joint of a coupling.
    pub other: usize,
    /// What is scaled to reach a strength, in the unit of the law.
    pub size: f64,
    /// Widths, places and phases, drawn once.
    pub shape: Shape,
}

impl Hidden {
    /// Whether a name is its own or one of the same physics, for this effect on this robot: some
    /// aliases hold at some joints alone.
    pub fn is_called(&self, name: &str, robot: &Robot) -> bool {
        let entry = self.law.entry();
        if name == entry.name {
            return !name.is_empty();
        }
        let last = self.joint + 1 == robot.joints.len();
        let holds = match (self.law, name) {
            (Law::RotorInertia, "link_parameters") | (Law::LinkInertia, "rotor_inertia") => {
                self.joint == 0
            }
            (Law::JointZero, "base_tilt") => self.joint == 0 && robot.is_planar(),
            (Law::BaseTilt, "joint_zero") => robot.is_planar(),
            (Law::JointZero, "link_parameters") => last,
            (Law::Viscous | Law::SublinearViscous, _) => self.variant > 0,
            _ => true,
        };
        holds && entry.same.contains(&name)
    }
}

/// What a law needs beside its size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shape {
    /// Middle of the joint's motion \[rad\] and its reach \[rad\].
    pub middle: f64,
    pub reach: f64,
    /// The same of the other joint.
    pub other_middle: f64,
    pub other_reach: f64,
    /// Typical rate [rad/s] and torque [N m] of the joint.
    pub rate: f64,
    pub torque: f64,
    /// Largest torque [N m].
    pub peak: f64,
    /// Numbers in [0, 1) and a phase \[rad\], drawn.
    pub first: f64,
    pub second: f64,
    pub phase: f64,
    /// One lap of the reference \[s\].
    pub lap_s: f64,
}
