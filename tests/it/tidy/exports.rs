//! Nothing is exported that nobody has a use for.

use super::{all_files, assert_none, root};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Names that a crate's root hands on with `pub use module::..`.
fn handed_on(root_file: &str) -> BTreeSet<String> {
    let uses = root_file.split("\npub use ").skip(1).filter_map(|rest| rest.split_once(';'));
    // another crate under another name is no item
    let items = uses.filter_map(|(path, _)| match path.split_once('{') {
        Some((_, list)) => Some(list),
        None => path.rsplit_once("::").map(|(_, name)| name),
    });
    items.flat_map(words).collect()
}

fn words(text: &str) -> Vec<String> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    let all = text.split(|c: char| !is_part(c)).filter(|word| !word.is_empty());
    all.map(str::to_owned).collect()
}

/// Whether a name is part of another public item: of a field, an argument or an answer.
fn is_of_an_item(name: &str, text: &str) -> bool {
    let defines = ["pub struct ", "pub enum ", "pub trait ", "pub use ", "pub type "];
    let has_trait = text.contains("pub trait ");
    let is_public = |line: &&str| {
        let line = line.trim_start();
        let is_item = line.starts_with("pub ") && !defines.iter().any(|own| line.starts_with(own));
        is_item || line.starts_with(") -> ") || has_trait && line.starts_with("fn ")
    };
    text.lines().filter(is_public).any(|line| words(line).iter().any(|word| word == name))
}

#[test]
fn every_exported_name_is_used_outside_or_is_part_of_one_that_is() {
    let read = |path: &PathBuf| (path.clone(), fs::read_to_string(path).unwrap());
    let files: Vec<(PathBuf, String)> = all_files().iter().map(read).collect();
    let known: Vec<(&Path, BTreeSet<String>)> = files
        .iter()
        .map(|(path, text)| (path.as_path(), words(text).into_iter().collect()))
        .collect();
    let mut faults = Vec::new();
    for entry in fs::read_dir(root().join("crates")).unwrap().map(Result::unwrap) {
        let own = entry.path().join("src");
        let exported = handed_on(&fs::read_to_string(own.join("lib.rs")).unwrap());
        for name in exported {
            let outside = known.iter().filter(|(path, _)| !path.starts_with(&own));
            let is_used = outside.into_iter().any(|(_, words)| words.contains(&name));
            let inside = files.iter().filter(|(path, _)| path.starts_with(&own));
            if !is_used && !inside.into_iter().any(|(_, text)| is_of_an_item(&name, text)) {
                faults.push(format!("{}: {name}", entry.file_name().to_string_lossy()));
            }
        }
    }
    faults.sort();
    assert_none(&faults, "names that nothing outside uses");
}

#[test]
fn names_that_are_handed_on_are_read() {
    let text = "//! x\npub use a::b::{One, two};\npub use c::Three;\npub use other as four;\n";
    let names: Vec<String> = handed_on(text).into_iter().collect();
    assert_eq!(names, ["One", "Three", "two"]);
    assert!(is_of_an_item("One", "    pub one: Vec<One>,\n"));
    assert!(!is_of_an_item("One", "pub struct One {\n"));
}
