//! Every file is a module of something: what no module names is not compiled, and no test of it
//! runs.

use super::{all_files, assert_none, root, shown};
use std::fs;
use std::path::{Path, PathBuf};

/// Files that cargo names itself, or that another file includes.
const HEADS: [&str; 4] = ["main", "lib", "mod", "build"];

/// Where a file's module would be named: in the file that its folder belongs to.
fn parents(path: &Path) -> Vec<PathBuf> {
    let folder = path.parent().unwrap();
    let mut parents: Vec<PathBuf> =
        ["main.rs", "lib.rs", "mod.rs"].iter().map(|head| folder.join(head)).collect();
    parents.push(folder.with_extension("rs"));
    parents
}

fn is_named(path: &Path) -> bool {
    let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
    // the module of a folder is named one level up
    let (path, name) = match stem.as_str() {
        "mod" => {
            let folder = path.parent().unwrap();
            (folder.to_owned(), folder.file_name().unwrap().to_string_lossy().into_owned())
        }
        _ => (path.to_owned(), stem),
    };
    // tests of what is private stand beside those of what is public
    if path.parent().unwrap().ends_with("tests/unit") {
        let attribute = format!("tests/unit/{name}.rs\"]\nmod tests;");
        let sources = all_files().into_iter().filter_map(|path| fs::read_to_string(path).ok());
        return sources.into_iter().any(|text| text.contains(&attribute));
    }
    let texts = parents(&path).into_iter().filter_map(|parent| fs::read_to_string(parent).ok());
    texts.into_iter().any(|text| text.contains(&format!("mod {name};")))
}

#[test]
fn every_file_is_a_module() {
    let cargo_names = |path: &Path| {
        let stem = path.file_stem().unwrap().to_string_lossy();
        let folder = path.parent().unwrap();
        let is_target = ["benches", "examples"].iter().any(|name| folder.ends_with(name));
        let is_single_test = folder.ends_with("tests") && folder.join("../Cargo.toml").exists();
        let is_head = HEADS.contains(&stem.as_ref()) && stem != "mod";
        is_target || is_single_test || is_head || path.starts_with(root().join("tests/fixtures"))
    };
    let files = all_files();
    let forgotten = files.iter().filter(|path| !cargo_names(path) && !is_named(path));
    let faults: Vec<String> = forgotten.map(|path| shown(path)).collect();
    assert_none(&faults, "a file that no module names is not compiled");
}
