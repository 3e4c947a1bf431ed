//! The least pushes that fell a robot, as text, JSON and a map.

use super::write_what_is_no_fall;
use crate::walk::HeatMap;
use crate::{Align, Table};
use denavit_plants::PlantModel;
use denavit_walk::robustness::{LeastPush, PushOptions};
use serde_json::json as value;
use std::fmt::{self, Write};

/// A direction in words.
fn direction_word(direction: [f64; 3]) -> &'static str {
    match direction {
        [x, _, _] if x > 0.5 => "forward",
        [x, _, _] if x < -0.5 => "backward",
        [_, y, _] if y > 0.5 => "left",
        _ => "right",
    }
}

/// The least pushes that fell a robot.
#[derive(Clone, Copy, Debug)]
pub struct PushAnswer<'a> {
    /// The scenario.
    pub name: &'a str,
    /// Its robot.
    pub model: &'a PlantModel,
    /// How it was pushed.
    pub options: &'a PushOptions,
    /// The least pushes.
    pub found: &'a [LeastPush],
}

/// The least pushes as JSON.
pub fn push_json(answer: &PushAnswer<'_>) -> serde_json::Value {
    let PushAnswer { name, model, options, found } = *answer;
    let link = options.point.link;
    let one = |push: &LeastPush| {
        value!({
            "at_s": push.at_s,
            "direction": direction_word(push.direction),
            "least_impulse_ns": push.impulse_ns,
            "outcome": push.outcome.word(),
        })
    };
    let pushes: Vec<serde_json::Value> = found.iter().map(one).collect();
    value!({
        "scenario": name,
        "link": model.links[link],
        "resolution_ns": options.resolution_ns,
        "falls_are_seen": !model.fall_points.is_empty(),
        "pushes": pushes,
    })
}

/// The same as text.
pub fn push_text(answer: &PushAnswer<'_>) -> String {
    let mut out = String::new();
    write(&mut out, answer).expect("text has room");
    out
}

fn write(out: &mut String, answer: &PushAnswer<'_>) -> fmt::Result {
    let PushAnswer { name, model, options, found } = *answer;
    let (at, to) = (&model.links[options.point.link], options.resolution_ns);
    writeln!(out, "{name}: the least impulse at {at} that fells it, to {to:.2} N s at most\n")?;
    let columns = [
        ("direction", Align::Left),
        ("at [s]", Align::Right),
        ("impulse [N s]", Align::Right),
        ("then", Align::Left),
    ];
    let mut table = Table::new(&columns);
    for push in found {
        table.push(vec![
            direction_word(push.direction).to_owned(),
            format!("{:.3}", push.at_s),
            push.impulse_ns.map_or_else(|| "-".to_owned(), |impulse| format!("{impulse:.2}")),
            push.outcome.word().to_owned(),
        ]);
    }
    write!(out, "{table}")?;
    write_what_is_no_fall(out, model)
}

/// The same as a map over the time in the cycle and the direction.
pub fn push_picture(answer: &PushAnswer<'_>) -> String {
    let PushAnswer { name, options, found, .. } = *answer;
    let cell = |push: &LeastPush| {
        let text = push.impulse_ns.map_or_else(|| "-".to_owned(), |p| format!("{p:.1}"));
        (Some(push.impulse_ns.unwrap_or(options.most_ns) / options.most_ns), text)
    };
    let cells: Vec<(Option<f64>, String)> = found.iter().map(cell).collect();
    let rows: Vec<f64> = (1..=options.directions.len()).map(|row| row as f64).collect();
    let words: Vec<&str> = options.directions.iter().map(|d| direction_word(*d)).collect();
    let title = format!("{}: least push that fells", name.replace('_', " "));
    let subtitle = format!("impulse [N s]; rows from below: {}", words.join(", "));
    let strongest = format!("{} N s", options.most_ns);
    let axes = [("time in the cycle [s]", &options.times_s[..]), ("direction", &rows[..])];
    HeatMap {
        title: &title,
        subtitle: &subtitle,
        axes,
        cells: &cells,
        meaning: ["none", &strongest],
    }
    .draw()
}
