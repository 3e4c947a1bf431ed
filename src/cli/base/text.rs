//! Base parameters for people at a terminal.

use super::Found;
use crate::cli::failure::Failure;
use denavit::number::Residue;
use denavit::report::{Align, Table, paragraph};
use std::io::Write;

pub(super) fn write(out: &mut dyn Write, found: &Found<'_>) -> Result<(), Failure> {
    let base = found.base;
    let columns = base.regressor.columns.len();
    writeln!(out, "{}: {} base parameters of {columns} columns\n", found.robot.name, base.rank())?;
    writeln!(out, "{}", table(found))?;
    for (title, names) in [
        ("identifiable alone", found.names(base.alone())),
        ("without any effect", found.names(base.zero())),
    ] {
        if !names.is_empty() {
            writeln!(out, "{}\n", paragraph(&format!("{title}: "), "  ", &names.join(", ")))?;
        }
    }
    let sums: Vec<_> = found.sums().collect();
    if !sums.is_empty() {
        writeln!(out, "columns that are sums of kept columns:")?;
        for (name, sum) in sums {
            writeln!(out, "  {name} = {}", base.sum_text(sum))?;
        }
        writeln!(out)?;
    }
    let verdict = if found.verified { "verified" } else { "NOT verified" };
    Ok(writeln!(out, "certificate {verdict} (exact; rank modulo {})", Residue::MODULUS)?)
}

fn table(found: &Found<'_>) -> Table {
    let base = found.base;
    let mut table = Table::new(&[
        ("kept", Align::Left),
        ("unit", Align::Left),
        ("value", Align::Right),
        ("base parameter", Align::Left),
    ]);
    let values = found.shown_values();
    for (row, parameter) in base.parameters.iter().enumerate() {
        table.push(vec![
            base.name(parameter.column).to_owned(),
            base.regressor.columns[parameter.column].unit.clone(),
            values.get(row).cloned().unwrap_or_default(),
            base.sum_text(&parameter.parts),
        ]);
    }
    table.without_empty_columns()
}
