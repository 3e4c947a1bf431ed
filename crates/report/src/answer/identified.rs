//! What was identified, as a table.

use crate::identification::{notes, warnings};
use crate::{Align, Table, paragraph, short};
use denavit_identify::estimate::{IdentifiedParameter, JointResidual, Status};
use denavit_replay::Forward;
use denavit_workflow::{Identified, SimulationGap};
use std::fmt::{self, Write};

/// What is remarked and doubted, for whom the answer does not say it.
pub fn identified_doubts(shown: &Identified) -> String {
    let mut out = String::new();
    write_doubts(&mut out, shown).expect("text has room");
    out
}

fn write_doubts(out: &mut String, shown: &Identified) -> fmt::Result {
    for (file, remark) in &shown.remarks {
        writeln!(out, "{file}: {remark}")?;
    }
    for text in notes(&shown.found).into_iter().chain(warnings(&shown.found)) {
        writeln!(out, "{}", paragraph("", "", &text))?;
    }
    Ok(())
}

/// What was identified, as tables of text.
pub fn identified_text(shown: &Identified) -> String {
    let mut out = String::new();
    write(&mut out, shown).expect("text has room");
    out
}

fn write(out: &mut String, shown: &Identified) -> fmt::Result {
    let Identified { robot, model, found, remarks, .. } = shown;
    let solution = &found.estimate.solution;
    for (file, remark) in remarks {
        writeln!(out, "{file}: {remark}")?;
    }
    for effect in &shown.effects {
        writeln!(out, "{effect}")?;
    }
    if !(remarks.is_empty() && shown.effects.is_empty()) {
        writeln!(out)?;
    }
    let (excited, rank) = (solution.excited(), model.rank());
    writeln!(
        out,
        "{}: {excited} of {rank} base parameters are excited, condition {} (columns scaled: {})\n",
        robot.name,
        short(solution.condition),
        short(solution.scaled_condition)
    )?;
    writeln!(out, "{}", parameter_table(&found.parameters))?;
    write_residuals(out, shown)?;
    if let Some(gap) = &shown.simulated {
        write_simulation(out, gap)?;
    }
    for text in notes(found).into_iter().chain(warnings(found)) {
        writeln!(out, "\n{}", paragraph("", "", &text))?;
    }
    write_nearest(out, found.consistent.distance)
}

/// Base parameters that were found.
pub(super) fn parameter_table(parameters: &[IdentifiedParameter]) -> Table {
    let mut table = Table::new(&[
        ("parameter", Align::Left),
        ("value", Align::Right),
        ("std", Align::Right),
        ("bias/std", Align::Right),
        ("model", Align::Right),
        ("unit", Align::Left),
        ("", Align::Left),
        ("formula", Align::Left),
    ]);
    let is_biased = parameters.iter().any(IdentifiedParameter::is_biased);
    for one in parameters {
        let bias = one.noise_bias.filter(|_| is_biased);
        let status = match one.status {
            Status::Identified => "",
            Status::Uncertain => "may be 0",
            Status::NotExcited => "not excited",
        };
        let formula = if one.expression == one.name { "" } else { &one.expression };
        table.push(vec![
            one.name.clone(),
            short(one.value),
            one.std.map_or("-".to_owned(), |std| format!("{std:.1e}")),
            bias.map_or(String::new(), |bias| format!("{bias:.1}")),
            one.model_value.map_or(String::new(), short),
            one.unit.clone(),
            status.to_owned(),
            shortened(formula),
        ]);
    }
    table.without_empty_columns()
}

/// Says how far the nearest physically consistent parameters are from an estimate, in standard
/// errors, where it is not so itself.
pub(super) fn write_nearest(out: &mut String, distance: f64) -> fmt::Result {
    if distance > 1.0 {
        let text = format!(
            "The estimate is not physically consistent: the nearest one that is lies {} standard \
             errors away, over all parameters. A model file gets that.",
            short(distance)
        );
        writeln!(out, "\n{}", paragraph("", "", &text))?;
    }
    Ok(())
}

