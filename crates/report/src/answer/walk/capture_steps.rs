//! Pushes, the steps predicted, and the steps made, as text and JSON.

use super::capturability::steps_value;
use crate::{Align, Table};
use denavit_walk::capturability::Steps;
use denavit_walk::robustness::CapturePush;
use serde_json::{Value, json as value};
use std::fmt::{self, Write};

fn agreeing(pushes: &[CapturePush]) -> usize {
    pushes.iter().filter(|push| push.agrees()).count()
}

fn outcome_word(push: &CapturePush) -> &'static str {
    match push.outcome.walks() {
        true if push.stands() => "stands",
        true => "moves",
        false => push.outcome.word(),
    }
}

/// Pushes, the steps predicted, and the steps made, as JSON.
pub fn capture_steps_json(name: &str, pushes: &[CapturePush]) -> Value {
    let one = |push: &CapturePush| {
        value!({
            "impulse_ns": push.impulse_ns,
            "capture_m": push.capture_m,
            "predicted_steps": push.predicted.map(steps_value),
            "steps": push.steps,
            "outcome": outcome_word(push),
            "agrees": push.agrees(),
        })
    };
    value!({
        "scenario": name,
        "pushes": pushes.iter().map(one).collect::<Vec<Value>>(),
        "agree": agreeing(pushes),
    })
}

/// The same as text.
pub fn capture_steps_text(name: &str, pushes: &[CapturePush]) -> String {
    let mut out = String::new();
    write(&mut out, name, pushes).expect("text has room");
    out
}

fn write(out: &mut String, name: &str, pushes: &[CapturePush]) -> fmt::Result {
    writeln!(out, "{name}: steps after a push, predicted and made\n")?;
    let columns = [
        ("impulse [N s]", Align::Right),
        ("capture point [m]", Align::Right),
        ("predicted", Align::Right),
        ("steps", Align::Right),
        ("then", Align::Left),
        ("", Align::Left),
    ];
    let mut table = Table::new(&columns);
    for push in pushes {
        let predicted = match push.predicted {
            Some(Steps::Least(steps)) => steps.to_string(),
            Some(Steps::Falls) => "fall".to_owned(),
            None => "-".to_owned(),
        };
        let other = if push.agrees() { "" } else { "other than predicted" };
        table.push(vec![
            format!("{:.2}", push.impulse_ns),
            format!("{:.4}", push.capture_m),
            predicted,
            push.steps.to_string(),
            outcome_word(push).to_owned(),
            other.to_owned(),
        ]);
    }
    writeln!(out, "{table}")?;
    writeln!(out, "{} of {} as predicted", agreeing(pushes), pushes.len())
}
