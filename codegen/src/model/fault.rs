//! What can be wrong with a model file: where, why, and what to do about it.

use super::inertia::Unphysical;
use super::unit::{Dimension, UnitError};
use crate::expr::text::ParseError;
use std::fmt;

/// Most faults that one answer lists: garbage has millions.
pub const MAX_FAULTS: usize = 100;

/// What is wrong at a place: a sentence (`Display`), and what to do about it.
pub trait Explained: fmt::Display {
    /// The way out, where it is not plain from the sentence.
    fn hint(&self) -> Option<String>;
}

/// One fault with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault<C = Cause> {
    /// JSON pointer of the value at fault, as `/links/3/parent`; empty for the whole file.
    pub pointer: String,
    /// Line of the value, from 1.
    pub line: usize,
    /// Column of the value in characters, from 1.
    pub column: usize,
    /// What is wrong.
    pub cause: C,
}

impl<C: Explained> Fault<C> {
    /// What to do about it.
    pub fn hint(&self) -> Option<String> {
        self.cause.hint()
    }

    /// File, place, cause and hint.
    pub fn message(&self, file: &str) -> String {
        let mut message = format!("{file}:{}:{}: ", self.line, self.column);
        if !self.pointer.is_empty() {
            message.push_str(&format!("{}: ", self.pointer));
        }
        message.push_str(&self.cause.to_string());
        if let Some(hint) = self.hint() {
            message.push_str(&format!("\n  hint: {hint}"));
        }
        message
    }
}

/// Everything that is wrong with a file, in its order.
#[derive(Clone, Debug, PartialEq)]
pub struct FileError<C> {
    /// The name of the file, as it was given.
    pub file: String,
    /// The faults, at least one, at most [`MAX_FAULTS`].
    pub faults: Vec<Fault<C>>,
    /// How many more there are.
    pub omitted: usize,
}

/// Everything that is wrong with a model file, or with a file of equations.
pub type ModelError = FileError<Cause>;

impl<C: Explained> fmt::Display for FileError<C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, fault) in self.faults.iter().enumerate() {
            let separator = if index == 0 { "" } else { "\n" };
            write!(f, "{separator}{}", fault.message(&self.file))?;
        }
        match self.omitted {
            0 => Ok(()),
            1 => write!(f, "\nand 1 more fault"),
            more => write!(f, "\nand {more} more faults"),
        }
    }
}

impl<C: Explained + fmt::Debug> std::error::Error for FileError<C> {}

