//! Files in: models by path or by name, logs, what other files refer to.

use super::failure::{Failure, reason};
use super::mistaken::{Mistaken, Wanted};
use super::model_effects::ModelApart;
use super::remarks::print_remarks;
use super::said::say_note;
use denavit::effect::{self, Effect};
use denavit::import;
use denavit::model::Robot;
use denavit::model::equations::{self, Equations};
use denavit::shipped::{self, ShippedModel};
use denavit::simulate::LogFile;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};
use std::sync::Mutex;

/// More is not read: the limit of [`model::read`], which refuses what has more.
pub(super) const MAX_MODEL_BYTES: u64 = 16 << 20;

/// Nor is more of what another file refers to: a log of an hour has less.
const MAX_LOG_BYTES: u64 = 256 << 20;

/// The files that this run has read: no output may take the place of one.
static READ: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// What standard input and pipes held: they can be read once, and workers open a scenario each.
static STREAMS: Mutex<Vec<(PathBuf, Vec<u8>)>> = Mutex::new(Vec::new());

/// The robot of a path with the effects that its file names: those of `folder`, or of the folder
/// `effects` beside the file, then the shipped ones.
pub(crate) fn read_model_with_effects(
    place: &Path,
    folder: Option<&Path>,
) -> Result<Robot, Failure> {
    let (name, bytes) = read_named(place, &[shipped::MODELS])?;
    let own = effects_beside(place, folder)?;
    let robot = effect::read_model(&name, &bytes, &own).map_err(Failure::Model)?;
    print_remarks(&name, &robot, &bytes);
    Ok(robot)
}

/// The folder of a user's own effects, if there is one: `folder`, or that beside a model's file.
pub(crate) fn effects_folder(place: &Path, folder: Option<&Path>) -> Option<PathBuf> {
    let beside = place.parent().filter(|_| place.is_file()).map(|parent| parent.join("effects"));
    folder.map(Path::to_owned).or(beside)
}

/// The effects of a folder that was asked for, or of the folder `effects` beside a model's file.
pub(crate) fn effects_beside(place: &Path, folder: Option<&Path>) -> Result<Vec<Effect>, Failure> {
    match (folder, effects_folder(place, None)) {
        (Some(folder), _) => given_effects(folder),
        (None, Some(beside)) => own_effects(&beside),
        (None, None) => Ok(Vec::new()),
    }
}

/// The effects of a folder that was asked for.
pub(crate) fn given_effects(folder: &Path) -> Result<Vec<Effect>, Failure> {
    if folder.is_dir() {
        return own_effects(folder);
    }
    let (file, error) = (folder.display().to_string(), io::ErrorKind::NotADirectory);
    Err(Failure::Read { file, error: error.into() })
}

/// The effects of a folder, if there is one.
fn own_effects(folder: &Path) -> Result<Vec<Effect>, Failure> {
    let files = effect::files(folder)
        .map_err(|error| Failure::Read { file: folder.display().to_string(), error })?;
    let read = |path: &PathBuf| {
        effect::read(&path.display().to_string(), &read_file(path)?).map_err(Failure::Model)
    };
    files.iter().map(read).collect()
}

/// Name and content of a model: of a path, of a shipped model's name, or of standard input.
pub(crate) fn read_model_bytes(place: &Path) -> Result<(String, Vec<u8>), Failure> {
    read_named(place, &[shipped::MODELS])
}

/// A log of the project's own columns.
pub(crate) fn read_log(path: &Path) -> Result<LogFile, Failure> {
    let name = path.display().to_string();
    let failure = |error| Failure::Read { file: name.clone(), error };
    let mut bytes = Vec::new();
    let read = open(path).and_then(|file| file.take(MAX_LOG_BYTES + 1).read_to_end(&mut bytes));
    read.map_err(failure)?;
    if bytes.len() as u64 > MAX_LOG_BYTES {
        return Err(Failure::TooLarge { file: name, limit: MAX_LOG_BYTES });
    }
    LogFile::from_csv(&name, &bytes).map_err(Failure::Log)
}

/// What a command can be about that takes models and equations.
pub(crate) enum Input {
    Model(Box<ModelApart>),
    Equations(Box<Equations>),
}

/// The model or the equations of a path, told apart by their format.
pub(crate) fn read_input(place: &Path, folder: Option<&Path>) -> Result<Input, Failure> {
    let (name, bytes) = read_named(place, &[shipped::MODELS, shipped::EQUATIONS])?;
    if equations::is_equations_file(&bytes) {
        let equations = equations::read(&name, &bytes).map_err(Failure::Model)?;
        return Ok(Input::Equations(Box::new(equations)));
    }
    Ok(Input::Model(Box::new(ModelApart::of(place, folder, (&name, &bytes))?)))
}

