//! What the parts of an emitted module share, in whatever language: names and values.

use super::names::{Names, Words, identifier};
use crate::model::{Parameter, Robot};
use crate::program::{Leaf, Program, Routine, constant_values};
use std::fmt;

/// Why a program cannot be written as a module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EmitError {
    /// The default of a parameter is no finite `f64`.
    NotFinite {
        /// The parameter.
        parameter: String,
    },
}

impl fmt::Display for EmitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { parameter } => {
                write!(f, "the default of `{parameter}` is too large, or divides by zero")
            }
        }
    }
}

impl std::error::Error for EmitError {}

/// What the parts of a module share.
pub(super) struct Context<'a> {
    pub(super) robot: &'a Robot,
    pub(super) program: &'a Program,
    /// Which names the language has already.
    pub(super) words: Words,
    /// Fields of the model's parameters, by row of the robot's parameters.
    pub(super) model_fields: Vec<String>,
    /// Fields of what functions read, by row of the prelude's outputs.
    pub(super) prelude_fields: Vec<String>,
    /// Number of entries of `q`.
    pub(super) dof: usize,
}

impl<'a> Context<'a> {
    pub(super) fn new(robot: &'a Robot, program: &'a Program, words: Words) -> Self {
        let mut names = Names::fields(words);
        let model_fields =
            robot.parameters.values().map(|parameter| names.field(&parameter.name)).collect();
        let dof = robot.degrees_of_freedom();
        let prelude_fields = Vec::new();
        let mut context = Self { robot, program, words, model_fields, prelude_fields, dof };
        context.prelude_fields = prelude_fields_of(&context);
        context
    }

    /// The field of a parameter of the program.
    pub(super) fn model_field(&self, name: &str) -> &str {
        let mut parameters = self.robot.parameters.values();
        let row = parameters.position(|parameter| parameter.name == name);
        &self.model_fields[row.expect("the program's parameters are the robot's")]
    }

    /// Whether parameters are set at run time.
    pub(super) fn has_parameters(&self) -> bool {
        !self.program.parameters.is_empty()
    }

    /// The names of the functions: unique, also where links are called alike.
    pub(super) fn function_names(&self) -> Vec<String> {
        let mut names = Names::locals(self.words);
        let routines = &self.program.routines;
        routines.iter().for_each(|routine| {
            names.claim(routine.name.as_str());
        });
        let name = |routine: &Routine| match routine.link {
            None => routine.name.as_str().to_owned(),
            Some(_) => names.unique(&identifier(&routine.full_name()).to_ascii_lowercase()),
        };
        routines.iter().map(name).collect()
    }

    /// The default of each parameter of the model; none if the file gives none.
    pub(super) fn default_values(&self) -> Result<Vec<Option<f64>>, EmitError> {
        let parameters = || self.robot.parameters.values();
        let given: Vec<_> = parameters().filter_map(|parameter| parameter.default).collect();
        let mut values = constant_values(&self.robot.dag, &given).into_iter();
        let value = |parameter: &Parameter| match parameter.default.and_then(|_| values.next()) {
            Some(value) if !value.is_finite() => {
                Err(EmitError::NotFinite { parameter: parameter.name.clone() })
            }
            value => Ok(value),
        };
        parameters().map(value).collect()
    }
}

/// The names of the prelude's outputs: a parameter keeps its own, the others are numbered.
fn prelude_fields_of(context: &Context<'_>) -> Vec<String> {
    let code = &context.program.prelude;
    // A number never makes the name of another parameter of the model.
    let mut names = Names::fields(context.words);
    let mut taken = names.clone();
    context.model_fields.iter().for_each(|field| {
        taken.claim(field);
    });
    let mut fields = vec![None; code.outputs.len()];
    for (field, output) in fields.iter_mut().zip(&code.outputs) {
        if let Some(Leaf::Parameter(row)) = code.leaves.get(*output) {
            let name = context.model_field(&context.program.parameters[*row]);
            *field = names.claim(name).then(|| name.to_owned());
        }
    }
    let mut numbers = 1..;
    let mut numbered = || loop {
        let name = format!("r{}", numbers.next().expect("numbers do not end"));
        if taken.claim(&name) {
            return name;
        }
    };
    fields.into_iter().map(|field| field.unwrap_or_else(&mut numbered)).collect()
}
