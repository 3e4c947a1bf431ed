//! What is said about each fault: a sentence, and a hint where the way out is not plain from it.

use super::fault::{Cause, Explained};
use super::json::{MAX_BYTES, MAX_DEPTH, MAX_VALUES};
use super::spelling::MAX_NAME_LENGTH;
use super::unit::{Dimension, UnitError};
use crate::number::MAX_DECIMAL_DIGITS;
use std::fmt;

/// What a message calls the place of an effect.
pub(super) const EFFECT_PLACE: &str = "place of an effect";

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FileTooLarge(bytes) => {
                write!(f, "the file has {bytes} bytes, more than the {MAX_BYTES} that are read")
            }
            Self::NotUtf8 => write!(f, "the file is not UTF-8 text"),
            Self::ByteOrderMark => write!(f, "the file begins with a byte order mark"),
            Self::Syntax(message) => write!(f, "not JSON: {message}"),
            Self::TooDeep => {
                write!(f, "lists and objects are nested more than {MAX_DEPTH} levels deep")
            }
            Self::TooManyValues => write!(f, "the file has more than {MAX_VALUES} values"),
            Self::WrongKind { expected, found } => write!(f, "expected {expected}, found {found}"),
            Self::UnknownKey { key, .. } => write!(f, "unknown key `{}`", clip(key)),
            Self::DuplicateKey(key) => write!(f, "the key `{}` is given twice", clip(key)),
            Self::MissingKey(key) => write!(f, "the key `{key}` is missing"),
            Self::WrongFormat { found, expected } => {
                write!(f, "the format is `{}`, not `{expected}`", clip(found))
            }
            Self::NoEquations => write!(f, "there is no equation"),
            Self::NotAnEquation(text) => write!(f, "\"{}\" is not an equation", clip(text)),
            Self::UnknownWord { what, found, .. } => write!(f, "unknown {what} `{}`", clip(found)),
            Self::WrongLength { expected, found } => {
                write!(f, "expected {expected} values, found {found}")
            }
            Self::NoLinks => write!(f, "the model has no link"),
            Self::NotIdentifier(name) => write!(f, "`{}` is not a name", clip(name)),
            Self::ReservedName(name, by) => write!(f, "the name `{name}` belongs to {by}"),
            Self::DuplicateName(name, what) => {
                write!(f, "the name `{name}` is already that of {what}")
            }
            Self::NameClash { name, link } => {
                write!(f, "the name `{name}` is also that of a symbol generated for link `{link}`")
            }
            _ => self.fmt_expression(f),
        }
    }
}

