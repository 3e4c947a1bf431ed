//! A designed gait as a scenario file (`"denavit-scenario/1"`), complete: what `simulate` walks.

use super::design::LimitCycle;
use super::following::joint_gains;
use super::planned::PlannedPhase;
use denavit_plants::PlantModel;
use std::fmt::Write;

/// What a scenario file says besides the gait.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioHead<'a> {
    /// Its name.
    pub name: &'a str,
    /// What it shows.
    pub description: &'a str,
    /// What it was made of.
    pub source: &'a str,
    /// The model: a shipped name or a file.
    pub model: &'a str,
    /// Steps of the run.
    pub steps: usize,
}

/// The scenario file of a gait; the same gait gives the same bytes.
pub fn scenario_text(gait: &LimitCycle, model: &PlantModel, head: &ScenarioHead<'_>) -> String {
    let mut text = String::from("{\n  \"format\": \"denavit-scenario/1\",\n");
    for (key, value) in [
        ("name", head.name),
        ("description", head.description),
        ("source", head.source),
        ("model", head.model),
    ] {
        line(&mut text, 1, key, &quoted(value), true);
    }
    let start = &gait.cycle.start;
    line(&mut text, 1, "duration_s", &number(head.steps as f64 * gait.step.period_s), true);
    text.push_str("  \"initial\": {\n");
    line(&mut text, 2, "t_s", &number(start.t_s), true);
    for (key, values) in [("q", &start.q), ("qd", &start.qd)] {
        let _ = writeln!(text, "    \"{key}\": {{");
        for (index, (joint, value)) in model.joints.iter().zip(values).enumerate() {
            line(&mut text, 3, &joint.name, &number(*value), index + 1 < values.len());
        }
        text.push_str("    },\n");
    }
    line(&mut text, 2, "on_ground", "true", false);
    text.push_str("  },\n  \"control\": {\n    \"joints\": {\n");
    let driven = &gait.step.legs.driven;
    for (index, joint) in driven.iter().enumerate() {
        joint_text(&mut text, gait, (*joint, &model.joints[*joint].name));
        text.push_str(if index + 1 < driven.len() { ",\n" } else { "\n" });
    }
    text.push_str("    }\n  },\n");
    text.push_str("  \"contact\": {\"fallback_friction\": 0.8},\n");
    text.push_str("  \"integrator\": {\n    \"method\": \"radau\",\n    \"relative\": 1e-07,\n");
    text.push_str("    \"absolute\": 1e-08,\n    \"max_step_s\": 0.02\n  },\n");
    text.push_str("  \"log_period_s\": 0.01,\n  \"tolerances\": {\"energy_j\": 0.001}\n}\n");
    text
}

fn joint_text(text: &mut String, gait: &LimitCycle, (joint, name): (usize, &str)) {
    let law = joint_gains(&gait.step, &gait.gains, joint);
    let _ = writeln!(text, "      {}: {{", quoted(name));
    line(text, 4, "kp", &number(law.stiffness), true);
    line(text, 4, "kd", &number(law.damping), true);
    sequence(text, gait, "gain_factor", |phase, step| number(law.factors[step][phase]));
    text.push_str(",\n");
    sequence(text, gait, "reference", |phase, step| {
        quintic(&gait.step.phases[phase], gait.step.role_of(joint, step))
    });
    text.push_str(",\n");
    sequence(text, gait, "feed_forward", |phase, step| {
        let coordinate = gait.step.role_of(joint, step);
        let drive = gait.step.legs.driven.iter().position(|driven| *driven == coordinate);
        cubic(&gait.step.phases[phase], drive.unwrap_or(0))
    });
    text.push_str("\n      }");
}

/// A function of time over two steps, again and again.
fn sequence(
    text: &mut String,
    gait: &LimitCycle,
    key: &str,
    reference: impl Fn(usize, usize) -> String,
) {
    let _ = write!(text, "        \"{key}\": {{\"sequence\": {{\"repeat\": true, \"parts\": [");
    let phases = &gait.step.phases;
    for step in 0..2 {
        for (phase, planned) in phases.iter().enumerate() {
            let comma = if step == 0 && phase == 0 { "" } else { "," };
            let duration = number(planned.duration_s);
            let inner = reference(phase, step);
            let _ = write!(
                text,
                "{comma}\n          {{\"duration_s\": {duration}, \"reference\": {inner}}}"
            );
        }
    }
    text.push_str("\n        ]}}");
}

fn quintic(phase: &PlannedPhase, coordinate: usize) -> String {
    let column = |rows: &[Vec<f64>]| list(rows.iter().map(|row| row[coordinate]));
    format!(
        "{{\"quintic\": {{\n            \"times\": {},\n            \"values\": {},\n            \
         \"rates\": {},\n            \"accelerations\": {}}}}}",
        list(phase.times_s.iter().copied()),
        column(&phase.q),
        column(&phase.qd),
        column(&phase.qdd)
    )
}

fn cubic(phase: &PlannedPhase, drive: usize) -> String {
    let values: Vec<f64> = phase.torques_nm.iter().map(|row| row[drive]).collect();
    let ends = phase.torque_rates(&values);
    format!(
        "{{\"cubic\": {{\n            \"times\": {},\n            \"values\": {},\n            \
         \"end_rates\": {}}}}}",
        list(phase.times_s.iter().copied()),
        list(values.into_iter()),
        list(ends.into_iter())
    )
}

fn line(text: &mut String, depth: usize, key: &str, value: &str, goes_on: bool) {
    let comma = if goes_on { "," } else { "" };
    let _ = writeln!(text, "{}{}: {value}{comma}", "  ".repeat(depth), quoted(key));
}

/// A number that reads back as the same.
fn number(value: f64) -> String {
    format!("{value:?}")
}

fn list(values: impl Iterator<Item = f64>) -> String {
    format!("[{}]", values.map(number).collect::<Vec<_>>().join(", "))
}

/// A text in JSON.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => {
                quoted.push('\\');
                quoted.push(character);
            }
            control if (control as u32) < 0x20 => {
                let _ = write!(quoted, "\\u{:04x}", control as u32);
            }
            other => quoted.push(other),
        }
    }
    quoted.push('"');
    quoted
}
