//! A diagnosis as text.

use super::diagnosis_folder::DiagnosisFolder;
use crate::diagnosis::closes;
use crate::{Align, Table, paragraph, percent, short, verdict_paragraph};
use denavit_diagnose::{
    Candidate, EffectValue, FoundEffect, Gap, Gaps, MotionGap, MotionGaps, Visible,
};
use denavit_workflow::Diagnosed;
use std::fmt::{self, Write};

/// A diagnosis as text, with the files of its folder if there is one.
pub fn diagnosed_text(shown: &Diagnosed, folder: Option<&DiagnosisFolder>) -> String {
    let mut out = String::new();
    write(&mut out, shown, folder).expect("text has room");
    out
}

fn write(out: &mut String, shown: &Diagnosed, folder: Option<&DiagnosisFolder>) -> fmt::Result {
    let Diagnosed { robot, candidates, found, remarks, .. } = shown;
    writeln!(out, "{}: {}", robot.name, found.verdict.word().replace('_', " "))?;
    for [log, searched] in shown.searched_again() {
        let said = format!(
            "{log} says the same as {searched}, which was searched: nothing is judged \
                            by it. Judge by a log of another motion."
        );
        writeln!(out, "{}", paragraph("", "", &said))?;
    }
    writeln!(out, "{}", paragraph("", "", &verdict_paragraph(found, candidates)))?;
    let places: Vec<String> = found
        .before
        .iter()
        .filter(|one| one.share > 0.05)
        .map(|one| format!("  {}", one.sentence()))
        .collect();
    if !places.is_empty() {
        writeln!(out, "\nwhere\n{}", places.join("\n"))?;
    }
    given(out, shown)?;
    found.effects.iter().try_for_each(|one| effect(out, shown, one))?;
    for one in &found.structures {
        let name = &one.at;
        let share = percent(one.share);
        writeln!(out, "\n{name} still lacks, without a name: {} ({share} of it)", one.formula())?;
    }
    if let Some(step) = found.steps.last().filter(|step| !step.is_taken && step.log_odds > 0.0) {
        writeln!(
            out,
            "\nnot named: {}, odds {}, {} of the torque",
            candidates[step.added].name(),
            odds(step.log_odds),
            percent(step.size)
        )?;
    }
    if found.effects.is_empty() {
        visible(out, shown)?;
    }
    gaps(out, shown)?;
    motion(out, shown)?;
    for (file, remark) in remarks {
        writeln!(out, "{file}: {remark}")?;
    }
    folder.map_or(Ok(()), |folder| files(out, shown, folder))
}

/// Odds in words: as powers of ten where they are large.
fn odds(log_odds: f64) -> String {
    let tens = log_odds / std::f64::consts::LN_10;
    if tens.abs() < 3.0 { format!("{:.2}", log_odds.exp()) } else { format!("10^{tens:.0}") }
}

/// Effects that are listed for each joint: those that are seen worst.
const WORST: usize = 3;

/// How small effects would have been seen.
fn visible(out: &mut String, shown: &Diagnosed) -> fmt::Result {
    for (joint, described) in shown.model.joints.iter().enumerate() {
        let mut own: Vec<&Visible> =
            shown.found.visible.iter().filter(|one| one.joint.0 == joint).collect();
        own.sort_by(|a, b| b.share.total_cmp(&a.share));
        let worst = own.iter().take(WORST).map(|one| {
            let Candidate { effect, law, .. } = &shown.candidates[one.candidate];
            match one.least.is_finite() {
                true => format!("{effect} from {} {}", short(one.least), law.parameters()[0].unit),
                false => format!("{effect} never"),
            }
        });
        let worst: Vec<String> = worst.collect();
        if !worst.is_empty() {
            writeln!(out, "seen worst at {}: {}", described.name, worst.join(", "))?;
        }
    }
    Ok(())
}

/// What the model has of effects.
fn given(out: &mut String, shown: &Diagnosed) -> fmt::Result {
    if shown.model_effects.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nof the model itself")?;
    for effect in &shown.model_effects {
        writeln!(out, "  {effect}")?;
        for one in &shown.found.given {
            let own = &shown.candidates[one.candidate];
            if effect.is_of(own) {
                one.parameters.iter().try_for_each(|one| writeln!(out, "    {}", value(one)))?;
            }
        }
    }
    Ok(())
}

/// A parameter with its error.
fn value(value: &EffectValue) -> String {
    let std = match value.std.is_finite() {
        true => format!("+- {:.1e}", value.std),
        false => "(not determined)".to_owned(),
    };
    format!("{} = {} {std} {}", value.name, short(value.value), value.unit).trim_end().to_owned()
}

