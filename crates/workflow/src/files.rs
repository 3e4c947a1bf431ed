//! Files in: models by path or by name, and what other files refer to.

use crate::error::{Cause, Error};
use crate::known_columns::known_columns;
use crate::mistaken::{FileKind, Mistaken};
use crate::robot_file::{RobotFile, WholeRobot};
use denavit_codegen::effect::{self, Effect};
use denavit_codegen::model::equations::{self, Equations};
use denavit_import::{self as import, Beside};
use denavit_measure::log::{ColumnMapping, of_file};
use denavit_plants::shipped::{self, ShippedModel};
use denavit_simulate::LogFile;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};
use std::sync::Mutex;

/// More is not read: the limit of `model::read`, which refuses what has more.
pub(crate) const MAX_MODEL_BYTES: u64 = 16 << 20;

/// Nor is more of what another file refers to: a log of an hour has less.
const MAX_LOG_BYTES: u64 = 256 << 20;

/// Reads files, and knows which it has read: no output may take the place of one.
#[derive(Debug, Default)]
pub struct Files {
    read: Mutex<Vec<PathBuf>>,
    /// What standard input and pipes held: they can be read once, and workers open a scenario
    /// each.
    streams: Mutex<Vec<(PathBuf, Vec<u8>)>>,
}

/// What was read as a model.
#[derive(Debug)]
pub struct ModelText {
    /// The name of its file, for messages.
    pub name: String,
    /// The text of the model file: of a URDF or MJCF that of the model that it becomes.
    pub text: Vec<u8>,
    /// What importing it had to decide.
    pub notes: Vec<String>,
}

/// Models, or equations of motion.
#[derive(Debug)]
pub enum Input {
    /// A model.
    Model(Box<RobotFile>),
    /// Equations.
    Equations(Box<Equations>),
}

impl Files {
    /// Has read nothing.
    pub const fn new() -> Self {
        Self { read: Mutex::new(Vec::new()), streams: Mutex::new(Vec::new()) }
    }

    /// Forgets what was read.
    pub fn forget(&self) {
        if let (Ok(mut read), Ok(mut streams)) = (self.read.lock(), self.streams.lock()) {
            read.clear();
            streams.clear();
        }
    }

    /// A file to be read: no output may take its place.
    ///
    /// # Errors
    /// If it cannot be opened.
    pub fn open(&self, path: &Path) -> io::Result<File> {
        let file = File::open(path)?;
        self.note(path);
        Ok(file)
    }

    /// Takes a file, or all files of a folder, as read.
    pub fn note(&self, path: &Path) {
        if let (Ok(path), Ok(mut read)) = (path.canonicalize(), self.read.lock()) {
            read.push(path);
        }
    }

    /// Whether the file of this path, which has no links in it, was read.
    pub fn has_read(&self, path: &PathBuf) -> bool {
        // a folder that was read is a bag: its files are in it, and not below
        let is_it = |one: &PathBuf| one == path || one.is_dir() && path.parent() == Some(one);
        self.read.lock().is_ok_and(|read| read.iter().any(is_it))
    }

    /// The robot of a path, of a shipped model's name, or of standard input (`-`); its own effects
    /// are those of `folder`, or of the folder `effects` beside the file.
    ///
    /// # Errors
    /// All that is wrong with the file, or why it is not read.
    pub fn robot(&self, place: &Path, folder: Option<&Path>) -> Result<RobotFile, Error> {
        let read = self.model_text(place)?;
        RobotFile::new(read, self.effects_beside(place, folder)?)
    }

    /// The same, its effects not taken apart.
    ///
    /// # Errors
    /// All that is wrong with the file, or why it is not read.
    pub fn whole_robot(&self, place: &Path, folder: Option<&Path>) -> Result<WholeRobot, Error> {
        let read = self.model_text(place)?;
        WholeRobot::new(read, &self.effects_beside(place, folder)?)
    }

