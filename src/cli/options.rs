//! Options that several commands have.

use super::failure::Failure;
use super::files::FILES;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use denavit::derive::Flavour;
use denavit::function::{FunctionName, NoFunction};
use denavit::model::Terms;
use denavit::program::CodeError;
use denavit::workflow::Shapes;
use std::path::{Path, PathBuf};

/// The model that a command is about.
#[derive(Debug, Args)]
pub(crate) struct ModelArgument {
    /// Path of a model file, name of a shipped model, or - for standard input
    #[arg(value_name = "MODEL")]
    pub(crate) model: PathBuf,
}

/// Where the definitions of added effects are.
#[derive(Debug, Default, Args)]
pub(crate) struct EffectsOption {
    /// Folder of your own effects; without it the folder `effects` beside the model
    #[arg(long, value_name = "DIR")]
    pub(crate) effects: Option<PathBuf>,
}

/// What links look like on a page.
#[derive(Debug, Args)]
pub(crate) struct ShapesOption {
    /// Show the shapes of this URDF or MJCF on links of the same names; `inspect` takes its own
    #[arg(long, value_name = "ROBOT", requires = "html")]
    shapes: Option<PathBuf>,
    /// Folder of their meshes (STL, OBJ), or of their package; without it that of ROBOT
    #[arg(long, value_name = "DIR", requires = "html")]
    meshes: Option<PathBuf>,
}

impl ShapesOption {
    /// The shapes that were asked for, or those of a model.
    pub(crate) fn read(&self, model: &Path) -> Result<Option<Shapes>, Failure> {
        Ok(FILES.shapes_of(model, self.shapes.as_deref(), self.meshes.as_deref())?)
    }
}

/// Functions, given as a list of names.
#[derive(Debug, Args)]
pub(crate) struct FunctionList {
    /// Functions, separated by commas; if none are named, all that the model has but regressor,
    /// base_regressor and base_parameters, and, where code is emitted, those for walking:
    /// contact_derivatives, center_of_mass_bias, centroidal_momentum_matrix,
    /// centroidal_momentum_bias, angular_momenta, zero_moment_point, cart_table_zmp,
    /// foot_rotation_indicator, capture_point
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = function_names())]
    functions: Vec<FunctionName>,
}

impl FunctionList {
    /// The functions asked for, each once, in the order of listings; those of general use if none
    /// are named.
    pub(crate) fn wanted(&self) -> Vec<FunctionName> {
        match self.functions.is_empty() {
            true => FunctionName::ALL.to_vec(),
            false => FunctionName::every().filter(|name| self.functions.contains(name)).collect(),
        }
    }

    /// The same; if none are named, those for walking, too.
    pub(crate) fn wanted_with_walking(&self) -> Vec<FunctionName> {
        match self.functions.is_empty() {
            true => [&FunctionName::ALL[..], &FunctionName::WALKING].concat(),
            false => self.wanted(),
        }
    }

    /// Refuses what was named and is not among the functions that were found.
    pub(crate) fn refuse_missing(
        &self,
        model: &str,
        found: impl IntoIterator<Item = FunctionName>,
    ) -> Result<(), Failure> {
        let found: Vec<FunctionName> = found.into_iter().collect();
        let missing = self.functions.iter().filter(|name| !found.contains(name));
        let (model, asked) = (model.to_owned(), missing.copied().collect::<Vec<_>>());
        match asked.is_empty() {
            true => Ok(()),
            false => Err(CodeError::NoFunction(NoFunction { model, asked }).into()),
        }
    }
}

/// A function, by name.
pub(crate) fn function_names() -> impl TypedValueParser<Value = FunctionName> {
    PossibleValuesParser::new(FunctionName::every().map(FunctionName::as_str)).try_map(|name| {
        FunctionName::parse(&name).ok_or_else(|| format!("`{name}` is not a function"))
    })
}

/// Whether the nominal parameters go into the functions.
#[derive(Debug, Args)]
pub(crate) struct FlavourOption {
    /// Fold the nominal parameters into the functions (otherwise parameters are set at run time)
    #[arg(long)]
    baked: bool,
    /// Parameters that the model gives as 0 stay 0, and have no field and no column of a regressor
    /// (all others are set at run time)
    #[arg(long, conflicts_with = "baked")]
    sparse: bool,
}

impl FlavourOption {
    /// The flavour asked for.
    pub(crate) fn flavour(&self) -> Flavour {
        match (self.baked, self.sparse) {
            (true, _) => Flavour::Baked,
            (false, true) => Flavour::Sparse,
            (false, false) => Flavour::Tunable,
        }
    }
}

/// A term of the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Term {
    /// D qdd
    Inertia,
    /// C qd
    Coriolis,
    /// G
    Gravity,
    /// Viscous and Coulomb friction, joint damping
    Friction,
    /// Reflected rotor inertia
    Rotor,
    /// Springs across joints
    Spring,
}

/// The terms of a list.
pub(crate) fn terms(list: &[Term]) -> Terms {
    let has = |term| list.contains(&term);
    Terms {
        inertia: has(Term::Inertia),
        coriolis: has(Term::Coriolis),
        gravity: has(Term::Gravity),
        friction: has(Term::Friction),
        rotor: has(Term::Rotor),
        spring: has(Term::Spring),
    }
}
