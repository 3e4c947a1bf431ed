//! Names: which texts are identifiers, and which known name a misspelt one was meant to be.

/// Longest name of a link, constant or contact.
pub(super) const MAX_NAME_LENGTH: usize = 64;

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
pub(super) fn is_identifier(text: &str) -> bool {
    let mut bytes = text.bytes();
    text.len() <= MAX_NAME_LENGTH
        && bytes.next().is_some_and(|byte| byte.is_ascii_alphabetic())
        && bytes.all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
}

/// Who else needs the name, if somebody does.
pub(super) fn reserved_by(name: &str) -> Option<&'static str> {
    if RUST_WORDS.contains(&name) {
        Some("the Rust language, in which emitted code is written")
    } else if EXPRESSION_WORDS.contains(&name) {
        Some("the expression language")
    } else {
        None
    }
}

/// The candidate nearest to a misspelt `name`, if one is near enough to be meant.
pub(super) fn nearest<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    if name.len() > MAX_NAME_LENGTH {
        return None;
    }
    let length = name.chars().count();
    candidates
        .into_iter()
        .filter(|candidate| candidate.len() <= MAX_NAME_LENGTH)
        .map(|candidate| (distance(name, candidate), candidate))
        .filter(|&(edits, _)| edits <= 1 + length / 4 && edits < length)
        .min_by_key(|&(edits, _)| edits)
        .map(|(_, candidate)| candidate)
}

/// Insertions, deletions, substitutions and swaps of neighbours (restricted Damerau-Levenshtein)
/// that lead from one text to the other, upper and lower case counting as equal.
fn distance(from: &str, to: &str) -> usize {
    let from: Vec<char> = from.to_lowercase().chars().collect();
    let to: Vec<char> = to.to_lowercase().chars().collect();
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=to.len()).collect();
    for (i, &a) in from.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, &b) in to.iter().enumerate() {
            let mut edits = (last[j] + usize::from(a != b)).min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a == to[j - 1] && from[i - 1] == b {
                edits = edits.min(before[j - 1] + 1);
            }
            row.push(edits);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[to.len()]
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

    #[test]
    fn the_nearest_name_is_one_that_could_be_meant() {
        let keys = ["mass", "com", "inertia", "about"];
        assert_eq!(nearest("maas", keys), Some("mass"));
        assert_eq!(nearest("inertai", keys), Some("inertia"));
        assert_eq!(nearest("Mass", keys), Some("mass"));
        assert_eq!(nearest("temperature", keys), None);
        assert_eq!(nearest("a", keys), None);
    }
}
