//! Flags of the command as the keywords of Python.

use crate::failure::Wrong;

/// What a usage error of the command says, without what is only of the command.
pub(crate) fn usage(text: &str, command: &str) -> Wrong {
    let lines = text.lines().take_while(|line| !line.starts_with("Usage:"));
    let lines = lines.map(str::trim).filter(|line| !line.is_empty());
    let (mut said, mut hint): (Vec<&str>, Option<String>) = (Vec::new(), None);
    for line in lines.filter(|line| !line.starts_with("For more information")) {
        let values =
            line.strip_prefix("[possible values: ").and_then(|rest| rest.strip_suffix(']'));
        match (values, line.strip_prefix("tip: ")) {
            (Some(values), _) => hint = Some(format!("one of {values}")),
            (None, Some(tip)) => hint = Some(in_python(tip, command)),
            (None, None) => said.push(line),
        }
    }
    let cause = match said.split_first() {
        Some((first, names)) if first.ends_with(REQUIRED) => {
            format!("needed: {}", names.join(", "))
        }
        _ => said.join("; "),
    };
    if cause.contains("cannot be used with") {
        hint = Some("leave one of the two out".to_owned());
    }
    let wrong = Wrong::new(in_python(cause.strip_prefix("error: ").unwrap_or(&cause), command));
    Wrong { hint, ..wrong }
}

const REQUIRED: &str = "required arguments were not provided:";

/// Flags whose keywords have a unit, or another name: `with` is a word of Python, and some are
/// calls. Of each the command that has it, or none if all do.
const KEYWORDS: [(&str, &str, &str); 21] = [
    ("", "after", "after_s"),
    ("", "capture", "capture_m"),
    ("", "filter", "filter_hz"),
    ("", "height", "height_m"),
    ("", "html", "report"),
    ("", "impulses", "impulses_ns"),
    ("", "longest-step", "longest_step_m"),
    ("", "off", "off_rad_s"),
    ("", "out", "report"),
    ("", "period", "period_s"),
    ("", "static", "measurements"),
    ("", "step", "step_s"),
    ("", "step-time", "step_time_s"),
    ("", "time-limit", "time_limit_s"),
    ("", "two-stage", "identify_two_stage"),
    ("", "window", "window_s"),
    ("", "with", "joint_parameters"),
    ("export", "out", "path"),
    ("import", "out", "path"),
    ("walk", "most", "most_ns"),
    ("walk", "resolution", "resolution_ns"),
];

/// The keyword of a flag of a command.
fn keyword(flag: &str, command: &str) -> String {
    let of = |owner: &str| KEYWORDS.iter().find(|(of, own, _)| *of == owner && *own == flag);
    let other = of(command).or_else(|| of(""));
    other.map_or_else(|| flag.replace('-', "_"), |(.., keyword)| (*keyword).to_owned())
}

/// What follows a flag, without the word that stands for its value: ` <FILE>`, ` MAP.json`.
fn behind_value(rest: &str) -> &str {
    let Some(word) = rest.strip_prefix(' ') else { return rest };
    if let Some((_, behind)) = word.strip_prefix('<').and_then(|word| word.split_once('>')) {
        return behind.strip_prefix("...").unwrap_or(behind);
    }
    let is_of_word = |c: char| c.is_ascii_uppercase() || c == '_';
    let end = word.find(|c: char| !is_of_word(c)).unwrap_or(word.len());
    let behind = &word[end..];
    match end {
        0 | 1 => rest,
        _ => behind.strip_prefix(".json").or_else(|| behind.strip_prefix("..")).unwrap_or(behind),
    }
}

/// Values that sentences give to options.
const VALUES: [&str; 8] =
    ["biasing", "condition", "floating", "free", "iv", "lock", "tanh", "time-stepping"];

/// A value behind an option, as Python gives it, and what follows it.
fn value(rest: &str) -> Option<(String, &str)> {
    let word = rest.strip_prefix(' ')?;
    let is_end = |c: char| c.is_whitespace() || matches!(c, ',' | ';' | ':' | ')');
    let (word, behind) = word.split_at(word.find(is_end).unwrap_or(word.len()));
    if word.parse::<f64>().is_ok() {
        return Some((format!("={word}"), behind));
    }
    VALUES.contains(&word).then(|| (format!("=\"{word}\""), behind))
}

/// What the command says of an output, and what Python has in its place.
const OUTPUT: (&str, &str) = (", and take -o", ": the `scenario` of the answer walks");

/// Flags of a command as the keywords of Python: `--accept-suspicious` as `accept_suspicious`.
pub(crate) fn in_python(text: &str, command: &str) -> String {
    let text = text.replace(OUTPUT.0, OUTPUT.1);
    let (mut found, mut rest) = (String::new(), text.as_str());
    // a whole command is for a terminal, and stays as it is
    while let Some(at) = rest.find(COMMAND) {
        let end = rest[at + 1..].find('`').map_or(rest.len(), |end| at + end + 2);
        found.push_str(&keywords(&rest[..at], command));
        found.push_str(&rest[at..end]);
        rest = &rest[end..];
    }
    found + &keywords(rest, command)
}

/// How a whole command begins.
const COMMAND: &str = "`denavit ";

/// Flags as keywords, in a text without whole commands.
fn keywords(text: &str, command: &str) -> String {
    let (mut found, mut rest) = (String::new(), text);
    while let Some(at) = rest.find("--") {
        let (before, flag) = rest.split_at(at);
        let flag = &flag[2..];
        let end = flag.find(|c: char| !c.is_ascii_lowercase() && c != '-').unwrap_or(flag.len());
        found.push_str(before);
        let (flag, others) = flag.split_at(end);
        if flag.is_empty() {
            found.push_str("--");
            rest = others;
            continue;
        }
        found.push_str(&keyword(flag, command));
        let (given, behind) = value(others).unwrap_or_else(|| (String::new(), others));
        found.push_str(&given);
        rest = behind_value(behind);
    }
    found.push_str(rest);
    found
}