/// What is wrong. `Display` gives the sentence, [`Cause::hint`] the way out; `message.rs` has both.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// The file has more than 16 MiB; holds its size in bytes.
    FileTooLarge(usize),
    /// The file is not UTF-8.
    NotUtf8,
    /// The file begins with a byte order mark.
    ByteOrderMark,
    /// Not JSON; holds what the JSON reader says.
    Syntax(String),
    /// Lists and objects are nested too deep.
    TooDeep,
    /// The file has too many values.
    TooManyValues,
    /// A value of the wrong kind.
    WrongKind {
        /// What should stand here.
        expected: &'static str,
        /// What stands here.
        found: &'static str,
    },
    /// A key that the format does not have here.
    UnknownKey {
        /// The key.
        key: String,
        /// The key that was meant, perhaps.
        nearest: Option<&'static str>,
        /// The keys that may stand here.
        known: &'static [&'static str],
    },
    /// A key that the same object already has.
    DuplicateKey(String),
    /// A key that must stand here does not.
    MissingKey(&'static str),
    /// The tag is not that of this kind of file.
    WrongFormat {
        /// The tag.
        found: String,
        /// The tag that it should be.
        expected: &'static str,
    },
    /// A file of equations without an equation.
    NoEquations,
    /// An equation that is not one expression, "=", and another one.
    NotAnEquation(String),
    /// A word that is none of those that may stand here.
    UnknownWord {
        /// What the word should say.
        what: &'static str,
        /// The word.
        found: String,
        /// The words that may stand here.
        known: &'static [&'static str],
        /// The word that was meant, perhaps.
        nearest: Option<&'static str>,
    },
    /// A list of the wrong length.
    WrongLength {
        /// How many values it should have.
        expected: usize,
        /// How many it has.
        found: usize,
    },
    /// The model has no link.
    NoLinks,
    /// The name cannot be written in an expression.
    NotIdentifier(String),
    /// The name has a meaning elsewhere; holds it and where.
    ReservedName(String, &'static str),
    /// The name is taken; holds it and what has it.
    DuplicateName(String, &'static str),
    /// The name is also that of a generated symbol; holds both names.
    NameClash {
        /// The name.
        name: String,
        /// The link whose symbol has it.
        link: String,
    },
    /// A text is not an expression; holds the text and the fault.
    Expression(String, ParseError),
    /// A name in an expression that nobody declared.
    UnknownSymbol {
        /// The expression.
        text: String,
        /// The name.
        name: String,
        /// The declared name that was meant, perhaps.
        nearest: Option<String>,
        /// The key of the file under which it would be declared.
        section: &'static str,
    },
    /// A joint variable in a row of the table.
    VariableInRow(String),
    /// A symbol where only numbers may stand; holds the expression and the symbol.
    SymbolInValue(String, String),
    /// A value refers to a constant that has no value or is declared later.
    ValueNotKnown(String, String),
    /// A division by 0, at least with the values that the file gives; holds the expression.
    DivisionByZero(String),
    /// The root of a negative number or the logarithm of one that is not positive, at least with
    /// the values that the file gives; holds the expression.
    NotReal(String),
    /// All expressions together are longer than the limit, which it holds (bytes).
    TooMuchText(usize),
    /// Not a finite number; holds the text.
    NotFinite(String),
    /// A number that is too large, or too long when written out.
    HugeNumber,
    /// A text that is no unit; holds it and the reason.
    Unit(String, UnitError),
    /// A quantity of the wrong dimension.
    WrongDimension {
        /// What the value is.
        what: String,
        /// The dimension it must have.
        expected: Dimension,
        /// The dimension that it has.
        found: Dimension,
    },
    /// A sum of two dimensions; holds the expression and both.
    MixedSum(String, Dimension, Dimension),
    /// A function of a quantity that is no pure number; holds the expression and the dimension.
    FunctionOfQuantity(String, Dimension),
    /// No link has this name; holds it and the name that was meant, perhaps.
    UnknownLink(String, Option<String>),
    /// No contact has this name; holds it and the name that was meant, perhaps.
    UnknownContact(String, Option<String>),
    /// A parent that stands later in the file.
    LateParent(String),
    /// Links that carry each other, in order.
    Cycle(Vec<String>),
    /// `std` or `known` at an entry that is written in declared names.
    NotAParameter,
    /// An effect with a link and a contact.
    TwoPlaces,
    /// A body of a base that does not move.
    BodyOnFixedBase,
    /// An entry that a fixed joint cannot have.
    NotOnFixedJoint(&'static str),
    /// An angle that is near a multiple of a quarter turn, and not one.
    RoundedAngle {
        /// What is written.
        found: String,
        /// The multiple.
        exact: String,
    },
    /// An unknown in a row of the table.
    UnknownInRow(String),
    /// A drive of a fixed joint.
    DriveOnFixedJoint(String),
    /// Damping in the joint and viscous friction in its drive.
    DampingTwice(String),
    /// A range whose ends are exchanged; holds both as text.
    ReversedRange(String, String),
    /// A number that must be positive; holds what it is and its value.
    NotPositive(&'static str, String),
    /// A number that must not be negative; holds what it is and its value.
    Negative(&'static str, String),
    /// A gear ratio of 0.
    ZeroGearRatio,
    /// The ground's normal has no direction.
    ZeroNormal,
    /// A body that is said to be a point and a capsule.
    PointOrCapsule,
    /// Mass properties that no body has.
    Unphysical(Unphysical),
    /// A triangle inequality is accepted as violated, and holds.
    NothingToAccept,
    /// A number that must be rational, and is not; holds its text.
    NotRational(String),
    /// A number outside the bounds of the parameter that it is of; holds the parameter's name and
    /// its effect's, if these are not where it stands, the number, and which end it is beyond.
    OutOfBounds(Option<[String; 2]>, String, String),
    /// An effect without a law of its kind; holds the kind and the key of the law.
    NoLaw(&'static str, &'static str),
    /// An effect with a law that its kind does not have; holds the kind and the key.
    WrongLaw(&'static str, &'static str),
    /// A key of a law that does not belong there; holds the key and why.
    LawKey(&'static str, &'static str),
    /// A law that is not nothing where its parameters have their nominal values.
    NeverVanishes,
    /// An effect that cannot act there; holds its name and where it acts.
    WrongPlace(String, &'static str),
    /// An effect has no parameter of this name; holds both and the name that was meant, perhaps.
    NotOfEffect(String, String, Option<String>),
    /// An effect that is added twice in one place.
    AddedTwice(String),
    /// What an effect would change is not there; holds its name and what is missing.
    NothingToChange(String, &'static str),
    /// No effect has this name; holds it and the name that was meant, perhaps.
    UnknownEffect(String, Option<String>),
}
