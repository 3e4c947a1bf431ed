//! Why an output is not written.

use super::failure::Failure;
use denavit::workflow::reason;
use std::fmt;
use std::io;

/// Why an output is not written.
#[derive(Debug)]
pub(crate) enum OutputFailure {
    /// A file cannot be written.
    Write { file: String, error: io::Error },
    /// A link leads to a place in a directory that is not there.
    LinkToNowhere { link: String, target: String },
    /// A file that was read would be replaced by the output.
    Overwrites(String),
    /// Two documents were asked for on standard output.
    TwoDocuments,
    /// Several files were asked for on standard output.
    NoFolder,
    /// Two outputs would be one file.
    SameOutput(String),
    /// What is to be written has no place in the format of the file; why.
    NotOfFormat { file: String, cause: String },
}

impl OutputFailure {
    fn hint(&self) -> Option<&'static str> {
        Some(match self {
            Self::Write { error, .. } => match error.kind() {
                io::ErrorKind::NotFound => "make the directory first",
                io::ErrorKind::IsADirectory => "give the path of a file in it",
                io::ErrorKind::NotADirectory => "a part of the path is a file",
                io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
                    "choose a place where you may write"
                }
                _ => return None,
            },
            Self::LinkToNowhere { .. } => {
                "make the directory of its target first, or remove the link"
            }
            Self::Overwrites(_) => "choose another file for the output",
            Self::TwoDocuments => "give all but one of them a file",
            Self::NoFolder => "give the path of a folder; `./-` is one of that name",
            Self::SameOutput(_) => "give each a file of its own",
            Self::NotOfFormat { .. } => "a name that ends in .csv is written as CSV",
        })
    }
}

impl fmt::Display for OutputFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Write { file, error } => {
                write!(f, "{file}: cannot be written: {}", reason(error))?;
            }
            Self::LinkToNowhere { link, target } => {
                write!(f, "{link}: is a link to {target}, whose directory is not there")?;
            }
            Self::Overwrites(file) => {
                write!(f, "{file}: is what this command reads, and would be replaced")?;
            }
            Self::TwoDocuments => write!(f, "standard output would hold two documents")?,
            Self::NoFolder => write!(f, "standard output is no folder for several files")?,
            Self::SameOutput(file) => write!(f, "{file}: two outputs would be this file")?,
            Self::NotOfFormat { file, cause } => write!(f, "{file}: {cause}")?,
        }
        match self.hint() {
            Some(hint) => write!(f, "\n  hint: {hint}"),
            None => Ok(()),
        }
    }
}

impl From<OutputFailure> for Failure {
    fn from(failure: OutputFailure) -> Self {
        Self::Output(failure)
    }
}
