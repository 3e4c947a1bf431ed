//! What is said of an excitation, as text and as JSON.

use crate::{Align, ExcitationPicture, Table, excitation_picture, paragraph, short};
use denavit_codegen::model::Robot;
use denavit_excite::{
    Check, ExciteOptions, Excited, Extremes, JointUse, LimitKind, Stack, StartReport,
};
use denavit_workflow::EffectUse;
use serde_json::{Value, json};
use std::fmt::{self, Write};

/// A trajectory that was found or checked.
#[derive(Clone, Copy, Debug)]
pub struct ExcitationAnswer<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// What becomes of the model's effects: limits of torques are kept without those left out.
    pub effects: &'a [EffectUse],
    /// Which columns are excited.
    pub stack: &'a Stack,
    /// The trajectory against its limits.
    pub check: &'a Check,
    /// How it was found, if it was looked for.
    pub excited: Option<&'a Excited>,
}

/// A trajectory that was looked for as a trajectory file; remarks say how it was found.
pub fn excited_trajectory(found: &Excited, options: &ExciteOptions) -> String {
    let check = &found.found().ended;
    let model = &found.model.regression.model;
    let remarks = json!({
        "denavit": env!("CARGO_PKG_VERSION"),
        "condition": check.excitation.condition,
        "condition_scaled": check.excitation.condition_scaled,
        "feasible": check.is_feasible(),
        "seed": options.seed,
        "start": found.best + 1,
        "starts": options.starts,
    });
    format!("{:#}\n", found.to_json(&format!("{model}_excitation"), &remarks))
}

/// The picture of a trajectory that was looked for.
pub fn drawn_excitation(found: &Excited) -> String {
    let check = &found.found().ended;
    let model = &found.model.regression.model;
    let title = format!("{}: exciting trajectory", model.replace('_', " "));
    let subtitle = format!(
        "condition {:.1} (columns of length 1: {:.1}), {}",
        check.excitation.condition,
        check.excitation.condition_scaled,
        if check.is_feasible() { "within all limits" } else { "outside of a limit" },
    );
    let picture = ExcitationPicture { title: &title, subtitle: &subtitle, excited: found };
    excitation_picture(&picture)
}

/// An excitation as JSON.
pub fn excited_json(found: &ExcitationAnswer<'_>) -> Value {
    let check = found.check;
    let mut answer = json!({
        "model": found.robot.name,
        "feasible": check.is_feasible(),
        "condition": finite(check.excitation.condition),
        "condition_scaled": finite(check.excitation.condition_scaled),
        "log_determinant": finite(check.excitation.log_determinant),
        "worst_use": finite(check.limits.worst()),
        "columns": found.stack.names,
        "not_excited": found.stack.left_out,
        "joints": check.limits.joints.iter().map(joint).collect::<Vec<_>>(),
        "lowest_point": check.limits.lowest.as_ref().map(|(point, height)| json!({
            "point": point, "height_m": finite(*height),
            "clearance_m": finite(check.limits.clearance_m),
        })),
        "assumed_limits": check.limits.assumed.iter().map(|(joint, limit, value)| json!({
            "joint": joint, "limit": limit.key(), "value": value,
        })).collect::<Vec<_>>(),
    });
    if !found.effects.is_empty() {
        answer["effects"] = json!(found.effects);
    }
    if let Some(excited) = found.excited {
        answer["start"] = json!(excited.best + 1);
        answer["starts"] = excited.starts.iter().map(start).collect();
    }
    answer
}

fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

fn joint(joint: &JointUse) -> Value {
    let of = |extremes: &Option<Extremes>| {
        extremes.as_ref().map(|e| json!({ "range": e.range, "limits": e.limits, "use": e.usage }))
    };
    json!({
        "name": joint.name,
        "position": of(&joint.position),
        "velocity": of(&joint.velocity),
        "acceleration": of(&joint.acceleration),
        "torque": of(&joint.torque),
    })
}

fn start(start: &StartReport) -> Value {
    json!({
        "condition_at_start": finite(start.began.excitation.condition),
        "feasible_at_start": start.began.is_feasible(),
        "condition": finite(start.ended.excitation.condition),
        "feasible": start.ended.is_feasible(),
        "objective": finite(start.objective),
        "worst_use": finite(start.ended.limits.worst()),
        "evaluations": start.evaluations,
        "stop": start.stop.word(),
        "shrunk": start.shrunk,
    })
}

