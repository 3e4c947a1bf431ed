//! Effects as data: physics that a rigid-body model lacks, one law to a file.
//!
//! An effect is a file `denavit-effect/1`: its law in the expression language, parameters with
//! units and bounds, states, and what it is taken for. docs/reference/effects.md lists the
//! catalogue.
//!
//! 1. `read`: text to an [`Effect`], all faults at once
//! 2. `spelling`: units that depend on the joint, as `torque/rate`
//! 3. `linear`: which parameters a law is linear in, decided on expressions
//! 4. [`catalogue`]: the shipped effects
//! 5. [`read_model`], [`attach`]: a robot with the effects that its file names

mod attach;
mod catalogue;
mod law;
mod linear;
mod reaction;
mod read;
mod spelling;

pub use attach::{attach, place_name, read_estimated_model, read_model, with_term};
pub use catalogue::{SHIPPED, catalogue, files, find};
pub use read::read;
pub use spelling::JointUnit;

pub use crate::model::SpringSide;

use crate::expr::{Dag, ExprId, free_symbols};
use crate::number::{Rational, decimal_text};
use std::borrow::Cow;

/// The tag of a file of an effect.
pub const FORMAT: &str = "denavit-effect/1";

/// The JSON Schema (draft 2020-12) of a file of an effect: its form, not its content.
pub fn schema() -> &'static str {
    include_str!("schema.json")
}

/// What an effect is to the equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum EffectKind {
    /// Adds to the torque that a joint needs.
    Torque,
    /// The same, with states of its own.
    State,
    /// Stands between a true quantity and what is logged of it.
    Measurement,
    /// Moves what the model says of a place.
    Parameter,
    /// A term of the model that was left out.
    Term,
    /// Changes its law with the state of motion: stick, stop, saturation.
    Mode,
}

impl EffectKind {
    /// The kinds, in the order of listings.
    pub const ALL: [Self; 6] =
        [Self::Torque, Self::State, Self::Measurement, Self::Parameter, Self::Term, Self::Mode];

    /// The word in files.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Torque => "torque",
            Self::State => "state",
            Self::Measurement => "measurement",
            Self::Parameter => "parameter",
            Self::Term => "term",
            Self::Mode => "mode",
        }
    }
}

/// How often an effect is met, before any log is looked at: what names of equal evidence are
/// judged by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Occurrence {
    /// Of every drive: the dynamic model that robots are identified with has it.
    Standard,
    /// Of most robots somebody would ask for it.
    #[default]
    Common,
    /// A special drive, or another formula for something that is common.
    Uncommon,
    /// Known from single works.
    Rare,
}

impl Occurrence {
    /// The words, in the order of files.
    pub const ALL: [Self; 4] = [Self::Standard, Self::Common, Self::Uncommon, Self::Rare];
}

/// Where an effect can act.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum EffectSite {
    /// On one joint.
    Joint,
    /// On the series spring between the motor of a joint and its link: the position of the law is
    /// how far the motor is ahead, and its torque is passed on beside that of the spring.
    Spring,
    /// On one joint, depending on another one.
    JointPair,
    /// On one link.
    Link,
    /// At one contact point.
    Contact,
    /// On the whole model.
    Model,
}

/// A parameter of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectParameter {
    /// The name, an identifier.
    pub name: String,
    /// The symbol in [`Effect::dag`].
    pub symbol: ExprId,
    /// Its unit, which may depend on whether the joint turns or slides.
    pub unit: JointUnit,
    /// What it is.
    pub description: String,
    /// The value that switches the effect off; none for those that only shape it.
    pub nominal: Option<Rational>,
    /// Lowest and highest value; none where there is no end.
    pub bounds: [Option<Rational>; 2],
    /// Values to start a search from; for a parameter that shapes the law at least one.
    pub start: Vec<Rational>,
    /// Whether the law is affine in it, jointly with the other linear ones: decided on the
    /// expressions. Never where a state answers to it.
    pub linear: bool,
}

/// A state of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectState {
    /// The name, an identifier.
    pub name: String,
    /// The symbol in [`Effect::dag`].
    pub symbol: ExprId,
    /// Its unit.
    pub unit: JointUnit,
    /// Its derivative with respect to time.
    pub rate: ExprId,
    /// Its value at the beginning, of the motion and parameters there.
    pub initial: ExprId,
}

/// A quantity that is logged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channel {
    /// The joint's torque, whose symbol is `tau`.
    Torque,
    /// The joint's position, `q`.
    Position,
    /// The joint's rate, `qd`.
    Rate,
}

impl Channel {
    /// The name in files and laws.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Torque => "tau",
            Self::Position => "q",
            Self::Rate => "qd",
        }
    }
}

