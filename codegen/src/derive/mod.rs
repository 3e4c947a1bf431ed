//! The driver: from a checked robot to the functions asked for, one line per stage.
//!
//! [`MotionEquations`] are what a person reads: D, C, G and what goes with them, in any method.

mod equations;

pub use equations::{EquationOptions, EquationPart, MotionEquations, MotionError};

use crate::dynamics::portfolio::Portfolio;
use crate::expr::{Dag, Operations};
use crate::function::{Function, FunctionName};
use crate::kinematics::Mechanism;
use crate::model::{BakeError, Robot, bake, bake_zeros};
use crate::regressor;
use crate::regroup::regroup;
use std::fmt;
use std::time::{Duration, Instant};

/// Whether parameters stay symbols.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Flavour {
    /// Parameters are set at run time; what depends on them alone is computed once.
    Tunable,
    /// The same, but what the model gives as 0 stays 0 and drops out, columns of regressors too.
    Sparse,
    /// The model's values are folded into the code; zeros drop out.
    Baked,
}

impl fmt::Display for Flavour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Tunable => "tunable",
            Self::Sparse => "sparse",
            Self::Baked => "baked",
        })
    }
}

/// What a stage did.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StageReport {
    /// The stage, or the function derived.
    pub stage: String,
    /// Nodes of the graph after it.
    pub nodes: usize,
    /// Operations of the functions that the stage made; none for the stages before.
    pub operations: Option<Operations>,
    /// How long it took.
    pub time: Duration,
}

/// The functions of a robot, with the graph that holds them.
#[derive(Clone, Debug)]
pub struct Derivation {
    /// The robot as it was derived: with values in place of symbols if baked.
    pub robot: Robot,
    /// Holds the expressions of all functions, and those of the robot.
    pub dag: Dag,
    /// The functions, in the order in which they were asked for.
    pub functions: Vec<Function>,
    /// What each stage did.
    pub report: Vec<StageReport>,
}

/// Derives the functions of `wanted`, each in its cheapest formulation. Functions that the robot
/// cannot have (contacts without contact points) are left out. Baking fails if a parameter has no
/// value.
pub fn derive(
    robot: &Robot,
    flavour: Flavour,
    wanted: &[FunctionName],
) -> Result<Derivation, BakeError> {
    let mut log = Log { report: Vec::new(), started: Instant::now() };
    let robot = match flavour {
        Flavour::Tunable => robot.clone(),
        Flavour::Sparse => bake_zeros(robot),
        Flavour::Baked => bake(robot)?,
    };
    let mut dag = robot.dag.clone();
    let mechanism = Mechanism::new(&mut dag, &robot);
    log.stage("kinematics", &dag, None);
    let regrouped = regroup(&mut dag, &mechanism);
    log.stage("regroup", &dag, None);
    let portfolio = Portfolio::new(&mut dag, &robot, &regrouped);
    let mut functions: Vec<Function> = Vec::new();
    for &name in wanted {
        let made = match name {
            FunctionName::Regressor
            | FunctionName::BaseRegressor
            | FunctionName::BaseParameters => regressor::functions::derive(&mut dag, &robot, name),
            _ => portfolio.derive(&mut dag, name),
        };
        let entries: Vec<_> = made.iter().flat_map(Function::entries).collect();
        let operations = Operations::count(&dag, &entries);
        log.stage(name.as_str(), &dag, Some(operations));
        functions.extend(made);
    }
    Ok(Derivation { robot, dag, functions, report: log.report })
}

struct Log {
    report: Vec<StageReport>,
    started: Instant,
}

impl Log {
    fn stage(&mut self, stage: &str, dag: &Dag, operations: Option<Operations>) {
        let time = self.started.elapsed();
        self.report.push(StageReport {
            stage: stage.to_owned(),
            nodes: dag.len(),
            operations,
            time,
        });
        self.started = Instant::now();
    }
}
