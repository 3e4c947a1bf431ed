//! The README, and the pages that took over from it, show real output.

use super::{Directory, run_in};
use std::path::Path;

fn project(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path:?}: {error}"))
}

/// The blocks of text of a page.
fn blocks(page: &str) -> Vec<&str> {
    let pieces = page.split("```");
    pieces.filter_map(|piece| piece.strip_prefix("text\n")).collect()
}

/// A block that begins with a command line shows everything that the command prints. `$` before it
/// is the prompt; `UPDATE_EXPECT=1` writes the block anew.
#[test]
fn pasted_output_is_what_the_commands_print() {
    let directory = Directory::new("readme");
    let readme = project("README.md");
    let mut compared = 0;
    for block in blocks(&readme) {
        let Some((command, shown)) =
            block.strip_prefix("$ denavit ").and_then(|b| b.split_once('\n'))
        else {
            continue;
        };
        let words: Vec<&str> = command.split_whitespace().collect();
        let run = run_in(&directory.path, &words);
        let printed = run.stdout + &run.stderr;
        if std::env::var_os("UPDATE_EXPECT").is_some() {
            replace("README.md", shown, &printed);
        } else {
            assert_eq!(shown, printed, "{command}; UPDATE_EXPECT=1 writes the README anew");
        }
        compared += 1;
    }
    assert!(compared >= 1, "the README shows no command");
}

const BENCHMARKS: &str = "docs/evidence/benchmarks.md";

/// One block shows a part of what the demo prints of its first robot, line by line.
#[test]
fn the_part_of_the_demo_that_is_shown_is_real() {
    let directory = Directory::new("readme-demo");
    let run = run_in(&directory.path, &["demo"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let page = project(BENCHMARKS);
    let blocks = blocks(&page);
    let block = blocks.iter().find(|block| block.contains("operations of one call"));
    let block = block.expect("a part of the demo");
    let start = run.stdout.find("operations of one call").expect("a table");
    let printed = &run.stdout[start..];
    // a line is known by its words before the numbers
    let key =
        |line: &str| line.trim_end_matches(|c: char| " +-.e0123456789".contains(c)).to_owned();
    let mut updated = String::new();
    for line in block.lines() {
        let printed_line = printed.lines().find(|printed| key(printed) == key(line));
        updated += printed_line.unwrap_or_else(|| panic!("no `{line}` in:\n{printed}"));
        updated.push('\n');
    }
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        return replace(BENCHMARKS, block, &updated);
    }
    assert_eq!(*block, updated, "UPDATE_EXPECT=1 writes {BENCHMARKS} anew");
}

fn replace(page: &str, block: &str, updated: &str) {
    let text = project(page);
    assert!(text.contains(block));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(page);
    std::fs::write(path, text.replace(block, updated)).expect("the page");
}

#[test]
fn the_picture_is_what_inspect_draws() {
    let directory = Directory::new("readme-picture");
    let run = run_in(&directory.path, &["inspect", "tulip", "--svg", "tulip.svg"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let drawn = std::fs::read_to_string(directory.path.join("tulip.svg")).expect("the picture");
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide/tulip.svg");
        std::fs::write(path, &drawn).expect("the picture");
    }
    assert!(drawn == project("docs/guide/tulip.svg"), "docs/guide/tulip.svg is not up to date");
}
