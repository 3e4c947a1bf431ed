//! The command as a user meets it: answers, exit codes, messages, files.

mod answers;
mod base;
mod blind;
mod decompose;
mod diagnose;
mod diagnose_emps;
mod diagnose_excitation;
mod diagnose_spring;
mod effects;
mod embedded;
mod emit_languages;
mod errors;
mod excite;
mod gears;
mod given_effects;
mod guide;
mod help;
mod identify;
mod identify_contradiction;
mod identify_doubts;
mod identify_logs;
mod identify_long;
mod identify_noise;
mod identify_procedures;
mod identify_rest;
mod identify_told;
mod import;
mod landings;
mod list;
mod mutated_files;
mod outputs;
mod printed;
mod readme;
mod real_data;
#[cfg(feature = "mcap")]
mod ros_logs;
mod shell;
mod simulate;
mod simulate_summary;
mod simulated_again;
mod view;
mod walk;
mod walk_design;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// What a run of the command gave.
struct Run {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

fn run_in(directory: &Path, arguments: &[&str]) -> Run {
    let output = command(directory).args(arguments).output().expect("the command starts");
    Run::of(output)
}

fn command(directory: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_denavit"));
    command.current_dir(directory).stdin(Stdio::null());
    command
}

impl Run {
    /// Without lines of progress: how many there are is a matter of how busy the machine is.
    fn of(output: Output) -> Self {
        let said = String::from_utf8(output.stderr).expect("UTF-8");
        let is_kept = |line: &&str| !line.starts_with("progress: ");
        Self {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).expect("UTF-8"),
            stderr: said.split_inclusive('\n').filter(is_kept).collect(),
        }
    }
}

/// The answer to a question that has one.
fn answer(arguments: &[&str]) -> String {
    let directory = Directory::new("answer");
    let run = run_in(&directory.path, arguments);
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{arguments:?}");
    run.stdout
}

fn json(arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&answer(arguments)).expect("JSON")
}

/// A directory of a test's own, empty at first, removed in the end.
struct Directory {
    path: PathBuf,
}

impl Directory {
    fn new(name: &str) -> Self {
        use std::sync::atomic::{AtomicUsize, Ordering};
        static NEXT: AtomicUsize = AtomicUsize::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let name = format!("{name}-{}-{number}", std::process::id());
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        std::fs::create_dir_all(&path).expect("a directory");
        Self { path }
    }

    /// The names of its files, sorted.
    fn files(&self) -> Vec<String> {
        let entries = self.path.read_dir().expect("a directory");
        let name = |entry: std::io::Result<std::fs::DirEntry>| {
            entry.expect("an entry").file_name().to_string_lossy().into_owned()
        };
        let mut names: Vec<String> = entries.map(name).collect();
        names.sort();
        names
    }
}

impl Drop for Directory {
    fn drop(&mut self) {
        // a directory that stays is a nuisance, no failure
        let _ = std::fs::remove_dir_all(&self.path);
    }
}
