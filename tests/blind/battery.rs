//! The battery as a whole: every case is written to files, diagnosed by somebody who gets the files
//! alone, and scored.

use super::case::Case;
use super::design::{CONDITION_ROWS, CONDITIONS_FROM, Kind, Plan, ROWS, plan};
use super::hidden::Law;
use super::score::{Answer, Named, Score, by_condition, confusion, score, table};
use serde_json::Value;
use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::process::Command;

/// The files of a case that a diagnosis sees.
#[derive(Clone, Copy, Debug)]
pub struct Files<'a> {
    pub model: &'a Path,
    pub train: &'a Path,
    pub validate: &'a Path,
}

/// Where the numbers of the reported run begin.
const REPORTED: u64 = 11_000;

/// Numbers of the reported run: those of the first rows, then those with conditions of real logs.
pub fn reported() -> impl Iterator<Item = u64> {
    let behind = CONDITIONS_FROM + REPORTED;
    (REPORTED..REPORTED + ROWS as u64).chain(behind..behind + CONDITION_ROWS as u64)
}

/// Generates a case below `folder`, has it diagnosed and scores the answer. The sealed answer is
/// written after the diagnosis.
pub fn examine(
    number: u64,
    folder: &Path,
    diagnose: impl FnOnce(Files<'_>) -> Answer,
) -> io::Result<Score> {
    let generated = Case::new(number).generate();
    let folder = folder.join(number.to_string());
    generated.write_files(&folder)?;
    let [model, train, validate] =
        ["model.json", "train.csv", "validate.csv"].map(|name| folder.join(name));
    let answer = diagnose(Files { model: &model, train: &train, validate: &validate });
    generated.write_answer(&folder)?;
    Ok(score(&generated, &answer))
}

/// Tables of a run: of the first rows, and beside them of those with conditions of real logs.
pub fn report(scores: &[Score]) -> String {
    let (first, behind): (Vec<Score>, Vec<Score>) =
        scores.iter().cloned().partition(|score| score.condition.is_none());
    let mut text = String::new();
    if !first.is_empty() {
        text += &tables(&first);
    }
    if !behind.is_empty() {
        let apart = if first.is_empty() { "" } else { "\n" };
        text += &format!("{apart}## Conditions of real logs\n\n");
        text += &format!("{}\n{}", by_condition(&behind), tables(&behind));
    }
    text
}

fn tables(scores: &[Score]) -> String {
    let missed = scores.iter().filter(|score| !score.right).map(|score| {
        let Score { number, kind, level, truth, said, found, false_names, .. } = score;
        let condition = score.condition.map_or(String::new(), |one| format!(", {one:?}"));
        format!(
            "| {number} | {kind:?}{condition} | {level} | {} | {} | {found} | {false_names} |\n",
            truth.join(" + "),
            said.join(" + ")
        )
    });
    let heading = "| case | kind | strength | hidden | said | found | false |\n\
                   |---:|---|---|---|---|---:|---:|\n";
    let missed: String = missed.collect();
    format!("{}\n{}\n{heading}{missed}", table(scores), confusion(scores))
}

/// The command for a case.
pub fn command(denavit: &Path, files: Files<'_>) -> Command {
    let mut command = Command::new(denavit);
    command.arg("diagnose").arg(files.model).arg("--json");
    command.arg("--train").arg(files.train).arg("--validate").arg(files.validate);
    command
}

/// An answer from the JSON that the command prints: effects without a name of the catalogue are
/// called `unnamed` or have none.
pub fn answer(value: &Value) -> Answer {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let effects = value["effects"].as_array().map_or(&[][..], Vec::as_slice);
    let numbers = |effect: &Value| -> BTreeMap<String, [f64; 2]> {
        let entries = effect["parameters"].as_object().into_iter().flatten();
        let pair = |entry: &Value| Some([entry["value"].as_f64()?, entry["std"].as_f64()?]);
        entries.filter_map(|(name, entry)| Some((name.clone(), pair(entry)?))).collect()
    };
    let named = |effect: &Value| {
        let name = text(&effect["effect"]);
        // A law of two joints acts on the first.
        let joint = |one: &Value| {
            let at = one["at"].as_str().filter(|at| *at != "model")?;
            Some(at.split(" with ").next().unwrap_or(at).to_owned())
        };
        let others = effect["indistinguishable"].as_array().map_or(&[][..], Vec::as_slice);
        Named {
            name: if name == "unnamed" { String::new() } else { name },
            joint: joint(effect),
            others: others.iter().map(|one| (text(&one["effect"]), joint(one))).collect(),
            parameters: numbers(effect),
        }
    };
    Answer {
        verdict: text(&value["verdict"]),
        effects: effects.iter().map(named).collect(),
        closed: value["share_closed"].as_f64(),
    }
}

/// Effects that the test suite looks for, each once, on a small robot.
const SUITE: [Law; 18] = [
    Law::Coulomb,
    Law::Viscous,
    Law::TorqueOffset,
    Law::AsymmetricViscous,
    Law::Stribeck,
    Law::Dahl,
    Law::LoadFriction,
    Law::QuadraticDrag,
    Law::RotorInertia,
    Law::ReturnSpring,
    Law::HardeningSpring,
    Law::Cogging,
    Law::TorqueDelay,
    Law::TorqueGain,
    Law::JointZero,
    Law::Payload,
    Law::BaseTilt,
    Law::Coriolis,
];

/// Numbers of the cases for the test suite, all for tuning: 31.
pub fn suite() -> Vec<u64> {
    let first = |fits: &dyn Fn(&Plan) -> bool| (0..1000).find(|number| fits(&plan(*number)));
    let single = |law: Law| {
        let one = move |plan: &Plan, robot: usize| {
            plan.kind == Kind::Single && plan.laws == [law] && plan.robot <= robot
        };
        // seen without doubt if there is such a case; on a small robot if there is one
        first(&|plan| one(plan, 2) && plan.strength < 2).or_else(|| first(&|plan| one(plan, 5)))
    };
    let nothing = |robot: usize| first(&|plan| plan.kind == Kind::Nothing && plan.robot == robot);
    let other = |kind: Kind, laws: usize| {
        first(&|plan| plan.kind == kind && plan.robot != 3 && plan.laws.len() == laws)
    };
    let mut numbers: Vec<Option<u64>> = SUITE.into_iter().map(single).collect();
    numbers.extend((0..6).map(nothing));
    numbers.push(other(Kind::Pair, 2));
    numbers.push(first(&|plan| plan.laws == [Law::ProductCoupling]));
    numbers.push(first(&|plan| plan.laws == [Law::Magnet]));
    numbers.push(first(&|plan| plan.kind == Kind::CannotTell && plan.still));
    numbers.push(first(&|plan| plan.kind == Kind::CannotTell && !plan.still && plan.robot < 3));
    numbers.push(other(Kind::Thesis, 3));
    numbers.push(other(Kind::Thesis, 1));
    numbers.into_iter().flatten().collect()
}
