//! What was identified, as a page of HTML.

use super::{Arguments, IdentifyFailure, Shown};
use crate::cli::failure::Failure;
use clap::ValueEnum;
use denavit::model::Robot;
use denavit::report::html::Fact;
use denavit::report::{IdentificationPage, SimulationPart};
use std::path::PathBuf;

/// What an identification is made of.
pub(super) fn facts(arguments: &Arguments, robot: &Robot) -> Vec<Fact> {
    let list = |paths: &[PathBuf]| {
        let names: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
        names.join(", ")
    };
    let facts = [
        ("denavit", env!("CARGO_PKG_VERSION").to_owned()),
        ("model", format!("{}, content {:016x}", robot.name, robot.hash)),
        ("estimated from", list(&arguments.train)),
        ("judged with", list(&arguments.validate)),
        ("method", word(arguments.method)),
        ("standard errors", word(arguments.errors)),
        ("seed", arguments.seed.to_string()),
    ];
    let given = facts.into_iter().filter(|(_, value)| !value.is_empty());
    given.map(|(name, value)| Fact { name: name.to_owned(), value }).collect()
}

pub(super) fn of(arguments: &Arguments, shown: &Shown<'_>) -> Result<String, Failure> {
    let facts = facts(arguments, shown.robot);
    let mut remarks: Vec<String> =
        shown.remarks.iter().map(|(file, remark)| format!("{file}: {remark}")).collect();
    remarks.extend(shown.effects.iter().map(ToString::to_string));
    let told = shown.simulated.map(|gap| (gap, gap.method(), gap.reasons()));
    let simulation = told.as_ref().map(|(gap, method, reasons)| SimulationPart {
        method,
        before: gap.before.as_ref().ok(),
        after: gap.after.as_ref().ok(),
        reasons,
    });
    let page = IdentificationPage {
        model: &shown.robot.name,
        facts: &facts,
        remarks: &remarks,
        found: shown.found,
        simulation,
    };
    Ok(page.page().map_err(IdentifyFailure::Formula)?.render())
}

/// The word by which an option's value is given.
fn word(value: impl ValueEnum) -> String {
    value.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}
