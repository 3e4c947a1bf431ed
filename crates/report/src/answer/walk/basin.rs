//! Starts around the cycle of a gait, as text, JSON, rows and a map.

use super::write_what_is_no_fall;
use crate::walk::HeatMap;
use crate::{Align, Table};
use denavit_plants::PlantModel;
use denavit_simulate::Log;
use denavit_walk::robustness::BasinStart;
use serde_json::json as value;
use std::fmt::{self, Write};

/// Outcomes with how often each occurred, in the order of the alphabet.
fn counted(starts: &[BasinStart]) -> Vec<(&'static str, usize)> {
    let mut words: Vec<&'static str> = starts.iter().map(|start| start.outcome.word()).collect();
    words.sort_unstable();
    words.dedup();
    let count = |word: &'static str| starts.iter().filter(|s| s.outcome.word() == word).count();
    words.into_iter().map(|word| (word, count(word))).collect()
}

/// Starts around a cycle, of which each was to walk so many cycles.
#[derive(Clone, Copy, Debug)]
pub struct BasinAnswer<'a> {
    /// The scenario.
    pub name: &'a str,
    /// Its robot.
    pub model: &'a PlantModel,
    /// Cycles that each start was to walk.
    pub cycles: u32,
    /// The starts.
    pub starts: &'a [BasinStart],
}

/// Starts as JSON.
pub fn basin_json(answer: &BasinAnswer<'_>) -> serde_json::Value {
    let BasinAnswer { name, model, cycles, starts } = *answer;
    let outcomes: serde_json::Map<String, serde_json::Value> =
        counted(starts).into_iter().map(|(word, count)| (word.to_owned(), count.into())).collect();
    value!({
        "scenario": name,
        "starts": starts.len(),
        "cycles": cycles,
        "outcomes": outcomes,
        "falls_are_seen": !model.fall_points.is_empty(),
        "walks": starts.iter().filter(|start| start.outcome.walks()).count(),
    })
}

/// Starts as text.
pub fn basin_text(answer: &BasinAnswer<'_>) -> String {
    let mut out = String::new();
    write(&mut out, answer).expect("text has room");
    out
}

fn write(out: &mut String, answer: &BasinAnswer<'_>) -> fmt::Result {
    let BasinAnswer { name, model, cycles, starts } = *answer;
    writeln!(out, "{name}: {} starts, {cycles} cycles each\n", starts.len())?;
    let mut table = Table::new(&[("outcome", Align::Left), ("starts", Align::Right)]);
    for (word, count) in counted(starts) {
        table.push(vec![word.to_owned(), count.to_string()]);
    }
    write!(out, "{table}")?;
    write_what_is_no_fall(out, model)
}

/// Starts row by row: deviations, cycles walked, distance at the end.
pub fn basin_log(answer: &BasinAnswer<'_>) -> Log {
    let BasinAnswer { name, model, starts, .. } = *answer;
    let mut columns = vec!["t".to_owned()];
    for prefix in ["q", "qd"] {
        columns.extend(model.joints.iter().map(|joint| format!("{prefix}_{}", joint.name)));
    }
    columns.extend(["walks", "cycles", "distance"].map(str::to_owned));
    let mut values = Vec::new();
    for (index, start) in starts.iter().enumerate() {
        values.push(index as f64);
        values.extend(&start.deviation.q);
        values.extend(&start.deviation.qd);
        values.push(f64::from(u8::from(start.outcome.walks())));
        values.push(start.cycles as f64);
        values.push(start.distance);
    }
    let header = vec![
        ("basin_of".to_owned(), name.to_owned()),
        ("t".to_owned(), "number of the start".to_owned()),
    ];
    Log { header, columns, values }
}

/// Starts on a grid as a map: the two coordinates, how far each is varied, and how often.
pub fn basin_picture(
    answer: &BasinAnswer<'_>,
    names: [&str; 2],
    reach: [f64; 2],
    count: usize,
) -> String {
    let BasinAnswer { name, cycles, starts, .. } = *answer;
    let values = reach.map(|reach| -> Vec<f64> {
        let share = |index: usize| 2.0 * index as f64 / (count - 1) as f64 - 1.0;
        (0..count).map(|index| reach * share(index)).collect()
    });
    let cell = |start: &BasinStart| {
        let share = start.cycles as f64 / f64::from(cycles);
        let text = if start.outcome.walks() { String::new() } else { start.cycles.to_string() };
        (Some(1.0 - share.min(1.0)), text)
    };
    let cells: Vec<(Option<f64>, String)> = starts.iter().map(cell).collect();
    let title = format!("{}: basin of attraction", name.replace('_', " "));
    let subtitle = format!("cycles walked of {cycles}, from deviations off the fixed point");
    let meaning = ["walks all cycles", "walks none"];
    let axes = [(names[0], &values[0][..]), (names[1], &values[1][..])];
    HeatMap { title: &title, subtitle: &subtitle, axes, cells: &cells, meaning }.draw()
}
