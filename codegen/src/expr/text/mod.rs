//! Expressions as text: an infix parser, and a printer whose text it reads back.
//!
//! ```text
//! expression := ["-"|"+"] product { ("+"|"-") product }
//! product    := power { ("*"|"/") power }
//! power      := operand [ "^" ["-"|"+"] power ]
//! operand    := number | "pi" | name | "(" expression ")" | function "(" expression, ... ")"
//!             | "select(" expression ("<"|"<="|"=="|">"|">=") expression "," a "," b ")"
//! number     := digits [ "." digits ] [ "e" ["-"|"+"] digits ], read exactly
//! ```
//!
//! - `+ - * /` group to the left, `^` to the right: `a^2^3 = a^8`. A minus sign in front of a
//!   product negates the product, `-a*b = -(a*b)`, and in front of a power the power. A sign may
//!   also stand after an operator: `a*-b`, `a^-2`.
//! - An exponent is anything that folds to a whole number n with |n| <= [`MAX_EXPONENT`].
//! - `select(a < b, x, y)` is x where a < b, and y elsewhere.
//!
//! Nesting is not limited: neither the parser nor the printer recurses. The length of the text is
//! ([`MAX_TEXT_BYTES`]), and so is that of a constant ([`MAX_CONSTANT_BITS`]).

mod error;
mod lexer;
mod parse;
mod print;
#[cfg(test)]
mod tests;

pub use error::{ParseCause, ParseError, nearest};
#[cfg(test)]
pub(super) use parse::parse_with;
pub use parse::{MAX_CONSTANT_BITS, MAX_EXPONENT, MAX_TEXT_BYTES, parse};
pub use print::{Printed, print, print_with_intermediates};

use super::dag::{BinaryFunction, UnaryFunction};

/// A function of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Function {
    Unary(UnaryFunction),
    Binary(BinaryFunction),
    Select,
}

/// The functions by their names.
const FUNCTIONS: [(&str, Function); 13] = [
    ("sin", Function::Unary(UnaryFunction::Sin)),
    ("cos", Function::Unary(UnaryFunction::Cos)),
    ("tan", Function::Unary(UnaryFunction::Tan)),
    ("sqrt", Function::Unary(UnaryFunction::Sqrt)),
    ("exp", Function::Unary(UnaryFunction::Exp)),
    ("log", Function::Unary(UnaryFunction::Log)),
    ("tanh", Function::Unary(UnaryFunction::Tanh)),
    ("abs", Function::Unary(UnaryFunction::Abs)),
    ("sign", Function::Unary(UnaryFunction::Sign)),
    ("atan2", Function::Binary(BinaryFunction::Atan2)),
    ("min", Function::Binary(BinaryFunction::Min)),
    ("max", Function::Binary(BinaryFunction::Max)),
    ("select", Function::Select),
];

/// The name of pi.
const PI: &str = "pi";

impl Function {
    fn of_name(name: &str) -> Option<Self> {
        FUNCTIONS.iter().find(|(known, _)| *known == name).map(|&(_, function)| function)
    }

    fn name(self) -> &'static str {
        let row = FUNCTIONS.iter().find(|(_, function)| *function == self);
        row.expect("the table has every function").0
    }

    fn argument_count(self) -> usize {
        match self {
            Self::Unary(_) => 1,
            Self::Binary(_) => 2,
            Self::Select => 3,
        }
    }
}

/// Whether `name` may name a symbol in a text: a letter or `_`, then letters, digits and `_`, all
/// ASCII, and no word of the language (`pi` and the functions).
pub fn is_symbol_name(name: &str) -> bool {
    let mut bytes = name.bytes();
    let starts = bytes.next().is_some_and(|byte| byte.is_ascii_alphabetic() || byte == b'_');
    let is_word = name == PI || Function::of_name(name).is_some();
    starts && !is_word && bytes.all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
}