    /// Name and text of a model: of a path, of a shipped model's name, or of standard input.
    ///
    /// # Errors
    /// Why it is not read, or all that is wrong with a URDF or MJCF.
    pub fn model_text(&self, place: &Path) -> Result<ModelText, Error> {
        self.named(place, &[shipped::MODELS])
    }

    /// Name and text of a URDF or MJCF.
    ///
    /// # Errors
    /// Why it is not read, or that it is something else.
    pub fn description(&self, place: &Path) -> Result<(String, Vec<u8>), Error> {
        let (name, bytes) = self.any(place, &[shipped::MODELS])?;
        match Mistaken::file(&name, &bytes, FileKind::Description) {
            Some(mistaken) => Err(Cause::Mistaken(mistaken).into()),
            None => Ok((name, bytes)),
        }
    }

    /// The model or the equations of a path, told apart by their format.
    ///
    /// # Errors
    /// All that is wrong with the file, or why it is not read.
    pub fn input(&self, place: &Path, folder: Option<&Path>) -> Result<Input, Error> {
        let read = self.named(place, &[shipped::MODELS, shipped::EQUATIONS])?;
        if equations::is_equations_file(&read.text) {
            let equations = equations::read(&read.name, &read.text).map_err(Cause::Model)?;
            return Ok(Input::Equations(Box::new(equations)));
        }
        let own = self.effects_beside(place, folder)?;
        Ok(Input::Model(Box::new(RobotFile::new(read, own)?)))
    }

    /// The effects of a folder that was asked for, or of the folder `effects` beside a model's
    /// file.
    ///
    /// # Errors
    /// All that is wrong with one of its files, or why it is not read.
    pub fn effects_beside(
        &self,
        place: &Path,
        folder: Option<&Path>,
    ) -> Result<Vec<Effect>, Error> {
        match (folder, effects_folder(place, None)) {
            (Some(folder), _) => self.given_effects(folder),
            (None, Some(beside)) => self.own_effects(&beside),
            (None, None) => Ok(Vec::new()),
        }
    }

    /// The effects of a folder that was asked for.
    ///
    /// # Errors
    /// If there is no folder, or none of an effect in it, or all that is wrong with one of its
    /// files.
    pub fn given_effects(&self, folder: &Path) -> Result<Vec<Effect>, Error> {
        folder.read_dir().map_err(|error| Error::read(folder, error))?;
        let effects = self.own_effects(folder)?;
        if effects.is_empty() {
            let none = "no effect is in it: effects are files with the ending .json";
            return Err(Error::read(folder, io::Error::new(io::ErrorKind::NotFound, none)));
        }
        Ok(effects)
    }

    /// The effects of a folder, if there is one.
    fn own_effects(&self, folder: &Path) -> Result<Vec<Effect>, Error> {
        let files = effect::files(folder).map_err(|error| Error::read(folder, error))?;
        let read = |path: &PathBuf| {
            let effect = effect::read(&path.display().to_string(), &self.bytes(path)?);
            Ok(effect.map_err(Cause::Model)?)
        };
        files.iter().map(read).collect()
    }

    /// A log of the project's own columns, of any format.
    ///
    /// # Errors
    /// All that is wrong with it, or why it is not read.
    pub fn log(&self, path: &Path) -> Result<LogFile, Error> {
        let name = path.display().to_string();
        if path.is_dir() {
            return self.table(path, name);
        }
        let mut bytes = Vec::new();
        let file = self.open(path);
        let read = file.and_then(|file| file.take(MAX_LOG_BYTES + 1).read_to_end(&mut bytes));
        read.map_err(|error| Error::read(path, error))?;
        if bytes.len() as u64 > MAX_LOG_BYTES {
            return Err(Cause::TooLarge { file: name, limit: MAX_LOG_BYTES }.into());
        }
        match denavit_logs::is_text(&bytes) {
            true => Ok(LogFile::from_csv(&name, &bytes).map_err(Cause::Log)?),
            false => self.table(path, name),
        }
    }

