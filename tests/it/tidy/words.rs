//! Words: what people read has the words of docs/glossary.md, and none that stand beside them there
//! as those that are not used.

use super::documents::{pages, read};
use super::markdown::{prose, without_code};
use super::{assert_none, root, rust_files, shown};
use std::fs;
use std::path::PathBuf;

/// The words of the field, and those that have given way to them.
struct Words {
    kept: Vec<String>,
    refused: Vec<String>,
}

impl Words {
    /// Those of the first table of the glossary.
    fn read() -> Self {
        let page = read(&root().join("docs/glossary.md"));
        let table = page.lines().skip_while(|line| *line != "## Words").skip(1);
        let rows = table.take_while(|line| !line.starts_with("## ")).filter(|l| l.starts_with('|'));
        let mut words = Self { kept: Vec::new(), refused: Vec::new() };
        for row in rows.skip(2) {
            let cells: Vec<&str> = row.split('|').map(str::trim).collect();
            words.kept.push(cells[1].to_lowercase());
            words.refused.extend(cells[3].split(", ").map(str::to_lowercase));
        }
        words.refused.retain(|word| !word.is_empty());
        words
    }

    /// The first refused word of a text, if there is one.
    fn refused_in(&self, text: &str) -> Option<&str> {
        let text = text.to_lowercase();
        self.refused.iter().map(String::as_str).find(|word| {
            // a word that is right may have one in it that is not
            let around = self.kept.iter().filter(|kept| !word.contains(kept.as_str()));
            is_in(word, &around.fold(text.clone(), |text, kept| text.replace(kept, "KEPT")))
        })
    }
}

/// Whether a word stands in a text by itself: not as a part of another word or of code, nor as a
/// quoted key.
fn is_in(word: &str, text: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || "_-`\"\\{}".contains(c);
    text.match_indices(word).any(|(at, _)| {
        let (before, after) = (&text[..at], &text[at + word.len()..]);
        !before.ends_with(is_part) && !after.starts_with(is_part)
    })
}

/// The texts of a file of Rust, with the numbers of their first lines: literals of several words.
/// Comments are not looked at, but for those of flags, which are the help of the command.
fn texts(code: &str, has_help: bool) -> Vec<(usize, String)> {
    let (mut texts, mut rest, mut line) = (Vec::new(), code, 1);
    while let Some(at) = rest.find(['"', '/', '\'']) {
        line += rest[..at].matches('\n').count();
        let from = &rest[at..];
        let length = match from {
            _ if from.starts_with("//") => from.find('\n').unwrap_or(from.len()),
            _ if from.starts_with("'\"'") || from.starts_with("'\\") => 3,
            _ if from.starts_with('"') && rest[..at].ends_with("r#") => {
                from.find("\"#").map_or(from.len(), |end| end + 2)
            }
            _ if from.starts_with('"') => 2 + length_of_literal(&from[1..]),
            _ => 1,
        };
        let own = &from[..length];
        if own.starts_with('"') && own.contains(' ') {
            texts.push((line, joined(own)));
        } else if has_help && own.starts_with("///") {
            texts.push((line, own.to_owned()));
        }
        line += own.matches('\n').count();
        rest = &from[length..];
    }
    texts
}

/// The length of a literal up to the quote that ends it.
fn length_of_literal(from: &str) -> usize {
    let mut is_escaped = false;
    let end = from.bytes().position(|byte| {
        let ends = byte == b'"' && !is_escaped;
        is_escaped = byte == b'\\' && !is_escaped;
        ends
    });
    end.unwrap_or(from.len() - 1)
}

/// What a literal says, in one line.
fn joined(literal: &str) -> String {
    let text = literal.trim_end_matches('#').trim_matches('"');
    text.split("\\\n").enumerate().fold(String::new(), |text, (at, part)| {
        text + if at == 0 { part } else { part.trim_start() }
    })
}

#[test]
fn printed_texts_have_the_words_of_the_glossary() {
    let words = Words::read();
    let mut faults = Vec::new();
    for path in ["src", "codegen", "crates"].into_iter().flat_map(rust_files) {
        let place = shown(&path);
        if place.contains("/tests/") || place.ends_with("tests.rs") {
            continue;
        }
        let text = read(&path);
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        for (line, text) in texts(code, place.starts_with("src/cli")) {
            if let Some(word) = words.refused_in(&text) {
                faults.push(format!("{place}:{line}: {word}"));
            }
        }
    }
    assert_none(&faults, "words that docs/glossary.md refuses");
}