impl Cause {
    /// The sentence of a fault in an expression, a number or a unit.
    fn fmt_expression(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Expression(text, error) => {
                let before = text.get(..error.offset).unwrap_or(text);
                let (column, cause) = (before.chars().count() + 1, error.cause.to_string());
                write!(f, "in \"{}\", at character {column}: {}", clip(text), clip(&cause))
            }
            Self::UnknownSymbol { text, name, .. } => {
                write!(f, "in \"{}\": nothing is called `{}`", clip(text), clip(name))
            }
            Self::VariableInRow(name) => {
                write!(f, "`{}` looks like a joint variable, which a row does not name", clip(name))
            }
            Self::SymbolInValue(text, name) => {
                write!(
                    f,
                    "\"{}\" depends on `{name}`, but only a number may stand here",
                    clip(text)
                )
            }
            Self::ValueNotKnown(text, name) => {
                write!(
                    f,
                    "\"{}\" needs the value of `{}`, which is not known here",
                    clip(text),
                    clip(name)
                )
            }
            Self::DivisionByZero(text) => {
                write!(f, "in \"{}\": division by 0 with the values of this file", clip(text))
            }
            Self::NotReal(text) => {
                write!(f, "in \"{}\": no real number with the values of this file", clip(text))
            }
            Self::TooMuchText(limit) => {
                write!(f, "the expressions of the file are together longer than {limit} bytes")
            }
            Self::NotFinite(text) => write!(f, "`{}` is not a finite number", clip(text)),
            Self::HugeNumber => {
                write!(f, "the number is beyond 1e308 or longer than {MAX_DECIMAL_DIGITS} digits")
            }
            Self::Unit(text, error) => write!(f, "\"{}\" is not a unit: {error}", clip(text)),
            Self::WrongDimension { what, expected, found } => {
                write!(f, "{what} must be {}, this is {}", measure(expected), measure(found))
            }
            Self::MixedSum(text, left, right) => {
                let (left, right) = (measure(left), measure(right));
                write!(f, "in \"{}\": a sum of something {left} and something {right}", clip(text))
            }
            Self::FunctionOfQuantity(text, found) => {
                write!(f, "in \"{}\": a function of a quantity in {found}", clip(text))
            }
            _ => self.fmt_structure(f),
        }
    }

    /// The sentence of a fault in the robot that the file describes.
    fn fmt_structure(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownLink(name, _) => write!(f, "no link is called `{}`", clip(name)),
            Self::UnknownContact(name, _) => write!(f, "no contact is called `{}`", clip(name)),
            Self::LateParent(name) => {
                write!(f, "the parent `{name}` stands after the link that it carries")
            }
            Self::Cycle(links) => write!(f, "these links carry each other: {}", circle(links)),
            Self::NotAParameter => {
                write!(f, "`std` and `known` say something about a parameter, which this is not")
            }
            Self::TwoPlaces => {
                write!(f, "an effect acts in one place, not on a link and a contact")
            }
            Self::BodyOnFixedBase => write!(f, "a fixed base has no body"),
            Self::NotOnFixedJoint(key) => write!(f, "a fixed joint has no `{key}`"),
            Self::RoundedAngle { found, exact } => {
                write!(f, "\"{}\" is almost {exact}, and not quite", clip(found))
            }
            Self::UnknownInRow(name) => {
                write!(f, "the unknown `{name}` stands in a row, which must be known")
            }
            Self::DriveOnFixedJoint(link) => {
                write!(f, "the joint of `{link}` is fixed: no motor can drive it")
            }
            Self::DampingTwice(link) => {
                write!(f, "`{link}` has `damping` in its joint and `viscous` in its drive")
            }
            Self::ReversedRange(low, high) => {
                write!(f, "the lower end {low} is above the upper end {high}")
            }
            Self::NotPositive(what, value) => write!(f, "{what} must be positive, this is {value}"),
            Self::Negative(what, value) => {
                write!(f, "{what} must not be negative, this is {value}")
            }
            Self::ZeroGearRatio => write!(f, "the gear ratio is 0"),
            Self::ZeroNormal => write!(f, "the normal of the ground is the zero vector"),
            Self::PointOrCapsule => write!(f, "a capsule has no `position`"),
            Self::Unphysical(reason) => write!(f, "{reason}"),
            Self::NothingToAccept => {
                write!(f, "there is no violated triangle inequality to accept")
            }
            _ => self.fmt_effect(f),
        }
    }

    /// The sentence of a fault in an effect.
    fn fmt_effect(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotRational(text) => write!(f, "\"{}\" is not a rational number", clip(text)),
            Self::OutOfBounds(Some([parameter, effect]), value, beyond) => {
                write!(f, "`{parameter}` of `{effect}` is {value}: it cannot be {beyond}")
            }
            Self::OutOfBounds(None, value, beyond) => {
                write!(f, "the value {value} is out of bounds: it cannot be {beyond}")
            }
            Self::NoLaw(kind, key) => write!(f, "an effect of the kind `{kind}` has `{key}`"),
            Self::WrongLaw(kind, key) => {
                write!(f, "an effect of the kind `{kind}` has no `{key}`")
            }
            Self::LawKey(key, why) => write!(f, "`{key}` {why}"),
            Self::NeverVanishes => {
                write!(f, "with all `nominal` values the effect does not vanish")
            }
            Self::WrongPlace(name, place) => write!(f, "`{name}` acts on {place}, not here"),
            Self::NotOfEffect(effect, name, _) => {
                write!(f, "`{effect}` has no parameter `{}`", clip(name))
            }
            Self::AddedTwice(name) => write!(f, "`{name}` is added twice in this place"),
            Self::NothingToChange(name, what) => {
                write!(f, "there is nothing that `{name}` could change: {what}")
            }
            Self::UnknownEffect(name, _) => write!(f, "no effect is called `{}`", clip(name)),
            other => unreachable!("{other:?} has its sentence above"),
        }
    }
}