    /// A log of messages, or of columns that are no text: those that the project has names for.
    fn table(&self, path: &Path, name: String) -> Result<LogFile, Error> {
        let file = self.open(path).map_err(|error| Error::read(path, error))?;
        let log = known_columns(path, file);
        let log = log.map_err(|faults| Cause::Logs(vec![of_file(&name, faults)]))?;
        Ok(LogFile::of(&name, log))
    }

    /// A log of another format as the text that it would be.
    fn as_text(&self, path: &Path) -> Result<Vec<u8>, String> {
        let file = self.open(path).map_err(|error| reason(&error))?;
        let log = known_columns(path, file).map_err(|error| error.to_string())?;
        Ok(log.to_csv().into_bytes())
    }

    /// Which columns of logs are ours, as a file says.
    ///
    /// # Errors
    /// What is wrong with it, or why it is not read.
    pub fn columns(&self, path: &Path) -> Result<ColumnMapping, Error> {
        let read = ColumnMapping::from_json(&path.display().to_string(), &self.bytes(path)?);
        Ok(read.map_err(Cause::Mapping)?)
    }

    /// Name and text of a path, of a file of one of these lists, or of standard input.
    fn named(&self, place: &Path, lists: &[&[ShippedModel]]) -> Result<ModelText, Error> {
        let (name, bytes) = self.any(place, lists)?;
        let read = described(name, bytes, &mut |named| self.of_description(place, None, named))?;
        let takes_equations = lists.contains(&shipped::EQUATIONS);
        if takes_equations && equations::is_equations_file(&read.text) {
            return Ok(read);
        }
        match Mistaken::file(&read.name, &read.text, FileKind::Model) {
            Some(mistaken) => Err(Cause::Mistaken(mistaken).into()),
            None => Ok(read),
        }
    }

    /// A file that a description at `place` names: from its folder and below, from nowhere else,
    /// but for meshes, which are in `meshes`, if that is a folder.
    ///
    /// # Errors
    /// Why not, as a sentence.
    pub fn of_description(
        &self,
        place: &Path,
        meshes: Option<&Path>,
        named: Beside<'_>,
    ) -> Result<Vec<u8>, String> {
        let own = place.parent().filter(|_| place.is_file());
        let own = own.map(|own| if own.as_os_str().is_empty() { Path::new(".") } else { own });
        match named {
            Beside::Description(file) => {
                let own = own.ok_or("the description is in no folder")?;
                self.below(own, file)
            }
            Beside::Mesh(file) => {
                let folder = meshes.or(own).ok_or("no folder of meshes is given")?;
                self.mesh(folder, file)
            }
        }
    }

    /// A mesh of a folder, by its path in it or, behind `package://`, in that package, which is
    /// the folder or in it.
    fn mesh(&self, folder: &Path, file: &str) -> Result<Vec<u8>, String> {
        let path = ["package://", "model://"].into_iter().find_map(|way| file.strip_prefix(way));
        let Some(path) = path else { return self.below(folder, file) };
        let Some((_, inside)) = path.split_once('/') else { return self.below(folder, path) };
        self.below(folder, path).or_else(|why| self.below(folder, inside).map_err(|_| why))
    }

    fn below(&self, folder: &Path, file: &str) -> Result<Vec<u8>, String> {
        let outside = || format!("it is not in {} or below", folder.display());
        let relative = Path::new(file);
        let is_inside =
            |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
        if !relative.components().all(is_inside) {
            return Err(outside());
        }
        let said = |error: io::Error| match error.kind() {
            io::ErrorKind::NotFound => format!("{} has no such file", folder.display()),
            _ => reason(&error),
        };
        let whole = folder.join(relative).canonicalize().map_err(said)?;
        if !whole.starts_with(folder.canonicalize().map_err(said)?) || !whole.is_file() {
            return Err(outside());
        }
        let mut bytes = Vec::new();
        let file = self.open(&whole);
        let read = file.and_then(|file| file.take(MAX_MODEL_BYTES + 1).read_to_end(&mut bytes));
        if bytes.len() as u64 > MAX_MODEL_BYTES {
            return Err(format!("it has more than the {MAX_MODEL_BYTES} bytes that are read"));
        }
        read.map(|_| bytes).map_err(said)
    }

