//! Broken models, each with the exact message that it gets.
//!
//! A case of `fixtures/broken/*.txt` changes lines of `base.json`, which is in order:
//!
//! ```text
//! --- what is wrong
//! -"gear_ratio": 50,          a text that the base has exactly once
//! +"gear_ratio": 0,           what takes its place
//! > base.json:43:21: ...      the message
//! ```
//!
//! or gives the whole file in lines that begin with `|`. `UPDATE_EXPECT=1` rewrites the messages.

use super::fixture;
use denavit_codegen::model;
use std::fmt::Write;
use std::time::{Duration, Instant};

struct Case<'a> {
    title: &'a str,
    edits: Vec<(&'a str, &'a str)>,
    whole: Option<String>,
    expected: String,
    /// The lines of the case without its message.
    header: String,
}

fn parse_cases(text: &str) -> Vec<Case<'_>> {
    let mut cases: Vec<Case<'_>> = Vec::new();
    for line in text.lines().filter(|line| !line.is_empty()) {
        if let Some(title) = line.strip_prefix("--- ") {
            cases.push(Case {
                title,
                edits: Vec::new(),
                whole: None,
                expected: String::new(),
                header: String::new(),
            });
        }
        let case = cases.last_mut().expect("a title comes first");
        let (mark, rest) = line.split_at(1);
        match mark {
            ">" => {
                let _ = writeln!(case.expected, "{}", rest.strip_prefix(' ').unwrap_or(rest));
                continue;
            }
            "-" if !line.starts_with("--- ") => case.edits.push((rest, "")),
            "+" => case.edits.last_mut().expect("a + follows a -").1 = rest,
            "|" => case.whole.get_or_insert_default().push_str(&format!("{rest}\n")),
            _ => assert!(line.starts_with("--- "), "no mark: {line}"),
        }
        let _ = writeln!(case.header, "{line}");
    }
    cases
}

fn source(case: &Case<'_>, base: &str) -> String {
    let mut text = case.whole.clone().unwrap_or_else(|| base.to_owned());
    for (old, new) in &case.edits {
        assert_eq!(base.matches(old).count(), 1, "{}: `{old}` must stand once", case.title);
        text = text.replacen(old, new, 1);
    }
    text
}

#[test]
fn the_base_of_the_broken_models_is_in_order() {
    let base = std::fs::read(fixture("broken/base.json")).expect("the base");
    if let Err(error) = model::read("base.json", &base) {
        panic!("{error}");
    }
}

#[test]
fn every_broken_model_gets_its_message() {
    let base = std::fs::read_to_string(fixture("broken/base.json")).expect("the base");
    let update = std::env::var_os("UPDATE_EXPECT").is_some();
    let mut files: Vec<_> = std::fs::read_dir(fixture("broken"))
        .expect("the folder")
        .map(|entry| entry.expect("a file").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "txt"))
        .collect();
    files.sort();
    let (mut count, mut wrong) = (0, String::new());
    for path in files {
        let text = std::fs::read_to_string(&path).expect("a text");
        let mut blessed = Vec::new();
        for case in parse_cases(&text) {
            count += 1;
            let message = match model::read("base.json", source(&case, &base).as_bytes()) {
                Ok(_) => "no fault found\n".to_owned(),
                Err(error) => format!("{error}\n"),
            };
            if message != case.expected {
                let _ =
                    write!(wrong, "{}\nexpected\n{}found\n{message}\n", case.title, case.expected);
            }
            let lines: String = message.lines().map(|line| format!("> {line}\n")).collect();
            blessed.push(format!("{}{lines}", case.header));
        }
        if update {
            std::fs::write(&path, blessed.join("\n")).expect("writable fixtures");
        }
    }
    assert!(count >= 45, "only {count} broken models");
    assert!(wrong.is_empty() || update, "{wrong}");
}

/// Reads a text that is too large for a fixture, within a time that even a debug build keeps.
fn message_of(source: &[u8]) -> String {
    let start = Instant::now();
    let message = model::read("large.json", source).expect_err("a broken model").to_string();
    let elapsed = start.elapsed();
    assert!(elapsed < Duration::from_secs(60), "it took {elapsed:?}");
    message
}

