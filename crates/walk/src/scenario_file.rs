//! Scenario files (`"denavit-scenario/1"`) of designed gaits, complete: what `simulate` walks. The
//! same gait gives the same bytes.

use denavit_plants::{Override, PlantModel};
use denavit_simulate::State;
use serde_json::Value;
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
    /// Values in place of the model's.
    pub parameters: &'a [Override],
    /// Steps of the run, of gaits that do not say themselves how many they have.
    pub steps: usize,
}

/// The friction of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactFriction {
    /// No slip, and this coefficient where that has no answer to an impact.
    Fallback(f64),
    /// This coefficient everywhere.
    Coulomb(f64),
}

/// The law of a joint.
pub(crate) struct JointLaw {
    /// The coordinate.
    pub(crate) joint: usize,
    /// [N m/rad].
    pub(crate) stiffness: f64,
    /// [N m s/rad].
    pub(crate) damping: f64,
    /// Functions of time, each by its key as text: `reference` and others.
    pub(crate) functions: Vec<(&'static str, String)>,
}

/// What a file says of a run.
pub(crate) struct ScenarioRun<'a> {
    pub(crate) duration_s: f64,
    /// Where it starts.
    pub(crate) start: &'a State,
    pub(crate) laws: &'a [JointLaw],
    pub(crate) friction: ContactFriction,
}

/// The text of a scenario file.
pub(crate) fn scenario_file(
    model: &PlantModel,
    head: &ScenarioHead<'_>,
    run: &ScenarioRun<'_>,
) -> String {
    let mut text = String::from("{\n  \"format\": \"denavit-scenario/1\",\n");
    head_lines(
        &mut text,
        &[
            ("name", head.name),
            ("description", head.description),
            ("source", head.source),
            ("model", head.model),
        ],
    );
    if !head.parameters.is_empty() {
        text.push_str("  \"parameters\": {\n");
        for (index, given) in head.parameters.iter().enumerate() {
            let goes_on = index + 1 < head.parameters.len();
            line(&mut text, 2, &given.parameter, &number(given.value), goes_on);
        }
        text.push_str("  },\n");
    }
    line(&mut text, 1, "duration_s", &number(run.duration_s), true);
    text.push_str("  \"initial\": {\n");
    line(&mut text, 2, "t_s", &number(run.start.t_s), true);
    for (key, values) in [("q", &run.start.q), ("qd", &run.start.qd)] {
        let _ = writeln!(text, "    \"{key}\": {{");
        for (index, (joint, value)) in model.joints.iter().zip(values).enumerate() {
            line(&mut text, 3, &joint.name, &number(*value), index + 1 < values.len());
        }
        text.push_str("    },\n");
    }
    line(&mut text, 2, "on_ground", "true", false);
    text.push_str("  },\n  \"control\": {\n    \"joints\": {\n");
    for (index, law) in run.laws.iter().enumerate() {
        let _ = writeln!(text, "      {}: {{", quoted(&model.joints[law.joint].name));
        line(&mut text, 4, "kp", &number(law.stiffness), true);
        line(&mut text, 4, "kd", &number(law.damping), !law.functions.is_empty());
        for (place, (key, function)) in law.functions.iter().enumerate() {
            line(&mut text, 4, key, function, place + 1 < law.functions.len());
        }
        text.push_str(if index + 1 < run.laws.len() { "      },\n" } else { "      }\n" });
    }
    text.push_str("    }\n  },\n");
    let (key, friction) = match run.friction {
        ContactFriction::Fallback(friction) => ("fallback_friction", friction),
        ContactFriction::Coulomb(friction) => ("friction", friction),
    };
    let _ = writeln!(text, "  \"contact\": {{\"{key}\": {}}},", number(friction));
    // in space the corners of a sole share its load: errors of the motion must stay below what
    // decides which of them carry
    let [relative, absolute] = if model.planar { ["1e-07", "1e-08"] } else { ["1e-08", "1e-09"] };
    text.push_str("  \"integrator\": {\n    \"method\": \"radau\",\n");
    let _ = writeln!(text, "    \"relative\": {relative},\n    \"absolute\": {absolute},");
    text.push_str("    \"max_step_s\": 0.02\n  },\n");
    text.push_str("  \"log_period_s\": 0.01,\n  \"tolerances\": {\"energy_j\": 0.001}\n}\n");
    text
}

/// Functions of time one after the other, each for some time \[s\], as text of a reference.
pub(crate) fn sequence(parts: impl Iterator<Item = (f64, String)>, repeats: bool) -> String {
    let parts = parts.map(|(duration_s, reference)| {
        let duration = number(duration_s);
        format!("          {{\"duration_s\": {duration}, \"reference\": {reference}}}")
    });
    let parts = parts.collect::<Vec<_>>().join(",\n");
    format!("{{\"sequence\": {{\"repeat\": {repeats}, \"parts\": [\n{parts}\n        ]}}}}")
}

/// Lines of those entries that say something.
pub(crate) fn head_lines(text: &mut String, entries: &[(&str, &str)]) {
    for (key, value) in entries.iter().filter(|(_, value)| !value.is_empty()) {
        line(text, 1, key, &quoted(value), true);
    }
}

/// A line of an object.
pub(crate) fn line(text: &mut String, depth: usize, key: &str, value: &str, goes_on: bool) {
    let comma = if goes_on { "," } else { "" };
    let _ = writeln!(text, "{}{}: {value}{comma}", "  ".repeat(depth), quoted(key));
}

/// A number that reads back as the same.
pub(crate) fn number(value: f64) -> String {
    format!("{value:?}")
}

/// A list of such numbers.
pub(crate) fn list(values: impl Iterator<Item = f64>) -> String {
    format!("[{}]", values.map(number).collect::<Vec<_>>().join(", "))
}

/// A text in JSON.
pub(crate) fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}
