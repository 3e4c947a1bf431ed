//! Identifiers of emitted code, made from the names of a model.

use std::collections::BTreeSet;

/// Words that are no identifiers, in any edition of Rust.
const KEYWORDS: [&str; 54] = [
    "as", "async", "await", "break", "const", "continue", "crate", "dyn", "else", "enum", "extern",
    "false", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "match", "mod", "move", "mut",
    "pub", "ref", "return", "self", "static", "struct", "super", "trait", "true", "type", "unsafe",
    "use", "where", "while", "abstract", "become", "box", "do", "final", "macro", "override",
    "priv", "try", "typeof", "unsized", "virtual", "yield", "union", "_", "Self",
];

/// Names that emitted functions give to arguments, to the parameters and to packs of values.
const LOCALS: [&str; 16] = [
    "q",
    "qd",
    "qdd",
    "tau",
    "b",
    "f",
    "t",
    "states",
    "p",
    "live",
    "parameters",
    "model",
    "link",
    "contact",
    "sines",
    "cosines",
];

/// A set of names of which each is given once.
#[derive(Clone, Debug)]
pub(super) struct Names {
    taken: BTreeSet<String>,
}

impl Names {
    /// For fields and variants: the words of the language are taken.
    pub(super) fn fields() -> Self {
        Self { taken: KEYWORDS.map(str::to_owned).into() }
    }

    /// For values and functions: the names of arguments are taken too.
    pub(super) fn locals() -> Self {
        let mut names = Self::fields();
        names.taken.extend(LOCALS.map(str::to_owned));
        names
    }

    /// Takes the name of a model's thing as a variant: `right_foot` becomes `RightFoot`.
    pub(super) fn variant(&mut self, name: &str) -> String {
        let name = camel_case(name);
        match KEYWORDS.contains(&name.as_str()) {
            true => self.numbered(&format!("{name}_"), ""),
            false => self.numbered(&name, ""),
        }
    }

    /// Takes the name of a model's thing as an identifier: `type` becomes `type_`.
    pub(super) fn field(&mut self, name: &str) -> String {
        let name = identifier(name);
        match KEYWORDS.contains(&name.as_str()) {
            true => self.unique(&format!("{name}_")),
            false => self.unique(&name),
        }
    }

    /// Takes `name`, if it is free.
    pub(super) fn claim(&mut self, name: &str) -> bool {
        self.taken.insert(name.to_owned())
    }

    /// Whether `name` is free.
    pub(super) fn is_free(&self, name: &str) -> bool {
        !self.taken.contains(name)
    }

    /// Takes all of `names`, if each is free.
    pub(super) fn claim_all(&mut self, names: &[String]) -> bool {
        let free = names.iter().all(|name| self.is_free(name));
        if free {
            self.taken.extend(names.iter().cloned());
        }
        free
    }

    /// Takes `name`, or the first free one of `name_2`, `name_3`, ...
    pub(super) fn unique(&mut self, name: &str) -> String {
        self.numbered(name, "_")
    }

    fn numbered(&mut self, name: &str, separator: &str) -> String {
        if self.claim(name) {
            return name.to_owned();
        }
        let numbered = (2..).map(|number| format!("{name}{separator}{number}"));
        let name =
            numbered.into_iter().find(|name| self.is_free(name)).expect("numbers do not end");
        self.taken.insert(name.clone());
        name
    }
}

/// A name as an identifier: what is no ASCII letter, digit or underscore becomes an underscore.
pub(super) fn identifier(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '_' { c } else { '_' };
    let text: String = name.chars().map(plain).collect();
    let starts_well = text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    match starts_well && text.chars().any(|c| c != '_') {
        true => text,
        false => format!("n{text}"),
    }
}

/// `right_foot` as a name of a type or variant: `RightFoot`.
pub(super) fn camel_case(name: &str) -> String {
    let identifier = identifier(name);
    let words = identifier.split('_').filter(|word| !word.is_empty());
    let capital = |word: &str| {
        let (first, rest) = word.split_at(1);
        first.to_ascii_uppercase() + rest
    };
    let text: String = words.map(capital).collect();
    if text.starts_with(|c: char| c.is_ascii_digit()) { format!("N{text}") } else { text }
}

/// The joints of a cumulated angle as they are written after `s` and `c`: `23`, or `9_10`.
pub(super) fn joint_numbers(joints: &[usize]) -> String {
    let separator = if joints.iter().any(|&joint| joint > 9) { "_" } else { "" };
    joints.iter().map(ToString::to_string).collect::<Vec<_>>().join(separator)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_identifiers() {
        assert_eq!(identifier("I_x'"), "I_x_");
        assert_eq!(identifier("2nd"), "n2nd");
        assert_eq!(identifier("µ"), "n_");
        assert_eq!(camel_case("right_foot_2"), "RightFoot2");
        assert_eq!(camel_case("3x"), "N3x");
    }

    #[test]
    fn names_are_given_once() {
        let mut names = Names::fields();
        let given = ["m1", "m1", "m1", "type"].map(|name| names.field(name));
        assert_eq!(given, ["m1", "m1_2", "m1_3", "type_"]);
        let given = ["foot", "foot_", "Self"].map(|name| names.variant(name));
        assert_eq!(given, ["Foot", "Foot2", "Self_"]);
        assert!(!names.claim_all(&["s1".to_owned(), "m1".to_owned()]));
        assert!(names.claim("s1"), "a failed claim takes nothing");
    }

    #[test]
    fn joints_beyond_nine_are_kept_apart() {
        assert_eq!(joint_numbers(&[2, 3]), "23");
        assert_eq!(joint_numbers(&[9, 10]), "9_10");
    }
}
