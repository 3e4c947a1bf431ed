//! Logs: where they are, and runs as files of any format.

use super::failure::Failure;
use super::files::FILES;
use super::output_failure::OutputFailure;
use clap::builder::{PathBufValueParser, TypedValueParser};
#[cfg(feature = "mcap")]
use denavit::logs;
use denavit::simulate::Log;
use denavit::workflow::LogSource;
use std::path::Path;

/// A log of the command line: a file.
pub(crate) fn log_source() -> impl TypedValueParser<Value = LogSource> {
    PathBufValueParser::new().map(LogSource::File)
}

/// Takes the files of logs as read: no output may take their place.
pub(crate) fn note_logs<'a>(logs: impl IntoIterator<Item = &'a LogSource>) {
    logs.into_iter().filter_map(LogSource::file).for_each(|path| FILES.note(path));
}

/// Names of logs, as a list.
pub(crate) fn listed(logs: &[LogSource]) -> String {
    let names: Vec<String> = logs.iter().map(ToString::to_string).collect();
    names.join(", ")
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
