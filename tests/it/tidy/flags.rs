//! Texts of the library name options of the library; the command turns them into flags.

use super::{assert_none, rust_files, shown};
use std::fs;

/// A flag in a line of code that is no comment, if there is one.
fn flag(line: &str) -> Option<&str> {
    let is_comment = line.trim_start().starts_with("//");
    // other programs, and whole command lines of ours, have flags
    let is_whole = ["cargo ", "--features", "denavit "].iter().any(|own| line.contains(own));
    let mut rest = line;
    while let Some(at) = rest.find("--").filter(|_| !(is_comment || is_whole)) {
        let (before, found) = rest.split_at(at);
        let opens = before.ends_with([' ', '(', '"', '`']);
        if opens && found[2..].starts_with(|c: char| c.is_ascii_lowercase()) {
            let end = found[2..].find(|c: char| !(c.is_ascii_lowercase() || c == '-'));
            return Some(&found[..end.map_or(found.len(), |end| end + 2)]);
        }
        rest = &found[2..];
    }
    None
}

#[test]
fn texts_of_the_library_name_no_flags() {
    let mut faults = Vec::new();
    for path in ["codegen", "crates"].into_iter().flat_map(rust_files) {
        let place = shown(&path);
        if place.contains("/tests/") || place.ends_with("tests.rs") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        let found = code.lines().enumerate().filter_map(|(at, line)| Some((at, flag(line)?)));
        faults.extend(found.map(|(at, flag)| format!("{place}:{}: {flag}", at + 1)));
    }
    assert_none(&faults, "flags in texts of the library");
}

#[test]
fn flags_are_seen() {
    assert_eq!(flag("    \"a lower cutoff (--filter) has less\""), Some("--filter"));
    assert_eq!(flag("    // --filter"), None);
    assert_eq!(flag("    a -- b --1"), None);
}