/// The same, where a URDF or MJCF stays one.
pub(crate) fn read_model_bytes_as_they_are(place: &Path) -> Result<(String, Vec<u8>), Failure> {
    read_any(place, &[shipped::MODELS])
}

/// Name and content of a path, of a file of one of these lists, or of standard input: the model
/// file of what URDF or MJCF describes.
fn read_named(place: &Path, lists: &[&[ShippedModel]]) -> Result<(String, Vec<u8>), Failure> {
    let (name, bytes) = read_any(place, lists)?;
    let bytes = described(&name, bytes, &mut |file| read_below(place, file))?;
    let takes_equations = lists.contains(&shipped::EQUATIONS);
    match Mistaken::file(&name, &bytes, Wanted::Model) {
        Some(_) if takes_equations && equations::is_equations_file(&bytes) => Ok((name, bytes)),
        Some(mistaken) => Err(mistaken.into()),
        None => Ok((name, bytes)),
    }
}

/// The model file of what URDF or MJCF describes, and any other file as it is.
pub(crate) fn described(
    name: &str,
    bytes: Vec<u8>,
    include: &mut import::Include<'_>,
) -> Result<Vec<u8>, Failure> {
    if !import::is_description(&bytes) {
        return Ok(bytes);
    }
    let options = import::Options::default();
    let imported = import::import(name, &bytes, &options, include).map_err(Failure::Import)?;
    for note in &imported.notes {
        say_note(&format_args!("note: {name}: {note}"));
    }
    Ok(imported.model.into_bytes())
}

/// A file that another one includes: from its folder and below, from nowhere else.
pub(crate) fn read_below(place: &Path, file: &str) -> Result<Vec<u8>, String> {
    let outside = || "it is not in the folder of the file that includes it".to_owned();
    let relative = Path::new(file);
    let is_inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    if !place.is_file() || !relative.components().all(is_inside) {
        return Err(outside());
    }
    let said = |error: io::Error| reason(&error);
    let folder = match place.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let whole = folder.join(relative).canonicalize().map_err(said)?;
    if !whole.starts_with(folder.canonicalize().map_err(said)?) || !whole.is_file() {
        return Err(outside());
    }
    let mut bytes = Vec::new();
    let read = open(&whole).and_then(|file| file.take(MAX_MODEL_BYTES).read_to_end(&mut bytes));
    read.map(|_| bytes).map_err(said)
}

fn read_any(place: &Path, shipped: &[&[ShippedModel]]) -> Result<(String, Vec<u8>), Failure> {
    let name = place.to_string_lossy().into_owned();
    if name == "-" {
        let name = "standard input";
        return Ok((name.to_owned(), read_all(name, &mut io::stdin().lock())?));
    }
    let bytes = read_path(place, &name, shipped)?;
    Ok((name, bytes))
}

fn read_path(path: &Path, name: &str, shipped: &[&[ShippedModel]]) -> Result<Vec<u8>, Failure> {
    let failure = |error| Failure::Read { file: name.to_owned(), error };
    let is_file = path.metadata().is_ok_and(|metadata| !metadata.is_dir());
    let mut known = shipped.iter().copied().flatten();
    if let Some(model) = known.find(|model| model.name == name && !is_file) {
        return Ok(model.text.as_bytes().to_vec());
    }
    match open(path) {
        Ok(_) if path.is_dir() => Err(failure(io::ErrorKind::IsADirectory.into())),
        Ok(mut file) => read_all(name, &mut file),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Err(no_model(path, name, shipped)),
        Err(error) => Err(failure(error)),
    }
}

/// The bytes of a file, or of standard input.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, Failure> {
    let is_stream = path.metadata().map_or(path == Path::new("-"), |found| !found.is_file());
    match STREAMS.lock() {
        Ok(mut streams) if is_stream => {
            if let Some((_, bytes)) = streams.iter().find(|(known, _)| known == path) {
                return Ok(bytes.clone());
            }
            let bytes = read_once(path)?;
            streams.push((path.to_owned(), bytes.clone()));
            Ok(bytes)
        }
        _ => read_once(path),
    }
}

fn read_once(path: &Path) -> Result<Vec<u8>, Failure> {
    let name = path.display().to_string();
    if name == "-" {
        return read_all("standard input", &mut io::stdin().lock());
    }
    let mut file = open(path).map_err(|error| Failure::Read { file: name.clone(), error })?;
    read_all(&name, &mut file)
}