fn effect(out: &mut String, shown: &Diagnosed, one: &FoundEffect) -> fmt::Result {
    let own = &shown.candidates[one.candidate];
    let doubt = if one.is_named { "" } else { "unnamed, nearest: " };
    writeln!(
        out,
        "\n{doubt}{} ({}) at {}: odds {}, {} of the torque, {}",
        own.title,
        own.effect,
        own.at_in_words(),
        odds(one.log_odds),
        percent(one.size),
        closes(one)
            .map_or_else(|| "closes nothing alone".to_owned(), |share| format!("closes {share}"))
    )?;
    one.parameters.iter().try_for_each(|one| writeln!(out, "  {}", value(one)))?;
    for other in &one.alternatives {
        let name = shown.candidates[other.candidate].name();
        let exact = if other.is_exact { "; no motion tells them apart" } else { "" };
        writeln!(out, "  or {name}, odds {} against it{exact}", odds(other.log_odds))?;
    }
    for other in &one.finer {
        let name = &shown.candidates[other.candidate].effect;
        writeln!(out, "  finer, not asked for: {name}, odds {} against it", odds(other.log_odds))?;
    }
    match &one.experiment {
        Some(Ok(found)) => writeln!(
            out,
            "  a motion of {} s tells them apart in {} of logs like these (separation {}; these \
             logs: {})",
            found.duration_s,
            percent(found.power),
            short(found.separation),
            short(found.separation_before)
        )?,
        Some(Err(reason)) => writeln!(out, "  no motion is found to tell them apart: {reason}")?,
        None => {}
    }
    Ok(())
}

fn gaps(out: &mut String, shown: &Diagnosed) -> fmt::Result {
    use Align::{Left, Right};
    let mut table = Table::new(&[
        ("joint", Left),
        ("train before", Right),
        ("after", Right),
        ("noise", Right),
        ("held out before", Right),
        ("after", Right),
        ("noise", Right),
    ]);
    let found = &shown.found;
    let row = |name: &str, value: &dyn Fn(&Gap) -> Option<f64>| -> Vec<String> {
        let sets = [&found.train, &found.held_out];
        let gaps =
            sets.into_iter().flat_map(|Gaps { before, after, floor, .. }| [before, after, floor]);
        let cells = gaps.map(|gap| value(gap).map_or_else(String::new, percent));
        std::iter::once(name.to_owned()).chain(cells).collect()
    };
    for (place, name) in found.places.iter().enumerate() {
        let of_place = |gap: &Gap| gap.per_joint.get(place).copied().flatten();
        table.push(row(name, &of_place));
    }
    table.push(row("all", &|gap| Some(gap.all)));
    writeln!(out, "\ntorque mismatch: size of the residual over that of the torque\n{table}")?;
    Ok(())
}

/// The gap of the models in motion.
fn motion(out: &mut String, shown: &Diagnosed) -> fmt::Result {
    use Align::{Left, Right};
    let MotionGaps { train, held_out } = match &shown.found.motion {
        None => return Ok(()),
        Some(Err(reason)) => return writeln!(out, "not simulated: {reason}\n"),
        Some(Ok(gaps)) => gaps,
    };
    let mut table = Table::new(&[
        ("joint", Left),
        ("train before", Right),
        ("after", Right),
        ("held out before", Right),
        ("after", Right),
    ]);
    let row = |name: &str, value: &dyn Fn(&MotionGap) -> Option<f64>| -> Vec<String> {
        let cells = train.iter().chain(held_out);
        let cells = cells.map(|gap| value(gap).map_or_else(String::new, percent));
        std::iter::once(name.to_owned()).chain(cells).collect()
    };
    for (joint, described) in shown.model.joints.iter().enumerate() {
        let of_joint = |gap: &MotionGap| gap.per_joint.get(joint).copied().flatten();
        table.push(row(&described.name, &of_joint));
    }
    table.push(row("all", &|gap| Some(gap.all)));
    let what = "simulation mismatch: errors of positions in windows of 0.2 s under measured \
                torques, over how far joints went";
    writeln!(out, "{what}\n{table}")
}

fn files(out: &mut String, shown: &Diagnosed, folder: &DiagnosisFolder) -> fmt::Result {
    for (path, what) in folder.files(shown) {
        writeln!(out, "wrote {}: {what}", path.display())?;
    }
    if let Some(remark) = folder.about_model() {
        writeln!(out, "{remark}")?;
    }
    Ok(())
}
