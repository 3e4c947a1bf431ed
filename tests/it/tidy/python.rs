//! The Python package keeps the limits of the rest.

use super::{MAX_COLUMNS, MAX_FILE_LINES, MAX_FUNCTION_LINES, assert_none, root, shown};
use std::fs;
use std::path::PathBuf;

/// Python files written by people, with the stubs.
fn python_files() -> Vec<PathBuf> {
    let (mut files, mut pending) = (Vec::new(), vec![root().join("python")]);
    while let Some(at) = pending.pop() {
        for entry in fs::read_dir(&at).unwrap().map(Result::unwrap) {
            let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
            let is_made = name.starts_with('.') || ["build", "target"].contains(&name.as_str());
            if path.is_dir() && !is_made {
                pending.push(path);
            } else if path.extension().is_some_and(|ending| ending == "py" || ending == "pyi") {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

/// How many lines a function takes that begins at `start`: to the next line that is indented no
/// deeper, where its parameters have ended.
fn function_lines(lines: &[&str], start: usize) -> usize {
    let indent = |line: &str| line.len() - line.trim_start().len();
    let own = indent(lines[start]);
    let ends = |line: &&str| {
        !line.trim().is_empty() && indent(line) <= own && !line.trim_start().starts_with(')')
    };
    let rest = lines[start + 1..].iter().position(ends);
    rest.map_or(lines.len() - start, |rest| rest + 1)
}

#[test]
fn python_is_short() {
    let mut faults = Vec::new();
    let files = python_files();
    assert!(files.len() > 10, "the package is where it is looked for");
    for path in files {
        let text = fs::read_to_string(&path).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        if lines.len() > MAX_FILE_LINES {
            faults.push(format!("{}: {} lines", shown(&path), lines.len()));
        }
        for (index, line) in lines.iter().enumerate() {
            let place = format!("{}:{}", shown(&path), index + 1);
            if line.chars().count() > MAX_COLUMNS {
                faults.push(format!("{place}: too wide"));
            }
            let is_function = line.trim_start().starts_with("def ");
            if is_function && function_lines(&lines, index) > MAX_FUNCTION_LINES {
                faults.push(format!("{place}: a function of more than 70 lines"));
            }
        }
        let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
        if ["utils", "util", "helpers", "helper", "misc", "common"].contains(&stem.as_str()) {
            faults.push(format!("{}: a file is named after its idea", shown(&path)));
        }
    }
    assert_none(&faults, "at most 500 lines a file, 70 a function and 100 columns a line");
}
