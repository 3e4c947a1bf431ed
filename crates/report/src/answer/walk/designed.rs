//! A gait that was designed, as text, JSON and a picture.

use crate::run::{GaitCurve, GaitPicture};
use crate::{Align, Ordered, Table};
use denavit_walk::gait_plan::Knot;
use denavit_workflow::Designed;
use serde_json::{Map, Value, json as value};
use std::fmt::{self, Write};

/// Joint angles over a step with the postures marked.
pub fn designed_picture(designed: &Designed) -> String {
    let title = format!("{}: joint angles", designed.name.replace('_', " "));
    let over = if designed.curves.postures.is_empty() { "the walk" } else { "one step" };
    let subtitle = format!("{}, {}, over {over}", designed.model.name, designed.kind);
    let curves: Vec<GaitCurve> = designed
        .curves
        .joints
        .iter()
        .map(|(name, values)| GaitCurve { name: name.clone(), values: values.clone() })
        .collect();
    GaitPicture {
        title: &title,
        subtitle: &subtitle,
        times_s: &designed.curves.times_s,
        curves: &curves,
        postures: &designed.curves.postures,
    }
    .draw()
}

/// A gait as JSON.
pub fn designed_json(designed: &Designed) -> Value {
    let mut answer = Map::new();
    answer.insert("gait".to_owned(), value!(designed.name));
    answer.insert("kind".to_owned(), value!(designed.kind));
    answer.insert("model".to_owned(), value!(designed.model.name));
    for row in &designed.rows {
        answer.insert(row.key.to_owned(), value!(row.number));
        if !row.place.is_empty() {
            answer.insert(format!("{}_at", row.key), value!(row.place));
        }
    }
    let knot = |knot: &Knot| {
        let joints = designed.model.joints.iter().zip(&knot.q);
        let q = Ordered(joints.map(|(joint, q)| (joint.name.clone(), *q)).collect());
        value!({
            "t_s": knot.t_s,
            "name": knot.name,
            "solved": knot.is_solved,
            "residual": knot.residual,
            "static_margin_m": knot.static_margin_m,
            "zmp_margin_m": knot.pressure_margin_m,
            "q": serde_json::to_value(q).unwrap_or_default(),
        })
    };
    answer.insert("knots".to_owned(), designed.knots.iter().map(knot).collect());
    Value::Object(answer)
}

/// The same as text.
pub fn designed_text(designed: &Designed) -> String {
    let mut out = String::new();
    write(&mut out, designed).expect("text has room");
    out
}

fn write(out: &mut String, designed: &Designed) -> fmt::Result {
    let (name, kind, model) = (&designed.name, designed.kind, &designed.model.name);
    writeln!(out, "{name}: {kind} for {model}\n")?;
    let columns = [("", Align::Left), ("", Align::Right), ("where", Align::Left)];
    let mut table = Table::new(&columns);
    for row in &designed.rows {
        table.push(vec![row.name.to_owned(), row.shown.clone(), row.place.clone()]);
    }
    write!(out, "{table}")
}
