//! Operation counts of the demo, beside those to compare with.

use denavit::derive::Flavour;
use denavit::function::FunctionName;
use denavit::model::{Robot, Terms};
use denavit::program::{CodeError, CodeOptions, Counts, FunctionCount, Lowered, Program, counts};
use denavit::report::{Align, Table};
use serde::Serialize;

/// Multiplications and additions of one call.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(super) struct Operations {
    mul: usize,
    add: usize,
}

impl From<&Counts> for Operations {
    fn from(counts: &Counts) -> Self {
        Self { mul: counts.mul, add: counts.add }
    }
}

/// Counts of one function in the ways in which it may be counted.
#[derive(Serialize)]
pub(super) struct Comparison {
    /// Parameters tunable, with all terms of the model.
    tunable: Operations,
    /// Values baked in, with all terms of the model.
    baked: Operations,
    /// Parameters tunable, rigid bodies alone: without friction, rotors and springs of drives.
    rigid: Operations,
    /// What the rigid bodies took in the prototypes that came before this program.
    reference: Option<Operations>,
}

/// Model, function, multiplications, additions: the best of the formulations that were tried in
/// Python before this program was written (pseudo-inertias, regrouped parameters, symbolic
/// geometry), rigid bodies alone.
const REFERENCES: [(&str, FunctionName, usize, usize); 12] = [
    ("puma560", FunctionName::InverseDynamics, 252, 224),
    ("puma560", FunctionName::MassMatrix, 150, 132),
    ("puma560", FunctionName::CoriolisMatrix, 568, 465),
    ("puma560", FunctionName::GravityVector, 35, 21),
    ("puma560", FunctionName::Bias, 233, 200),
    ("puma560", FunctionName::ForwardDynamics, 444, 403),
    ("tulip", FunctionName::InverseDynamics, 771, 724),
    ("tulip", FunctionName::MassMatrix, 789, 617),
    ("tulip", FunctionName::CoriolisMatrix, 2592, 2162),
    ("tulip", FunctionName::GravityVector, 114, 81),
    ("tulip", FunctionName::Bias, 759, 704),
    ("tulip", FunctionName::ForwardDynamics, 2194, 1898),
];

/// Counts the functions of `program`, which are those of `robot` with tunable parameters, and the
/// others to compare them with. Functions of single links are left out.
pub(super) fn compare(
    robot: &Robot,
    program: &Program,
) -> Result<Vec<(String, Comparison)>, CodeError> {
    let routines: Vec<_> =
        program.routines.iter().filter(|routine| routine.link.is_none()).collect();
    let wanted: Vec<FunctionName> = routines.iter().map(|routine| routine.name).collect();
    let baked = function_counts(robot, Flavour::Baked, &wanted)?;
    let mut rigid_robot = robot.clone();
    rigid_robot.terms = Terms { friction: false, rotor: false, ..Terms::ALL };
    for link in rigid_robot.links.values_mut() {
        link.joint.spring = None;
        link.drive = None;
    }
    let rigid = function_counts(&rigid_robot, Flavour::Tunable, &wanted)?;
    let rows = routines.iter().zip(baked.iter().zip(&rigid)).map(|(routine, (baked, rigid))| {
        let reference = REFERENCES
            .iter()
            .find(|(model, name, ..)| *model == robot.name && *name == routine.name)
            .map(|&(_, _, mul, add)| Operations { mul, add });
        let comparison = Comparison {
            tunable: (&counts(program, routine)).into(),
            baked: (&baked.counts).into(),
            rigid: (&rigid.counts).into(),
            reference,
        };
        (routine.full_name(), comparison)
    });
    Ok(rows.collect())
}

fn function_counts(
    robot: &Robot,
    flavour: Flavour,
    wanted: &[FunctionName],
) -> Result<Vec<FunctionCount>, CodeError> {
    let functions = wanted.to_vec();
    let options = CodeOptions { flavour, functions, ..CodeOptions::default() };
    Ok(Lowered::new(robot, &options)?.counts())
}

/// The comparison as a table.
pub(super) fn table(rows: &[(String, Comparison)]) -> Table {
    use Align::{Left, Right};
    let mut table = Table::new(&[
        ("function", Left),
        ("tunable", Right),
        ("baked", Right),
        ("rigid bodies, tunable", Right),
        ("best prototype", Right),
    ]);
    for (name, row) in rows {
        let show = |operations: Operations| format!("{} + {}", operations.mul, operations.add);
        table.push(vec![
            name.clone(),
            show(row.tunable),
            show(row.baked),
            show(row.rigid),
            row.reference.map_or(String::new(), show),
        ]);
    }
    table
}