    fn any(&self, place: &Path, shipped: &[&[ShippedModel]]) -> Result<(String, Vec<u8>), Error> {
        let name = place.to_string_lossy().into_owned();
        if name == "-" {
            let name = "standard input";
            return Ok((name.to_owned(), whole(name, &mut io::stdin().lock())?));
        }
        let bytes = self.path(place, &name, shipped)?;
        Ok((name, bytes))
    }

    fn path(&self, path: &Path, name: &str, shipped: &[&[ShippedModel]]) -> Result<Vec<u8>, Error> {
        let is_file = path.metadata().is_ok_and(|metadata| !metadata.is_dir());
        let mut known = shipped.iter().copied().flatten();
        if let Some(model) = known.find(|model| model.name == name && !is_file) {
            return Ok(model.text.as_bytes().to_vec());
        }
        match self.open(path) {
            Ok(_) if path.is_dir() => Err(Error::read(path, io::ErrorKind::IsADirectory.into())),
            Ok(mut file) => whole(name, &mut file),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                Err(no_model(path, name, shipped))
            }
            Err(error) => Err(Error::read(path, error)),
        }
    }

    /// The bytes of a file, or of standard input (`-`).
    ///
    /// # Errors
    /// Why they are not read.
    pub fn bytes(&self, path: &Path) -> Result<Vec<u8>, Error> {
        let is_stream = path.metadata().map_or(path == Path::new("-"), |found| !found.is_file());
        match self.streams.lock() {
            Ok(mut streams) if is_stream => {
                if let Some((_, bytes)) = streams.iter().find(|(known, _)| known == path) {
                    return Ok(bytes.clone());
                }
                let bytes = self.once(path)?;
                streams.push((path.to_owned(), bytes.clone()));
                Ok(bytes)
            }
            _ => self.once(path),
        }
    }

    fn once(&self, path: &Path) -> Result<Vec<u8>, Error> {
        let name = path.display().to_string();
        if name == "-" {
            return whole("standard input", &mut io::stdin().lock());
        }
        let mut file = self.open(path).map_err(|error| Error::read(path, error))?;
        whole(&name, &mut file)
    }

    /// The bytes of a file; refuses what is something else, and the name of what is.
    ///
    /// # Errors
    /// Why they are not read.
    pub fn wanted(&self, path: &Path, wanted: FileKind) -> Result<Vec<u8>, Error> {
        let name = path.display().to_string();
        let bytes = self.bytes(path).map_err(|error| {
            let mistaken = error.is_not_found().then(|| Mistaken::name(&name, wanted)).flatten();
            mistaken.map_or(error, |mistaken| Cause::Mistaken(mistaken).into())
        })?;
        match Mistaken::file(&name, &bytes, wanted) {
            Some(mistaken) => Err(Cause::Mistaken(mistaken).into()),
            None => Ok(bytes),
        }
    }

    /// The bytes of a file, or of the shipped one of a kind that has this name.
    ///
    /// # Errors
    /// Why they are not read.
    pub fn bytes_or_shipped(
        &self,
        path: &Path,
        kind: &'static str,
        all: &'static [ShippedModel],
        wanted: FileKind,
    ) -> Result<Vec<u8>, Error> {
        let name = path.display().to_string();
        let is_file = path.metadata().is_ok_and(|metadata| metadata.is_file());
        if let Some(shipped) = all.iter().find(|one| one.name == name && !is_file) {
            return Ok(shipped.text.as_bytes().to_vec());
        }
        self.wanted(path, wanted).map_err(|error| match error.is_not_found() {
            true => {
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                let names = all.iter().map(|one| one.name);
                let nearest = denavit_codegen::expr::text::nearest(&stem, names);
                Cause::NoShipped { kind, name, nearest, all }.into()
            }
            false => error,
        })
    }

    /// A model or a log that another file refers to: a shipped model, or a path from that file's
    /// directory.
    ///
    /// # Errors
    /// Why it is not read, as a sentence.
    pub fn beside(&self, file: &Path, model: &str) -> Result<Vec<u8>, String> {
        if let Some(shipped) = shipped::find_referred(model) {
            return Ok(shipped.text.as_bytes().to_vec());
        }
        let directory = file.parent().unwrap_or(Path::new(""));
        let place = directory.join(model);
        if place.is_dir() {
            return self.as_text(&place);
        }
        let mut bytes = Vec::new();
        let opened = self.open(&place);
        let read = opened.and_then(|file| file.take(MAX_LOG_BYTES + 1).read_to_end(&mut bytes));
        if bytes.len() as u64 > MAX_LOG_BYTES {
            return Err(format!("it has more than the {MAX_LOG_BYTES} bytes that are read"));
        }
        read.map_err(|error| {
            let shipped = shipped::MODELS.iter().chain(shipped::BODIES).map(|model| model.name);
            match denavit_codegen::expr::text::nearest(model, shipped) {
                Some(nearest) => format!("{} (`{nearest}` is a shipped model)", reason(&error)),
                None => reason(&error),
            }
        })?;
        if !denavit_logs::is_text(&bytes) {
            return self.as_text(&place);
        }
        if !import::is_description(&bytes) {
            return Ok(bytes);
        }
        let options = import::Options::default();
        let mut include = |named: Beside<'_>| self.of_description(&place, None, named);
        let imported = import::import(model, &bytes, &options, &mut include);
        imported.map(|found| found.model.into_bytes()).map_err(|error| error.to_string())
    }
}