/// What joins a drive to its joint. Where the torque that is logged is the drive's and the position
/// the joint's, the rotor moves otherwise than the joint; where both are the drive's, the joint
/// does. Numbers are over the inertia of what moves: of the rotor, or of the bodies about the joint
/// where all joints are at 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Transmission {
    /// The root of that inertia times the compliance \[s\]: one over the angular frequency of the
    /// swing while the other side stands.
    pub swing_s: ExprId,
    /// Damping of that swing, as a share of the critical one.
    pub damping: ExprId,
    /// The width in which only drag is passed on [rad, m].
    pub play: ExprId,
    /// What the sides drag each other along by, also within the play, over the inertia and their
    /// difference in velocity \[1/s\].
    pub drag: ExprId,
    /// The share of the drive's friction that brakes the joint instead: of bearings, not of a
    /// motor.
    pub joint_friction: ExprId,
}

/// What is logged of a true quantity, or what is true of a logged one: value(t - delay), then a
/// first-order lag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measured {
    /// Which quantity.
    pub channel: Channel,
    /// Whether `value` is what is true where the channel's symbol is what is logged: a drive that
    /// gives less than the torque that was demanded of it.
    pub is_inverse: bool,
    /// What it would be without delay and lag: the channel's symbol if nothing changes it.
    pub value: ExprId,
    /// Delay \[s\]; negative if the channel runs ahead of the others.
    pub delay_s: ExprId,
    /// Time constant of the lag \[s\].
    pub lag_s: ExprId,
    /// What is between the drive, whose torque is logged, and the joint; rigid if there is none.
    pub transmission: Option<Transmission>,
}

/// A property of a place that an effect can move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Property {
    /// Mass of a link \[kg\].
    Mass,
    /// First moment of a link about the origin of its frame \[kg m\], along one axis.
    FirstMoment(usize),
    /// Moment of inertia about that origin \[kg m^2\]: xx, yy, zz, xy, xz, yz.
    Inertia(usize),
    /// Acceleration of free fall in frame 0 \[m/s^2\], along one axis.
    Gravity(usize),
    /// The position that the model takes for the joint's: q becomes q + this.
    Zero,
    /// Stiffness of the joint's series spring \[N/m\].
    SeriesStiffness,
}

/// A term of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ModelTerm {
    /// `C qd`.
    Coriolis,
    /// `G`.
    Gravity,
    /// Reflected rotor inertia.
    Rotor,
    /// Friction of the drives.
    Friction,
    /// Springs across joints.
    Spring,
    /// `D qdd`.
    Inertia,
}

impl ModelTerm {
    /// The terms, in the order of listings.
    pub const ALL: [Self; 6] =
        [Self::Coriolis, Self::Gravity, Self::Rotor, Self::Friction, Self::Spring, Self::Inertia];

    /// The word in files.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Coriolis => "coriolis",
            Self::Gravity => "gravity",
            Self::Rotor => "rotor",
            Self::Friction => "friction",
            Self::Spring => "spring",
            Self::Inertia => "inertia",
        }
    }
}

/// What an effect does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Law {
    /// The torque that its joint needs besides [N m, N].
    Torque(ExprId),
    /// What is logged.
    Measured(Measured),
    /// What is added to properties of the place.
    Moves(Vec<(Property, ExprId)>),
    /// A term, with the coefficient 1.
    Term(ModelTerm),
}

impl Law {
    /// The expressions of the law.
    pub fn expressions(&self) -> Vec<ExprId> {
        match self {
            Self::Torque(torque) => vec![*torque],
            Self::Measured(measured) => {
                let mut all = vec![measured.value, measured.delay_s, measured.lag_s];
                let parts = |one: Transmission| {
                    [one.swing_s, one.play, one.damping, one.drag, one.joint_friction]
                };
                let parts = measured.transmission.map(parts);
                all.extend(parts.into_iter().flatten());
                all
            }
            Self::Moves(moves) => moves.iter().map(|(_, by)| *by).collect(),
            Self::Term(_) => Vec::new(),
        }
    }
}

/// Another effect that this one is taken for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Confusion {
    /// Its name.
    pub effect: String,
    /// Why.
    pub reason: String,
}