impl Explained for Cause {
    fn hint(&self) -> Option<String> {
        let hint = match self {
            Self::UnknownKey { nearest: Some(nearest), .. } => format!("did you mean `{nearest}`?"),
            Self::UnknownKey { known, nearest: None, .. } => {
                format!("the keys here are {}", known.join(", "))
            }
            Self::UnknownWord { what: EFFECT_PLACE, .. } => {
                "it is \"model\", {\"link\": ..} or {\"contact\": ..}".to_owned()
            }
            Self::UnknownWord { nearest: Some(nearest), .. } => {
                format!("did you mean \"{nearest}\"?")
            }
            Self::UnknownWord { known, nearest: None, .. } => {
                format!("it is one of \"{}\"", known.join("\", \""))
            }
            Self::Expression(_, error) => return error.hint.clone(),
            Self::UnknownSymbol { nearest: Some(name), .. }
            | Self::UnknownLink(_, Some(name))
            | Self::UnknownContact(_, Some(name))
            | Self::NotOfEffect(_, _, Some(name))
            | Self::UnknownEffect(_, Some(name)) => format!("did you mean `{name}`?"),
            Self::UnknownSymbol { nearest: None, name, section, .. } => {
                format!(
                    "declare it: \"{section}\": {{\"{}\": {{\"value\": .., \"unit\": ..}}}}",
                    clip(name)
                )
            }
            Self::Unit(_, UnitError::NotCoherent(_, advice)) => (*advice).to_owned(),
            Self::RoundedAngle { exact, .. } => format!(
                "write \"{exact}\": with rounded angles what cancels in theory does not; axes that \
                 really are out of line are \"{exact} + 0.0002\""
            ),
            Self::Unphysical(reason) => return reason.hint(),
            other => return other.fixed_hint().map(str::to_owned),
        };
        Some(hint)
    }
}

