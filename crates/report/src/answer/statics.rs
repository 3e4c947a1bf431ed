//! What follows from measurements at rest, as a table of text and as JSON.

use crate::identification::warnings;
use crate::{Align, Table, paragraph, short};
use denavit_numerics::Determined;
use denavit_plants::regression::RegressionModel;
use denavit_workflow::StaticsFound;
use serde_json::json;
use std::fmt::{self, Write};

/// What follows from measurements at rest, as a table of text.
pub fn statics_text(all: &StaticsFound) -> String {
    let mut out = String::new();
    write(&mut out, all).expect("text has room");
    out
}

/// What is said of equations that cannot all be true.
const CONTRADICTION: &str = " They contradict each other: a measurement, its sign, its unit or its \
                             deviation is wrong, and what follows is not to be used.";

/// What is to be said of logs, and of what does not follow.
fn remarks(all: &StaticsFound) -> Vec<String> {
    let of_logs = all.of_logs.iter().flat_map(|found| warnings(found));
    let reasons = all.reasons.iter().map(|&reason| reason.to_owned());
    all.remarks.iter().cloned().chain(of_logs).chain(reasons).collect()
}

/// A combination as a sum.
fn sum(model: &RegressionModel, one: &Determined) -> String {
    let mut text = String::new();
    for &(at, factor) in &one.members {
        let sign = match (text.is_empty(), factor < 0.0) {
            (true, true) => "-",
            (true, false) => "",
            (false, true) => " - ",
            (false, false) => " + ",
        };
        let size = factor.abs();
        let times =
            if (size - 1.0).abs() < 1e-12 { String::new() } else { format!("{} ", short(size)) };
        text += &format!("{sign}{times}{}", model.standard[at].name);
    }
    text
}

fn write(out: &mut String, all: &StaticsFound) -> fmt::Result {
    let StaticsFound { model, knowledge, found, .. } = all;
    for remark in remarks(all) {
        writeln!(out, "{}\n", paragraph("", "", &remark))?;
    }
    let alone = found.parameters.iter().flatten().count();
    writeln!(
        out,
        "{}: {} equations determine {} combinations of {} parameters, of which {alone} stand \
         alone\n",
        model.model,
        knowledge.count(),
        found.combinations.len(),
        model.standard.len(),
    )?;
    let mut table = Table::new(&[
        ("what follows", Align::Left),
        ("value", Align::Right),
        ("std", Align::Right),
        ("model", Align::Right),
        ("unit", Align::Left),
    ]);
    for one in &found.combinations {
        let of_model = one
            .members
            .iter()
            .map(|&(at, factor)| model.standard[at].value.map(|value| factor * value));
        let of_model = of_model.sum::<Option<f64>>();
        table.push(vec![
            sum(model, one),
            short(one.value),
            format!("{:.1e}", one.std),
            of_model.map_or(String::new(), short),
            one.members.first().map_or(String::new(), |m| model.standard[m.0].unit.clone()),
        ]);
    }
    write!(out, "{}", table.without_empty_columns())?;
    if found.degrees_of_freedom > 0 {
        let missed = (found.chi_squared / found.degrees_of_freedom as f64).sqrt();
        let missed = if missed < 0.01 { "less than 0.01".to_owned() } else { short(missed) };
        let text = format!(
            "The equations miss each other by {} standard deviations ({} more than are needed): \
             about 1 is what the stated deviations lead one to expect.{}",
            missed,
            found.degrees_of_freedom,
            if found.contradicts() { CONTRADICTION } else { "" }
        );
        writeln!(out, "\n{}", paragraph("", "", &text))?;
    }
    Ok(())
}

/// What follows from measurements at rest, as JSON (docs/reference/identification.md).
pub fn statics_json(all: &StaticsFound) -> serde_json::Value {
    let StaticsFound { model, knowledge, found, .. } = all;
    let parameters = model.standard.iter().zip(&found.parameters);
    let parameters = parameters.map(|(one, follows)| {
        json!({
            "name": one.name,
            "unit": one.unit,
            "value": follows.map(|(value, _)| value),
            "std": follows.map(|(_, std)| std),
            "model_value": one.value,
            "identifiable": follows.is_some(),
        })
    });
    let combinations = found.combinations.iter().map(|one| {
        let members = one.members.iter();
        let members: serde_json::Map<String, serde_json::Value> =
            members.map(|&(at, factor)| (model.standard[at].name.clone(), factor.into())).collect();
        json!({"members": members, "value": one.value, "std": one.std})
    });
    json!({
        "model": model.model,
        "equations": knowledge.count(),
        "parameters": parameters.collect::<Vec<_>>(),
        "combinations": combinations.collect::<Vec<_>>(),
        "chi_squared": found.chi_squared,
        "degrees_of_freedom": found.degrees_of_freedom,
        "contradicts": found.contradicts(),
        "remarks": remarks(all),
    })
}