/// Long formulas are for JSON.
fn shortened(formula: &str) -> String {
    const LONGEST: usize = 60;
    if formula.chars().count() <= LONGEST {
        return formula.to_owned();
    }
    let start: String = formula.chars().take(LONGEST - 4).collect();
    format!("{start} ...")
}

fn write_residuals(out: &mut String, shown: &Identified) -> fmt::Result {
    let found = &shown.found;
    let mut table = Table::new(&[
        ("joint", Align::Left),
        ("train", Align::Right),
        ("validate", Align::Right),
        ("residual", Align::Right),
        ("correlation", Align::Right),
    ]);
    let held_out = |joint: &JointResidual| found.validate.as_ref()?.joint(&joint.name);
    let percent = |share: f64| format!("{:.2} %", 100.0 * share);
    for joint in &found.train.joints {
        let other = held_out(joint);
        table.push(vec![
            joint.name.clone(),
            percent(joint.relative),
            other.map_or(String::new(), |other| percent(other.relative)),
            short(joint.residual_rms),
            format!("{:.2}", joint.autocorrelation.first().copied().unwrap_or(0.0)),
        ]);
    }
    let all = found.validate.as_ref().map_or(String::new(), |all| percent(all.relative));
    table.push(vec!["all".to_owned(), percent(found.train.relative), all]);
    write!(out, "{}", table.without_empty_columns())?;
    let before = match found.before {
        Some(before) => format!("a residual of {} of the torque", percent(before)),
        None => {
            let without = found.parameters.iter().filter(|one| one.model_value.is_none());
            let names: Vec<&str> = without.map(|one| one.name.as_str()).collect();
            format!("not known, since the model has no value of {}", names.join(", "))
        }
    };
    writeln!(
        out,
        "\n{}",
        paragraph("", "", &format!("before, with the nominal parameters: {before}"))
    )?;
    Ok(())
}

fn write_simulation(out: &mut String, gap: &SimulationGap) -> fmt::Result {
    let [before, after] = [&gap.before, &gap.after].map(|made| made.as_ref().ok());
    if gap.kind().is_some() {
        writeln!(out, "\n{}", paragraph("", "", &format!("Logs {}:", gap.method())))?;
        let names = [
            "joint",
            "position before",
            "after",
            "velocity before",
            "after",
            "torque before",
            "after",
        ];
        let align = |at: usize| if at == 0 { Align::Left } else { Align::Right };
        let columns: Vec<(&str, Align)> =
            names.into_iter().enumerate().map(|(at, name)| (name, align(at))).collect();
        let mut table = Table::new(&columns);
        let percent = |share: Option<f64>| {
            share.map_or(String::new(), |share| format!("{:.3} %", 100.0 * share))
        };
        for joint in after.or(before).map_or(&[][..], |made| &made.joints) {
            let of = |made: Option<&Forward>| {
                made?.joints.iter().find(|other| other.name == joint.name).cloned()
            };
            let both = [of(before), of(after)];
            let mut row = vec![joint.name.clone()];
            for made in &both {
                row.push(percent(made.as_ref().map(|one| one.position.relative)));
            }
            for made in &both {
                row.push(percent(made.as_ref().map(|one| one.rate.relative)));
            }
            for made in &both {
                let torque = made.as_ref().and_then(|one| one.torque.as_ref());
                row.push(percent(torque.map(|one| one.relative)));
            }
            table.push(row);
        }
        let mut all = vec!["all".to_owned()];
        all.extend([before, after].map(|made| percent(made.map(Forward::relative))));
        table.push(all);
        write!(out, "{}", table.without_empty_columns())?;
    }
    for reason in gap.reasons() {
        writeln!(out, "\n{}", paragraph("", "", &reason))?;
    }
    Ok(())
}
