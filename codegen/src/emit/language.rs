//! The languages that a model is emitted in, and the files of each.

use super::context::EmitError;
use super::{c, rust};
use crate::model::Robot;
use crate::program::{CodeError, CodeOptions, Lowered};
use std::fmt;
use std::path::{Path, PathBuf};

/// A language that code is emitted in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Language {
    /// A module that needs the crate denavit-runtime.
    #[default]
    Rust,
    /// C99: a header and a source that need nothing else.
    C,
    /// A header of C++17: templates over the scalar.
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

/// Why a language is not written to a file of this name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileNameError {
    /// C is written to two files, and the output is the name of neither.
    TwoFilesOfC(String),
    /// No source can include a header of this name.
    NotIncluded(String),
    /// The end of its name is that of no language.
    OtherLanguage(String),
}

impl fmt::Display for FileNameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TwoFilesOfC(file) => write!(
                f,
                "{file}: C is a source and a header, whose names end in .c and .h\n  hint: give \
                 one of them, as robot.c, and robot.h is written beside it; C++ \
                 (`options.language=cpp`) is one file"
            ),
            Self::NotIncluded(file) => write!(
                f,
                "{file}: a source cannot include a header of this name\n  hint: give a name \
                 without quotation marks, backslashes and `?`"
            ),
            Self::OtherLanguage(file) => write!(
                f,
                "{file}: the end of this name is that of no language that is emitted\n  hint: it \
                 is .rs, .c, .h, .hpp or .cpp; `options.language` takes any name"
            ),
        }
    }
}

impl std::error::Error for FileNameError {}

/// Why a model has no files of source code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SourceError {
    /// It has no code.
    Code(CodeError),
    /// A default is no number that the language can hold; holds model and cause.
    Emit(String, EmitError),
    /// The language is not written to a file of this name.
    FileName(FileNameError),
}

impl fmt::Display for SourceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Code(error) => write!(f, "{error}"),
            Self::Emit(model, error) => write!(
                f,
                "{model}: {error}\n  hint: check the exponents of the numbers in the model"
            ),
            Self::FileName(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for SourceError {}

/// How a model becomes source code.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SourceOptions {
    /// Its language.
    pub language: Language,
    /// Its functions, and how they become code.
    pub code: CodeOptions,
}

/// A model as source code.
#[derive(Clone, Debug)]
pub struct Sources {
    /// The model as code.
    pub lowered: Lowered,
    /// Names and texts; the file that was asked for comes first.
    pub files: Vec<(PathBuf, String)>,
}

impl Sources {
    /// Derives a robot's functions and writes them in a language. Nothing goes to disk: `output` is
    /// the name of the file that is asked for.
    pub fn new(robot: &Robot, options: &SourceOptions, output: &Path) -> Result<Self, SourceError> {
        let lowered = Lowered::new(robot, &options.code).map_err(SourceError::Code)?;
        let files = options.language.files(&lowered, output)?;
        Ok(Self { lowered, files })
    }
}

impl Language {
    /// The language of a file by the end of its name: Rust where it has none.
    pub fn of(output: &Path) -> Result<Self, FileNameError> {
        match extension(output).as_deref() {
            Some("c" | "h") => Ok(Self::C),
            Some("hpp" | "hh" | "hxx" | "cpp" | "cc" | "cxx") => Ok(Self::Cpp),
            Some("rs") | None => Ok(Self::Rust),
            Some(_) => Err(FileNameError::OtherLanguage(output.display().to_string())),
        }
    }

    /// The files that a program becomes where one is asked for, the one asked for first.
    fn files(
        self,
        Lowered { derivation, program }: &Lowered,
        output: &Path,
    ) -> Result<Vec<(PathBuf, String)>, SourceError> {
        let robot = &derivation.robot;
        let failed = |error: EmitError| SourceError::Emit(robot.name.clone(), error);
        Ok(match self {
            Self::Rust => {
                vec![(output.to_owned(), rust::module(robot, program).map_err(failed)?)]
            }
            Self::Cpp => {
                vec![(output.to_owned(), c::cpp_header(robot, program).map_err(failed)?)]
            }
            Self::C => {
                let names = files_of_c(output).map_err(SourceError::FileName)?;
                let (header, source, included) = names;
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
    pub fn check(self, output: &Path) -> Result<(), FileNameError> {
        match self {
            Self::C => files_of_c(output).map(|_| ()),
            Self::Rust | Self::Cpp => Ok(()),
        }
    }
}

/// Header and source of C, and what the source includes.
fn files_of_c(output: &Path) -> Result<(PathBuf, PathBuf, String), FileNameError> {
    let shown = output.display().to_string();
    if !matches!(extension(output).as_deref(), Some("c" | "h")) {
        return Err(FileNameError::TwoFilesOfC(shown));
    }
    let (header, source) = (output.with_extension("h"), output.with_extension("c"));
    let name = header.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    // The name stands between quotation marks.
    let is_plain = |c: char| !c.is_control() && !matches!(c, '"' | '\\' | '?');
    if name.is_empty() || !name.chars().all(is_plain) {
        return Err(FileNameError::NotIncluded(shown));
    }
    let name = name.to_owned();
    Ok((header, source, name))
}

fn extension(path: &Path) -> Option<String> {
    path.extension().map(|extension| extension.to_string_lossy().into_owned())
}
