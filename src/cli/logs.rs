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

/// A run as the file of a name: MCAP if it ends so, otherwise CSV. Other formats are only read.
pub(crate) fn run_file(path: &Path, log: &Log) -> Result<Vec<u8>, Failure> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let written = match ending.as_str() {
        "mcap" => mcap(log),
        "parquet" | "arrow" | "feather" | "ipc" | "db3" => Err("runs are CSV or MCAP".to_owned()),
        _ => Ok(log.to_csv().into_bytes()),
    };
    let file = path.display().to_string();
    written.map_err(|cause| OutputFailure::NotOfFormat { file, cause }.into())
}

#[cfg(feature = "mcap")]
fn mcap(Log { header, columns, values }: &Log) -> Result<Vec<u8>, String> {
    logs::write_mcap(&logs::McapRows { header, columns, values })
}

#[cfg(not(feature = "mcap"))]
fn mcap(_: &Log) -> Result<Vec<u8>, String> {
    Err("`cargo install --locked --path . --features mcap` makes one that writes MCAP".to_owned())
}
