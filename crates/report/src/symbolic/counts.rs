//! What each function of a model costs.

use crate::{Align, Ordered, Table};
use denavit_codegen::derive::Flavour;
use denavit_codegen::program::{Counts, FunctionCount};
use serde::Serialize;

#[derive(Serialize)]
struct CountJson<'a> {
    model: &'a str,
    flavour: String,
    functions: Ordered<CountsJson>,
}

#[derive(Serialize)]
struct CountsJson {
    mul: usize,
    add: usize,
    neg: usize,
    div: usize,
    sqrt: usize,
    sincos: usize,
    select: usize,
    function: usize,
    prelude: usize,
}

impl From<&Counts> for CountsJson {
    fn from(counts: &Counts) -> Self {
        let Counts { mul, add, neg, div, sqrt, sincos, select, function, prelude } = *counts;
        Self { mul, add, neg, div, sqrt, sincos, select, function, prelude }
    }
}

/// The operations of each function of a model as a table, with a title.
pub fn counts_text(model: &str, flavour: Flavour, functions: &[FunctionCount]) -> String {
    let table = table(functions);
    format!("{model}: operations of one call, {flavour} parameters\n\n{table}")
}

/// The operations of each function of a model as a JSON document.
pub fn counts_json<'a>(
    model: &'a str,
    flavour: Flavour,
    functions: &[FunctionCount],
) -> impl Serialize + use<'a> {
    let counts = functions.iter().map(|row| (row.full_name(), (&row.counts).into()));
    CountJson { model, flavour: flavour.to_string(), functions: Ordered(counts.collect()) }
}

/// One row for each function; of functions of links, the dearest one.
fn table(functions: &[FunctionCount]) -> Table {
    let mut columns = vec![("function", Align::Left)];
    let kinds = kinds(&Counts::default()).map(|(name, _)| name);
    let is_used = |column: usize| {
        column < 2 || functions.iter().any(|row| self::kinds(&row.counts)[column].1 > 0)
    };
    let used: Vec<usize> = (0..kinds.len()).filter(|&column| is_used(column)).collect();
    columns.extend(used.iter().map(|&column| (kinds[column], Align::Right)));
    let mut table = Table::new(&columns);
    for row in shown(functions) {
        let mut cells = vec![row.0];
        let counts = self::kinds(&row.1.counts);
        cells.extend(used.iter().map(|&column| counts[column].1.to_string()));
        table.push(cells);
    }
    table
}

fn shown(rows: &[FunctionCount]) -> Vec<(String, &FunctionCount)> {
    let mut shown: Vec<(String, &FunctionCount)> = Vec::new();
    for row in rows {
        if row.link.is_none() {
            shown.push((row.name.to_string(), row));
            continue;
        }
        if shown.last().is_some_and(|(_, last)| last.name == row.name) {
            continue;
        }
        let links: Vec<_> = rows.iter().filter(|other| other.name == row.name).collect();
        let Some(dearest) = links.iter().rev().max_by_key(|other| other.counts.total()) else {
            continue;
        };
        let link = dearest.link.as_deref().unwrap_or_default();
        shown.push((format!("{} (of {link}, the dearest of {})", row.name, links.len()), dearest));
    }
    shown
}

/// The kinds of operations with their numbers.
fn kinds(counts: &Counts) -> [(&'static str, usize); 9] {
    let Counts { mul, add, neg, div, sqrt, sincos, select, function, prelude } = *counts;
    [
        ("mul", mul),
        ("add", add),
        ("neg", neg),
        ("div", div),
        ("sqrt", sqrt),
        ("sincos", sincos),
        ("select", select),
        ("function", function),
        ("prelude", prelude),
    ]
}
