//! The guide is run: its files are written, its commands run in order, its output compared.
//!
//! What stands behind the language of a block says what becomes of it:
//!
//! - ` ```json arm.json `: a file of that name is written
//! - ` ```sh `: each line is run, and exits with 0; with `exit=1` behind it, with 1
//! - ` ```sh no_run `: needs something that tests do not have, and is left alone
//! - ` ```text `: what the last block of commands prints; `...` stands for any lines
//!
//! Pictures of the page that the commands draw are compared, too. `UPDATE_EXPECT=1` writes all of
//! it anew. Other languages are run elsewhere: Rust by the doctests of the crate, Python by the
//! tests of the package.

use super::{Directory, run_in};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn guide() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide")
}

fn is_update() -> bool {
    std::env::var_os("UPDATE_EXPECT").is_some()
}

/// A fenced block of a page: the words behind the fence, and its lines with where they begin.
struct Block<'a> {
    words: Vec<&'a str>,
    start: usize,
    body: &'a str,
}

fn blocks(page: &str) -> Vec<Block<'_>> {
    let (mut blocks, mut at) = (Vec::new(), 0);
    let mut open: Option<(Vec<&str>, usize)> = None;
    for line in page.split_inclusive('\n') {
        let next = at + line.len();
        if let Some(info) = line.strip_prefix("```") {
            open = match open.take() {
                None => Some((info.split_whitespace().collect(), next)),
                Some((words, start)) => {
                    blocks.push(Block { words, start, body: &page[start..at] });
                    None
                }
            };
        }
        at = next;
    }
    assert!(open.is_none(), "a block without an end");
    blocks
}

/// A line without its numbers.
fn key(line: &str) -> String {
    let kept = line.replace(|c: char| c.is_ascii_digit() || ".+-e%".contains(c), " ");
    kept.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The lines that a block would show of what was printed now.
fn fresh(printed: &str, shown: &str) -> String {
    let lines: Vec<&str> = printed.lines().collect();
    let (mut text, mut at, mut is_skipping) = (String::new(), 0, false);
    for line in shown.lines() {
        if line == "..." {
            is_skipping = true;
            text += "...\n";
            continue;
        }
        if is_skipping {
            let rest = &lines[at..];
            let found = rest.iter().position(|other| *other == line);
            let found = found.or_else(|| rest.iter().position(|other| key(other) == key(line)));
            at += found.unwrap_or_else(|| panic!("no line `{line}` in:\n{printed}"));
            is_skipping = false;
        }
        text += lines.get(at).unwrap_or_else(|| panic!("no line `{line}` at the end"));
        text.push('\n');
        at += 1;
    }
    if !is_skipping {
        for line in &lines[at..] {
            text += line;
            text.push('\n');
        }
    }
    text
}

fn follow(name: &str) {
    let directory = Directory::new(&format!("guide-{name}"));
    let path = guide().join(format!("{name}.md"));
    let page = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path:?}: {error}"));
    let (mut printed, mut updated, mut copied) = (String::new(), String::new(), 0);
    for block in blocks(&page) {
        match block.words[..] {
            ["sh", "no_run"] => {}
            ["sh", ref tags @ ..] => {
                let code = tags.first().map_or("0", |tag| tag.trim_start_matches("exit="));
                printed = run_lines(&directory, block.body, code.parse().expect("an exit code"));
            }
            ["text"] => {
                let now = fresh(&printed, block.body);
                assert!(is_update() || now == block.body, "{name}: now\n{now}");
                updated += &page[copied..block.start];
                updated += &now;
                copied = block.start + block.body.len();
            }
            [_, file] if file.contains('.') => {
                fs::write(directory.path.join(file), block.body).expect("written");
            }
            _ => {}
        }
    }
    updated += &page[copied..];
    if is_update() {
        fs::write(&path, updated).expect("written");
    }
    compare_pictures(&directory, &page);
    evidence_leads_to_what_was_found(&directory);
}

fn run_lines(directory: &Directory, lines: &str, code: i32) -> String {
    let mut printed = String::new();
    for line in lines.lines() {
        let mut words = line.split_whitespace();
        assert_eq!(words.next(), Some("denavit"), "{line}");
        let run = run_in(&directory.path, &words.collect::<Vec<_>>());
        assert_eq!(run.code, Some(code), "{line}: {}{}", run.stdout, run.stderr);
        printed += &run.stdout;
        printed += &run.stderr;
    }
    printed
}

/// The page of a diagnosis says what became of an effect that a round took, where it is not there
/// in the end.
fn evidence_leads_to_what_was_found(directory: &Directory) {
    let found = |file: &str| fs::read_to_string(directory.path.join("found").join(file)).ok();
    let Some((json, report)) = found("diagnosis.json").zip(found("report.html")) else { return };
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let names = |list: &str, is_one: fn(&serde_json::Value) -> bool| -> BTreeSet<String> {
        let all = json[list].as_array().expect("a list").iter().filter(|one| is_one(one));
        all.map(|one| format!("{} {}", one["effect"], one["at"])).collect()
    };
    let taken = names("rounds", |round| round["is_taken"] == true);
    let is_exchanged = !taken.is_subset(&names("effects", |_| true));
    let is_told = report.contains("After each round effects are exchanged");
    assert_eq!(is_told, is_exchanged);
}

/// Pictures that the commands drew. That of a diagnosis stands on the page of its answer.
fn compare_pictures(directory: &Directory, page: &str) {
    let shown = page.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    for name in shown.filter(|name| name.ends_with(".svg") && !name.contains('/')) {
        let report = fs::read_to_string(directory.path.join("found/report.html"));
        let on_page = report.ok().and_then(|report| {
            let (_, rest) = report.split_once("<svg xmlns")?;
            Some(format!("<svg xmlns{}</svg>\n", rest.split_once("</svg>")?.0))
        });
        let Some(drawn) = fs::read_to_string(directory.path.join(name)).ok().or(on_page) else {
            continue;
        };
        if is_update() {
            fs::write(guide().join(name), &drawn).expect("written");
        }
        let kept = fs::read_to_string(guide().join(name)).expect("a picture");
        assert!(drawn == kept, "{name} is not up to date: UPDATE_EXPECT=1 draws it anew");
    }
}

macro_rules! pages {
    ($($test:ident: $page:literal),* $(,)?) => {
        const PAGES: &[&str] = &[$($page),*];
        $(
            #[test]
            fn $test() {
                follow($page);
            }
        )*
    };
}

pages! {
    the_tutorial_is_real: "tutorial",
    the_page_on_models_is_real: "model",
    the_page_on_simulation_is_real: "simulate",
    the_page_on_identification_is_real: "identify",
    the_page_on_diagnosis_is_real: "diagnose",
    the_page_on_walking_is_real: "walk",
    the_page_on_code_is_real: "controller-code",
    the_page_on_urdf_is_real: "from-your-urdf",
    the_page_on_python_is_real: "python",
    the_page_on_studies_is_real: "studies",
    the_page_on_fleets_is_real: "fleet",
    the_page_on_the_library_is_real: "library",
    the_page_on_shells_is_real: "shell",
    the_page_of_questions_is_real: "faq",
}

#[test]
fn every_page_of_the_guide_is_run() {
    let entries = fs::read_dir(guide()).expect("the guide").map(|entry| entry.expect("an entry"));
    let mut pages: Vec<String> = entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter_map(|name| name.strip_suffix(".md").map(str::to_owned))
        .collect();
    let mut run = PAGES.to_vec();
    pages.sort();
    run.sort_unstable();
    assert_eq!(pages, run);
}
