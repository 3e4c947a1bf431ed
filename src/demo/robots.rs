//! A robot derived, emitted, set, drawn, counted and checked.

use super::checks::{self, Check};
use super::compiled::Compiled;
use super::counts::{self, Comparison};
use super::{Document, Written};
use denavit::derive::{Derivation, StageReport};
use denavit::emit::latex::document;
use denavit::emit::{SourceError, rust};
use denavit::function::FunctionName;
use denavit::model::Robot;
use denavit::program::{CodeError, CodeOptions, Lowered};
use denavit::regressor::{BaseOptions, ProvenBase, ProvenBaseError};
use denavit::report::symbolic::BaseReport;
use denavit::report::{Align, Ordered, Pose, Table, picture};
use serde::Serialize;
use std::fmt;

/// What became of one robot.
#[derive(Serialize)]
pub struct RobotOutcome {
    model: String,
    hash: String,
    degrees_of_freedom: usize,
    stages: Ordered<StageJson>,
    operations: Ordered<Comparison>,
    base: BaseJson,
    files: Vec<Written>,
    checks: Vec<Check>,
}

#[derive(Serialize)]
struct StageJson {
    milliseconds: f64,
    nodes: usize,
}

/// What was found of the base parameters.
#[derive(Serialize)]
struct BaseJson {
    columns: usize,
    rank: usize,
    alone: usize,
    verified: bool,
    milliseconds: f64,
}

/// Why a robot of the demo comes to nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RobotError {
    /// It has no source code.
    Source(SourceError),
    /// Its base parameters are not found.
    Base(ProvenBaseError),
}

impl fmt::Display for RobotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Source(error) => write!(f, "{error}"),
            Self::Base(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for RobotError {}

/// A robot without code.
fn without_code(error: CodeError) -> RobotError {
    RobotError::Source(SourceError::Code(error))
}

impl RobotOutcome {
    /// Of a robot and the functions that were generated of it. `show` hears what is being done,
    /// `write` takes documents to files; the seed draws states for the checks.
    pub fn new<E: From<RobotError>>(
        robot: &Robot,
        compiled: &Compiled,
        seed: u64,
        show: &dyn Fn(&str),
        write: &mut dyn FnMut(Document) -> Result<Written, E>,
    ) -> Result<Self, E> {
        let name = compiled.name;
        let show = |doing: &str| show(&format!("{name}: {doing}"));
        let mut files = Vec::new();
        let mut keep = |ending: &str, text: String, what: &str| {
            let (name, what) = (format!("{name}{ending}"), what.to_owned());
            files.push(write(Document { name, text, what })?);
            Ok::<(), E>(())
        };
        show("deriving and emitting");
        let lowered = Lowered::new(robot, &CodeOptions::default()).map_err(without_code)?;
        let functions = lowered.program.routines.len();
        let module = rust::module(&lowered.derivation.robot, &lowered.program)
            .map_err(|error| RobotError::Source(SourceError::Emit(name.to_owned(), error)))?;
        let what = format!("{functions} functions as Rust, tunable parameters");
        keep("_dynamics.rs", module, &what)?;
        show("setting the equations");
        let document = equations(robot, &lowered.derivation);
        keep("_equations.tex", document, "D, C, G and W^T as LaTeX")?;
        show("finding base parameters");
        let found =
            ProvenBase::find(robot.clone(), &BaseOptions::default()).map_err(RobotError::Base)?;
        let document = BaseReport::new(&found).latex();
        keep("_base_parameters.tex", document, "base parameters as LaTeX")?;
        let certificate = found.certificate.to_text();
        keep("_certificate.json", certificate, "the certificate that they are exact")?;
        show("drawing");
        let pose = Pose::zero(robot)
            .map_err(|error| without_code(CodeError::Lower(name.to_owned(), error)))?;
        keep(".svg", picture(robot, &pose), "the robot with the frames of its links")?;
        show("counting");
        let operations = counts::compare(robot, &lowered.program).map_err(without_code)?;
        show("checking");
        let checks = checks::run(robot, compiled, seed).map_err(without_code)?;
        Ok(Self {
            model: name.to_owned(),
            hash: format!("{:016x}", robot.hash),
            degrees_of_freedom: robot.degrees_of_freedom(),
            stages: Ordered(stages(&lowered.derivation)),
            operations: Ordered(operations),
            base: BaseJson::of(&found),
            files,
            checks,
        })
    }

    /// Whether all checks passed, and the base parameters are proven.
    pub fn passed(&self) -> bool {
        self.base.verified && self.checks.iter().all(Check::passed)
    }
}

impl BaseJson {
    fn of(found: &ProvenBase) -> Self {
        let base = &found.base;
        let (columns, rank) = (base.regressor.columns.len(), base.rank());
        let milliseconds = 1e3 * found.time.as_secs_f64();
        let (alone, verified) = (base.alone().len(), found.verified);
        Self { columns, rank, alone, verified, milliseconds }
    }
}

/// D, C, G and, of a robot with contacts, W^T as a LaTeX document.
fn equations(robot: &Robot, derivation: &Derivation) -> String {
    use FunctionName::{ContactJacobian, CoriolisMatrix, GravityVector, MassMatrix};
    let is_set =
        |name| matches!(name, MassMatrix | CoriolisMatrix | GravityVector | ContactJacobian);
    let functions = derivation.functions.iter().filter(|function| is_set(function.name));
    let functions: Vec<_> = functions.cloned().collect();
    document(robot, &derivation.dag, &functions).expect("our template has a place for each value")
}

/// What each stage took; a robot without contacts has none for their functions.
fn stages(derivation: &Derivation) -> Vec<(String, StageJson)> {
    let made = |stage: &&StageReport| {
        let name = FunctionName::parse(&stage.stage);
        name.is_none_or(|name| derivation.functions.iter().any(|f| f.name == name))
    };
    let json = |stage: &StageReport| {
        let milliseconds = 1e3 * stage.time.as_secs_f64();
        (stage.stage.clone(), StageJson { milliseconds, nodes: stage.nodes })
    };
    derivation.report.iter().filter(made).map(json).collect()
}

impl fmt::Display for RobotOutcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { model, hash, degrees_of_freedom, .. } = self;
        writeln!(f, "\n{model}: {degrees_of_freedom} degrees of freedom, hash {hash}")?;
        let mut stages =
            Table::new(&[("stage", Align::Left), ("nodes", Align::Right), ("ms", Align::Right)]);
        let mut total = 0.0;
        for (name, stage) in &self.stages.0 {
            total += stage.milliseconds;
            stages.push(vec![
                name.clone(),
                stage.nodes.to_string(),
                format!("{:.2}", stage.milliseconds),
            ]);
        }
        stages.push(vec!["total".to_owned(), String::new(), format!("{total:.2}")]);
        writeln!(f, "\nstages (nodes: of the graph after it)\n{stages}")?;
        writeln!(f, "operations of one call (mul + add)\n{}", counts::table(&self.operations.0))?;
        let BaseJson { columns, rank, alone, verified, milliseconds } = &self.base;
        let verdict = if *verified { "verified" } else { "NOT VERIFIED" };
        writeln!(
            f,
            "base parameters: {rank} of {columns} columns in {milliseconds:.1} ms, {alone} of them \
             parameters alone; certificate {verdict}\n"
        )?;
        writeln!(f, "checks, by running the generated functions\n{}", checks::table(&self.checks))?;
        self.files.iter().try_for_each(|file| writeln!(f, "{file}"))
    }
}
