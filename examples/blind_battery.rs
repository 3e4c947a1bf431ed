//! The blind battery: cases in which an effect is hidden, and how a diagnosis does on them.
//!
//! `blind_battery --case N --out DIR [--count K]` writes `DIR/N/model.json`, `train.csv`,
//! `validate.csv` and, not to be looked at before the diagnosis has answered, `answer.json`.
//! With `--diagnose DENAVIT`, the path of the command, each case is diagnosed as soon as it is
//! written, and `DIR/report.md` has the figures; what it said stays in `DIR/N/said.json` and is not
//! asked for again. `--case suite` takes the cases of the tests, `--case
//! reported` those of the reported run. docs/evidence/battery.md describes it.

use denavit_blind::battery::{Files, answer, examine, report, reported, suite};
use denavit_blind::case::Case;
use denavit_blind::score::Answer;
use std::error::Error;
use std::path::{Path, PathBuf};

const USAGE: &str = "--case N|suite|reported --out DIR [--count K] [--diagnose DENAVIT]";

fn main() -> Result<(), Box<dyn Error>> {
    let (mut case, mut count, mut out, mut command) = (None, 1, None, None);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let value = arguments.next().ok_or(format!("{argument}: a value is missing"))?;
        match argument.as_str() {
            "--case" => case = Some(value),
            "--count" => count = value.parse::<u64>()?,
            "--out" => out = Some(PathBuf::from(value)),
            "--diagnose" => command = Some(PathBuf::from(value)),
            _ => return Err(format!("{argument}: {USAGE}").into()),
        }
    }
    let (Some(case), Some(out)) = (case, out) else { return Err(USAGE.into()) };
    let numbers: Vec<u64> = match case.as_str() {
        "suite" => suite(),
        "reported" => reported().collect(),
        number => {
            let first = number.parse()?;
            (first..first + count).collect()
        }
    };
    let mut scores = Vec::new();
    for number in numbers {
        if let Some(command) = &command {
            let score = examine(number, &out, |files| run(command, files))?;
            let verdict = if score.right { "right" } else { "wrong" };
            let (truth, said) = (score.truth.join(" + "), score.said.join(" + "));
            println!("{number} {}: {truth} -> {said}: {verdict}", score.level);
            scores.push(score);
            std::fs::write(out.join("report.md"), report(&scores))?;
        } else {
            let folder = out.join(number.to_string());
            let generated = Case::new(number).generate();
            generated.write_files(&folder)?;
            generated.write_answer(&folder)?;
            println!("{}", folder.display());
        }
    }
    Ok(())
}

/// The command's answer, also from an earlier run; one that failed has none, which is always
/// wrong.
fn run(command: &Path, files: Files<'_>) -> Answer {
    let said = files.model.with_file_name("said.json");
    let parsed = |bytes: &[u8]| serde_json::from_slice(bytes).ok().map(|value| answer(&value));
    if let Some(before) = std::fs::read(&said).ok().and_then(|bytes| parsed(&bytes)) {
        return before;
    }
    let output = denavit_blind::battery::command(command, files).output();
    let failed = |why: &str| {
        eprintln!("{}: {why}", files.model.display());
        Answer { verdict: "failed".into(), ..Answer::default() }
    };
    match output {
        Err(error) => failed(&error.to_string()),
        Ok(output) => match parsed(&output.stdout) {
            Some(answer) => {
                // a run that is broken off goes on from here
                let _ = std::fs::write(&said, &output.stdout);
                answer
            }
            None => failed(&String::from_utf8_lossy(&output.stderr)),
        },
    }
}
