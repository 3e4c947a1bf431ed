//! Names: which texts are identifiers, and which of them are taken.

/// Longest name of a link, constant or contact.
pub(crate) const MAX_NAME_LENGTH: usize = 64;

/// Words that emitted Rust could not use as a field name.
const RUST_WORDS: [&str; 39] = [
    "as", "async", "await", "break", "const", "continue", "crate", "dyn", "else", "enum", "extern",
    "false", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "match", "mod", "move", "mut",
    "pub", "ref", "return", "self", "static", "struct", "super", "trait", "true", "type", "unsafe",
    "use", "where", "while", "Self",
];

/// Names that expressions give a meaning of their own.
const EXPRESSION_WORDS: [&str; 16] = [
    "pi", "t", "sin", "cos", "tan", "sqrt", "atan2", "exp", "log", "tanh", "abs", "sign", "min",
    "max", "select", "inf",
];

/// Whether a text is a letter followed by letters, digits and underscores, not too long.
pub(crate) fn is_identifier(text: &str) -> bool {
    let mut bytes = text.bytes();
    text.len() <= MAX_NAME_LENGTH
        && bytes.next().is_some_and(|byte| byte.is_ascii_alphabetic())
        && bytes.all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
}

/// Who else needs the name, if somebody does.
pub(crate) fn reserved_by(name: &str) -> Option<&'static str> {
    if RUST_WORDS.contains(&name) {
        Some("the Rust language, in which emitted code is written")
    } else if EXPRESSION_WORDS.contains(&name) {
        Some("the expression language")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_begin_with_a_letter() {
        assert!(["l6y", "right_hip_z", "A"].into_iter().all(is_identifier));
        assert!(
            !["", "6l", "_x", "a-b", "a b", "é", &"x".repeat(65)].into_iter().any(is_identifier)
        );
        assert!(reserved_by("fn").is_some() && reserved_by("pi").is_some());
        assert!(reserved_by("l1").is_none());
    }
}