/// A checked effect.
#[derive(Clone, Debug)]
pub struct Effect {
    /// The name, an identifier.
    pub name: String,
    /// A few words for listings.
    pub title: String,
    /// What it is, in a sentence or more.
    pub description: String,
    /// Where the law comes from.
    pub source: String,
    /// What it is to the equations.
    pub kind: EffectKind,
    /// Where it can act.
    pub at: EffectSite,
    /// How often it is met.
    pub occurrence: Occurrence,
    /// On which side of a series spring it acts, if it is a law of a joint.
    pub side: SpringSide,
    /// Its parameters, in file order.
    pub parameters: Vec<EffectParameter>,
    /// Its states, in file order.
    pub states: Vec<EffectState>,
    /// Its law.
    pub law: Law,
    /// What the second joint of a pair needs besides [N m, N], in the symbols of the first one's
    /// law; none where only the first joint feels the effect.
    pub torque_2: Option<ExprId>,
    /// Shipped effects of the same physics that it is a finer form of: with some values of its
    /// parameters, or near them, it is that law.
    pub refines: Vec<String>,
    /// What it is taken for.
    pub confused_with: Vec<Confusion>,
    /// Holds the expressions; the symbols of the motion are those of [`VARIABLES`].
    pub dag: Dag,
}

/// The symbols of laws that have a value in every sample: time, motion of the joint, torques, and
/// the same of the other joint of a pair. Samples have them as columns, in this order.
pub const COLUMNS: [&str; 13] = [
    "t",
    "q",
    "qd",
    "creep",
    "qdd",
    "tau_load",
    "tau_load_rate",
    "tau",
    "q_2",
    "qd_2",
    "qdd_2",
    "tau_load_2",
    "tau_load_rate_2",
];

/// The symbols of laws for the components of gravity in frame 0, which do not change.
pub const GRAVITY: [&str; 3] = ["g_x", "g_y", "g_z"];

/// The symbols that laws may use beside their own: [`COLUMNS`], then [`GRAVITY`].
pub const VARIABLES: [&str; COLUMNS.len() + GRAVITY.len()] = {
    let mut variables = [""; COLUMNS.len() + GRAVITY.len()];
    let mut place = 0;
    while place < variables.len() {
        variables[place] = match place < COLUMNS.len() {
            true => COLUMNS[place],
            false => GRAVITY[place - COLUMNS.len()],
        };
        place += 1;
    }
    variables
};

/// Those of [`VARIABLES`] that both joints of a pair have: the second one's end in `_2`.
const MOTION: [&str; 5] = ["q", "qd", "qdd", "tau_load", "tau_load_rate"];

impl Effect {
    /// The parameter of that name.
    pub fn parameter(&self, name: &str) -> Option<&EffectParameter> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }

    /// The effect on a side of series springs, if that is said.
    pub fn on_side(&self, side: Option<SpringSide>) -> Cow<'_, Self> {
        match side.filter(|side| *side != self.side) {
            Some(side) => Cow::Owned(Self { side, ..self.clone() }),
            None => Cow::Borrowed(self),
        }
    }

    /// Whether it brakes a motor by its motion alone, and so may brake a link behind a series
    /// spring as well: friction of bearings and seals, not that of loaded gears.
    pub fn is_of_any_bearing(&self) -> bool {
        let Law::Torque(torque) = self.law else { return false };
        let mut exprs = vec![torque];
        exprs.extend(self.states.iter().map(|state| state.rate));
        let used = free_symbols(&self.dag, &exprs);
        let uses = |name: &str| self.dag.find_symbol(name).is_some_and(|id| used.contains(&id));
        let is_of_joint = self.at == EffectSite::Joint && self.side == SpringSide::Motor;
        is_of_joint
            && ["qd", "creep"].into_iter().any(uses)
            && !["qdd", "tau_load", "tau_load_rate"].into_iter().any(uses)
    }

    /// The expression of a symbol of [`VARIABLES`] or of a parameter, if a law uses it.
    pub fn symbol(&mut self, name: &str) -> Option<ExprId> {
        let id = self.dag.find_symbol(name)?;
        Some(self.dag.symbol_expr(id))
    }
}

/// Which end of its bounds a value is beyond, in words; none if it is within.
fn beyond(value: &Rational, [low, high]: &[Option<Rational>; 2]) -> Option<String> {
    let below =
        low.as_ref().filter(|low| value < low).map(|low| format!("below {}", decimal_text(low)));
    let above = || high.as_ref().filter(|high| value > high);
    below.or_else(|| above().map(|high| format!("above {}", decimal_text(high))))
}

#[cfg(test)]
mod tests {
    use super::{COLUMNS, GRAVITY, MOTION, VARIABLES};

    #[test]
    fn symbols_of_laws_are_columns_then_gravity() {
        assert_eq!(VARIABLES[..COLUMNS.len()], COLUMNS);
        assert_eq!(VARIABLES[COLUMNS.len()..], GRAVITY);
        for name in MOTION {
            assert!(COLUMNS.contains(&name) && COLUMNS.contains(&&*format!("{name}_2")), "{name}");
        }
    }
}
