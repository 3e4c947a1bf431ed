//! Options of the library by their flags: its texts name them as `options.seed`, or with a value as
//! `options.method=iv`.

use std::borrow::Cow;

/// Options whose flags are called otherwise, or take what a word says.
const OTHERWISE: [(&str, &str); 11] = [
    ("accepts_cut", "accept-cut"),
    ("accepts_suspicious", "accept-suspicious"),
    ("columns", "columns MAP.json"),
    ("controller", "controller FILE"),
    ("decimation", "decimate"),
    ("parameters", "with"),
    ("period_s", "period"),
    ("slow", "skip-slow"),
    ("step_s", "step"),
    ("terms", "terms"),
    ("uses_prior", "prior"),
];

/// Whose options they are.
const OWNERS: [&str; 5] = ["options", "logs", "conditions", "scenario", "robot"];

/// A call of the library that is a flag of the command.
const CALL: (&str, &str) = ("identify_two_stage", "--two-stage");

/// A sentence of the library, with flags in place of its options. It is for what people read: files
/// and JSON keep their texts.
pub(crate) fn by_flag(text: &str) -> Cow<'_, str> {
    let mut parts = text.split('`');
    let mut named = parts.next().unwrap_or_default().to_owned();
    let mut is_quoted = true;
    while let Some(part) = parts.next() {
        match flag_of(part).filter(|_| is_quoted) {
            Some(flag) => {
                named += &flag;
                named += parts.next().unwrap_or_default();
                continue;
            }
            None => {
                named.push('`');
                named += part;
            }
        }
        is_quoted = !is_quoted;
    }
    if named == text { Cow::Borrowed(text) } else { Cow::Owned(named) }
}

/// The flag of a quoted name, if it is one of an option.
fn flag_of(name: &str) -> Option<String> {
    if name == CALL.0 {
        return Some(CALL.1.to_owned());
    }
    let (owner, option) = name.split_once('.')?;
    (OWNERS.contains(&owner) && is_option(option)).then(|| flag(option))
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
        let text =
            "a (`conditions.filter`), or `options.method=iv`; `logs.accepts_suspicious`, `x`";
        assert_eq!(by_flag(text), "a (--filter), or --method iv; --accept-suspicious, `x`");
        assert_eq!(by_flag("`a`, `logs.columns` and `b`"), "`a`, --columns MAP.json and `b`");
        assert_eq!(by_flag("`identify_two_stage` finds"), "--two-stage finds");
        assert_eq!(by_flag("`options.hold=hip_z=0`"), "--hold hip_z=0");
        assert_eq!(by_flag("`options.duration_s=10`"), "--duration-s 10");
    }

    #[test]
    fn all_else_stays() {
        for text in ["`options`", "`options.A`", "`options.a b`", "options.a", "`other.a`", "`", ""]
        {
            assert_eq!(by_flag(text), text);
        }
    }
}
