//! Files in, through the library's [`Files`]; what it notes of them goes to standard error.

use super::failure::Failure;
use super::said::say_note;
use denavit::measure::log::ColumnMapping;
use denavit::model::Robot;
pub(crate) use denavit::workflow::effects_folder;
use denavit::workflow::{Files, Input, RobotFile};
use std::path::{Path, PathBuf};

/// The files of this run: no output may take the place of one.
pub(crate) static FILES: Files = Files::new();

/// What was noted of a file.
pub(crate) fn say_notes(notes: &[String]) {
    notes.iter().for_each(say_note);
}

/// The robot of a path with the effects that its file names: those of `folder`, or of the folder
/// `effects` beside the file, then the shipped ones.
pub(crate) fn read_model_with_effects(
    place: &Path,
    folder: Option<&Path>,
) -> Result<Robot, Failure> {
    let read = FILES.whole_robot(place, folder)?;
    say_notes(&read.notes);
    Ok(read.robot)
}

/// The same, its effects apart.
pub(crate) fn read_robot(place: &Path, folder: Option<&Path>) -> Result<RobotFile, Failure> {
    let read = FILES.robot(place, folder)?;
    say_notes(&read.notes);
    Ok(read)
}

/// The model or the equations of a path, told apart by their format.
pub(crate) fn read_input(place: &Path, folder: Option<&Path>) -> Result<Input, Failure> {
    let read = FILES.input(place, folder)?;
    if let Input::Model(model) = &read {
        say_notes(&model.notes);
    }
    Ok(read)
}

/// The bytes of a file, or of standard input.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, Failure> {
    Ok(FILES.bytes(path)?)
}

/// Whether this run has read the file of this path, which has no links in it.
pub(crate) fn is_input(path: &PathBuf) -> bool {
    FILES.has_read(path)
}

/// Which columns of logs are ours, as a file says; as they are called without one.
pub(crate) fn mapping(path: Option<&Path>) -> Result<ColumnMapping, Failure> {
    Ok(path.map(|path| FILES.columns(path)).transpose()?.unwrap_or_default())
}
