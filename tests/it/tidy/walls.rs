//! Which package may use which: cargo refuses what a manifest does not name, and this table says
//! what manifests may name.

use super::{assert_none, root};
use std::fs;

/// Our packages, each after what it may use: folder, and the packages that it uses.
const WALLS: [(&str, &[&str]); 22] = [
    ("codegen/runtime", &[]),
    ("codegen", &["runtime"]),
    ("codegen/jit", &["codegen", "runtime"]),
    ("crates/numerics", &["runtime"]),
    // knows nothing of robots
    ("crates/evidence", &[]),
    // knows files, and no robots
    ("crates/logs", &[]),
    // knows no number that is not exact
    ("crates/import", &["codegen"]),
    ("crates/plants", &["codegen", "jit", "runtime"]),
    ("crates/simulate", &["codegen", "numerics", "plants", "runtime"]),
    ("crates/walk", &["codegen", "numerics", "plants", "runtime", "simulate"]),
    ("crates/measure", &["codegen", "logs", "numerics", "plants", "simulate"]),
    // concludes nothing of logs
    ("crates/replay", &["codegen", "measure", "numerics", "plants", "simulate"]),
    // knows no log
    ("crates/excite", &["codegen", "numerics", "plants", "runtime", "simulate"]),
    ("crates/identify", &["codegen", "evidence", "measure", "numerics", "plants"]),
    ("crates/elastic", &["identify", "measure", "numerics", "plants"]),
    // knows no motion
    ("crates/statics", &["codegen", "numerics", "plants"]),
    (
        "crates/diagnose",
        &["codegen", "evidence", "excite", "identify", "measure", "numerics", "plants", "replay"],
    ),
    // prints nothing
    (
        "crates/workflow",
        &[
            "codegen", "diagnose", "elastic", "excite", "identify", "import", "logs", "measure",
            "numerics", "plants", "replay", "simulate", "statics", "walk",
        ],
    ),
    (
        "crates/report",
        &[
            "codegen", "diagnose", "elastic", "excite", "identify", "numerics", "plants", "replay",
            "runtime", "simulate", "walk", "workflow",
        ],
    ),
    // a client of the facade
    ("python", &[]),
    // shares nothing with what it tries out
    ("tests/blind", &[]),
    (
        "",
        &[
            "codegen", "diagnose", "elastic", "excite", "identify", "import", "jit", "logs",
            "measure", "numerics", "plants", "replay", "report", "runtime", "simulate", "statics",
            "walk", "workflow",
        ],
    ),
];

/// Our packages that a manifest names outside its tests.
fn named(manifest: &str) -> Vec<&str> {
    let (mut names, mut counts) = (Vec::new(), false);
    for line in manifest.lines() {
        if line.starts_with('[') {
            counts = ["[dependencies]", "[build-dependencies]"].contains(&line.trim());
        } else if let Some(rest) = line.strip_prefix("denavit-").filter(|_| counts) {
            names.extend(rest.split(['.', ' ', '=']).next());
        }
    }
    names
}

#[test]
fn packages_use_only_what_is_below_them() {
    let mut faults = Vec::new();
    for (folder, allowed) in WALLS {
        let manifest = fs::read_to_string(root().join(folder).join("Cargo.toml")).unwrap();
        for name in named(&manifest) {
            if !allowed.contains(&name) {
                faults.push(format!("{folder} uses {name}"));
            }
        }
    }
    let crates = fs::read_dir(root().join("crates")).unwrap().map(Result::unwrap);
    for entry in crates {
        let folder = format!("crates/{}", entry.file_name().to_string_lossy());
        if !WALLS.iter().any(|(known, _)| *known == folder) {
            faults.push(format!("{folder} has no place"));
        }
    }
    assert_none(&faults, "walls between packages");
}

#[test]
fn manifests_are_read_without_their_tests() {
    let manifest = "[package]\nname = \"denavit-x\"\n[dependencies]\n\
                    denavit-plants.workspace = true\nclap = \"4\"\n\
                    [dev-dependencies]\ndenavit-walk.workspace = true\n\
                    [build-dependencies]\ndenavit-codegen = { workspace = true }\n";
    assert_eq!(named(manifest), ["plants", "codegen"]);
}
