//! Options of the library by their flags: its texts name them as `options.filter`, or with a value
//! as `options.method=iv`.

use std::borrow::Cow;

/// Options whose flags are called otherwise.
const OTHERWISE: [(&str, &str); 8] = [
    ("accepts_cut", "accept-cut"),
    ("accepts_suspicious", "accept-suspicious"),
    ("decimation", "decimate"),
    ("derivatives", "rates"),
    ("period_s", "period"),
    ("slow", "skip-slow"),
    ("step_s", "step"),
    ("uses_prior", "prior"),
];

const OPTION: &str = "`options.";

/// A call of the library that is a flag of the command.
const CALL: (&str, &str) = ("`identify_two_stage`", "--two-stage");

/// A text of the library, with flags in place of its options.
pub(crate) fn by_flag(text: &str) -> Cow<'_, str> {
    if !(text.contains(OPTION) || text.contains(CALL.0)) {
        return Cow::Borrowed(text);
    }
    let text = text.replace(CALL.0, CALL.1);
    let mut parts = text.split(OPTION);
    let mut named = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        match part.split_once('`').filter(|(option, _)| is_option(option)) {
            Some((option, rest)) => {
                named += &flag(option);
                named += rest;
            }
            None => {
                named += OPTION;
                named += part;
            }
        }
    }
    Cow::Owned(named)
}

fn is_option(text: &str) -> bool {
    let (name, value) = text.split_once('=').unwrap_or((text, ""));
    let is_name = !name.is_empty() && name.chars().all(|c| c.is_ascii_lowercase() || c == '_');
    is_name && !value.contains(char::is_whitespace)
}

fn flag(option: &str) -> String {
    let (name, value) = option.split_once('=').map_or((option, None), |(a, b)| (a, Some(b)));
    let other = OTHERWISE.iter().find(|(own, _)| *own == name).map(|(_, flag)| *flag);
    let flag = other.map_or_else(|| name.replace('_', "-"), str::to_owned);
    match value {
        Some(value) => format!("--{flag} {value}"),
        None => format!("--{flag}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_become_flags() {
        let text = "a (`options.filter`), or `options.method=iv`; `options.accepts_suspicious`";
        assert_eq!(by_flag(text), "a (--filter), or --method iv; --accept-suspicious");
        assert_eq!(by_flag("`identify_two_stage` finds"), "--two-stage finds");
        assert_eq!(by_flag("`options.hold=hip_z=0`"), "--hold hip_z=0");
        assert_eq!(by_flag("`options.duration_s=10`"), "--duration-s 10");
    }

    #[test]
    fn all_else_stays() {
        for text in ["`options`", "`options.", "`options.A`", "`options.a b`", "options.a", ""] {
            assert_eq!(by_flag(text), text);
        }
    }
}
