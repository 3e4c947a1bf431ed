//! Tables of parameters.

use super::headings;
use super::shown_by::motions;
use crate::html::{Cell, FormulaError, HtmlTable, Part, Row, Section};
use crate::{Values, short};
use denavit_codegen::model::Robot;
use denavit_identify::estimate::{IdentifiedParameter, Status};
use denavit_plants::UpdatedModel;
use denavit_plants::regression::RegressionModel;

/// The base parameters.
pub(crate) fn base_parameters(found: &[IdentifiedParameter]) -> Result<HtmlTable, FormulaError> {
    let columns = headings(&[
        ("parameter", false),
        ("value ± standard error", true),
        ("model", true),
        ("errors apart", true),
        ("unit", false),
        ("remark", false),
        ("formula", false),
    ]);
    let rows = found.iter().map(base_row).collect::<Result<_, _>>()?;
    let caption = "What the logs determine: sums of the bodies' parameters. Marked are those that \
                   the motion does not show, which keep their nominal values.";
    Ok(HtmlTable { caption: caption.to_owned(), columns, rows })
}

fn base_row(one: &IdentifiedParameter) -> Result<Row, FormulaError> {
    let mut remarks = Vec::new();
    match one.status {
        Status::Identified => {}
        Status::Uncertain => remarks.push("may be 0".to_owned()),
        Status::NotExcited => remarks.push("not excited".to_owned()),
    }
    if let Some(bias) = one.noise_bias.filter(|_| one.is_biased()) {
        remarks.push(format!("noise biases it by {bias:.1} errors"));
    }
    if one.is_changed() {
        remarks.push("changes with the filter".to_owned());
    }
    let is_sum = one.expression != one.name;
    let cells = vec![
        Cell::text(&one.name),
        value(one.value, one.std),
        or_empty(one.model_value, short),
        apart(one.value, one.model_value, one.std),
        Cell::unit(&one.unit),
        Cell::prose(remarks.join("; ")),
        if is_sum { Cell::folded("show", &one.latex)? } else { Cell::text("") },
    ];
    Ok(Row { cells, is_marked: one.status == Status::NotExcited })
}

/// The numbers of a model file, before and after.
pub(super) fn bodies(
    before: &Robot,
    updated: &UpdatedModel,
    found: &[IdentifiedParameter],
) -> HtmlTable {
    let columns = headings(&[
        ("parameter", false),
        ("value ± standard error", true),
        ("model", true),
        ("errors apart", true),
        ("unit", false),
        ("remark", false),
    ]);
    let after = &updated.robot;
    let mut values = [before, after].map(Values::new);
    let mut rows = Vec::new();
    for parameter in after.parameters.values().filter(|one| !one.known) {
        let old = before.parameters.values().find(|one| one.name == parameter.name);
        let old = old.and_then(|one| one.default);
        let [old, new] =
            [(0, old), (1, parameter.default)].map(|(which, it)| values[which].number(it?));
        let Some(new) = new else { continue };
        let alone = found.iter().find(|one| one.expression == parameter.name);
        let std = updated.errors.get(&parameter.name).copied();
        let is_hidden = alone.is_some_and(|one| one.status == Status::NotExcited);
        let remark = match alone.map(|one| one.status) {
            Some(Status::NotExcited) => "not excited",
            Some(Status::Uncertain) if std.is_some() => "may be 0",
            Some(Status::Identified) if std.is_some() => "",
            // about the centre of mass, or moved so that the body exists
            Some(_) => "depends on others, too",
            None if old == Some(new) => "open: as in the model",
            None => "in sums alone",
        };
        let unit = parameter.unit.as_ref().map(ToString::to_string).unwrap_or_default();
        let cells = vec![
            Cell::text(&parameter.name),
            value(new, std),
            or_empty(old, short),
            apart(new, old, std),
            Cell::unit(&unit),
            Cell::prose(remark),
        ];
        rows.push(Row { cells, is_marked: is_hidden });
    }
    let caption =
        "Numbers of the model file, of the nearest physically consistent robot. Where logs \
                   determine sums alone, the rest stays near the model, and no error is known."
            .to_owned();
    HtmlTable { caption, columns, rows }
}

/// What the motion does not show, and what would.
pub(super) fn not_excited(
    model: &RegressionModel,
    found: &[IdentifiedParameter],
) -> Option<Section> {
    let hidden = found.iter().filter(|one| one.status == Status::NotExcited);
    let names: Vec<&str> = hidden.map(|one| one.name.as_str()).collect();
    if names.is_empty() {
        return None;
    }
    let motions = motions(model, &names);
    let rows = names.iter().zip(&motions).map(|(name, motion)| {
        let cells = vec![Cell::text(*name), Cell::prose(motion)];
        Row { cells, is_marked: false }
    });
    let columns = headings(&[("parameter", false), ("shown where", false)]);
    let caption = "These keep the values of the model. By the regressor of the robot the plainest \
                   motions that show each of them, when what the logs determine is known."
        .to_owned();
    let table = HtmlTable { caption, columns, rows: rows.collect() };
    Some(Section { heading: "Not excited".to_owned(), parts: vec![Part::Table(table)] })
}

fn or_empty(value: Option<f64>, shown: fn(f64) -> String) -> Cell {
    value.map_or_else(|| Cell::text(""), |value| Cell::number(value, shown(value)))
}

/// How many standard errors a value is from the model's.
fn apart(value: f64, model: Option<f64>, std: Option<f64>) -> Cell {
    let count = model.zip(std.filter(|std| *std > 0.0)).map(|(model, std)| (value - model) / std);
    or_empty(count, |count| match count.abs() < 100.0 {
        true => format!("{count:+.1}"),
        false => format!("{count:+.0}"),
    })
}

fn value(value: f64, std: Option<f64>) -> Cell {
    let shown = std.map_or_else(|| short(value), |std| with_error(value, std));
    Cell::number(value, shown)
}

/// A value with its error: as many decimals as the error has in two digits.
fn with_error(value: f64, std: f64) -> String {
    if !(std > 0.0 && std.is_finite() && value.is_finite()) {
        return short(value);
    }
    let power = std.log10().floor();
    // errors above 100 or below a millionth are written with powers of ten
    if !(-6.0..2.0).contains(&power) {
        return format!("{value:.3e} ± {std:.1e}");
    }
    let decimals = (1.0 - power).max(0.0) as usize;
    format!("{value:.decimals$} ± {std:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_the_decimals_of_their_errors() {
        let shown = [(12.3456, 0.0234), (0.5, 3.0), (1e5, 2.5e3), (1.0, 0.0)];
        let shown = shown.map(|(value, std)| with_error(value, std));
        assert_eq!(shown, ["12.346 ± 0.023", "0.5 ± 3.0", "1.000e5 ± 2.5e3", "1"]);
    }
}
