//! A diagnosis as a page of HTML.

use super::Arguments;
use crate::cli::logs::listed;
use denavit::report::answer::DiagnosisFolder;
use denavit::report::html::{Fact, Page};
use denavit::report::{DiagnosisPage, DiagnosisSource};
use denavit::workflow::Diagnosed;

pub(super) fn of(arguments: &Arguments, shown: &Diagnosed, folder: &DiagnosisFolder) -> Page {
    let filters = shown.found.filters;
    let facts = [
        ("verdict", shown.found.verdict.word().replace('_', " ")),
        ("denavit", env!("CARGO_PKG_VERSION").to_owned()),
        ("model", format!("{}, content {:016x}", shown.robot.name, shown.robot.hash)),
        ("searched", listed(&arguments.train)),
        ("judged with", listed(&arguments.validate)),
        ("effects tried", format!("{} in all places", shown.candidates.len())),
        (
            "filters",
            format!("motion {:.3} Hz, torques {:.3} Hz", filters.motion_hz, filters.torque_hz),
        ),
        ("seed", arguments.seed.to_string()),
    ];
    let facts = facts.map(|(name, value)| Fact { name: name.to_owned(), value });
    let mut remarks: Vec<String> =
        shown.remarks.iter().map(|(file, remark)| format!("{file}: {remark}")).collect();
    remarks.extend(shown.model_effects.iter().map(ToString::to_string));
    remarks.extend(folder.about_model());
    let joints: Vec<&str> = shown.model.joints.iter().map(|joint| joint.name.as_str()).collect();
    DiagnosisPage::new(DiagnosisSource {
        robot: &shown.robot,
        facts: &facts,
        remarks: &remarks,
        joints: &joints,
        candidates: &shown.candidates,
        effects: &shown.effects,
        found: &shown.found,
    })
    .page()
}