/// An excitation as text.
pub fn excited_text(found: &ExcitationAnswer<'_>) -> String {
    let mut out = String::new();
    write(&mut out, found).expect("text has room");
    out
}

fn write(out: &mut String, found: &ExcitationAnswer<'_>) -> fmt::Result {
    let check = found.check;
    let columns = found.stack.names.len();
    writeln!(
        out,
        "{}: {columns} base parameters, condition {}, of columns of length 1 {}",
        found.robot.name,
        shown(check.excitation.condition),
        shown(check.excitation.condition_scaled)
    )?;
    for effect in found.effects {
        writeln!(out, "{}", paragraph("", "  ", &effect.to_string()))?;
    }
    if !found.stack.left_out.is_empty() {
        let text = format!("not excited by what moves: {}", found.stack.left_out.join(", "));
        writeln!(out, "{}", paragraph("", "  ", &text))?;
    }
    if !check.limits.assumed.is_empty() {
        let of = |(joint, limit, value): &(String, LimitKind, f64)| {
            format!("{} of {joint} {}", limit.key(), short(*value))
        };
        let listed: Vec<String> = check.limits.assumed.iter().map(of).collect();
        let text = format!(
            "limits that the model does not give, and that were taken from one sine a lap over the \
             whole range: {}\n  hint: `limits` of a joint in the model file can state them; low \
             ones make the motion weak",
            listed.join(", ")
        );
        writeln!(out, "{}", paragraph("", "  ", &text))?;
    }
    writeln!(out, "\n{}", uses(check))?;
    if let Some((point, height)) = &check.limits.lowest {
        writeln!(
            out,
            "lowest point: {point}, {height:.4} m above the ground ({:.4} m to be kept)\n",
            check.limits.clearance_m
        )?;
    }
    if let Some(excited) = found.excited {
        writeln!(out, "{}", starts(excited))?;
    }
    match check.is_feasible() {
        true => writeln!(out, "within all limits")?,
        false => {
            writeln!(
                out,
                "outside of a limit: {:.2} % of its range",
                100.0 * check.limits.worst()
            )?;
        }
    }
    if !check.excites() {
        writeln!(out, "not all base parameters are excited: some are as good as invisible")?;
    }
    Ok(())
}

fn shown(number: f64) -> String {
    match number {
        number if !number.is_finite() => "infinite".to_owned(),
        number if number < 1e5 => format!("{number:.2}"),
        number => format!("{number:.3e}"),
    }
}

/// Ranges and the largest use of each limit.
fn uses(check: &Check) -> Table {
    let mut table = Table::new(&[
        ("joint", Align::Left),
        ("position", Align::Right),
        ("use", Align::Right),
        ("velocity", Align::Right),
        ("use", Align::Right),
        ("acceleration", Align::Right),
        ("use", Align::Right),
        ("torque", Align::Right),
        ("use", Align::Right),
    ]);
    for joint in &check.limits.joints {
        let all = [&joint.position, &joint.velocity, &joint.acceleration, &joint.torque];
        let mut cells = vec![joint.name.clone()];
        for extremes in all {
            match extremes {
                Some(Extremes { range: [low, high], usage, .. }) => {
                    cells.push(format!("{low:.3} .. {high:.3}"));
                    cells.push(format!("{:.1} %", 100.0 * usage));
                }
                None => cells.extend(["".to_owned(), "".to_owned()]),
            }
        }
        table.push(cells);
    }
    table.without_empty_columns()
}

fn starts(excited: &Excited) -> Table {
    let mut table = Table::new(&[
        ("start", Align::Right),
        ("condition", Align::Right),
        ("worst use", Align::Right),
        ("->", Align::Left),
        ("condition", Align::Right),
        ("worst use", Align::Right),
        ("evaluations", Align::Right),
        ("stopped by", Align::Left),
        ("", Align::Left),
    ]);
    for (index, start) in excited.starts.iter().enumerate() {
        let percent = |check: &Check| format!("{:.1} %", 100.0 * check.limits.worst());
        table.push(vec![
            (index + 1).to_string(),
            shown(start.began.excitation.condition),
            percent(&start.began),
            "->".to_owned(),
            shown(start.ended.excitation.condition),
            percent(&start.ended),
            start.evaluations.to_string(),
            start.stop.word().to_owned(),
            if index == excited.best { "taken".to_owned() } else { String::new() },
        ]);
    }
    table
}
