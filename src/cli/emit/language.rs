//! The languages that a model is emitted in, and the files of each.

use crate::cli::failure::Failure;
use crate::cli::output_failure::OutputFailure;
use clap::ValueEnum;
use denavit::derive::Derivation;
use denavit::emit::{EmitError, c, rust};
use denavit::program::Program;
use std::fmt;
use std::path::{Path, PathBuf};

/// A language that code is emitted in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Language {
    /// A module that needs the crate denavit-runtime
    Rust,
    /// C99: a header and a source that need nothing else
    C,
    /// A header of C++17: templates over the scalar
    #[value(alias = "c++")]
    Cpp,
}

impl fmt::Display for Language {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rust => "Rust",
            Self::C => "C",
            Self::Cpp => "C++",
        })
    }
}

impl Language {
    /// The language of a file by the end of its name; Rust where that says nothing.
    pub(super) fn of(output: &Path) -> Self {
        match extension(output).as_deref() {
            Some("c" | "h") => Self::C,
            Some("hpp" | "hh" | "hxx" | "cpp" | "cc" | "cxx") => Self::Cpp,
            _ => Self::Rust,
        }
    }

    /// The files that a program becomes where one is asked for, the one asked for first.
    pub(super) fn files(
        self,
        derivation: &Derivation,
        program: &Program,
        output: &Path,
    ) -> Result<Vec<(PathBuf, String)>, Failure> {
        let robot = &derivation.robot;
        let failed = |error: EmitError| Failure::Emit(robot.name.clone(), error);
        Ok(match self {
            Self::Rust => {
                vec![(output.to_owned(), rust::module(robot, program).map_err(failed)?)]
            }
            Self::Cpp => {
                vec![(output.to_owned(), c::cpp_header(robot, program).map_err(failed)?)]
            }
            Self::C => {
                let (header, source, included) = files_of_c(output)?;
                let files = c::files(robot, program, &included).map_err(failed)?;
                let mut files = vec![(source, files.source), (header, files.header)];
                if files[1].0 == output {
                    files.swap(0, 1);
                }
                files
            }
        })
    }

    /// Refuses an output that the language cannot be written to, before a long run.
    pub(super) fn check(self, output: &Path) -> Result<(), Failure> {
        match self {
            Self::C => files_of_c(output).map(|_| ()),
            Self::Rust | Self::Cpp => Ok(()),
        }
    }
}

/// Header and source of C, and what the source includes.
fn files_of_c(output: &Path) -> Result<(PathBuf, PathBuf, String), Failure> {
    let shown = output.display().to_string();
    if !matches!(extension(output).as_deref(), Some("c" | "h")) {
        return Err(OutputFailure::TwoFilesOfC(shown).into());
    }
    let (header, source) = (output.with_extension("h"), output.with_extension("c"));
    let name = header.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    // The name stands between quotation marks.
    let is_plain = |c: char| !c.is_control() && !matches!(c, '"' | '\\' | '?');
    if name.is_empty() || !name.chars().all(is_plain) {
        return Err(OutputFailure::NotIncluded(shown).into());
    }
    let name = name.to_owned();
    Ok((header, source, name))
}

fn extension(path: &Path) -> Option<String> {
    path.extension().map(|extension| extension.to_string_lossy().into_owned())
}
