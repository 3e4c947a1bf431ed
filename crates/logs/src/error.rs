//! Why a log cannot be opened or read: all that is wrong with its file.

use super::fault::FileFault;
use std::fmt;

/// All that is wrong with the file of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct Error(Vec<FileFault>);

/// What kind of reason it is; of several faults that of the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The system does not give the file.
    Unreadable,
    /// A format that is not read, or not by this build.
    Format,
    /// The file is cut, or corrupt.
    Damaged,
    /// A table that is none: names, rows or cells are wrong.
    Table,
    /// Messages that make no table on one clock.
    Messages,
}

impl Error {
    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        match &self.0[0] {
            FileFault::Unreadable(_) => ErrorKind::Unreadable,
            FileFault::NoFeature { .. }
            | FileFault::NotInBatches
            | FileFault::OtherFormat { .. } => ErrorKind::Format,
            FileFault::Damaged { .. } => ErrorKind::Damaged,
            FileFault::NotUtf8 { .. }
            | FileFault::LongLine { .. }
            | FileFault::NoColumns
            | FileFault::RepeatedColumn { .. }
            | FileFault::RowLength { .. }
            | FileFault::ColumnLength { .. }
            | FileFault::NotANumber { .. }
            | FileFault::NoNumbers { .. } => ErrorKind::Table,
            FileFault::NoMessages { .. }
            | FileFault::Bag { .. }
            | FileFault::Outside { .. }
            | FileFault::Repeated { .. }
            | FileFault::Pause { .. }
            | FileFault::Apart { .. } => ErrorKind::Messages,
        }
    }

    /// The faults, in the order of the file.
    pub fn faults(&self) -> &[FileFault] {
        &self.0
    }

    /// The faults, to be told with the name of the file.
    pub fn into_faults(self) -> Vec<FileFault> {
        self.0
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, fault) in self.0.iter().enumerate() {
            let end = if index > 0 { "\n" } else { "" };
            write!(f, "{end}{fault}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}

/// Faults, at least one.
impl From<Vec<FileFault>> for Error {
    fn from(faults: Vec<FileFault>) -> Self {
        Self(faults)
    }
}
