//! The equations of motion, whichever way they were derived.

use super::{Flavour, derive};
use crate::dynamics::methods::{self, Method, MethodResult};
use crate::expr::{Dag, ExprId};
use crate::function::{Form, FunctionName, NoFunction};
use crate::fundamental::written_out;
use crate::model::Robot;
use std::fmt;
use std::time::{Duration, Instant};

/// How equations of motion are derived.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EquationOptions {
    /// One of the thesis's four ways; none for the recursions that emitted code uses.
    pub method: Option<Method>,
    /// What the recursions derive, each once; D, C, G, tau and the contact Jacobian if nothing is
    /// named.
    pub functions: Vec<FunctionName>,
}

/// Why a robot has not the equations asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MotionError {
    /// It has none of these functions.
    NoFunction(NoFunction),
    /// It has an effect, for which the method has no place; holds model and effect.
    Effect(String, String),
}

impl fmt::Display for MotionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoFunction(error) => write!(f, "{error}"),
            Self::Effect(model, effect) => {
                write!(f, "{model}: this has no place for the effect `{effect}`")
            }
        }
    }
}

impl std::error::Error for MotionError {}

/// A matrix or a vector of the equations of motion.
#[derive(Clone, Debug)]
pub struct EquationPart {
    /// What it is called in JSON.
    pub key: String,
    /// The function, where it is one of the compiler's.
    pub function: Option<FunctionName>,
    /// Of which link, where there is one for each.
    pub link: Option<String>,
    /// The name of the array.
    pub output: &'static str,
    /// What it is called in formulas.
    pub symbol: &'static str,
    /// Its dimensions.
    pub shape: Vec<usize>,
    /// Its entries, row-major.
    pub entries: Vec<ExprId>,
    /// What the entries are.
    pub doc: String,
    /// The formulation, if there is a choice.
    pub form: &'static str,
    /// How long it took, if it was derived by itself.
    pub time: Option<Duration>,
}

impl EquationPart {
    /// Whether it is a term of the equations, and not what they add up to or a constraint.
    fn is_term(&self) -> bool {
        ["D", "C", "G", "tau_drive"].contains(&self.symbol)
    }

    /// Its letter, or its name if it has none.
    pub fn label(&self) -> &str {
        if self.symbol.is_empty() { &self.key } else { self.symbol }
    }
}

/// The equations of motion of a robot.
#[derive(Clone, Debug)]
pub struct MotionEquations {
    /// The model's name.
    pub model: String,
    /// The method's name.
    pub method: &'static str,
    /// The moving links, in the order of q.
    pub joints: Vec<String>,
    /// Holds all expressions.
    pub dag: Dag,
    /// D, C, G and what goes with them.
    pub parts: Vec<EquationPart>,
    /// Whether the parts were named, so that all of them are wanted.
    pub is_named: bool,
    /// How long it took altogether, if the parts were derived together.
    pub time: Option<Duration>,
}

/// What is derived by recursion, with its letters.
const RECURSIVE: [(FunctionName, &str); 5] = [
    (FunctionName::MassMatrix, "D"),
    (FunctionName::CoriolisMatrix, "C"),
    (FunctionName::GravityVector, "G"),
    (FunctionName::InverseDynamics, "tau"),
    (FunctionName::ContactJacobian, "W^T"),
];

impl MotionEquations {
    /// The equations of a robot. Functions that were asked for and that it cannot have are an
    /// error; so are effects, if one of the four methods is asked for.
    pub fn derive(robot: &Robot, options: &EquationOptions) -> Result<Self, MotionError> {
        if let (Some(law), Some(_)) = (robot.laws.first(), options.method) {
            return Err(MotionError::Effect(robot.name.clone(), law.effect.clone()));
        }
        let equations = match options.method {
            None => Self::recursive(robot, &options.functions),
            Some(method) => Self::by_method(robot, method),
        };
        let has =
            |name: &FunctionName| equations.parts.iter().any(|part| part.function == Some(*name));
        let asked: Vec<_> = options.functions.iter().copied().filter(|name| !has(name)).collect();
        match asked.is_empty() {
            true => Ok(equations),
            false => Err(MotionError::NoFunction(NoFunction { model: robot.name.clone(), asked })),
        }
    }

