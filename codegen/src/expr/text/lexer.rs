//! The tokens of a text.

use super::error::{ParseCause, ParseError};
use crate::expr::dag::Relation;
use crate::number::DecimalError;

/// A token; number and name are slices of the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Token<'a> {
    Number(&'a str),
    Name(&'a str),
    Plus,
    Minus,
    Star,
    Slash,
    Caret,
    Open,
    Close,
    Comma,
    /// A relation; `>` and `>=` are `<` and `<=` with the sides exchanged.
    Relation {
        relation: Relation,
        exchanged: bool,
    },
    End,
}

/// Reads one token after the other; never holds more than one.
pub(super) struct Lexer<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }

    /// The next token and the byte at which it starts.
    pub(super) fn next(&mut self) -> Result<(usize, Token<'a>), ParseError> {
        let rest = self.text[self.at..].trim_start();
        let start = self.text.len() - rest.len();
        let Some(first) = rest.bytes().next() else {
            self.at = start;
            return Ok((start, Token::End));
        };
        let (length, token) = match first {
            b'+' => (1, Token::Plus),
            b'-' => (1, Token::Minus),
            b'*' => (1, Token::Star),
            b'/' => (1, Token::Slash),
            b'^' => (1, Token::Caret),
            b'(' => (1, Token::Open),
            b')' => (1, Token::Close),
            b',' => (1, Token::Comma),
            b'<' | b'>' | b'=' => relation(rest).ok_or_else(|| {
                ParseError::new(start, ParseCause::UnexpectedCharacter(char::from(first)))
            })?,
            b'0'..=b'9' | b'.' => {
                let length = number_length(rest).ok_or_else(|| {
                    ParseError::new(start, ParseCause::Number(DecimalError::Malformed))
                })?;
                (length, Token::Number(&rest[..length]))
            }
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => {
                let ends = |byte: u8| !byte.is_ascii_alphanumeric() && byte != b'_';
                let length = rest.bytes().position(ends).unwrap_or(rest.len());
                (length, Token::Name(&rest[..length]))
            }
            _ => {
                let character = rest.chars().next().expect("there is a first byte");
                let cause = ParseCause::UnexpectedCharacter(character);
                return Err(ParseError::new(start, cause));
            }
        };
        self.at = start + length;
        Ok((start, token))
    }

    /// Whether an opening bracket follows.
    pub(super) fn at_open(&self) -> bool {
        self.text[self.at..].trim_start().starts_with('(')
    }

    /// The text of the token that starts at `start` and was read last, for messages.
    pub(super) fn token_text(&self, start: usize) -> String {
        const LONGEST: usize = 32;
        let token = &self.text[start..self.at];
        match token.char_indices().nth(LONGEST) {
            Some((end, _)) => format!("{}...", &token[..end]),
            None => token.to_owned(),
        }
    }
}

fn relation<'a>(rest: &str) -> Option<(usize, Token<'a>)> {
    let token = |relation, exchanged| Token::Relation { relation, exchanged };
    Some(match rest.as_bytes() {
        [b'=', b'=', ..] => (2, token(Relation::Equal, false)),
        [b'<', b'=', ..] => (2, token(Relation::LessEqual, false)),
        [b'>', b'=', ..] => (2, token(Relation::LessEqual, true)),
        [b'<', ..] => (1, token(Relation::Less, false)),
        [b'>', ..] => (1, token(Relation::Less, true)),
        _ => return None,
    })
}

/// The length of the number that `rest` starts with; `None` where no number can be meant, as in
/// `1.2.3` or `.`.
fn number_length(rest: &str) -> Option<usize> {
    let bytes = rest.as_bytes();
    let digits_from = |at: usize| {
        bytes[at..].iter().position(|byte| !byte.is_ascii_digit()).map_or(bytes.len(), |n| at + n)
    };
    let whole = digits_from(0);
    let mut end = whole;
    if bytes.get(whole) == Some(&b'.') {
        end = digits_from(whole + 1);
        if end == 1 {
            return None;
        }
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = (end + 1 + sign).min(bytes.len());
        if digits_from(exponent) > exponent {
            end = digits_from(exponent);
        }
    }
    (bytes.get(end) != Some(&b'.')).then_some(end)
}
