//! The law of an effect: its keys in the file, and their expressions.

use super::{Channel, EffectKind, EffectSite, Law, Measured, ModelTerm, Property, Transmission};
use crate::expr::{ExprId, SymbolClass};
use crate::model::check::Scope;
use crate::model::entry::Scalar;
use crate::model::reader::{Fields, Node, Word};
use crate::model::{Cause, Dimension, JointKind, Report};

const CHANNELS: Word<'_, Channel> = Word {
    what: "channel",
    known: &["tau", "q", "qd"],
    values: &[Channel::Torque, Channel::Position, Channel::Rate],
};

const TERMS: Word<'_, ModelTerm> = Word {
    what: "term",
    known: &["coriolis", "gravity", "rotor", "friction", "spring", "inertia"],
    values: &ModelTerm::ALL,
};

/// The law as it is written.
pub(super) enum LawFile<'a> {
    Torque(Scalar<'a>),
    Measured { channel: Channel, parts: Box<[Option<Scalar<'a>>; 11]> },
    Moves(Vec<(Property, Scalar<'a>)>),
    Term(ModelTerm),
}

impl<'a> LawFile<'a> {
    /// Reads the law that an effect of this kind has, and refuses others.
    pub(super) fn read(fields: &Fields<'a>, kind: EffectKind, report: &mut Report) -> Option<Self> {
        let keys: &[&'static str] = match kind {
            EffectKind::Torque | EffectKind::State => &["torque"],
            EffectKind::Measurement => &["measured"],
            EffectKind::Parameter => &["moves"],
            EffectKind::Term => &["term"],
            EffectKind::Mode => &["torque", "measured"],
        };
        for key in ["torque", "measured", "moves", "term"] {
            if let Some(node) = fields.get(key).filter(|_| !keys.contains(&key)) {
                report.push(node.at(), Cause::WrongLaw(kind.as_str(), key));
            }
        }
        if kind == EffectKind::State
            && fields.get("states").is_none_or(|s| s.0.entries().is_empty())
        {
            report.push(fields.at(), Cause::NoLaw(kind.as_str(), "states"));
        }
        let Some((key, node)) = keys.iter().find_map(|key| Some((*key, fields.get(key)?))) else {
            report.push(fields.at(), Cause::NoLaw(kind.as_str(), keys[0]));
            return None;
        };
        match key {
            "torque" => node.scalar(report).map(Self::Torque),
            "measured" => read_measured(node, report),
            "moves" => read_moves(node, report).map(Self::Moves),
            _ => node.word(&TERMS, report).map(Self::Term),
        }
    }
}

fn read_measured<'a>(node: Node<'a>, report: &mut Report) -> Option<LawFile<'a>> {
    const KEYS: &[&str] = &[
        "channel",
        "value",
        "true",
        "gain",
        "offset",
        "delay_s",
        "lag_s",
        "swing_s",
        "damping",
        "play",
        "drag",
        "joint_friction",
    ];
    let fields = node.fields(KEYS, report)?;
    let channel = fields.required_word("channel", &CHANNELS, report);
    let has_more = KEYS[1..7].iter().any(|&key| fields.get(key).is_some());
    for key in &KEYS[7..] {
        let Some(node) = fields.get(key) else { continue };
        let why = match *key {
            "damping" => "belongs to a law of `tau` that has nothing else",
            _ => "belongs to a law of `tau` or `q` that has nothing else",
        };
        let is_of = channel == Channel::Torque || channel == Channel::Position && *key != "damping";
        if !is_of || has_more {
            report.push(node.at(), Cause::LawKey(key, why));
        }
    }
    if let (Some(node), Some(_)) = (fields.get("true"), fields.get("value")) {
        report.push(node.at(), Cause::LawKey("true", "stands in place of `value`, not beside it"));
    }
    let parts = Box::new(std::array::from_fn(|part| fields.scalar(KEYS[part + 1], report)));
    Some(LawFile::Measured { channel, parts })
}

fn read_moves<'a>(node: Node<'a>, report: &mut Report) -> Option<Vec<(Property, Scalar<'a>)>> {
    const KEYS: &[&str] =
        &["mass", "first_moment", "inertia", "gravity", "zero", "series_stiffness"];
    let fields = node.fields(KEYS, report)?;
    let mut moves = Vec::new();
    for (key, property) in [
        ("mass", Property::Mass),
        ("zero", Property::Zero),
        ("series_stiffness", Property::SeriesStiffness),
    ] {
        moves.extend(fields.scalar(key, report).map(|by| (property, by)));
    }
    let mut list = |key: &str, length: usize, property: fn(usize) -> Property| {
        let Some(node) = fields.get(key) else { return };
        let found = fields.items(key, report, Node::scalar);
        if found.len() != length {
            report.push(node.at(), Cause::WrongLength { expected: length, found: found.len() });
        }
        moves.extend(found.into_iter().take(length).enumerate().map(|(i, by)| (property(i), by)));
    };
    list("first_moment", 3, Property::FirstMoment);
    list("inertia", 6, Property::Inertia);
    list("gravity", 3, Property::Gravity);
    Some(moves)
}

/// Reads expressions of laws: the symbols of the motion are those that the place has.
pub(super) struct LawReader {
    pub(super) scope: Scope,
    pub(super) joint: JointKind,
    torque: Dimension,
    position: Dimension,
}

impl LawReader {
    pub(super) fn new(mut scope: Scope, joint: JointKind, at: EffectSite) -> Self {
        let (torque, position) = match joint {
            JointKind::Prismatic => (Dimension::FORCE, Dimension::LENGTH),
            _ => (Dimension::TORQUE, Dimension::NONE),
        };
        let per_second = |dimension: Dimension| dimension.times(Dimension::RATE);
        let rate = per_second(position);
        let (acceleration, torque_rate) = (rate.and_then(per_second), per_second(torque));
        let second = Dimension::NONE.per(Dimension::RATE);
        let mut declare = |name: &str, class, dimension| {
            scope.declare(name, class, dimension, None);
        };
        use SymbolClass::{Acceleration, Configuration, Effort, Geometry, Rate, Time};
        declare("t", Time, second);
        if matches!(at, EffectSite::Joint | EffectSite::JointPair | EffectSite::Spring) {
            declare("q", Configuration, Some(position));
            declare("qd", Rate, rate);
        }
        if matches!(at, EffectSite::Joint | EffectSite::JointPair) {
            declare("qdd", Acceleration, acceleration);
            declare("tau_load", Effort, Some(torque));
            declare("tau_load_rate", Effort, torque_rate);
        }
        if at == EffectSite::Joint {
            declare("creep", Rate, rate);
        }
        if at == EffectSite::JointPair {
            declare("q_2", Configuration, Some(position));
            declare("qd_2", Rate, rate);
            declare("qdd_2", Acceleration, acceleration);
            declare("tau_load_2", Effort, Some(torque));
            declare("tau_load_rate_2", Effort, torque_rate);
        }
        if at == EffectSite::Model {
            for name in super::GRAVITY {
                declare(name, Geometry, Some(Dimension::ACCELERATION));
            }
        }
        Self { scope, joint, torque, position }
    }

    /// An expression of this dimension; 0 where there is none.
    pub(super) fn quantity(
        &mut self,
        scalar: Option<Scalar>,
        what: &str,
        dimension: Dimension,
        report: &mut Report,
    ) -> ExprId {
        let Some(scalar) = scalar else { return self.scope.dag.zero() };
        let expr = self.scope.expression(&scalar, report);
        self.scope.expect(expr, what, dimension, scalar.at, report);
        expr
    }

    /// The law with its expressions.
    pub(super) fn law(&mut self, file: &LawFile, report: &mut Report) -> Option<Law> {
        Some(match file {
            LawFile::Torque(torque) => {
                let torque = self.quantity(Some(torque.clone()), "a torque", self.torque, report);
                Law::Torque(torque)
            }
            LawFile::Measured { channel, parts } => {
                Law::Measured(self.measured(*channel, parts, report))
            }
            LawFile::Moves(moves) => Law::Moves(
                moves
                    .iter()
                    .map(|(property, by)| (*property, self.moved(*property, by, report)))
                    .collect(),
            ),
            LawFile::Term(term) => Law::Term(*term),
        })
    }

    /// What the second joint of a pair feels, if the file says so.
    pub(super) fn on_second(
        &mut self,
        fields: &Fields<'_>,
        kind: EffectKind,
        at: EffectSite,
        report: &mut Report,
    ) -> Option<ExprId> {
        let node = fields.get("torque_2")?;
        // states are those of one law
        if kind != EffectKind::Torque || at != EffectSite::JointPair {
            let why = "belongs to an effect of the kind `torque` at a `joint_pair`";
            report.push(node.at(), Cause::LawKey("torque_2", why));
            return None;
        }
        let torque = node.scalar(report)?;
        Some(self.quantity(Some(torque), "a torque", self.torque, report))
    }

    fn measured(
        &mut self,
        channel: Channel,
        parts: &[Option<Scalar<'_>>; 11],
        report: &mut Report,
    ) -> Measured {
        // only here: a law that adds to the torque cannot answer to the sum
        self.scope.declare("tau", SymbolClass::Effort, Some(self.torque), None);
        let dimension = match channel {
            Channel::Torque => self.torque,
            Channel::Position => self.position,
            Channel::Rate => self.position.times(Dimension::RATE).unwrap_or(self.position),
        };
        let [value, truth, gain, offset, delay, lag, swing, damping, play, drag, joint] = parts;
        let true_value = match channel {
            Channel::Torque => "tau",
            Channel::Position => "q",
            Channel::Rate => "qd",
        };
        let mut logged = match value.as_ref().or(truth.as_ref()) {
            Some(value) => self.quantity(Some(value.clone()), "what is logged", dimension, report),
            None => self.symbol(true_value),
        };
        if let Some(gain) = gain {
            let gain = self.quantity(Some(gain.clone()), "a gain", Dimension::NONE, report);
            logged = self.scope.dag.mul(gain, logged);
        }
        let offset = self.quantity(offset.clone(), "an offset", dimension, report);
        let value = self.scope.dag.add(logged, offset);
        let second = Dimension::NONE.per(Dimension::RATE).unwrap_or(Dimension::NONE);
        let delay_s = self.quantity(delay.clone(), "a delay", second, report);
        let lag_s = self.quantity(lag.clone(), "a lag", second, report);
        let transmission = (swing.is_some() || play.is_some()).then(|| Transmission {
            swing_s: self.quantity(swing.clone(), "a swing", second, report),
            damping: self.quantity(damping.clone(), "a damping", Dimension::NONE, report),
            play: self.quantity(play.clone(), "a play", self.position, report),
            drag: self.quantity(drag.clone(), "a drag", Dimension::RATE, report),
            joint_friction: self.quantity(joint.clone(), "a share", Dimension::NONE, report),
        });
        let is_torque = channel == Channel::Torque;
        let is_inverse = truth.is_some() || transmission.is_some() && is_torque;
        Measured { channel, is_inverse, value, delay_s, lag_s, transmission }
    }

    fn symbol(&mut self, name: &str) -> ExprId {
        match self.scope.dag.find_symbol(name) {
            Some(id) => self.scope.dag.symbol_expr(id),
            None => self.scope.dag.zero(),
        }
    }

    fn moved(&mut self, property: Property, by: &Scalar<'_>, report: &mut Report) -> ExprId {
        let (what, dimension) = match property {
            Property::Mass => ("a mass", Dimension::MASS),
            Property::FirstMoment(_) => ("a first moment", Dimension::FIRST_MOMENT),
            Property::Inertia(_) => ("a moment of inertia", Dimension::INERTIA),
            Property::Gravity(_) => ("gravity", Dimension::ACCELERATION),
            Property::Zero => ("a position", self.position),
            Property::SeriesStiffness => {
                let stiffness = Dimension::FORCE.per(Dimension::LENGTH);
                ("a stiffness", stiffness.unwrap_or(Dimension::FORCE))
            }
        };
        self.quantity(Some(by.clone()), what, dimension, report)
    }
}
