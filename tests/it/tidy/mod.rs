//! The rules of docs/ARCHITECTURE.md that a machine can hold, over the whole tree.

mod circles;
mod command_page;
mod documents;
mod errata;
mod errors;
mod exports;
mod flags;
mod ignored;
mod markdown;
mod policy;
mod python;
mod reached;
mod shipped;
mod walls;
mod words;

use std::fs;
use std::path::{Path, PathBuf};

const MAX_FILE_LINES: usize = 500;
const MAX_FUNCTION_LINES: usize = 70;
const MAX_COLUMNS: usize = 100;
/// The command parses, calls the library and prints.
const MAX_COMMAND_LINES: usize = 6000;

/// The stages of the compiler, in pipeline order: a stage uses only itself and those before it.
const STAGES: [&str; 17] = [
    "arena",
    "number",
    "expr",
    "fundamental",
    "model",
    "effect",
    "function",
    "spatial",
    "kinematics",
    "regroup",
    "dynamics",
    "regressor",
    "derive",
    "alias",
    "program",
    "emit",
    "build_script",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Every Rust file written by people below `folder`, in order.
fn rust_files(folder: &str) -> Vec<PathBuf> {
    let (mut files, mut pending) = (Vec::new(), vec![root().join(folder)]);
    while let Some(at) = pending.pop() {
        for entry in fs::read_dir(&at).unwrap().map(Result::unwrap) {
            let (path, name) = (entry.path(), entry.file_name());
            let skipped = ["target", "golden", "templates"].iter().any(|skip| name == *skip);
            if path.is_dir() && !skipped {
                pending.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

fn all_files() -> Vec<PathBuf> {
    ["src", "codegen", "crates", "python", "tests", "benches", "examples"]
        .into_iter()
        .flat_map(rust_files)
        .collect()
}

fn shown(path: &Path) -> String {
    path.strip_prefix(root()).unwrap().display().to_string()
}

fn assert_none(faults: &[String], rule: &str) {
    assert!(faults.is_empty(), "{rule}:\n  {}", faults.join("\n  "));
}

#[test]
fn the_command_is_short() {
    // tests of its parts stand below them
    let lines = |path: &PathBuf| {
        let text = fs::read_to_string(path).unwrap();
        text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default().lines().count()
    };
    let count: usize = rust_files("src/cli").iter().map(lines).sum();
    assert!(count > 1000 && count <= MAX_COMMAND_LINES, "src/cli has {count} lines");
}

#[test]
fn files_and_lines_are_short() {
    let mut faults = Vec::new();
    for path in all_files() {
        let text = fs::read_to_string(&path).unwrap();
        let lines = text.lines().count();
        if lines > MAX_FILE_LINES {
            faults.push(format!("{}: {lines} lines", shown(&path)));
        }
        for (index, line) in text.lines().enumerate() {
            if line.chars().count() > MAX_COLUMNS {
                faults.push(format!("{}:{}: too wide", shown(&path), index + 1));
            }
        }
    }
    assert_none(&faults, "at most 500 lines a file and 100 columns a line");
}

#[test]
fn functions_are_short() {
    let mut faults = Vec::new();
    for path in all_files() {
        let text = fs::read_to_string(&path).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        for (start, line) in lines.iter().enumerate() {
            let indent = line.len() - line.trim_start().len();
            let is_function = ["fn ", "pub fn ", "pub(crate) fn ", "pub(super) fn ", "const fn "]
                .iter()
                .any(|opening| line.trim_start().starts_with(opening));
            // rustfmt closes a function in the column where it opens.
            let closing = format!("{}}}", " ".repeat(indent));
            let end = lines[start..].iter().position(|line| *line == closing);
            // A declaration in a trait has no body.
            let opened = lines[start..].iter().find(|line| line.ends_with(['{', ';', '}']));
            let has_body = opened.is_some_and(|line| line.ends_with('{'));
            let counted = end.filter(|_| is_function && has_body);
            if let Some(length) = counted.filter(|&length| length + 1 > MAX_FUNCTION_LINES) {
                faults.push(format!("{}:{}: {} lines", shown(&path), start + 1, length + 1));
            }
        }
    }
    assert_none(&faults, "at most 70 lines a function");
}

#[test]
fn a_stage_uses_only_stages_before_it() {
    let mut faults = Vec::new();
    let source = root().join("codegen/src");
    for path in rust_files("codegen/src") {
        let own = path.strip_prefix(&source).unwrap().components().next().unwrap();
        let own = own.as_os_str().to_string_lossy();
        let own = own.trim_end_matches(".rs");
        let Some(rank) = STAGES.iter().position(|stage| *stage == own) else {
            assert_eq!(own, "lib", "{own} has no place in the pipeline");
            continue;
        };
        let text = fs::read_to_string(&path).unwrap();
        for (index, line) in text.lines().enumerate() {
            let code = line.split("//").next().unwrap();
            for used in code.split("crate::").skip(1) {
                let name: String =
                    used.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                let later = STAGES.iter().position(|stage| *stage == name);
                if later.is_some_and(|later| later > rank) {
                    let place = format!("{}:{}", shown(&path), index + 1);
                    faults.push(format!("{place}: {own} uses {name}, a later stage"));
                }
            }
        }
    }
    assert_none(&faults, "one direction of dependency");
}

#[test]
fn only_the_command_prints() {
    let mut faults = Vec::new();
    let files = ["src", "codegen", "crates"].into_iter().flat_map(rust_files);
    for path in files.filter(|path| path.iter().any(|part| part == "src")) {
        let place = shown(&path);
        // The build script speaks to cargo by printing.
        let may = ["src/cli", "src/main.rs", "codegen/src/build_script"];
        if may.iter().any(|prefix| place.starts_with(prefix)) {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        for (index, line) in text.lines().enumerate() {
            let code = line.split("//").next().unwrap();
            let prints = ["println!(", "print!(", "eprintln!(", "eprint!(", "dbg!("];
            if prints.iter().any(|call| code.contains(call)) {
                faults.push(format!("{place}:{}", index + 1));
            }
        }
    }
    assert_none(&faults, "only cli and main print");
}

#[test]
fn no_float_comes_before_the_program_stage() {
    let mut faults = Vec::new();
    let last = STAGES.iter().position(|stage| *stage == "program").unwrap();
    for path in rust_files("codegen/src") {
        let place = shown(&path);
        let stage = STAGES[..last].iter().any(|stage| {
            place.starts_with(&format!("codegen/src/{stage}/"))
                || place == format!("codegen/src/{stage}.rs")
        });
        // Looking at values: the ring of floats, the conversion it uses, messages that name it, and
        // tests.
        let allowed =
            ["expr/rings.rs", "expr/evaluate.rs", "number/mod.rs", "tests.rs", "_tests.rs"];
        if !stage || allowed.iter().any(|end| place.ends_with(end)) {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let code_lines = text.lines().take_while(|line| !line.contains("#[cfg(test)]"));
        for (index, line) in code_lines.enumerate() {
            let code = line.split("//").next().unwrap();
            if code.contains("f64") || code.contains("f32") {
                faults.push(format!("{place}:{}", index + 1));
            }
        }
    }
    assert_none(&faults, "no float is stored or decides anything before `program`");
}

#[test]
fn no_file_is_a_drawer_for_everything() {
    let faults: Vec<String> = all_files()
        .iter()
        .filter(|path| {
            let stem = path.file_stem().unwrap().to_string_lossy();
            ["utils", "util", "helpers", "helper", "misc", "common"].contains(&stem.as_ref())
        })
        .map(|path| shown(path))
        .collect();
    assert_none(&faults, "a file is named after its idea");
}

#[test]
fn nothing_is_left_unfinished() {
    let mut faults = Vec::new();
    for path in all_files().iter().filter(|path| !path.ends_with("tests/it/tidy/mod.rs")) {
        let text = fs::read_to_string(path).unwrap();
        for (index, line) in text.lines().enumerate() {
            let marks = ["todo!(", "unimplemented!(", "FIXME", "TODO", "XXX"];
            if marks.iter().any(|mark| line.contains(mark)) {
                faults.push(format!("{}:{}", shown(path), index + 1));
            }
        }
    }
    assert_none(&faults, "no stub");
}
