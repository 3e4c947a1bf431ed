//! Programs of a user: those of docs/reference/c-and-cpp.md, and one with a scalar of its own.

use super::compiled::{Language, compilers, warning_free};
use crate::robots::{load, repository};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::emit::c;
use denavit_codegen::function::FunctionName;
use denavit_codegen::program::lower;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A folder with the emitted PUMA 560 in both languages.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    let derivation = derive(&load("puma560"), Flavour::Tunable, &FunctionName::ALL).unwrap();
    let program = lower(&derivation.dag, &derivation.functions).unwrap();
    let files = c::files(&derivation.robot, &program, "puma560.h").unwrap();
    let header = c::cpp_header(&derivation.robot, &program).unwrap();
    for (name, text) in
        [("puma560.h", files.header), ("puma560.c", files.source), ("puma560.hpp", header)]
    {
        std::fs::write(folder.join(name), text).unwrap();
    }
    folder
}

/// What a program of these files prints.
fn printed(folder: &Path, compiler: &str, standard: &str, files: &[&str]) -> String {
    let mut compile = Command::new(compiler);
    compile.args([standard, "-O1", "-o", "program"]).args(files).arg("-lm").current_dir(folder);
    warning_free(&mut compile);
    let output = Command::new(folder.join("program")).output().unwrap();
    assert!(output.status.success());
    String::from_utf8(output.stdout).unwrap()
}

/// The block of a language on the page.
fn block(language: &str) -> String {
    let page = std::fs::read_to_string(repository().join("docs/reference/c-and-cpp.md")).unwrap();
    let (_, rest) = page.split_once(&format!("```{language}\n")).unwrap();
    rest.split_once("```").unwrap().0.to_owned()
}

#[test]
fn the_programs_of_the_guide_run_and_agree() {
    let folder = folder("c_guide");
    std::fs::write(folder.join("controller.c"), block("c")).unwrap();
    std::fs::write(folder.join("controller.cpp"), block("cpp")).unwrap();
    let mut shoulders = Vec::new();
    for compiler in compilers(Language::C) {
        let text = printed(&folder, compiler, "-std=c99", &["controller.c", "puma560.c"]);
        assert_eq!(text.lines().count(), 6, "{text}");
        let shoulder = text.lines().nth(1).unwrap();
        let torque = shoulder.strip_prefix("shoulder: ").unwrap();
        shoulders.push(torque.split_once(',').unwrap().0.to_owned());
    }
    for compiler in compilers(Language::Cpp) {
        let text = printed(&folder, compiler, "-std=c++17", &["controller.cpp"]);
        let (double, single) = text.trim().split_once(", ").unwrap();
        shoulders.push(double.to_owned());
        let numbers = [double, single].map(|one| one.trim_end_matches(" N m").parse::<f64>());
        let [double, single] = numbers.map(Result::unwrap);
        assert!((double - single).abs() < 1e-3 && double.abs() > 1.0, "{text}");
    }
    assert!(shoulders.iter().all(|torque| *torque == shoulders[0]), "{shoulders:?}");
}

#[test]
fn a_scalar_of_ones_own_makes_derivatives() {
    let folder = folder("c_dual");
    let program = repository().join("codegen/tests/fixtures/c/dual.cpp");
    std::fs::copy(program, folder.join("dual.cpp")).unwrap();
    for compiler in compilers(Language::Cpp) {
        let text = printed(&folder, compiler, "-std=c++17", &["dual.cpp"]);
        let largest: f64 = text.trim().parse().unwrap();
        assert!(largest < 1e-13, "{largest}");
    }
}
