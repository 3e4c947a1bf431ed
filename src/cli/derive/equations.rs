//! The equations of motion, whichever way they were derived.

use denavit::derive::{Flavour, derive};
use denavit::dynamics::methods::{self, Method, MethodResult};
use denavit::expr::{Dag, ExprId};
use denavit::function::{Form, FunctionName};
use denavit::model::Robot;
use std::time::Instant;

/// One term of the equations: a matrix or a vector.
pub(super) struct Part {
    /// What it is called in JSON.
    pub(super) name: &'static str,
    /// What it is called in formulas.
    pub(super) symbol: &'static str,
    /// Its dimensions.
    pub(super) shape: Vec<usize>,
    /// Its entries, row-major.
    pub(super) entries: Vec<ExprId>,
    /// The formulation, if there is a choice.
    pub(super) form: &'static str,
    /// How long it took [s], if it was derived by itself.
    pub(super) time: Option<f64>,
}

impl Part {
    /// Whether it is a square matrix that is its own transpose.
    pub(super) fn is_symmetric(&self) -> bool {
        let [rows, columns] = self.shape[..] else { return false };
        let entry = |row: usize, column: usize| self.entries[row * columns + column];
        rows == columns && (0..rows).all(|i| (0..i).all(|j| entry(i, j) == entry(j, i)))
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
    /// How long it took altogether [s], if the parts were derived together.
    pub(super) time: Option<f64>,
}

impl Equations {
    /// By the recursions that emitted code uses.
    pub(super) fn recursive(robot: &Robot) -> Self {
        use FunctionName::{CoriolisMatrix, GravityVector, InverseDynamics, MassMatrix};
        let wanted = [MassMatrix, CoriolisMatrix, GravityVector, InverseDynamics];
        let derivation =
            derive(robot, Flavour::Tunable, &wanted).expect("only baking asks for values");
        let symbols = ["D", "C", "G", "tau"];
        let functions = derivation.functions.iter().zip(symbols);
        let parts = functions
            .flat_map(|(function, symbol)| {
                let name = function.name.as_str();
                let stage = derivation.report.iter().find(|stage| stage.stage == name);
                let time = stage.map(|stage| stage.time.as_secs_f64());
                let form = match function.form {
                    Form::Plain => "plain",
                    Form::Grouped => "grouped axes",
                    Form::Explicit => "explicit",
                };
                function.outputs.iter().map(move |output| Part {
                    name,
                    symbol,
                    shape: output.shape.clone(),
                    entries: output.entries.clone(),
                    form,
                    time,
                })
            })
            .collect();
        Self {
            model: robot.name.clone(),
            method: "recursive",
            joints: joints(robot),
            dag: derivation.dag,
            parts,
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
        let part = |name, symbol, shape: &[usize], entries: Vec<ExprId>| Part {
            name,
            symbol,
            shape: shape.to_vec(),
            entries,
            form: "",
            time: None,
        };
        let parts = vec![
            part("mass_matrix", "D", &[n, n], mass_matrix.concat()),
            part("coriolis_matrix", "C", &[n, n], coriolis_matrix.concat()),
            part("gravity_vector", "G", &[n], gravity),
            part("drive_torque", "tau_drive", &[n], drive_torque),
            part("inverse_dynamics", "tau", &[n], inverse_dynamics),
        ];
        let (model, joints) = (robot.name.clone(), joints(robot));
        Self { model, method: method.as_str(), joints, dag, parts, time }
    }

    /// What holds between the parts.
    pub(super) fn law(&self) -> &'static str {
        match self.time {
            None => "tau = D qdd + C qd + G + the joints' own torques",
            Some(_) => "tau = D qdd + C qd + G + tau_drive",
        }
    }

    /// Number of nodes of the equations, each shared one counted once.
    pub(super) fn nodes(&self) -> usize {
        let entries: Vec<ExprId> =
            self.parts.iter().flat_map(|part| part.entries.iter().copied()).collect();
        self.dag.topological(&entries).len()
    }
}

fn joints(robot: &Robot) -> Vec<String> {
    robot.joints().map(|(link, _)| robot.links[link].name.clone()).collect()
}
