//! Which logs, and how they are read.

use crate::error::{Cause, Error};
use crate::files::MAX_MODEL_BYTES;
use crate::mistaken::{FileKind, Mistaken};
use denavit_codegen::model::Robot;
use denavit_logs::{self as logs, MemoryLog, Opening};
use denavit_measure::log::{
    ColumnMapping, LogOf, MeasuredLog, UsedColumns, of_file, read_opened, used_columns,
};
use denavit_plants::regression::{RegressionJoint, RegressionModel};
use std::fmt;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where a log is.
#[derive(Clone, Debug)]
pub enum LogSource {
    /// In a file of any format, or the folder of a bag.
    File(PathBuf),
    /// In memory; its name is for messages alone.
    Memory {
        /// What messages call it.
        name: String,
        /// Its columns.
        log: Arc<MemoryLog>,
    },
}

impl LogSource {
    /// The file, if it is in one.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::File(path) => Some(path),
            Self::Memory { .. } => None,
        }
    }
}

impl fmt::Display for LogSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => write!(f, "{}", path.display()),
            Self::Memory { name, .. } => f.write_str(name),
        }
    }
}

impl From<PathBuf> for LogSource {
    fn from(path: PathBuf) -> Self {
        Self::File(path)
    }
}

/// Logs, in files of any format or in memory, and how they are read.
#[derive(Clone, Debug, Default)]
pub struct Logs {
    /// Those that an answer is from.
    pub train: Vec<LogSource>,
    /// Those that judge it: another motion.
    pub held_out: Vec<LogSource>,
    /// Which of their columns are ours.
    pub columns: ColumnMapping,
    /// Whether logs are taken as they are, however wrong they look.
    pub accepts_suspicious: bool,
    /// Whether of a log that is cut or corrupt what is before the damage is taken.
    pub accepts_cut: bool,
}

impl Logs {
    /// Files that an answer is from, and those that judge it.
    pub fn new<P: Into<PathBuf>>(
        train: impl IntoIterator<Item = P>,
        held_out: impl IntoIterator<Item = P>,
    ) -> Self {
        let train = train.into_iter().map(|path| LogSource::File(path.into())).collect();
        let held_out = held_out.into_iter().map(|path| LogSource::File(path.into())).collect();
        Self { train, held_out, ..Self::default() }
    }

    /// One of them, as a log of this robot.
    pub(crate) fn measured(
        &self,
        source: &LogSource,
        robot: &Robot,
        model: &RegressionModel,
    ) -> Result<MeasuredLog, Error> {
        let contacts: Vec<String> = robot.contacts.values().map(|one| one.name.clone()).collect();
        let of = LogOf {
            model: &model.model,
            joints: &model.joints,
            contacts: &contacts,
            accepts_suspicious: self.accepts_suspicious,
        };
        self.of_robot(source, of)
    }

    /// One of them, of these joints alone, however wrong it looks.
    pub(crate) fn of_joints(
        &self,
        source: &LogSource,
        model: &str,
        joints: &[RegressionJoint],
    ) -> Result<MeasuredLog, Error> {
        self.of_robot(source, LogOf { model, joints, contacts: &[], accepts_suspicious: true })
    }

    fn of_robot(&self, source: &LogSource, of: LogOf<'_>) -> Result<MeasuredLog, Error> {
        match source {
            LogSource::File(path) => self.of_file(path, of),
            LogSource::Memory { name, log } => self.of_memory(name, log, of),
        }
    }

    /// A log that is open, with the columns that are read for a robot.
    pub(crate) fn opened<'a>(
        &self,
        source: &'a LogSource,
        robot: LogOf<'_>,
    ) -> Result<(logs::Log<'a>, UsedColumns), Error> {
        let name = source.to_string();
        let failed = |faults| Cause::Logs(vec![of_file(&name, faults)]);
        let log = match source {
            LogSource::File(path) => {
                self.open(path, &name)?.map_err(|faults| Cause::Logs(vec![faults]))?
            }
            LogSource::Memory { log, .. } => log.open().map_err(failed)?,
        };
        let used = used_columns(&name, &log, robot, &self.columns);
        let used = used.map_err(|faults| Cause::Logs(vec![faults]))?;
        Ok((log, used))
    }

    fn of_memory(
        &self,
        name: &str,
        log: &MemoryLog,
        robot: LogOf<'_>,
    ) -> Result<MeasuredLog, Error> {
        let opened = log.open().map_err(|faults| of_file(name, faults));
        let read = opened.and_then(|log| read_opened(name, log, robot, &self.columns));
        Ok(read.map_err(|faults| Cause::Logs(vec![faults]))?)
    }

    fn of_file(&self, path: &Path, robot: LogOf<'_>) -> Result<MeasuredLog, Error> {
        let file = path.display().to_string();
        let log = self.open(path, &file)?;
        let read = log.and_then(|log| read_opened(&file, log, robot, &self.columns));
        let failed = |faults| match other_file(path, &file) {
            Some(mistaken) => Cause::Mistaken(mistaken),
            None => Cause::Logs(vec![faults]),
        };
        Ok(read.map_err(failed)?)
    }

    /// Opens a file, or says what is wrong with it as a log.
    fn open(
        &self,
        path: &Path,
        file: &str,
    ) -> Result<Result<logs::Log<'static>, denavit_measure::Error>, Error> {
        // a folder is opened by its metadata
        let opened = match path.is_dir() {
            true => None,
            false => Some(File::open(path).map_err(|error| {
                let mistaken = Mistaken::name(file, FileKind::Log);
                mistaken.map_or_else(|| Error::read(path, error), |one| Cause::Mistaken(one).into())
            })?),
        };
        let how = Opening { accepts_cut: self.accepts_cut, named: self.columns.beginnings() };
        Ok(logs::open(path, opened, &how).map_err(|faults| of_file(file, faults)))
    }
}

/// What a file is that is no log, if that is known.
fn other_file(path: &Path, name: &str) -> Option<Mistaken> {
    let metadata = path.metadata().ok()?;
    let is_read = metadata.is_file() && metadata.len() <= MAX_MODEL_BYTES;
    let bytes = is_read.then(|| fs::read(path).ok()).flatten()?;
    Mistaken::file(name, &bytes, FileKind::Log)
}
