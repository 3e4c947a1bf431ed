//! Base parameters as Markdown.

use super::BaseReport;
use denavit_codegen::number::Residue;

/// A table, and lists of what is alone, without effect, or a sum of others.
pub(super) fn document(found: &BaseReport<'_>) -> String {
    let base = found.base();
    let columns = base.regressor.columns.len();
    let mut text = format!(
        "# Base parameters of {}\n\n{} base parameters of {columns} columns{}. Names `m`, `mx`, \
         `my`, `mz`, `Ixx` to `Iyz` are about the origin of the link frame.\n\n",
        escaped(&found.found.robot.name),
        base.rank(),
        found.place()
    );
    let head = found.head();
    let values = found.shown_values();
    text.push_str(&match values.is_empty() {
        true => format!("| | {head} | unit | base parameter |\n|---:|---|---|---|\n"),
        false => format!("| | {head} | unit | value | base parameter |\n|---:|---|---|---:|---|\n"),
    });
    for (row, parameter) in found.listed().iter().enumerate() {
        let (name, unit) = (parameter.name, parameter.unit);
        let value = values.get(row).map_or(String::new(), |value| format!(" {value} |"));
        let formula = base.sum_text(parameter.parts);
        text.push_str(&format!("| {} | `{name}` | {unit} |{value} `{formula}` |\n", row + 1));
    }
    for (title, names) in [
        ("Identifiable alone", found.names(base.alone())),
        ("Without any effect", found.names(base.zero())),
    ] {
        if !names.is_empty() {
            text.push_str(&format!("\n## {title}\n\n`{}`\n", names.join("`, `")));
        }
    }
    let on_axes = found.in_kept();
    let (title, sums) = match on_axes.is_empty() {
        true => ("Columns that are sums of kept columns", found.sums().collect()),
        false => ("In the base parameters of kept columns", on_axes),
    };
    if !sums.is_empty() {
        text.push_str(&format!("\n## {title}\n\n"));
        for (name, sum) in sums {
            text.push_str(&format!("- `{name} = {}`\n", base.sum_text(sum)));
        }
    }
    let verdict = if found.found.verified { "verified" } else { "not verified" };
    text.push_str(&format!(
        "\nThe certificate is {verdict}: exact relations, rank modulo {}.\n",
        Residue::MODULUS
    ));
    text
}

/// A name in running text.
pub(super) fn escaped(name: &str) -> String {
    name.replace('_', "\\_")
}