/// The bytes of a file, or of the shipped one of a kind that has this name; refuses what is
/// something else.
pub(crate) fn read_or_shipped(
    path: &Path,
    (kind, all): (&'static str, &'static [ShippedModel]),
    wanted: Wanted,
) -> Result<Vec<u8>, Failure> {
    let name = path.display().to_string();
    let is_file = path.metadata().is_ok_and(|metadata| metadata.is_file());
    if let Some(shipped) = all.iter().find(|one| one.name == name && !is_file) {
        return Ok(shipped.text.as_bytes().to_vec());
    }
    read_wanted(path, wanted).map_err(|failure| match failure {
        Failure::Read { error, .. } if error.kind() == io::ErrorKind::NotFound => {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            let nearest = denavit::expr::text::nearest(&stem, all.iter().map(|one| one.name));
            Failure::NoShipped { kind, name, nearest, all }
        }
        failure => failure,
    })
}

/// The bytes of a file; refuses what is something else, and the name of what is.
pub(crate) fn read_wanted(path: &Path, wanted: Wanted) -> Result<Vec<u8>, Failure> {
    let name = path.display().to_string();
    let bytes = read_file(path).map_err(|failure| match failure {
        Failure::Read { error, .. } if error.kind() == io::ErrorKind::NotFound => {
            match Mistaken::name(&name, wanted) {
                Some(mistaken) => mistaken.into(),
                None => Failure::Read { file: name.clone(), error },
            }
        }
        failure => failure,
    })?;
    match Mistaken::file(&name, &bytes, wanted) {
        Some(mistaken) => Err(mistaken.into()),
        None => Ok(bytes),
    }
}

/// A run begins: what others read in this process is no input of it.
pub(crate) fn begin() {
    if let (Ok(mut read), Ok(mut streams)) = (READ.lock(), STREAMS.lock()) {
        read.clear();
        streams.clear();
    }
}

/// A file to be read: no output may take its place.
pub(crate) fn open(path: &Path) -> io::Result<File> {
    let file = File::open(path)?;
    if let (Ok(path), Ok(mut read)) = (path.canonicalize(), READ.lock()) {
        read.push(path);
    }
    Ok(file)
}

/// Whether this run has read the file of this path, which has no links in it.
pub(crate) fn is_input(path: &PathBuf) -> bool {
    READ.lock().is_ok_and(|read| read.contains(path))
}

fn read_all(name: &str, file: &mut dyn Read) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    file.take(MAX_MODEL_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| Failure::Read { file: name.to_owned(), error })?;
    if bytes.len() as u64 > MAX_MODEL_BYTES {
        return Err(Failure::TooLarge { file: name.to_owned(), limit: MAX_MODEL_BYTES });
    }
    Ok(bytes)
}

fn no_model(path: &Path, name: &str, shipped: &[&[ShippedModel]]) -> Failure {
    if let Some(mistaken) = Mistaken::name(name, Wanted::Model) {
        return mistaken.into();
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let names = shipped.iter().copied().flatten().map(|model| model.name);
    let nearest = denavit::expr::text::nearest(&stem, names);
    let is_path = path.components().count() > 1 || path.extension().is_some();
    Failure::NoModel { name: name.to_owned(), nearest, is_path }
}

/// A model or a log that another file refers to: a shipped model, or a path from that file's
/// directory. The error is a sentence.
pub(crate) fn load_beside(file: &Path, model: &str) -> Result<Vec<u8>, String> {
    if let Some(shipped) = shipped::find_referred(model) {
        return Ok(shipped.text.as_bytes().to_vec());
    }
    let directory = file.parent().unwrap_or(Path::new(""));
    let mut bytes = Vec::new();
    let read = open(&directory.join(model))
        .and_then(|file| file.take(MAX_LOG_BYTES + 1).read_to_end(&mut bytes));
    if bytes.len() as u64 > MAX_LOG_BYTES {
        return Err(format!("it has more than the {MAX_LOG_BYTES} bytes that are read"));
    }
    let described = |bytes: Vec<u8>| {
        if !import::is_description(&bytes) {
            return Ok(bytes);
        }
        let place = directory.join(model);
        let options = import::Options::default();
        let imported =
            import::import(model, &bytes, &options, &mut |file| read_below(&place, file));
        imported.map(|found| found.model.into_bytes()).map_err(|error| error.to_string())
    };
    let read = read.map(|_| bytes).map_err(|error| {
        let shipped = shipped::MODELS.iter().chain(shipped::BODIES).map(|model| model.name);
        match denavit::expr::text::nearest(model, shipped) {
            Some(nearest) => format!("{} (`{nearest}` is a shipped model)", reason(&error)),
            None => reason(&error),
        }
    });
    read.and_then(described)
}
