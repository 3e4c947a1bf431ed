//! Each row of docs/evidence/errata.md names the test that decides it.

use super::{all_files, assert_none, root};
use std::fs;

#[test]
fn every_test_that_the_errata_name_exists() {
    let errata = fs::read_to_string(root().join("docs/evidence/errata.md")).unwrap();
    let files: Vec<_> =
        all_files().into_iter().filter(|path| path.to_string_lossy().contains("tests/")).collect();
    let is_there = |module: &str, test: &str| {
        files.iter().filter(|path| path.file_stem().is_some_and(|stem| stem == module)).any(
            |path| {
                let text = fs::read_to_string(path).unwrap();
                text.contains(&format!("#[test]\nfn {test}() {{"))
            },
        )
    };
    let named: Vec<_> = errata.split('`').filter_map(|word| word.split_once("::")).collect();
    assert!(named.len() >= 25, "only {} tests named", named.len());
    let missing: Vec<String> = named
        .into_iter()
        .filter(|(module, test)| !is_there(module, test))
        .map(|(module, test)| format!("{module}::{test}"))
        .collect();
    assert_none(&missing, "a test that docs/evidence/errata.md names exists");
}
