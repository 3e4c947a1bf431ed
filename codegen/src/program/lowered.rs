//! A model on its way to code: derived, lowered, counted.

use super::{Counts, LowerError, Program, counts, fuse, lower};
use crate::derive::{Derivation, Flavour, derive};
use crate::function::{FunctionName, NoFunction};
use crate::model::{BakeError, Robot};
use std::fmt;

/// How functions become code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CodeOptions {
    /// Whether parameters stay symbols.
    pub flavour: Flavour,
    /// Whether products are fused with the sums that they go into.
    pub fused: bool,
    /// The functions; those that the model cannot have are left out.
    pub functions: Vec<FunctionName>,
}

impl Default for CodeOptions {
    /// Every function of general use, tunable, without fused products.
    fn default() -> Self {
        let functions = FunctionName::ALL.to_vec();
        Self { flavour: Flavour::Tunable, fused: false, functions }
    }
}

/// Why a model has no code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CodeError {
    /// Values are missing that the baked flavour needs.
    Bake(BakeError),
    /// It holds numbers that no computer arithmetic holds; holds model and cause.
    Lower(String, LowerError),
    /// It has none of the functions.
    NoFunction(NoFunction),
}

impl fmt::Display for CodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bake(error) => write!(f, "{error}"),
            Self::Lower(model, error) => write!(
                f,
                "{model}: {error}\n  hint: check the exponents of the numbers in the model"
            ),
            Self::NoFunction(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for CodeError {}

/// The functions of a model, as expressions and as code.
#[derive(Clone, Debug)]
pub struct Lowered {
    /// Its functions as expressions.
    pub derivation: Derivation,
    /// Its functions as code.
    pub program: Program,
}

impl Lowered {
    /// Derives the functions of a robot and lowers them. None at all is an error.
    pub fn new(robot: &Robot, options: &CodeOptions) -> Result<Self, CodeError> {
        let CodeOptions { flavour, fused, functions } = options;
        let derivation = derive(robot, *flavour, functions).map_err(CodeError::Bake)?;
        if derivation.functions.is_empty() {
            let (model, asked) = (robot.name.clone(), functions.clone());
            return Err(CodeError::NoFunction(NoFunction { model, asked }));
        }
        let mut program = lower(&derivation.dag, &derivation.functions)
            .map_err(|error| CodeError::Lower(robot.name.clone(), error))?;
        if *fused {
            fuse(&mut program);
        }
        Ok(Self { derivation, program })
    }

    /// What a call of each function costs.
    pub fn counts(&self) -> Vec<FunctionCount> {
        let routines = self.program.routines.iter();
        let count = routines.map(|routine| FunctionCount {
            name: routine.name,
            link: routine.link.clone(),
            counts: counts(&self.program, routine),
        });
        count.collect()
    }
}

/// The counts of one function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FunctionCount {
    /// Which function.
    pub name: FunctionName,
    /// Of which link, where there is one function for each link.
    pub link: Option<String>,
    /// The operations of a call.
    pub counts: Counts,
}

impl FunctionCount {
    /// The name, with the link where there is one: `link_jacobian_foot`.
    pub fn full_name(&self) -> String {
        match &self.link {
            Some(link) => format!("{}_{link}", self.name),
            None => self.name.to_string(),
        }
    }
}