    /// By the recursions that emitted code uses; what is named, each once, or the equations.
    fn recursive(robot: &Robot, named: &[FunctionName]) -> Self {
        let wanted: Vec<FunctionName> = match named.is_empty() {
            true => RECURSIVE.iter().map(|(name, _)| *name).collect(),
            false => FunctionName::every().filter(|name| named.contains(name)).collect(),
        };
        let derivation =
            derive(robot, Flavour::Tunable, &wanted).expect("only baking asks for values");
        let mut parts = Vec::new();
        for function in &derivation.functions {
            let name = function.name.as_str();
            let stage = derivation.report.iter().find(|stage| stage.stage == name);
            let letter = RECURSIVE.iter().find(|(own, _)| *own == function.name);
            let single = function.outputs.len() == 1;
            parts.extend(function.outputs.iter().map(|output| EquationPart {
                key: if single { function.full_name() } else { output.name.to_owned() },
                function: Some(function.name),
                link: function.link.clone(),
                output: output.name,
                symbol: letter.map_or("", |(_, letter)| letter),
                shape: output.shape.clone(),
                entries: output.entries.clone(),
                doc: output.doc.clone(),
                form: form_name(function.form),
                time: stage.map(|stage| stage.time),
            }));
        }
        Self {
            model: robot.name.clone(),
            method: "recursive",
            joints: joints(robot),
            dag: derivation.dag,
            parts,
            is_named: !named.is_empty(),
            time: None,
        }
    }

    /// In one of the thesis's four ways.
    fn by_method(robot: &Robot, method: Method) -> Self {
        let started = Instant::now();
        let mut dag = robot.dag.clone();
        let MethodResult {
            method,
            mass_matrix,
            coriolis_matrix,
            gravity,
            drive_torque,
            inverse_dynamics,
        } = methods::derive(&mut dag, robot, method);
        let time = Some(started.elapsed());
        let n = gravity.len();
        let part = |name: &'static str, symbol, shape: &[usize], entries, doc: &str| EquationPart {
            key: name.to_owned(),
            function: FunctionName::parse(name),
            link: None,
            output: name,
            symbol,
            shape: shape.to_vec(),
            entries,
            doc: format!("By the method {method}. {doc}"),
            form: "",
            time: None,
        };
        let parts = vec![
            part("mass_matrix", "D", &[n, n], mass_matrix.concat(), "D(q), rotors included."),
            part("coriolis_matrix", "C", &[n, n], coriolis_matrix.concat(), "C(q, qd)."),
            part("gravity_vector", "G", &[n], gravity, "G(q) = dP/dq of gravity."),
            part("drive_torque", "tau_drive", &[n], drive_torque, "Friction, springs, offsets."),
            part("inverse_dynamics", "tau", &[n], inverse_dynamics, "Joint torques."),
        ];
        let (model, joints) = (robot.name.clone(), joints(robot));
        Self { model, method: method.as_str(), joints, dag, parts, is_named: false, time }
    }

    /// What holds between the parts.
    pub fn law(&self) -> &'static str {
        match self.time {
            None => "tau = D qdd + C qd + G + the joints' own torques",
            Some(_) => "tau = D qdd + C qd + G + tau_drive",
        }
    }

    /// What is written out: the terms D, C, G and tau_drive, or all that was named.
    pub fn written(&self) -> impl Iterator<Item = &EquationPart> {
        self.parts.iter().filter(|part| self.is_named || part.is_term())
    }

    /// What is written ([`Self::written`]), multiplied out as people do; none if that takes more
    /// than `limit` summands.
    pub fn written_out(&mut self, limit: usize) -> Option<Vec<ExprId>> {
        let entries = self.entries_of_terms();
        written_out(&mut self.dag, &entries, limit)
    }

    /// The entries of what is written, in order.
    pub fn entries_of_terms(&self) -> Vec<ExprId> {
        self.written().flat_map(|part| part.entries.iter().copied()).collect()
    }

    /// Number of nodes of what is written, each shared one counted once.
    pub fn nodes(&self) -> usize {
        self.dag.topological(&self.entries_of_terms()).len()
    }
}

fn form_name(form: Form) -> &'static str {
    match form {
        Form::Plain => "plain",
        Form::Grouped => "grouped axes",
        Form::Explicit => "explicit",
    }
}

fn joints(robot: &Robot) -> Vec<String> {
    robot.joints().map(|(link, _)| robot.links[link].name.clone()).collect()
}
