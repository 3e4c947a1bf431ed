//! Documents: links lead somewhere, the book has every page, sentences are short.

use super::markdown::{anchors, cells, links, sentences};
use super::{all_files, assert_none, root, shown};
use std::fs;
use std::path::{Path, PathBuf};

const MOST_WORDS_OF_A_SENTENCE: f64 = 20.0;
const MOST_WORDS_OF_A_CELL: usize = 40;
const MOST_WORDS_OF_A_GUIDE: usize = 1200;

/// Every page below `docs`, in order.
pub(super) fn pages() -> Vec<PathBuf> {
    let (mut pages, mut pending) = (Vec::new(), vec![root().join("docs")]);
    while let Some(folder) = pending.pop() {
        for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let path = entry.path();
            if path.is_dir() {
                pending.push(path);
            } else if path.extension().is_some_and(|extension| extension == "md") {
                pages.push(path);
            }
        }
    }
    pages.sort();
    pages
}

pub(super) fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// What is wrong with a link of a page, if anything is.
fn fault_of_link(page: &Path, target: &str) -> Option<&'static str> {
    if target.contains("://") || target.starts_with("mailto:") {
        return None;
    }
    let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
    let path =
        if file.is_empty() { page.to_owned() } else { page.parent().expect("a folder").join(file) };
    if !path.exists() {
        return Some("no such file");
    }
    let is_there = anchor.is_empty() || anchors(&read(&path)).iter().any(|one| one == anchor);
    (!is_there).then_some("no such heading")
}

#[test]
fn links_lead_to_files_and_headings() {
    let others = ["README.md", "CHANGELOG.md", "python/README.md"].map(|name| root().join(name));
    let mut faults = Vec::new();
    for page in pages().into_iter().chain(others) {
        for (line, target) in links(&read(&page)) {
            if let Some(fault) = fault_of_link(&page, &target) {
                faults.push(format!("{}:{line}: {target}: {fault}", shown(&page)));
            }
        }
    }
    assert_none(&faults, "every link leads somewhere");
}

/// The paths of documents that a text names.
fn named_documents(text: &str) -> Vec<&str> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || "._-/".contains(c);
    let starts = text.match_indices("docs/").map(|(start, _)| start);
    let inside = |start: &usize| !text[..*start].ends_with(|c: char| is_part(c) && c != '/');
    let paths = starts.filter(inside).map(|start| {
        let rest = &text[start..];
        let path = &rest[..rest.find(|c| !is_part(c)).unwrap_or(rest.len())];
        path.trim_end_matches('.')
    });
    paths.filter(|path| path.ends_with(".md") || path.ends_with(".svg")).collect()
}

#[test]
fn documents_that_are_named_exist() {
    let others = [
        ".ci/run",
        ".ci/long",
        ".ci/release",
        "CHANGELOG.md",
        "Cargo.toml",
        "README.md",
        "codegen/src/effect/schema.json",
        "codegen/src/model/equations-schema.json",
        "codegen/src/model/schema.json",
        "codegen/src/regressor/certificate-schema.json",
        "python/README.md",
    ];
    let others = others.into_iter().map(|name| root().join(name));
    let mut faults = Vec::new();
    for path in all_files().into_iter().chain(pages()).chain(others) {
        let text = read(&path);
        let missing = named_documents(&text).into_iter().filter(|name| !root().join(name).exists());
        faults.extend(missing.map(|name| format!("{}: {name}", shown(&path))));
    }
    assert_none(&faults, "documents that code, comments and pages name exist");
}

#[test]
fn the_book_has_every_page_once() {
    let summary = root().join("docs/SUMMARY.md");
    let mut listed: Vec<PathBuf> = links(&read(&summary))
        .into_iter()
        .map(|(_, target)| root().join("docs").join(target))
        .collect();
    listed.push(summary);
    listed.sort();
    assert_eq!(listed, pages(), "docs/SUMMARY.md lists every page of docs/ once");
}

/// Pages of the guide and of the reference, and the README.
fn read_by_users() -> Vec<PathBuf> {
    let is_read = |path: &PathBuf| {
        ["docs/guide/", "docs/reference/"].iter().any(|folder| shown(path).starts_with(folder))
    };
    pages().into_iter().filter(is_read).chain([root().join("README.md")]).collect()
}

#[test]
fn sentences_and_cells_are_short() {
    let mut faults = Vec::new();
    for path in read_by_users() {
        let page = read(&path);
        let lengths = sentences(&page);
        let mean = lengths.iter().sum::<usize>() as f64 / lengths.len().max(1) as f64;
        if mean > MOST_WORDS_OF_A_SENTENCE {
            faults.push(format!("{}: {mean:.1} words a sentence", shown(&path)));
        }
        let long = cells(&page).into_iter().filter(|(_, words)| *words > MOST_WORDS_OF_A_CELL);
        faults.extend(
            long.map(|(line, words)| format!("{}:{line}: a cell of {words} words", shown(&path))),
        );
    }
    assert_none(&faults, "at most 20 words a sentence in the mean, and 40 words a cell");
}

#[test]
fn pages_of_the_guide_are_short() {
    let guide = pages().into_iter().filter(|path| shown(path).starts_with("docs/guide/"));
    let words = guide.map(|path| (shown(&path), read(&path).split_whitespace().count()));
    let long = words.filter(|(_, words)| *words > MOST_WORDS_OF_A_GUIDE);
    let faults: Vec<String> = long.map(|(page, words)| format!("{page}: {words} words")).collect();
    assert_none(&faults, "at most 1200 words a page of the guide");
}

#[test]
fn types_of_the_glossary_exist() {
    let code: String = all_files().iter().map(|path| read(path)).collect();
    let page = read(&root().join("docs/glossary.md"));
    let (_, types) = page.split_once("## The compiler").expect("the types");
    let names = types.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next());
    let is_declared = |name: &str| {
        ["struct", "enum", "trait", "type"].iter().any(|kind| {
            let declared = format!("pub {kind} {name}");
            code.match_indices(&declared).any(|(start, _)| {
                !code[start + declared.len()..].starts_with(|c: char| c.is_alphanumeric())
            })
        })
    };
    let missing: Vec<String> = names.filter(|name| !is_declared(name)).map(str::to_owned).collect();
    assert_none(&missing, "docs/glossary.md names public types");
}
