//! Which format a file has, by its first bytes, and what reads it.

use super::csv::open_csv;
use super::error::Error;
use super::fault::{FileFault, of_io};
use super::opening::Opening;
use super::source::Log;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

/// Bytes that tell formats apart.
const MAGIC: usize = 16;

/// Bytes that are read at once.
const BUFFER: usize = 1 << 16;

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Text,
    Mcap,
    Parquet,
    Arrow,
    Sqlite,
    Other(&'static str, &'static str),
}

impl Format {
    fn of(first: &[u8]) -> Self {
        const UNPACK: &str = "unpack it first";
        let known: [(&[u8], Self); 9] = [
            (b"\x89MCAP", Self::Mcap),
            (b"PAR1", Self::Parquet),
            (b"ARROW1", Self::Arrow),
            (b"\xff\xff\xff\xff", Self::Arrow),
            (b"SQLite format 3\0", Self::Sqlite),
            (b"FEA1", Self::Other("Feather of version 1", "write it as Parquet or Arrow")),
            (b"#ROSBAG", Self::Other("a bag of ROS 1", "`rosbags-convert` makes one of ROS 2")),
            (b"\x1f\x8b", Self::Other("gzip", UNPACK)),
            (b"\x28\xb5\x2f\xfd", Self::Other("zstd", UNPACK)),
        ];
        let found = known.into_iter().find(|(magic, _)| first.starts_with(magic));
        found.map_or(Self::Text, |(_, format)| format)
    }
}

/// Whether a file that begins so is text, and none of the other formats that are known.
pub fn is_text(first: &[u8]) -> bool {
    Format::of(&first[..first.len().min(MAGIC)]) == Format::Text
}

/// Opens a log of any format. `file` is the one that stands at `path`, if it is open already.
///
/// # Errors
/// The file cannot be read, or is none of these formats, or nothing in it has columns.
pub fn open(path: &Path, file: Option<File>, how: &Opening) -> Result<Log<'static>, Error> {
    let failed = |error| vec![of_io(&error)];
    if path.is_dir() {
        return Ok(bag(path, how)?);
    }
    let file = file.map_or_else(|| File::open(path), Ok).map_err(failed)?;
    let mut source = BufReader::with_capacity(BUFFER, file);
    let first = source.fill_buf().map_err(failed)?;
    match Format::of(&first[..first.len().min(MAGIC)]) {
        Format::Text => open_csv(source),
        Format::Mcap => Ok(mcap(source, how)?),
        Format::Parquet => Ok(parquet(source)?),
        Format::Arrow => Ok(arrow(source)?),
        Format::Sqlite => Ok(sqlite(path, how)?),
        Format::Other(format, hint) => Err(vec![FileFault::OtherFormat { format, hint }].into()),
    }
}

#[cfg(feature = "mcap")]
fn bag(path: &Path, how: &Opening) -> Result<Log<'static>, Vec<FileFault>> {
    super::bag::open(path, how)
}

#[cfg(not(feature = "mcap"))]
fn bag(path: &Path, _: &Opening) -> Result<Log<'static>, Vec<FileFault>> {
    Err(vec![match path.join("metadata.yaml").is_file() {
        true => FileFault::NoFeature { format: "a bag of ROS 2", feature: "mcap" },
        false => FileFault::Unreadable("it is a directory".to_owned()),
    }])
}

#[cfg(feature = "mcap")]
fn mcap(source: BufReader<File>, how: &Opening) -> Result<Log<'static>, Vec<FileFault>> {
    super::mcap::open(source, how)
}

#[cfg(not(feature = "mcap"))]
fn mcap(_: BufReader<File>, _: &Opening) -> Result<Log<'static>, Vec<FileFault>> {
    Err(vec![FileFault::NoFeature { format: "MCAP", feature: "mcap" }])
}

#[cfg(feature = "sqlite")]
fn sqlite(path: &Path, how: &Opening) -> Result<Log<'static>, Vec<FileFault>> {
    super::sqlite::open(path, how)
}

#[cfg(not(feature = "sqlite"))]
fn sqlite(_: &Path, _: &Opening) -> Result<Log<'static>, Vec<FileFault>> {
    Err(vec![FileFault::NoFeature { format: "SQLite", feature: "sqlite" }])
}

#[cfg(feature = "parquet")]
fn parquet(source: BufReader<File>) -> Result<Log<'static>, Vec<FileFault>> {
    super::columnar::open_parquet(source)
}

#[cfg(not(feature = "parquet"))]
fn parquet(_: BufReader<File>) -> Result<Log<'static>, Vec<FileFault>> {
    Err(vec![FileFault::NoFeature { format: "Parquet", feature: "parquet" }])
}

#[cfg(feature = "parquet")]
fn arrow(source: BufReader<File>) -> Result<Log<'static>, Vec<FileFault>> {
    super::columnar::open_arrow(source)
}

#[cfg(not(feature = "parquet"))]
fn arrow(_: BufReader<File>) -> Result<Log<'static>, Vec<FileFault>> {
    Err(vec![FileFault::NoFeature { format: "Arrow", feature: "parquet" }])
}
