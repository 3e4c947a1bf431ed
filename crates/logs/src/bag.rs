//! Folders of ROS 2 bags: `metadata.yaml`, and the files that it names beside itself.

use super::fault::{FileFault, of_io};
use super::intake::Intake;
use super::opening::Opening;
use super::source::Log;
use saphyr_parser::{Event, Parser};
use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// The file that describes a bag, and its most bytes.
const METADATA: &str = "metadata.yaml";
const LONGEST: u64 = 4 << 20;

/// What metadata says.
#[derive(Debug, Default, PartialEq, Eq)]
struct Metadata {
    storage: String,
    compression: String,
    files: Vec<String>,
}

fn fault(cause: String, hint: &'static str) -> FileFault {
    FileFault::Bag { cause, hint }
}

/// Opens a bag.
pub(crate) fn open(folder: &Path, how: &Opening) -> Result<Log<'static>, Vec<FileFault>> {
    let Metadata { storage, compression, files } = described(folder).map_err(|one| vec![one])?;
    let mut faults = Vec::new();
    if !compression.is_empty() && !compression.eq_ignore_ascii_case("none") {
        let cause = format!("its files or messages are packed (compression_mode {compression})");
        faults
            .push(fault(cause, "`ros2 bag convert` unpacks them; chunks of MCAP may stay packed"));
    }
    let mut paths = Vec::new();
    for name in &files {
        match beside(folder, name) {
            Ok(path) => paths.push(path),
            Err(fault) => faults.push(fault),
        }
    }
    if files.is_empty() {
        let cause = format!("{METADATA} names no files");
        faults.push(fault(cause, "name the .mcap or .db3 file itself"));
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let mut intake = Intake::new(how);
    for path in &paths {
        let read = match storage.as_str() {
            "mcap" => File::open(path)
                .map_err(|error| of_io(&error))
                .and_then(|file| super::mcap::read(file, &mut intake)),
            "sqlite3" => sqlite(path, &mut intake),
            other => Err(fault(
                format!("its storage is `{other}`"),
                "`ros2 bag convert` writes mcap or sqlite3",
            )),
        };
        read.map_err(|fault| vec![of_file(fault, path)])?;
        if intake.is_damaged() {
            break;
        }
    }
    intake.into_log()
}

#[cfg(feature = "sqlite")]
fn sqlite(path: &Path, intake: &mut Intake<'_>) -> Result<(), FileFault> {
    super::sqlite::read(path, intake)
}

#[cfg(not(feature = "sqlite"))]
fn sqlite(_: &Path, _: &mut Intake<'_>) -> Result<(), FileFault> {
    Err(FileFault::NoFeature { format: "a bag with SQLite storage", feature: "sqlite" })
}

/// Says of which file of the bag it is.
fn of_file(fault: FileFault, path: &Path) -> FileFault {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    match fault {
        FileFault::Damaged { at, whole, cause } => {
            FileFault::Damaged { at, whole, cause: format!("{name}: {cause}") }
        }
        FileFault::Unreadable(why) => FileFault::Unreadable(format!("{name}: {why}")),
        fault => fault,
    }
}

/// The path of a file that metadata names: in the folder, also where links lead.
fn beside(folder: &Path, name: &str) -> Result<PathBuf, FileFault> {
    let outside = || FileFault::Outside { file: name.to_owned() };
    let relative = Path::new(name);
    let is_plain = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    if name.is_empty() || !relative.components().all(is_plain) {
        return Err(outside());
    }
    let unreadable = |error| FileFault::Unreadable(format!("{name}: {error}"));
    let place = folder.join(relative).canonicalize().map_err(unreadable)?;
    let folder = folder.canonicalize().map_err(unreadable)?;
    if place.starts_with(folder) { Ok(place) } else { Err(outside()) }
}

