//! Identifiers of emitted code, made from the names of a model.

use std::collections::BTreeSet;

/// The words of a language that no name of ours may be, separated by blanks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Words {
    /// Words that are no identifiers.
    keywords: &'static str,
    /// Names that emitted functions call, which no value may hide.
    called: &'static str,
}

/// Words of Rust, in any edition. Functions are called as methods, so that no value hides them.
pub(super) const RUST: Words = Words {
    keywords: "as async await break const continue crate dyn else enum extern false fn for gen if \
               impl in let loop match mod move mut pub ref return self static struct super trait \
               true type unsafe use where while abstract become box do final macro override priv \
               try typeof unsized virtual yield union _ Self",
    called: "",
};

/// Words of C and C++, in any edition, so that a header serves both; and names that are macros
/// where common headers are included.
pub(super) const C: Words = Words {
    keywords: "_ alignas alignof and and_eq asm atomic_cancel atomic_commit atomic_noexcept auto \
               bitand bitor bool break case catch char char16_t char32_t char8_t class co_await \
               co_return co_yield compl concept const const_cast consteval constexpr constinit \
               continue contract_assert decltype default delete do double dynamic_cast else enum \
               explicit export extern false float for friend goto if inline int long mutable \
               namespace new noexcept not not_eq nullptr operator or or_eq private protected \
               public reflexpr register reinterpret_cast requires restrict return short signed \
               sizeof static static_assert static_cast struct switch synchronized template this \
               thread_local throw true try typedef typeid typename typeof typeof_unqual union \
               unsigned using virtual void volatile wchar_t while xor xor_eq _Alignas _Alignof \
               _Atomic _BitInt _Bool _Complex _Generic _Imaginary _Noreturn _Static_assert \
               _Thread_local S Scalar Parameters ModelParameters near far huge linux unix \
               i386 errno assert NULL EOF NAN INFINITY \
               HUGE_VAL EDOM ERANGE FP_NAN FP_INFINITE FP_ZERO FP_SUBNORMAL FP_NORMAL M_E M_PI \
               TRUE FALSE DOMAIN SING OVERFLOW UNDERFLOW PLOSS TLOSS",
    called: "Turns DOF real std sincos_of sincos_pack fused sign_of lesser greater product_plus \
             product_minus minus_product prepare convert fabs sqrt sin cos tan exp log tanh \
             atan2 fma fmaf memcpy size_t uint64_t uint32_t int32_t Link Foot detail",
};

/// Names that emitted functions give to arguments, to the parameters and to packs of values.
const LOCALS: [&str; 17] = [
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
    "foot",
    "contact",
    "sines",
    "cosines",
];

/// A set of names of which each is given once.
#[derive(Clone, Debug)]
pub(super) struct Names {
    words: Words,
    taken: BTreeSet<String>,
}

impl Names {
    /// For fields and variants: the words of the language are taken.
    pub(super) fn fields(words: Words) -> Self {
        Self { words, taken: split(words.keywords).map(str::to_owned).collect() }
    }

    /// For values and functions: the names of arguments are taken too.
    pub(super) fn locals(words: Words) -> Self {
        let mut names = Self::globals(words);
        names.taken.extend(LOCALS.map(str::to_owned));
        names
    }

    /// For names beside all that common headers declare: what functions call is taken, too.
    pub(super) fn globals(words: Words) -> Self {
        let mut names = Self::fields(words);
        names.taken.extend(split(words.called).map(str::to_owned));
        names
    }

    /// Takes the name of a model's thing as a variant: `right_foot` becomes `RightFoot`.
    pub(super) fn variant(&mut self, name: &str) -> String {
        let name = camel_case(name);
        match self.is_keyword(&name) {
            true => self.numbered(&format!("{name}_"), ""),
            false => self.numbered(&name, ""),
        }
    }

    /// Takes the name of a model's thing as an identifier: `type` becomes `type_`.
    pub(super) fn field(&mut self, name: &str) -> String {
        let name = identifier(name);
        match self.is_keyword(&name) {
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

    fn is_keyword(&self, name: &str) -> bool {
        split(self.words.keywords).any(|word| word == name)
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

fn split(words: &'static str) -> impl Iterator<Item = &'static str> {
    words.split_whitespace()
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
        let mut names = Names::fields(RUST);
        let given = ["m1", "m1", "m1", "type"].map(|name| names.field(name));
        assert_eq!(given, ["m1", "m1_2", "m1_3", "type_"]);
        let given = ["foot", "foot_", "Self"].map(|name| names.variant(name));
        assert_eq!(given, ["Foot", "Foot2", "Self_"]);
        assert!(!names.claim_all(&["s1".to_owned(), "m1".to_owned()]));
        assert!(names.claim("s1"), "a failed claim takes nothing");
    }

    #[test]
    fn words_are_those_of_the_language() {
        let given = ["double", "type", "NULL"].map(|name| Names::fields(C).field(name));
        assert_eq!(given, ["double_", "type", "NULL_"]);
        let given = ["double", "type", "NULL"].map(|name| Names::fields(RUST).field(name));
        assert_eq!(given, ["double", "type_", "NULL"]);
        assert!(!Names::locals(C).claim("sqrt") && Names::locals(RUST).claim("sqrt"));
    }

    #[test]
    fn joints_beyond_nine_are_kept_apart() {
        assert_eq!(joint_numbers(&[2, 3]), "23");
        assert_eq!(joint_numbers(&[9, 10]), "9_10");
    }
}
