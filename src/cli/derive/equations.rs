//! The equations of motion, whichever way they were derived.

use crate::cli::options::every_function;
use denavit::derive::{Flavour, derive};
use denavit::dynamics::methods::{self, Method, MethodResult};
use denavit::emit::latex::document;
use denavit::expr::{Dag, ExprId};
use denavit::function::{Form, Function, FunctionName, Output};
use denavit::fundamental::written_out;
use denavit::model::Robot;
use std::time::Instant;

/// One term of the equations: a matrix or a vector.
pub(super) struct Part {
    /// What it is called in JSON.
    pub(super) key: String,
    /// The function, where it is one of the compiler's.
    function: Option<FunctionName>,
    /// Of which link, where there is one for each.
    link: Option<String>,
    /// The name of the array.
    output: &'static str,
    /// What it is called in formulas.
    pub(super) symbol: &'static str,
    /// Its dimensions.
    pub(super) shape: Vec<usize>,
    /// Its entries, row-major.
    pub(super) entries: Vec<ExprId>,
    /// What the entries are.
    doc: String,
    /// The formulation, if there is a choice.
    pub(super) form: &'static str,
    /// How long it took \[s\], if it was derived by itself.
    pub(super) time: Option<f64>,
}

impl Part {
    /// Whether it is a term of the equations, and not what they add up to or a constraint.
    fn is_term(&self) -> bool {
        ["D", "C", "G", "tau_drive"].contains(&self.symbol)
    }

    /// Its letter, or its name if it has none.
    pub(super) fn label(&self) -> &str {
        if self.symbol.is_empty() { &self.key } else { self.symbol }
    }
}

/// The equations of motion of a robot.
pub(super) struct Equations {
    pub(super) model: String,
    pub(super) method: &'static str,
    /// The moving links, in the order of q.
    pub(super) joints: Vec<String>,
    pub(super) dag: Dag,
    pub(super) parts: Vec<Part>,
    /// Whether the parts were named, so that all of them are wanted.
    is_named: bool,
    /// How long it took altogether \[s\], if the parts were derived together.
    pub(super) time: Option<f64>,
}

/// What is derived by recursion, with its letters.
const RECURSIVE: [(FunctionName, &str); 5] = [
    (FunctionName::MassMatrix, "D"),
    (FunctionName::CoriolisMatrix, "C"),
    (FunctionName::GravityVector, "G"),
    (FunctionName::InverseDynamics, "tau"),
    (FunctionName::ContactJacobian, "W^T"),
];

impl Equations {
    /// By the recursions that emitted code uses; what is named, each once, or the equations.
    pub(super) fn recursive(robot: &Robot, named: &[FunctionName]) -> Self {
        let wanted: Vec<FunctionName> = match named.is_empty() {
            true => RECURSIVE.iter().map(|(name, _)| *name).collect(),
            false => every_function().filter(|name| named.contains(name)).collect(),
        };
        let derivation =
            derive(robot, Flavour::Tunable, &wanted).expect("only baking asks for values");
        let mut parts = Vec::new();
        for function in &derivation.functions {
            let name = function.name.as_str();
            let stage = derivation.report.iter().find(|stage| stage.stage == name);
            let letter = RECURSIVE.iter().find(|(own, _)| *own == function.name);
            let single = function.outputs.len() == 1;
            parts.extend(function.outputs.iter().map(|output| Part {
                key: if single { function.full_name() } else { output.name.to_owned() },
                function: Some(function.name),
                link: function.link.clone(),
                output: output.name,
                symbol: letter.map_or("", |(_, letter)| letter),
                shape: output.shape.clone(),
                entries: output.entries.clone(),
                doc: output.doc.clone(),
                form: form_name(function.form),
                time: stage.map(|stage| stage.time.as_secs_f64()),
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
    pub(super) fn by_method(robot: &Robot, method: Method) -> Self {
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
        let time = Some(started.elapsed().as_secs_f64());
        let n = gravity.len();
        let part =
            |name: &'static str, symbol, shape: &[usize], entries: Vec<ExprId>, doc: &str| Part {
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

    /// Whether a function is among the parts.
    pub(super) fn has(&self, function: FunctionName) -> bool {
        self.parts.iter().any(|part| part.function == Some(function))
    }

    /// What holds between the parts.
    pub(super) fn law(&self) -> &'static str {
        match self.time {
            None => "tau = D qdd + C qd + G + the joints' own torques",
            Some(_) => "tau = D qdd + C qd + G + tau_drive",
        }
    }

    /// What is written out: the terms, or all that was named.
    pub(super) fn written(&self) -> impl Iterator<Item = &Part> {
        self.parts.iter().filter(|part| self.is_named || part.is_term())
    }

    /// D, C, G and W, or what was named, as a LaTeX document.
    pub(super) fn latex(&self, robot: &Robot) -> String {
        let mut functions: Vec<Function> = Vec::new();
        for part in self.parts.iter().filter(|part| self.is_named || part.symbol != "tau") {
            let Some(name) = part.function else { continue };
            let output = Output {
                name: part.output,
                shape: part.shape.clone(),
                entries: part.entries.clone(),
                doc: part.doc.clone(),
                details: Vec::new(),
            };
            let link = part.link.clone();
            match functions.last_mut().filter(|last| last.name == name && last.link == link) {
                Some(same) => same.outputs.push(output),
                None => {
                    let (arguments, outputs, form) = (Vec::new(), vec![output], Form::Plain);
                    functions.push(Function { name, link, arguments, outputs, form });
                }
            }
        }
        document(robot, &self.dag, &functions).expect("our template has a place for each value")
    }

    /// The equations with what is `written` of them written out as people do; none if that takes
    /// more than `limit` terms.
    pub(super) fn written_out(&mut self, limit: usize) -> Option<Vec<ExprId>> {
        let entries = self.entries_of_terms();
        written_out(&mut self.dag, &entries, limit)
    }

    /// The entries of what is written, in order.
    pub(super) fn entries_of_terms(&self) -> Vec<ExprId> {
        self.written().flat_map(|part| part.entries.iter().copied()).collect()
    }

    /// Number of nodes of what is written, each shared one counted once.
    pub(super) fn nodes(&self) -> usize {
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
