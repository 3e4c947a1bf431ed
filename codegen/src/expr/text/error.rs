//! What is wrong with a text, where, and what might have been meant.

use super::{FUNCTIONS, MAX_CONSTANT_BITS, MAX_EXPONENT, MAX_TEXT_BYTES, PI};
use crate::number::DecimalError;
use std::fmt;

/// Why a text is no expression.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ParseCause {
    /// A character that the language does not have.
    UnexpectedCharacter(char),
    /// Not a number, or one that is too long.
    Number(DecimalError),
    /// A number, a name or an opening bracket should stand here; the token found instead, or
    /// nothing at the end of the text.
    ExpectedOperand(Option<String>),
    /// An operator should stand here; the token found instead.
    ExpectedOperator(String),
    /// The bracket opened here is never closed.
    NeverClosed,
    /// A closing bracket without its opening one.
    NeverOpened,
    /// A comma that separates no arguments.
    StrayComma,
    /// Nobody knows this name.
    UnknownName(String),
    /// Nobody knows this function.
    UnknownFunction(String),
    /// The name of a function without its arguments.
    FunctionWithoutArguments(&'static str),
    /// A function with too few or too many arguments.
    ArgumentCount {
        /// The function.
        function: &'static str,
        /// How many arguments it takes.
        expected: usize,
        /// How many it was given.
        found: usize,
    },
    /// A relation that is not the first argument of `select`.
    StrayRelation,
    /// `select` whose first argument is no relation.
    SelectWithoutRelation,
    /// A division by an expression that is the constant 0.
    DivisionByZero,
    /// An exponent that is no whole number.
    ExponentNotWhole,
    /// An exponent that is larger than [`MAX_EXPONENT`].
    ExponentTooLarge,
    /// A constant that grew beyond [`MAX_CONSTANT_BITS`].
    ConstantTooLong,
    /// The text is longer than [`MAX_TEXT_BYTES`].
    TextTooLong,
}

impl fmt::Display for ParseCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnexpectedCharacter(character) => write!(f, "unexpected character {character:?}"),
            Self::Number(error) => write!(f, "{error}"),
            Self::ExpectedOperand(Some(found)) => {
                write!(f, "a number, name or bracket should stand here, not `{found}`")
            }
            Self::ExpectedOperand(None) => {
                write!(f, "the text ends where a number, name or bracket should stand")
            }
            Self::ExpectedOperator(found) => {
                write!(f, "an operator should stand here, not `{found}`")
            }
            Self::NeverClosed => write!(f, "this bracket is never closed"),
            Self::NeverOpened => write!(f, "this bracket was never opened"),
            Self::StrayComma => write!(f, "this comma separates no arguments of a function"),
            Self::UnknownName(name) => write!(f, "unknown name `{name}`"),
            Self::UnknownFunction(name) => write!(f, "unknown function `{name}`"),
            Self::FunctionWithoutArguments(name) => {
                write!(f, "the function `{name}` lacks its arguments")
            }
            Self::ArgumentCount { function, expected, found } => {
                let plural = if *expected == 1 { "" } else { "s" };
                write!(f, "`{function}` takes {expected} argument{plural}, not {found}")
            }
            Self::StrayRelation => {
                write!(f, "a relation may stand only in the first argument of `select`")
            }
            Self::SelectWithoutRelation => {
                write!(f, "the first argument of `select` must be a relation")
            }
            Self::DivisionByZero => write!(f, "division by zero"),
            Self::ExponentNotWhole => write!(f, "the exponent is not a whole number"),
            Self::ExponentTooLarge => write!(f, "the exponent is larger than {MAX_EXPONENT}"),
            Self::ConstantTooLong => {
                write!(f, "this constant needs more than {MAX_CONSTANT_BITS} bits")
            }
            Self::TextTooLong => write!(f, "the text is longer than {MAX_TEXT_BYTES} bytes"),
        }
    }
}

/// A fault of a text: its place, its cause and, if there is one, a hint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParseError {
    /// Where the faulty token starts, in bytes from the start of the text.
    pub offset: usize,
    /// What is wrong.
    pub cause: ParseCause,
    /// What may have been meant.
    pub hint: Option<String>,
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at byte {}: {}", self.offset, self.cause)?;
        match &self.hint {
            Some(hint) => write!(f, "; hint: {hint}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for ParseError {}

impl ParseError {
    pub(super) fn new(offset: usize, cause: ParseCause) -> Self {
        let hint = match &cause {
            ParseCause::FunctionWithoutArguments(name) => Some(format!("write {name}(...)")),
            ParseCause::SelectWithoutRelation => Some("write select(a < b, x, y)".to_owned()),
            ParseCause::ExponentNotWhole => {
                Some("write exp(b*log(a)), or sqrt(a) for a square root".to_owned())
            }
            ParseCause::ExpectedOperator(_) => Some("a product is written with *".to_owned()),
            ParseCause::UnexpectedCharacter('[' | ']' | '{' | '}') => {
                Some("brackets are ( and )".to_owned())
            }
            ParseCause::UnexpectedCharacter('=') => Some("equality is ==".to_owned()),
            ParseCause::UnexpectedCharacter('π') => Some("write pi".to_owned()),
            ParseCause::UnknownFunction(name) => {
                nearest(name, FUNCTIONS.iter().map(|(known, _)| *known)).map(did_you_mean)
            }
            _ => None,
        };
        Self { offset, cause, hint }
    }

    /// The same error; if a name was unknown, with the nearest of `candidates` (or of the words
    /// of the language) as a hint.
    pub fn suggest<'a>(mut self, candidates: impl IntoIterator<Item = &'a str>) -> Self {
        if let ParseCause::UnknownName(name) = &self.cause {
            self.hint = nearest(name, candidates.into_iter().chain([PI])).map(did_you_mean);
        }
        self
    }
}

fn did_you_mean(name: &str) -> String {
    format!("did you mean `{name}`?")
}

/// Longer names get no hint: the search costs the product of the lengths.
const LONGEST_NAME_FOR_HINTS: usize = 64;

/// The candidate that the fewest typing errors turn into `name`, if they are few for its length.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if name.len() > LONGEST_NAME_FOR_HINTS {
        return None;
    }
    let limit = (name.len() / 3).max(1);
    candidates
        .into_iter()
        .filter(|candidate| candidate.len() <= LONGEST_NAME_FOR_HINTS)
        .map(|candidate| (typing_errors(name.as_bytes(), candidate.as_bytes()), candidate))
        .filter(|(errors, candidate)| *errors <= limit && *errors < candidate.len().max(2))
        // every letter is one error away from every other: no reason to think it was meant
        .filter(|(errors, candidate)| *errors < name.len() || candidate.eq_ignore_ascii_case(name))
        .min()
        .map(|(_, candidate)| candidate)
}

/// Insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`; a change of
/// case alone counts as one error.
fn typing_errors(a: &[u8], b: &[u8]) -> usize {
    if a.eq_ignore_ascii_case(b) {
        return usize::from(a != b);
    }
    let mut rows = vec![vec![0usize; b.len() + 1]; a.len() + 1];
    rows[0] = (0..=b.len()).collect();
    for i in 1..=a.len() {
        rows[i][0] = i;
        for j in 1..=b.len() {
            let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = replaced.min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            rows[i][j] = best;
        }
    }
    rows[a.len()][b.len()]
}
