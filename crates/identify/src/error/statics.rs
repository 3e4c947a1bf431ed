//! What is wrong with measurements at rest.

use std::fmt;

/// Why a measurement is no knowledge; each holds the measurement's number, from 0.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum StaticFault {
    /// The model has no such link or joint; holds it and the one that is meant, perhaps.
    UnknownName(usize, String, Option<String>),
    /// A link has no mass among the unknowns: it is known, or written in symbols of its own.
    NoMass(usize, String),
    /// A link stands on the scale twice.
    Repeated(usize, String),
    /// Nothing is on the scale.
    NothingWeighed(usize),
    /// Links weigh so many times what the model says, as if in another unit: mass \[kg\], that of
    /// the model \[kg\].
    Unit(usize, f64, f64),
    /// Torques or positions of all postures seem to be in another unit, or of the other sign.
    Postures(MisreadPostures),
    /// A posture has not one position for each joint: expected, found.
    WrongPosture(usize, usize, usize),
    /// A standard deviation is not positive, or a number not finite.
    BadNumber(usize),
}

impl fmt::Display for StaticFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownName(at, name, near) => {
                write!(f, "measurement {}: nothing is called `{name}`", at + 1)?;
                match near {
                    Some(near) => write!(f, "\n  hint: `{near}` is meant, perhaps"),
                    None => Ok(()),
                }
            }
            Self::NoMass(at, link) => write!(
                f,
                "measurement {}: the mass of `{link}` is not among the unknown parameters",
                at + 1
            ),
            Self::Repeated(at, link) => {
                write!(f, "measurement {}: `{link}` is named twice", at + 1)
            }
            Self::NothingWeighed(at) => write!(
                f,
                "measurement {}: `links` is empty\n  hint: name the links on the scale",
                at + 1
            ),
            Self::Unit(at, mass, expected) => write!(
                f,
                "measurement {}: {mass} kg, and the model says {expected} kg: is it in {}?\n  \
                 hint: `logs.accepts_suspicious` takes it as it is",
                at + 1,
                if mass > expected { "grams" } else { "tonnes" }
            ),
            Self::Postures(one) => write!(f, "{one}"),
            Self::WrongPosture(at, expected, found) => write!(
                f,
                "measurement {}: a posture has {expected} positions, {found} are given",
                at + 1
            ),
            Self::BadNumber(at) => write!(
                f,
                "measurement {}: numbers must be finite, and standard deviations positive",
                at + 1
            ),
        }
    }
}

impl StaticFault {
    /// The number of the measurement, from 0; none where it is all of them.
    pub(crate) fn measurement(&self) -> Option<usize> {
        match *self {
            Self::UnknownName(at, ..)
            | Self::NoMass(at, _)
            | Self::Repeated(at, _)
            | Self::NothingWeighed(at)
            | Self::Unit(at, ..)
            | Self::WrongPosture(at, ..)
            | Self::BadNumber(at) => Some(at),
            Self::Postures(_) => None,
        }
    }
}

/// Torques or positions of all postures that seem to be in another unit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MisreadPostures {
    /// Whether it is the torques, or the positions of joints that turn.
    pub(crate) of_torques: bool,
    /// What they are to be multiplied with.
    pub(crate) factor: f64,
    /// The share of the torques (roots of mean squares) that the model's own values leave, as they
    /// are and with the factor.
    pub(crate) left: [f64; 2],
}

impl fmt::Display for MisreadPostures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { of_torques, factor, left: [before, after] } = self;
        let what = if *of_torques { "torques" } else { "positions" };
        let how = match *factor == -1.0 {
            true => "to have the wrong sign".to_owned(),
            false => "to be in another unit".to_owned(),
        };
        write!(
            f,
            "{what} of the postures seem {how}: the model's own values leave {:.0} % of the \
             torques, and {:.0} % with {factor} times the {what}\n  hint: \
             `logs.accepts_suspicious` \
             takes them as they are",
            100.0 * before,
            100.0 * after
        )
    }
}