#[test]
fn ten_megabytes_of_garbage_fail_fast() {
    let noise: Vec<u8> =
        (0..10_000_000u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    assert!(message_of(&noise).starts_with("large.json:1:"), "not UTF-8");
    let letters = "x".repeat(10_000_000);
    assert!(message_of(letters.as_bytes()).starts_with("large.json:1:1: not JSON: expected value"));
    let brackets = "[".repeat(10_000_000);
    assert!(message_of(brackets.as_bytes()).contains("not JSON: EOF while parsing"));
    let string = format!("{{\"name\": \"{}\"}}", "x".repeat(10_000_000));
    let message = message_of(string.as_bytes());
    assert!(message.len() < 1000 && message.contains("the key `format` is missing"), "{message}");
}

#[test]
fn nesting_and_number_of_values_are_bounded() {
    let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
    assert_eq!(
        message_of(deep.as_bytes()),
        "large.json:1:34: lists and objects are nested more than 32 levels deep\n  \
         hint: no such file needs more than ten levels"
    );
    let wide = format!("{{\"links\": [{}0]}}", "0,".repeat(1_000_000));
    assert!(message_of(wide.as_bytes()).contains("the file has more than 200000 values"));
}

/// Fractions grow by a digit every five levels. What is done with all of them must not be cubic in
/// their number: looking them up once was, and took 54 s for 8000 levels, which now take 0.8 s.
#[test]
fn deeply_nested_quotients_are_refused_in_time() {
    let levels = 11_000;
    let quotient = format!("{}1{}", "1/(1+".repeat(levels), ")".repeat(levels));
    let source = format!(
        "{{\"format\": \"denavit-model/1\", \"name\": \"deep\", \"convention\": \"standard\",\n\
         \"gravity\": [0, 0, 0], \"links\": [{{\"name\": \"l\",\n\
         \"joint\": {{\"type\": \"fixed\", \"a\": \"{quotient}\"}}}}]}}"
    );
    let message = message_of(source.as_bytes());
    let expected = "large.json:3:33: /links/0/joint/a: the number is beyond 1e308 or longer";
    assert!(message.starts_with(expected), "{message:.100}");
}

#[test]
fn a_file_that_is_too_large_is_refused_unread() {
    let message = message_of(&vec![b' '; 17 << 20]);
    assert_eq!(
        message,
        "large.json:1:1: the file has 17825792 bytes, more than the 16777216 that are read\n  \
         hint: such files have some kilobytes: is this the file?"
    );
}

#[test]
fn only_the_first_hundred_faults_are_listed() {
    let links = vec!["{\"nam\": 1}"; 20_000].join(",");
    let source = format!(
        "{{\"format\": \"denavit-model/1\", \"name\": \"many\", \"convention\": \"standard\",\n\
         \"gravity\": [0, 0, 0], \"links\": [{links}]}}"
    );
    let message = message_of(source.as_bytes());
    assert_eq!(message.lines().filter(|line| line.starts_with("large.json:")).count(), 100);
    // unknown key, missing name and missing joint of each link
    assert!(message.ends_with("and 59900 more faults"), "{}", message.lines().last().unwrap_or(""));
}

#[test]
fn long_chains_of_definitions_stay_small() {
    // each constant squares the one before: the thirtieth would have 3^(2^30) digits
    let mut constants = vec!["\"c0\": 3".to_owned()];
    constants.extend((1..30).map(|i| format!("\"c{i}\": \"c{}*c{}\"", i - 1, i - 1)));
    let source = format!(
        "{{\"format\": \"denavit-model/1\", \"name\": \"n\", \"convention\": \"standard\", \
         \"gravity\": [0, 0, 0], \"constants\": {{{}}}, \
         \"links\": [{{\"name\": \"l\", \"joint\": {{\"type\": \"fixed\"}}}}]}}",
        constants.join(", ")
    );
    assert!(message_of(source.as_bytes()).contains("longer than 400 digits"));
}