impl Cause {
    fn fixed_hint(&self) -> Option<&'static str> {
        Some(match self {
            Self::FileTooLarge(_) => "such files have some kilobytes: is this the file?",
            Self::NotUtf8 => "save the file as UTF-8",
            Self::ByteOrderMark => "save the file as UTF-8 without byte order mark",
            Self::TooDeep => "no such file needs more than ten levels",
            Self::TooManyValues => "such files have some thousands: is this the file?",
            Self::Syntax(message) => return syntax_hint(message),
            Self::MissingKey("format") => {
                "a model file begins with \"format\": \"denavit-model/1\""
            }
            Self::DuplicateKey(_) => "only one of them could count: remove the other",
            Self::WrongFormat { expected: "denavit-effect/1", .. } => {
                "docs/reference/effects.md describes the format"
            }
            Self::WrongFormat { expected, .. } if *expected == super::equations::FORMAT => {
                "docs/reference/equations.md describes the format"
            }
            Self::WrongFormat { .. } => "docs/reference/model-file.md describes the format",
            Self::NoEquations => "an equation is a text, as \"tau = m*l^2*thdd + m*g*l*cos(th)\"",
            Self::NotAnEquation(_) => "write two expressions with one = between them",
            Self::MissingKey("about") => {
                "say about which point the inertia is taken: \"com\" or \"origin\""
            }
            Self::NoLinks => "a link is {\"name\": .., \"joint\": {\"type\": ..}}",
            Self::NotIdentifier(name) if name.len() > MAX_NAME_LENGTH => {
                "a name has at most 64 characters"
            }
            Self::NotIdentifier(_) => {
                "a name is a letter followed by letters, digits and underscores"
            }
            Self::ReservedName(..) | Self::DuplicateName(..) => "choose another name",
            Self::NameClash { .. } => {
                "rename one of them: symbols of a link are a short prefix, `_`, and its name"
            }
            Self::VariableInRow(_) => {
                "leave it out: the variable adds to theta (revolute) or d (prismatic) by itself"
            }
            Self::SymbolInValue(..) => "give a number here, and the formula where it is used",
            Self::ValueNotKnown(..) => {
                "a value may use constants that are declared before it and have a value"
            }
            Self::NotReal(_) => "roots are of what is not negative, logarithms of what is positive",
            Self::NotFinite(_) => "leave the entry out if it is not known",
            Self::HugeNumber => "quantities of robots fit in a few digits: check the exponent",
            Self::Unit(..) => {
                "a unit is a product of powers of SI units, as \"kg m^2\" or \"N m/rad\""
            }
            Self::WrongDimension { .. } => "check the units of the constants in the expression",
            Self::MixedSum(..) | Self::FunctionOfQuantity(..) => {
                "check the units of the constants in the expression"
            }
            Self::UnknownLink(..) => {
                "the links are those of \"links\"; \"base\" is what they stand on"
            }
            Self::LateParent(_) => "move the parent in front of the links that it carries",
            Self::Cycle(_) => "one of them must stand on the base or on a link outside the circle",
            other => return other.robot_hint(),
        })
    }

    /// Hints about what the file says of the robot.
    fn robot_hint(&self) -> Option<&'static str> {
        Some(match self {
            Self::NotAParameter => {
                "the entry is written in declared names: say it of the unknowns that it uses"
            }
            Self::BodyOnFixedBase => {
                "the body is that of a floating base: it belongs to base_pitch"
            }
            Self::NotOnFixedJoint(_) => "a joint that moves is \"revolute\" or \"prismatic\"",
            Self::UnknownInRow(_) => "declare it under \"constants\"; unknowns belong to bodies",
            Self::DriveOnFixedJoint(_) => "remove the drive, or let the joint move",
            Self::DampingTwice(_) => {
                "both are viscous friction: keep `viscous` (motor side) or `damping` (joint side)"
            }
            Self::ReversedRange(..) => "exchange them",
            Self::NotPositive("the mass", _) => {
                "a link without mass has no \"body\"; an unknown mass has no \"mass\" entry"
            }
            Self::ZeroGearRatio => "leave it out for a direct drive; a reversing gear is negative",
            Self::ZeroNormal => "level ground has the normal [0, 0, 1]",
            Self::PointOrCapsule => {
                "a point has `position`; a capsule has `from`, `to` and `radius_m`"
            }
            Self::NothingToAccept => "remove the key: the inertia is that of a real body",
            Self::NotRational(_) => "write the number as a decimal or a fraction",
            Self::NeverVanishes => {
                "give `nominal` to the parameters that switch it off, as 0 to a coefficient"
            }
            Self::WrongPlace(..) => "docs/reference/effects.md says where each effect acts",
            Self::AddedTwice(_) => "add it once, with the sum of both",
            Self::UnknownEffect(..) => {
                "effects are those of docs/reference/effects.md, and the files of your own folder \
                 of effects"
            }
            _ => return None,
        })
    }
}

/// A dimension as part of a sentence.
fn measure(dimension: &Dimension) -> String {
    if *dimension == Dimension::NONE {
        "a pure number or an angle".to_owned()
    } else {
        format!("in {dimension}")
    }
}

/// A circle of links, shortened in the middle.
fn circle(links: &[String]) -> String {
    let mut names: Vec<String> = links.iter().map(|name| clip(name)).collect();
    if names.len() > 8 {
        names.splice(4..links.len() - 3, ["...".to_owned()]);
    }
    names.join(" -> ")
}

/// What to do about a text that is not JSON, from what the reader says.
fn syntax_hint(message: &str) -> Option<&'static str> {
    let hints = [
        ("key must be", "a comma too many, a comment, or a key without quotes: JSON has none"),
        ("expected value", "JSON has no NaN, no infinity and no numbers like .5 or +5"),
        ("trailing comma", "remove the comma before the closing bracket"),
        ("expected `,`", "a comma is missing before this"),
        ("EOF", "the file ends too early: a bracket or a quote is not closed"),
        ("control character", "a string ends on its line: is its closing quote missing?"),
        ("trailing characters", "the file is one object"),
        ("invalid number", "a number is written as -12.5e-3"),
    ];
    hints.into_iter().find(|(start, _)| message.starts_with(start)).map(|(_, hint)| hint)
}

/// The first 60 characters of what the user wrote: a message must stay readable.
fn clip(text: &str) -> String {
    let mut clipped: String = text.chars().take(60).collect();
    if clipped.len() < text.len() {
        clipped.push_str("...");
    }
    // a quoted line break or control character would tear the message apart
    clipped
        .chars()
        .flat_map(|c| if c.is_control() { c.escape_default().collect() } else { vec![c] })
        .collect()
}
