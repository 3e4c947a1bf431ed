//! Files out: whole or not there.

use super::failure::Failure;
use super::files::is_input;
use super::json::write_json;
use super::output_failure::OutputFailure;
use super::unfinished;
use serde::Serialize;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Links from one to the next that are followed: as many as Linux follows.
const MOST_LINKS: usize = 40;

/// Whether one of these outputs is standard output. Only one can be, JSON included.
pub(crate) fn on_stdout(outputs: &[Option<&PathBuf>], json: bool) -> Result<bool, Failure> {
    let documents = outputs.iter().flatten().filter(|path| path.as_os_str() == "-").count();
    match documents + usize::from(json) {
        0 | 1 => Ok(documents > 0),
        _ => Err(OutputFailure::TwoDocuments.into()),
    }
}

/// Finds before a long run what would keep its outputs from being written: each has a place of its
/// own, where files can be made, and is no input.
pub(crate) fn check_outputs(outputs: &[Option<&PathBuf>]) -> Result<(), Failure> {
    let mut seen = Vec::new();
    for path in outputs.iter().copied().flatten().filter(|path| path.as_os_str() != "-") {
        refuse_input(path)?;
        let place = target(path)?;
        if is_replaced(&place).map_err(|error| failed(path, error))? {
            // it goes as it came
            new_beside(&place).map_err(|error| failed(path, error))?;
        }
        if seen.contains(&place) {
            return Err(OutputFailure::SameOutput(path.display().to_string()).into());
        }
        seen.push(place);
    }
    Ok(())
}

/// Writes a file whole: into a new file beside it, which then takes its name. What was there stays
/// until then. `-` is standard output.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if path.as_os_str() == "-" {
        return Ok(io::stdout().lock().write_all(bytes)?);
    }
    write_together(&[(path.to_owned(), bytes.to_owned())])
}

/// Writes the document of an option, if it is asked for.
pub(crate) fn write_given(
    path: &Option<PathBuf>,
    text: impl FnOnce() -> String,
) -> Result<(), Failure> {
    path.as_ref().map_or(Ok(()), |path| write_whole(path, text().as_bytes()))
}

/// Prints an answer: as JSON, or as text with the files that were written; nothing where a document
/// on standard output stands for it.
pub(crate) fn print_answer<J: Serialize>(
    out: &mut dyn Write,
    (is_answered, json): (bool, bool),
    as_json: impl FnOnce() -> J,
    text: impl FnOnce() -> String,
    outputs: &[Option<&PathBuf>],
) -> Result<(), Failure> {
    match (is_answered, json) {
        (true, _) => Ok(()),
        (_, true) => write_json(out, &as_json()),
        (_, false) => {
            write!(out, "{}", text())?;
            say_written(out, outputs)
        }
    }
}

/// Writes files whole, as [`write_whole`] does: all are there before one takes its name.
pub(crate) fn write_together(files: &[(PathBuf, Vec<u8>)]) -> Result<(), Failure> {
    let (mut paths, mut written) = (Vec::new(), Vec::new());
    for (path, bytes) in files {
        refuse_input(path)?;
        let place = target(path)?;
        let whole = write_beside(&place, bytes).map_err(|error| failed(path, error))?;
        if let Some(file) = whole {
            paths.push(path);
            written.push((file, place));
        }
    }
    unfinished::name(written).map_err(|(at, error)| failed(paths[at], error))
}

/// Says which files were written.
pub(crate) fn say_written(
    out: &mut dyn Write,
    outputs: &[Option<&PathBuf>],
) -> Result<(), Failure> {
    let files = outputs.iter().flatten().filter(|path| path.as_os_str() != "-");
    for (at, path) in files.enumerate() {
        let begin = if at == 0 { "\n" } else { "" };
        writeln!(out, "{begin}wrote {}", path.display())?;
    }
    Ok(())
}

fn failed(path: &Path, error: io::Error) -> Failure {
    OutputFailure::Write { file: path.to_string_lossy().into_owned(), error }.into()
}

fn refuse_input(path: &Path) -> Result<(), Failure> {
    if path.is_file() && path.canonicalize().is_ok_and(|path| is_input(&path)) {
        return Err(OutputFailure::Overwrites(path.display().to_string()).into());
    }
    Ok(())
}

/// The file that is written where a path says: a link stays a link, and what it leads to is
/// written, whether it is there or not.
fn target(path: &Path) -> Result<PathBuf, Failure> {
    // pipes that a process has open have no path of their own
    if let Some(there) = path.canonicalize().ok().or(path.metadata().ok().map(|_| path.to_owned()))
    {
        return Ok(there);
    }
    let mut place = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&place) else { break };
        place = place.parent().unwrap_or(Path::new("")).join(next);
    }
    let folder = directory(&place).canonicalize();
    match (folder, place.file_name()) {
        _ if place.is_symlink() => {
            Err(failed(path, path.metadata().err().unwrap_or(io::ErrorKind::NotFound.into())))
        }
        (Err(_), _) if place != path => {
            let [link, target] = [path, &place].map(|path| path.display().to_string());
            Err(OutputFailure::LinkToNowhere { link, target }.into())
        }
        (Err(error), _) => Err(failed(path, error)),
        (_, None) => Err(failed(path, io::ErrorKind::IsADirectory.into())),
        (Ok(folder), Some(name)) => Ok(folder.join(name)),
    }
}

/// The directory of a path, whose parent is empty for a bare name.
fn directory(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Whether a new file takes the place of what is there. Devices and pipes are written to and not
/// replaced.
fn is_replaced(place: &Path) -> io::Result<bool> {
    match place.metadata() {
        Ok(metadata) if metadata.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Ok(metadata) if !metadata.is_file() => Ok(false),
        Ok(metadata) if metadata.permissions().readonly() => {
            Err(io::ErrorKind::PermissionDenied.into())
        }
        _ => Ok(true),
    }
}

fn new_beside(place: &Path) -> io::Result<NamedTempFile> {
    unfinished::new_file(directory(place))
}

/// Writes a file that has yet to take its name; none where the place itself is written to.
fn write_beside(place: &Path, bytes: &[u8]) -> io::Result<Option<NamedTempFile>> {
    if !is_replaced(place)? {
        return fs::write(place, bytes).map(|()| None);
    }
    let mut file = new_beside(place)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    if let Ok(metadata) = place.metadata() {
        file.as_file().set_permissions(metadata.permissions())?;
    }
    Ok(Some(file))
}

/// A directory for outputs of a run. What of it was not there before and is empty in the end, since
/// the run failed, goes with it.
pub(crate) struct NewDirectory {
    made: Vec<PathBuf>,
}

impl NewDirectory {
    /// Makes a directory with those above it.
    pub(crate) fn make(path: &Path) -> Result<Self, Failure> {
        if path.as_os_str() == "-" {
            return Err(OutputFailure::NoFolder.into());
        }
        let made = unfinished::new_directories(path).map_err(|error| failed(path, error))?;
        Ok(Self { made })
    }
}

impl Drop for NewDirectory {
    fn drop(&mut self) {
        for path in &self.made {
            // those with something in them stay
            let _ = fs::remove_dir(path);
        }
    }
}