/// The folder of a user's own effects, if there is one: `folder`, or that beside a model's file.
pub fn effects_folder(place: &Path, folder: Option<&Path>) -> Option<PathBuf> {
    let beside = place.parent().filter(|_| place.is_file()).map(|parent| parent.join("effects"));
    folder.map(Path::to_owned).or(beside)
}

/// The model file of what URDF or MJCF describes, and any other file as it is. `name` is that of
/// the file, for messages alone.
///
/// # Errors
/// All that is wrong with a URDF or MJCF.
pub fn described(
    name: String,
    text: Vec<u8>,
    include: &mut import::Include<'_>,
) -> Result<ModelText, Error> {
    if !import::is_description(&text) {
        return Ok(ModelText { name, text, notes: Vec::new() });
    }
    let options = import::Options::default();
    let imported = import::import(&name, &text, &options, include).map_err(Cause::Import)?;
    let notes = imported.notes.iter().map(|note| format!("note: {name}: {note}")).collect();
    Ok(ModelText { name, text: imported.model.into_bytes(), notes })
}

fn whole(name: &str, file: &mut dyn Read) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    file.take(MAX_MODEL_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| Error::read(Path::new(name), error))?;
    if bytes.len() as u64 > MAX_MODEL_BYTES {
        return Err(Cause::TooLarge { file: name.to_owned(), limit: MAX_MODEL_BYTES }.into());
    }
    Ok(bytes)
}

fn no_model(path: &Path, name: &str, shipped: &[&[ShippedModel]]) -> Error {
    if let Some(mistaken) = Mistaken::name(name, FileKind::Model) {
        return Cause::Mistaken(mistaken).into();
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let names = shipped.iter().copied().flatten().map(|model| model.name);
    let nearest = denavit_codegen::expr::text::nearest(&stem, names);
    let is_path = path.components().count() > 1 || path.extension().is_some();
    Cause::NoModel { name: name.to_owned(), nearest, is_path }.into()
}

/// What the system says, without its error number.
pub fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    let end = text.find(" (os error").unwrap_or(text.len());
    let mut text = text[..end].to_owned();
    if let Some(first) = text.get_mut(..1) {
        first.make_ascii_lowercase();
    }
    text
}
