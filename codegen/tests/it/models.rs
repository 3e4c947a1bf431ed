//! Robots for tests, read as a user's would be.

use denavit_codegen::model::{Robot, read};
use std::path::Path;

/// The robot of `models/NAME.json`.
pub(crate) fn model(name: &str) -> Robot {
    robot("../models", name)
}

/// The robot of `tests/fixtures/NAME.json`.
pub(crate) fn fixture(name: &str) -> Robot {
    robot("tests/fixtures", name)
}

fn robot(folder: &str, name: &str) -> Robot {
    let file = format!("{name}.json");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder).join(&file);
    let source = std::fs::read(&path).expect("the file is there");
    read(&file, &source).expect("it has no faults")
}
