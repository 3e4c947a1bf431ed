//! Model files: the shipped ones, broken ones, and whatever a fuzzer makes of them.

mod broken;
mod fuzz;
mod parameters;
mod pose;
mod remarks;
mod schema;
mod shipped;

use denavit_codegen::model::{self, Robot};
use std::path::{Path, PathBuf};

fn package() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A file of this package's fixtures.
fn fixture(name: &str) -> PathBuf {
    package().join("tests/fixtures").join(name)
}

/// The shipped models, name and text, in the order of their names.
fn shipped_models() -> Vec<(String, String)> {
    let mut models: Vec<(String, String)> = std::fs::read_dir(package().join("../models"))
        .expect("the folder of shipped models")
        .map(|entry| entry.expect("a file").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .map(|path| {
            let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
            (name, std::fs::read_to_string(path).expect("a text"))
        })
        .collect();
    models.sort();
    models
}

/// A robot from the text of its model.
fn robot_of(name: &str, text: &str) -> Robot {
    match model::read(name, text.as_bytes()) {
        Ok(robot) => robot,
        Err(error) => panic!("{error}"),
    }
}

/// A shipped robot.
fn shipped(name: &str) -> Robot {
    let path = package().join("../models").join(format!("{name}.json"));
    robot_of(name, &std::fs::read_to_string(path).expect("a shipped model"))
}