/// What the metadata of a folder say.
fn described(folder: &Path) -> Result<Metadata, FileFault> {
    const HINT: &str = "`ros2 bag reindex` writes it anew";
    let path = folder.join(METADATA);
    if !path.is_file() {
        let cause = format!("a folder without {METADATA}");
        return Err(fault(cause, "name the file of the log, or the folder of a ROS 2 bag"));
    }
    let mut text = String::new();
    let read = File::open(&path).and_then(|file| file.take(LONGEST).read_to_string(&mut text));
    read.map_err(|error| fault(format!("{METADATA}: {error}"), HINT))?;
    metadata(&text).map_err(|why| fault(format!("{METADATA}: {why}"), HINT))
}

/// Reads metadata event by event: nothing is expanded, however often it refers to itself.
fn metadata(text: &str) -> Result<Metadata, String> {
    let mut found = Metadata::default();
    let mut open: Vec<Level> = Vec::new();
    for event in Parser::new_from_str(text) {
        let (event, _) = event.map_err(|error| error.to_string())?;
        let value = match &event {
            Event::Scalar(value, ..) => Some(&**value),
            Event::Alias(_) => Some(""),
            _ => None,
        };
        match event {
            _ if value.is_some() => {
                let value = value.unwrap_or_default();
                if !Level::takes_key(&mut open, value) {
                    found.take(&open, value);
                    Level::is_done(&mut open);
                }
            }
            Event::MappingStart(..) => open.push(Level::Mapping(None)),
            Event::SequenceStart(..) => open.push(Level::List),
            Event::MappingEnd | Event::SequenceEnd => {
                open.pop();
                Level::is_done(&mut open);
            }
            _ => {}
        }
        if open.len() > DEEPEST {
            return Err("too many lists within lists".to_owned());
        }
    }
    Ok(found)
}

/// How deep mappings and lists are in each other, at most.
const DEEPEST: usize = 64;

/// A mapping or a list that is open.
enum Level {
    /// With the key whose value comes next.
    Mapping(Option<String>),
    List,
}

impl Level {
    /// Whether a scalar is the key of a mapping.
    fn takes_key(open: &mut [Self], value: &str) -> bool {
        match open.last_mut() {
            Some(Self::Mapping(key @ None)) => {
                *key = Some(value.to_owned());
                true
            }
            _ => false,
        }
    }

    /// A value is over.
    fn is_done(open: &mut [Self]) {
        if let Some(Self::Mapping(key)) = open.last_mut() {
            *key = None;
        }
    }
}

impl Metadata {
    fn take(&mut self, open: &[Level], value: &str) {
        let key = |level: &Level| match level {
            Level::Mapping(key) => key.clone().unwrap_or_default(),
            Level::List => String::new(),
        };
        let path: Vec<String> = open.iter().map(key).collect();
        let Some(("rosbag2_bagfile_information", path)) =
            path.split_first().map(|(first, rest)| (first.as_str(), rest))
        else {
            return;
        };
        match path.join("/").as_str() {
            "storage_identifier" => value.clone_into(&mut self.storage),
            "compression_mode" => value.clone_into(&mut self.compression),
            "relative_file_paths/" => self.files.push(value.to_owned()),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metadata_says_storage_and_files() {
        let text = "rosbag2_bagfile_information:\n  version: 8\n  storage_identifier: mcap\n  \
                    relative_file_paths:\n    - a_0.mcap\n    - \"a_1.mcap\"\n  duration:\n    \
                    nanoseconds: 5\n  compression_mode: \"\"\n  files:\n    - path: a_0.mcap\n";
        let found = metadata(text).expect("metadata");
        assert_eq!((found.storage.as_str(), found.compression.as_str()), ("mcap", ""));
        assert_eq!(found.files, ["a_0.mcap", "a_1.mcap"]);
        assert!(metadata("a: [b\n c: }").is_err());
        assert!(metadata(&"[".repeat(100_000)).is_err());
    }

    #[test]
    fn files_elsewhere_are_refused() {
        for name in ["../x.mcap", "/etc/passwd", "a/../../x", ""] {
            let found = beside(Path::new("."), name);
            assert_eq!(found, Err(FileFault::Outside { file: name.to_owned() }));
        }
    }
}
