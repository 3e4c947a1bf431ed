//! Logs of any format in, runs out.

use super::failure::Failure;
use super::files::{MAX_MODEL_BYTES, open};
use super::identify::IdentifyFailure;
use super::mistaken::{Mistaken, Wanted};
use super::output_failure::OutputFailure;
use denavit::logs::{self, Opening};
use denavit::measure::log::{ColumnMapping, LogOf, MeasuredLog, of_file, read_opened};
use denavit::simulate::Log;
use std::fs;
use std::path::Path;

/// A log of a robot, of any format. Of one that is cut, the whole part if that is accepted.
pub(crate) fn measured_log(
    path: &Path,
    robot: LogOf<'_>,
    (mapping, accepts_cut): (&ColumnMapping, bool),
) -> Result<MeasuredLog, Failure> {
    let file = path.display().to_string();
    // a folder is opened by its metadata
    let opened = match path.is_dir() {
        true => None,
        false => {
            let failed = |error| match Mistaken::name(&file, Wanted::Log) {
                Some(mistaken) => mistaken.into(),
                None => Failure::Read { file: file.clone(), error },
            };
            Some(open(path).map_err(failed)?)
        }
    };
    let how = Opening { accepts_cut, named: mapping.beginnings() };
    let log = logs::open(path, opened, &how).map_err(|faults| of_file(&file, faults));
    let read = log.and_then(|log| read_opened(&file, log, robot, mapping));
    read.map_err(|faults| match other_file(path, &file) {
        Some(mistaken) => mistaken.into(),
        None => IdentifyFailure::from(faults).into(),
    })
}

/// What a file is that is no log, if that is known.
fn other_file(path: &Path, name: &str) -> Option<Mistaken> {
    let metadata = path.metadata().ok()?;
    let is_read = metadata.is_file() && metadata.len() <= MAX_MODEL_BYTES;
    let bytes = is_read.then(|| fs::read(path).ok()).flatten()?;
    Mistaken::file(name, &bytes, Wanted::Log)
}

/// A run as the file of a name: MCAP if it ends so, otherwise CSV.
pub(crate) fn run_file(path: &Path, log: &Log) -> Result<Vec<u8>, Failure> {
    let is_mcap = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mcap"));
    if is_mcap { mcap(path, log) } else { Ok(log.to_csv().into_bytes()) }
}

#[cfg(feature = "mcap")]
fn mcap(path: &Path, log: &Log) -> Result<Vec<u8>, Failure> {
    let Log { header, columns, values } = log;
    logs::write_mcap(&logs::McapRows { header, columns, values }).map_err(|cause| {
        let file = path.display().to_string();
        OutputFailure::NotOfFormat { file, cause }.into()
    })
}

#[cfg(not(feature = "mcap"))]
fn mcap(path: &Path, _: &Log) -> Result<Vec<u8>, Failure> {
    let cause = "this build does not write MCAP: `cargo install --path . --features mcap` in the \
                 sources of denavit builds one that does";
    let (file, cause) = (path.display().to_string(), cause.to_owned());
    Err(OutputFailure::NotOfFormat { file, cause }.into())
}