#[test]
fn effects_have_the_words_of_the_glossary() {
    let words = Words::read();
    let mut faults = Vec::new();
    for entry in fs::read_dir(root().join("models/effects")).unwrap() {
        let path = entry.unwrap().path();
        let text = read(&path);
        // keys are single words in quotes, laws have products, units a key of their own
        let prose = text.lines().filter(|line| !line.trim_start().starts_with("\"unit\""));
        let texts = prose.flat_map(|line| line.split('"'));
        for text in texts.filter(|text| text.contains(' ') && !text.contains('*')) {
            if let Some(word) = words.refused_in(text) {
                faults.push(format!("{}: {word}: {text}", shown(&path)));
            }
        }
    }
    assert_none(&faults, "words that docs/glossary.md refuses");
}

#[test]
fn documents_have_the_words_of_the_glossary() {
    let words = Words::read();
    let mut faults = Vec::new();
    let others = ["README.md", "python/README.md"].map(|name| root().join(name));
    for page in pages().into_iter().chain(others).filter(|page| !page.ends_with("glossary.md")) {
        let text = read(&page);
        let lines = prose(&text);
        // a phrase may go on in the next line
        for (at, (number, line)) in lines.iter().enumerate() {
            let other = |at: Option<usize>| at.and_then(|at| lines.get(at)).map_or("", |one| one.1);
            let [last, next] = [at.checked_sub(1), Some(at + 1)].map(other);
            let text = without_code(&[last, line, next].map(str::trim).join(" "));
            if let Some(word) = words.refused_in(&text) {
                faults.push(format!("{}:{number}: {word}", shown(&page)));
            }
        }
    }
    assert_none(&faults, "words that docs/glossary.md refuses");
}

#[test]
fn texts_of_python_and_templates_have_the_words_of_the_glossary() {
    let mut words = Words::read();
    // code has names, which are single words
    words.refused.retain(|word| word.contains(' '));
    let mut faults = Vec::new();
    for path in ["python", "templates"].into_iter().flat_map(text_files) {
        for (at, line) in read(&path).lines().enumerate() {
            if let Some(word) = words.refused_in(&without_code(line)) {
                faults.push(format!("{}:{}: {word}", shown(&path), at + 1));
            }
        }
    }
    assert_none(&faults, "words that docs/glossary.md refuses");
}

/// Files of Python, and templates of emitted code, below a folder.
fn text_files(folder: &str) -> Vec<PathBuf> {
    let (mut files, mut pending) = (Vec::new(), vec![root().join(folder)]);
    while let Some(at) = pending.pop() {
        for path in fs::read_dir(&at).unwrap().map(|entry| entry.unwrap().path()) {
            let skipped =
                ["tests", "target", "__pycache__"].iter().any(|skip| path.ends_with(skip));
            match path.extension().and_then(|extension| extension.to_str()) {
                _ if path.is_dir() && !skipped => pending.push(path),
                Some("py" | "in" | "tera") => files.push(path),
                _ => {}
            }
        }
    }
    files.sort();
    files
}

#[test]
fn refused_words_are_seen() {
    let words = Words::read();
    let seen = |text| words.refused_in(text);
    assert_eq!(seen("half the rate of sampling"), Some("rate"));
    assert_eq!(seen("the gap of the torques"), Some("gap of the torques"));
    assert_eq!(seen("where drives turn around or rest"), Some("turn around"));
    assert_eq!(seen("half the sampling rate, `rates`, state_rate, separate"), None);
    let code =
        "let a = \"one \\\n   rate\"; // a rate\nb('\"', \"c \\\" rate\", r#\"d \"rate\" e\"#);";
    let found: Vec<(usize, String)> = texts(code, false);
    let expected = [(1, "one rate"), (3, "c \\\" rate"), (3, "d \"rate\" e")];
    assert_eq!(found, expected.map(|(line, text)| (line, text.to_owned())));
}
