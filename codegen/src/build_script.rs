//! What a build script calls: a model file becomes a module of Rust.
//!
//! ```no_run
//! // In build.rs, all of `main`:
//! denavit_codegen::build_script::emit("models/tulip.json");
//! ```
//!
//! The crate then includes the module, which needs `denavit-runtime` alone:
//!
//! ```ignore
//! /// Dynamics of the robot.
//! pub mod tulip {
//!     include!(concat!(env!("OUT_DIR"), "/tulip_dynamics.rs"));
//! }
//! ```

use crate::derive::{Flavour, derive};
use crate::effect::{self, Effect};
use crate::emit::EmitError;
use crate::emit::rust::module;
use crate::function::FunctionName;
use crate::model::{BakeError, ModelError, Robot};
use crate::program::{LowerError, fuse, lower};
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// What is generated of a model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Request {
    /// Whether parameters can be set at run time.
    pub flavour: Flavour,
    /// The functions; those that the robot cannot have are left out.
    pub functions: Vec<FunctionName>,
    /// Whether products are fused with sums: faster where the target has the instruction and the
    /// runtime its feature `fma`, at the price of bits that depend on the target.
    pub fuses: bool,
}

impl Default for Request {
    /// All functions, with parameters that can be set at run time.
    fn default() -> Self {
        Self { flavour: Flavour::Tunable, functions: FunctionName::ALL.to_vec(), fuses: false }
    }
}

/// Why there is no module of a model.
#[derive(Debug)]
pub enum BuildError {
    /// The file cannot be read.
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// The file is no model; names all its faults.
    Model(ModelError),
    /// Parameters cannot be baked in.
    Bake(BakeError),
    /// A function cannot become code.
    Lower {
        /// The model.
        model: String,
        /// Why not.
        error: LowerError,
    },
    /// The program cannot become text.
    Emit {
        /// The model.
        model: String,
        /// Why not.
        error: EmitError,
    },
    /// The module cannot be written.
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// The variable `OUT_DIR` is not set: cargo sets it for build scripts.
    NoOutDir,
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read { path, error } => write!(f, "{}: cannot read: {error}", path.display()),
            Self::Model(error) => write!(f, "{error}"),
            Self::Bake(error) => write!(f, "{error}"),
            Self::Lower { model, error } => write!(f, "{model}: {error}"),
            Self::Emit { model, error } => write!(f, "{model}: {error}"),
            Self::Write { path, error } => write!(f, "{}: cannot write: {error}", path.display()),
            Self::NoOutDir => write!(f, "OUT_DIR is not set: call this from a build script"),
        }
    }
}

impl std::error::Error for BuildError {}

/// Writes `OUT_DIR/<file stem>_dynamics.rs` with all functions of a model and tells cargo what it
/// depends on. A model that is wrong fails the build: each of its faults is an error that cargo
/// shows, and the build script itself goes on, so that faults of further models are shown too.
pub fn emit(model: impl AsRef<Path>) {
    emit_with(model, &Request::default());
}

/// The same for a choice of flavour and functions.
pub fn emit_with(model: impl AsRef<Path>, request: &Request) {
    let model = model.as_ref();
    println!("cargo::rerun-if-changed={}", model.display());
    let effects = effects_folder(model);
    // Of a path that is not there cargo would run the script, and build the crate, every time.
    if effects.exists() {
        println!("cargo::rerun-if-changed={}", effects.display());
    }
    let out_dir = std::env::var_os("OUT_DIR").map(PathBuf::from).ok_or(BuildError::NoOutDir);
    if let Err(error) = out_dir.and_then(|out_dir| generate(model, &out_dir, request)) {
        // A hint stands on a line of its own, indented; cargo shows it with its fault.
        for fault in error.to_string().replace("\n  ", "; ").lines() {
            println!("cargo::error={fault}");
        }
    }
}

/// Writes `<file stem>_dynamics.rs` into a directory: all of it, or nothing. Returns its path.
pub fn generate(model: &Path, out_dir: &Path, request: &Request) -> Result<PathBuf, BuildError> {
    let bytes =
        std::fs::read(model).map_err(|error| BuildError::Read { path: model.to_owned(), error })?;
    let own = own_effects(model)?;
    let robot =
        effect::read_model(&model.to_string_lossy(), &bytes, &own).map_err(BuildError::Model)?;
    let text = source(&robot, request)?;
    let stem = model.file_stem().unwrap_or_default().to_string_lossy();
    let path = out_dir.join(format!("{stem}_dynamics.rs"));
    write_whole(&path, &text).map_err(|error| BuildError::Write { path: path.clone(), error })?;
    Ok(path)
}

/// Where a model's own effects are.
fn effects_folder(model: &Path) -> PathBuf {
    model.parent().unwrap_or(Path::new("")).join("effects")
}

/// The effects of the folder `effects` beside a model, by file name.
fn own_effects(model: &Path) -> Result<Vec<Effect>, BuildError> {
    let folder = effects_folder(model);
    let files =
        effect::files(&folder).map_err(|error| BuildError::Read { path: folder.clone(), error })?;
    let read = |path: &PathBuf| {
        let bytes =
            std::fs::read(path).map_err(|error| BuildError::Read { path: path.clone(), error })?;
        effect::read(&path.to_string_lossy(), &bytes).map_err(BuildError::Model)
    };
    files.iter().map(read).collect()
}

/// The text of the module of a robot.
pub fn source(robot: &Robot, request: &Request) -> Result<String, BuildError> {
    let model = || robot.name.clone();
    let derivation =
        derive(robot, request.flavour, &request.functions).map_err(BuildError::Bake)?;
    let mut program = lower(&derivation.dag, &derivation.functions)
        .map_err(|error| BuildError::Lower { model: model(), error })?;
    if request.fuses {
        fuse(&mut program);
    }
    module(&derivation.robot, &program).map_err(|error| BuildError::Emit { model: model(), error })
}

/// Writes a file under another name and renames it, so that nobody sees half of it. A file that
/// holds the text already is left alone, and what depends on it is not built again.
fn write_whole(path: &Path, text: &str) -> io::Result<()> {
    if std::fs::read(path).is_ok_and(|old| old == text.as_bytes()) {
        return Ok(());
    }
    let unfinished = path.with_extension(format!("rs.{}", std::process::id()));
    let written =
        std::fs::write(&unfinished, text).and_then(|()| std::fs::rename(&unfinished, path));
    if written.is_err() {
        // The first error is the one to report, not that of cleaning up.
        let _ = std::fs::remove_file(&unfinished);
    }
    written
}
