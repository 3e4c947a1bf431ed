//! A crate outside the workspace that uses the compiler in its build script.

use super::flat::{Interpreted, bits, project};
use denavit_codegen::derive::Flavour;
use denavit_codegen::function::FunctionName;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A copy of the fixture under the target directory, with the project's lock file, its relative
/// paths made absolute and what else `change` does to a file's text.
fn copy(name: &str, change: impl Fn(&str, String) -> String) -> PathBuf {
    let source = project("tests/fixtures/outside_crate");
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(target.join("src")).unwrap();
    let root = project("").to_string_lossy().replace('\\', "/");
    for file in ["Cargo.toml", "build.rs", "src/lib.rs", "src/main.rs"] {
        let text = fs::read_to_string(source.join(file)).unwrap();
        let text = change(file, text.replace("../../../", &root));
        fs::write(target.join(file), text).unwrap();
    }
    fs::copy(project("Cargo.lock"), target.join("Cargo.lock")).unwrap();
    target
}

/// Runs cargo there. All copies share one target directory, so the compiler is built once.
fn cargo(directory: &Path, command: &str) -> Output {
    Command::new(env!("CARGO"))
        .args([command, "--quiet", "--offline"])
        .current_dir(directory)
        .env("CARGO_TARGET_DIR", Path::new(env!("CARGO_TARGET_TMPDIR")).join("outside_target"))
        .env_remove("RUSTFLAGS")
        .output()
        .unwrap()
}

/// An unoptimised build, so this also holds every function to a stack of 2 MiB.
#[test]
fn a_crate_outside_builds_and_computes_what_the_interpreter_computes() {
    let directory = copy("outside_crate", |_, text| text);
    let output = cargo(&directory, "run");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let printed = String::from_utf8(output.stdout).unwrap();
    let found: Vec<u64> =
        printed.lines().map(|line| u64::from_str_radix(line, 16).unwrap()).collect();

    let functions = [FunctionName::InverseDynamics];
    let interpreted = Interpreted::new("tulip", Flavour::Tunable, &functions);
    let vector = |start: f64| -> Vec<f64> { (0..18).map(|j| start + 0.125 * j as f64).collect() };
    let arguments = [vector(-1.0), vector(0.5), vector(-2.0)];
    let arguments: Vec<&[f64]> = arguments.iter().map(|vector| &vector[..]).collect();
    let routine = interpreted.routine(FunctionName::InverseDynamics, None);
    assert_eq!(found, bits(&interpreted.one(routine, &arguments)));
}

/// The build of a crate whose model is wrong names every fault, each as an error of its own, and
/// shows no backtrace.
#[test]
fn a_wrong_model_fails_the_build_with_all_its_faults() {
    let directory = copy("outside_crate_wrong", |file, text| match file {
        "build.rs" => text
            .replace("tulip.json", "planar_2r.json")
            .replace(&project("models").to_string_lossy().to_string(), "."),
        "Cargo.toml" => text.replace("outside_crate", "outside_crate_wrong"),
        _ => text,
    });
    let model = fs::read_to_string(project("models/planar_2r.json")).unwrap();
    let wrong = model.replace("\"mass\": 2.0", "\"mass\": -2.0").replace("\"l2\"}", "\"l3\"}");
    fs::write(directory.join("planar_2r.json"), wrong).unwrap();
    let output = cargo(&directory, "build");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success());
    assert!(message.contains("planar_2r.json:22:"), "{message}");
    assert!(message.contains("l3"), "{message}");
    assert!(message.contains("mass"), "{message}");
    assert!(!message.contains("panicked") && !message.contains("backtrace"), "{message}");
}
