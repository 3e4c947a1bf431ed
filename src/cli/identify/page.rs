//! What was identified, as a page of HTML.

use super::arguments::{Arguments, ErrorsName, MethodName};
use crate::cli::failure::{Failure, Misuse};
use crate::cli::flags::by_flag;
use crate::cli::logs::listed;
use clap::ValueEnum;
use denavit::model::Robot;
use denavit::report::html::Fact;
use denavit::report::{IdentificationPage, SimulationPart};
use denavit::workflow::{Identified, Logs};

/// The words by which method, errors and seed are given.
pub(super) type Words = [String; 3];

/// Those that are given.
pub(super) fn words(arguments: &Arguments) -> Words {
    [word(arguments.method), word(arguments.errors), arguments.seed.to_string()]
}

/// Those of an identification by default.
pub(super) fn default_words() -> Words {
    [word(MethodName::default()), word(ErrorsName::default()), "1".to_owned()]
}

/// What an identification is made of.
pub(super) fn facts(robot: &Robot, logs: &Logs, [method, errors, seed]: Words) -> Vec<Fact> {
    let facts = [
        ("denavit", env!("CARGO_PKG_VERSION").to_owned()),
        ("model", format!("{}, content {:016x}", robot.name, robot.hash)),
        ("estimated from", listed(&logs.train)),
        ("judged with", listed(&logs.held_out)),
        ("method", method),
        ("standard errors", errors),
        ("seed", seed),
    ];
    let given = facts.into_iter().filter(|(_, value)| !value.is_empty());
    given.map(|(name, value)| Fact { name: name.to_owned(), value }).collect()
}

pub(super) fn of(
    facts: &[Fact],
    identified: &Identified,
    is_good: bool,
) -> Result<String, Failure> {
    let Identified { robot, model, found, remarks, effects, simulated, .. } = identified;
    let mut notes: Vec<String> =
        remarks.iter().map(|(file, remark)| format!("{file}: {remark}")).collect();
    notes.extend(effects.iter().map(ToString::to_string));
    let told = simulated.as_ref().map(|gap| (gap, gap.method(), gap.reasons()));
    let simulation = told.as_ref().map(|(gap, method, reasons)| SimulationPart {
        method,
        before: gap.before.as_ref().ok(),
        after: gap.after.as_ref().ok(),
        reasons,
    });
    let updated = identified.updated.as_ref().ok();
    let page = IdentificationPage {
        robot,
        model,
        updated,
        facts,
        remarks: &notes,
        found,
        is_good,
        simulation,
    };
    let page = page.page().map_err(Misuse::Formula)?;
    Ok(page.rewritten(|text| by_flag(text).into_owned()).render())
}

/// The word by which an option's value is given.
fn word(value: impl ValueEnum) -> String {
    value.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}
