//! How the joints of a run followed their references, and which limits they went beyond.

use crate::{Align, Table};
use denavit_simulate::scenario::{Exceeded, Limited, Scenario};
use denavit_simulate::{JointRecord, Run};
use serde::Serialize;
use std::fmt::{self, Write};

/// A joint that is controlled.
#[derive(Serialize)]
pub(super) struct JointJson<'a> {
    joint: &'a str,
    unit: &'static str,
    /// Reference less position at the end.
    final_error: Option<f64>,
    largest_error: Option<f64>,
    largest_error_s: Option<f64>,
    torque_limit_share: Option<f64>,
}

/// A limit that was exceeded.
#[derive(Serialize)]
pub(super) struct ExceededJson<'a> {
    joint: &'a str,
    quantity: &'static str,
    unit: &'static str,
    limit: f64,
    worst: f64,
    by: f64,
    at_s: f64,
}

/// Joints that follow something, or have a limit of torque to reach.
fn controlled<'a>(
    scenario: &'a Scenario,
    run: &'a Run,
) -> impl Iterator<Item = (&'a str, &'static str, &'a JointRecord)> {
    let joints = scenario.plant.model().joints.iter().zip(&run.joints);
    let is_shown =
        |record: &JointRecord| record.tracking.is_some() || record.at_torque_limit.is_some();
    joints
        .filter(move |(_, record)| is_shown(record))
        .map(|(joint, record)| (joint.name.as_str(), unit(joint.slides), record))
}

fn unit(slides: bool) -> &'static str {
    if slides { "m" } else { "rad" }
}

/// Joint, unit and limit of what was exceeded.
fn named<'a>(scenario: &'a Scenario, exceeded: &Exceeded) -> (&'a str, &'static str) {
    let joint = &scenario.plant.model().joints[exceeded.joint];
    let unit = match (exceeded.limited, joint.slides) {
        (Limited::Position, slides) => unit(slides),
        (Limited::Speed, true) => "m/s",
        (Limited::Speed, false) => "rad/s",
    };
    (&joint.name, unit)
}

pub(super) fn joints<'a>(scenario: &'a Scenario, run: &'a Run) -> Vec<JointJson<'a>> {
    let json = |(joint, unit, record): (&'a str, _, &JointRecord)| JointJson {
        joint,
        unit,
        final_error: record.tracking.map(|tracking| tracking.last),
        largest_error: record.tracking.map(|tracking| tracking.largest.value),
        largest_error_s: record.tracking.map(|tracking| tracking.largest.at_s),
        torque_limit_share: record.at_torque_limit,
    };
    controlled(scenario, run).map(json).collect()
}

pub(super) fn exceeded<'a>(scenario: &'a Scenario, run: &Run) -> Vec<ExceededJson<'a>> {
    let json = |one: Exceeded| {
        let (joint, unit) = named(scenario, &one);
        ExceededJson {
            joint,
            quantity: one.limited.word(),
            unit,
            limit: one.limit,
            worst: one.worst.value,
            by: one.by(),
            at_s: one.worst.at_s,
        }
    };
    scenario.exceeded(run).into_iter().map(json).collect()
}

/// A table of the joints, then a line for each limit that was exceeded.
pub(super) fn write(out: &mut String, scenario: &Scenario, run: &Run) -> fmt::Result {
    let columns = ["final error", "largest error", "at", "at torque limit"];
    let columns = columns.map(|name| (name, Align::Right));
    let mut table = Table::new(&[&[("joint", Align::Left)], &columns[..]].concat());
    for (joint, unit, record) in controlled(scenario, run) {
        let [last, largest, at] = match record.tracking {
            Some(error) => [
                format!("{:.3e} {unit}", error.last),
                format!("{:.3e} {unit}", error.largest.value),
                format!("{:.3} s", error.largest.at_s),
            ],
            None => [(); 3].map(|()| String::new()),
        };
        let share = record.at_torque_limit.map(|share| format!("{:.1} %", 100.0 * share));
        table.push(vec![joint.to_owned(), last, largest, at, share.unwrap_or_default()]);
    }
    if !table.is_empty() {
        write!(out, "\n{}", table.without_empty_columns())?;
    }
    for one in scenario.exceeded(run) {
        let (joint, unit) = named(scenario, &one);
        writeln!(
            out,
            "limit exceeded: {joint}: {} {:.4e} {unit} at {:.3} s is {:.1e} {unit} beyond {}",
            one.limited.word(),
            one.worst.value,
            one.worst.at_s,
            one.by(),
            one.limit,
        )?;
    }
    Ok(())
}
