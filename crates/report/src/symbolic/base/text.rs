//! Base parameters for people at a terminal.

use super::BaseReport;
use crate::{Align, Table, paragraph};
use denavit_codegen::number::Residue;
use std::fmt::{self, Display, Write};

pub(super) fn write(
    out: &mut dyn Write,
    found: &BaseReport<'_>,
    effects: &[impl Display],
) -> fmt::Result {
    let base = found.base();
    let columns = base.regressor.columns.len();
    let (name, rank, place) = (&found.found.robot.name, base.rank(), found.place());
    writeln!(out, "{name}: {rank} base parameters of {columns} columns{place}\n")?;
    writeln!(out, "{}", table(found))?;
    for effect in effects {
        writeln!(out, "{}\n", paragraph("", "  ", &effect.to_string()))?;
    }
    for (title, names) in [
        ("identifiable alone", found.names(base.alone())),
        ("without any effect", found.names(base.zero())),
    ] {
        if !names.is_empty() {
            writeln!(out, "{}\n", paragraph(&format!("{title}: "), "  ", &names.join(", ")))?;
        }
    }
    let on_axes: Vec<_> = found.in_kept();
    let (title, sums) = match on_axes.is_empty() {
        true => ("columns that are sums of kept columns", found.sums().collect()),
        false => ("in the base parameters of kept columns (the other basis)", on_axes),
    };
    if !sums.is_empty() {
        writeln!(out, "{title}:")?;
        for (name, sum) in sums {
            writeln!(out, "  {name} = {}", base.sum_text(sum))?;
        }
        writeln!(out)?;
    }
    let verdict = if found.found.verified { "verified" } else { "NOT verified" };
    writeln!(out, "certificate {verdict} (exact; rank modulo {})", Residue::MODULUS)
}

fn table(found: &BaseReport<'_>) -> Table {
    let mut table = Table::new(&[
        (found.head(), Align::Left),
        ("unit", Align::Left),
        ("value", Align::Right),
        ("base parameter", Align::Left),
    ]);
    let values = found.shown_values();
    for (row, parameter) in found.listed().iter().enumerate() {
        table.push(vec![
            parameter.name.to_owned(),
            parameter.unit.to_owned(),
            values.get(row).cloned().unwrap_or_default(),
            found.base().sum_text(parameter.parts),
        ]);
    }
    table.without_empty_columns()
}
