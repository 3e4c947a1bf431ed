//! A diagnosis as text.

use super::Shown;
use crate::cli::failure::Failure;
use denavit::report::{Align, Table};
use std::io::Write;

fn percent(value: f64) -> String {
    format!("{:.2} %", 100.0 * value)
}

pub(super) fn write(out: &mut dyn Write, shown: &Shown<'_>) -> Result<(), Failure> {
    let Shown { robot, model, candidates, found, remarks } = shown;
    for (file, remark) in *remarks {
        writeln!(out, "{file}: {remark}")?;
    }
    writeln!(out, "{}: {}", robot.name, found.verdict.word().replace('_', " "))?;
    for reason in &found.reasons {
        writeln!(out, "  {reason}")?;
    }
    writeln!(out, "\nwhere")?;
    for one in found.before.iter().filter(|one| one.share > 0.05) {
        writeln!(out, "  {}", one.sentence())?;
    }
    for one in &found.effects {
        let own = &candidates[one.candidate];
        let doubt = if one.is_named { "" } else { "unnamed, nearest: " };
        writeln!(out, "\n{doubt}{} at {}: closes {}", own.title, own.at, percent(one.share))?;
        for value in &one.parameters {
            writeln!(
                out,
                "  {} = {:.5} +- {:.2} {}",
                value.name, value.value, value.std, value.unit
            )?;
        }
        for other in &one.alternatives {
            writeln!(out, "  or {}", candidates[other.candidate].name())?;
        }
    }
    for one in &found.structures {
        let name = &model.joints[one.joint].name;
        let share = percent(one.share);
        writeln!(out, "\n{name} still lacks, without a name: {} ({share} of it)", one.formula())?;
    }
    if let Some(step) = found.steps.last().filter(|step| !step.is_taken) {
        writeln!(
            out,
            "\nnot taken: {}, which would close {} ({:.1} standard errors, decoys {:.0} % as much)",
            candidates[step.added].name(),
            percent(step.share),
            step.significance,
            100.0 * step.decoy / step.gain
        )?;
    }
    let mut table = Table::new(&[
        ("joint", Align::Left),
        ("before", Align::Right),
        ("after", Align::Right),
        ("floor", Align::Right),
    ]);
    let shown = |gap: Option<f64>| gap.map_or_else(String::new, percent);
    let gaps = &found.held_out;
    for (joint, described) in model.joints.iter().enumerate() {
        let cells = [&gaps.before, &gaps.after, &gaps.floor].map(|gap| shown(gap.per_joint[joint]));
        let [before, after, floor] = cells;
        table.push(vec![described.name.clone(), before, after, floor]);
    }
    let all = [&gaps.before, &gaps.after, &gaps.floor].map(|gap| percent(gap.all));
    let [before, after, floor] = all;
    table.push(vec!["all".to_owned(), before, after, floor]);
    writeln!(out, "\ngap of held-out torques\n{table}")?;
    Ok(())
}
