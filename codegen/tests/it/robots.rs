//! The robots that tests run on.

use denavit_codegen::model::{self, Robot};
use std::path::PathBuf;

/// The repository's root, which holds models/ and tests/.
pub(crate) fn repository() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_path_buf()
}

/// Names of all shipped models, in order.
pub(crate) fn shipped() -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(repository().join("models"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert!(names.len() >= 12, "models are missing: {names:?}");
    names
}

/// A shipped model.
pub(crate) fn load(name: &str) -> Robot {
    let path = repository().join("models").join(format!("{name}.json"));
    let source = std::fs::read(&path).unwrap();
    model::read(&path.display().to_string(), &source).unwrap_or_else(|error| panic!("{error}"))
}

/// A model of the tests alone.
pub(crate) fn fixture(name: &str) -> Robot {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(name);
    let source = std::fs::read(&path).unwrap();
    model::read(name, &source).unwrap_or_else(|error| panic!("{error}"))
}
