//! References of a scenario: an object with one key, the kind.

use super::fault::Cause;
use super::ranges;
use super::read::Loader;
use super::reader::{FieldsNumbers, NodeNumbers, Report};
use crate::log::Log;
use denavit_codegen::expr::text::nearest;
use denavit_codegen::model::{Fields, Node};
use denavit_plants::trajectory::{
    Between, Bezier, CosineProfile, CubicSpline, EndCondition, Fourier, Part, Polynomial,
    QuinticSpline, Reference, Samples, Sequence,
};
use std::collections::BTreeMap;

const KINDS: &[&str] = &[
    "constant",
    "cubic",
    "quintic",
    "cosine",
    "bezier",
    "fourier",
    "polynomial",
    "sequence",
    "log",
];

/// The logs that references follow, each read once.
pub(super) struct Logs<'a> {
    load: &'a Loader<'a>,
    read: BTreeMap<String, Result<Log, Cause>>,
}

impl<'a> Logs<'a> {
    pub(super) fn new(load: &'a Loader<'a>) -> Self {
        Self { load, read: BTreeMap::new() }
    }

    pub(super) fn loader(&self) -> &'a Loader<'a> {
        self.load
    }

    pub(super) fn load(&self, file: &str) -> Result<Vec<u8>, String> {
        (self.load)(file)
    }

    fn get(&mut self, file: &str) -> &Result<Log, Cause> {
        let load = self.load;
        self.read.entry(file.to_owned()).or_insert_with(|| {
            let bytes = load(file).map_err(|reason| Cause::File(file.to_owned(), reason))?;
            let log = Log::from_csv(file, &bytes)
                .map_err(|error| Cause::Log(error.first_log_fault().clone()))?;
            match row_distance(&log).filter(|distance_s| *distance_s < ranges::LOG_PERIOD_S.least) {
                Some(distance_s) => Err(Cause::RowsTooNear(distance_s)),
                None => Ok(log),
            }
        })
    }
}

/// How far rows of a log are apart in the mean \[s\]; none of a single row.
fn row_distance(log: &Log) -> Option<f64> {
    let times = log.column("t")?;
    let gaps = times.len().checked_sub(1).filter(|gaps| *gaps > 0)?;
    Some((times[gaps] - times[0]) / gaps as f64)
}

/// A reference, or nothing with its faults noted.
pub(super) fn read(node: Node<'_>, logs: &mut Logs<'_>, report: &mut Report) -> Option<Reference> {
    if let Some(constant) = node.any_number().filter(|number| number.is_finite()) {
        return Some(Reference::Constant(constant));
    }
    let before = report.count();
    let fields = node.fields(KINDS, report)?;
    let mut kinds = fields.all().filter(|(key, _)| KINDS.contains(key));
    let Some((kind, inner)) = kinds.next() else {
        return node.wrong_kind("a number, or an object with one kind", report);
    };
    if let Some((_, other)) = kinds.next() {
        return other.wrong_kind("one kind of reference, not two", report);
    }
    let made = make(kind, inner, logs, report)?;
    if report.count() > before {
        return None;
    }
    made.map_err(|error| report.push(inner.at(), Cause::Reference(error))).ok()
}

fn make(
    kind: &str,
    node: Node<'_>,
    logs: &mut Logs<'_>,
    report: &mut Report,
) -> Option<Result<Reference, denavit_plants::Error>> {
    Some(match kind {
        "constant" => Ok(Reference::Constant(node.finite(report)?)),
        "polynomial" => Polynomial::new(node.numbers(report)).map(Reference::Polynomial),
        "cubic" => cubic(&node.fields(&["times", "values", "end_rates"], report)?, report)?,
        "quintic" => {
            let known = &["times", "values", "rates", "accelerations"];
            quintic(&node.fields(known, report)?, report)
        }
        "cosine" => {
            let fields = node.fields(&["times", "values"], report)?;
            let [times, values] = [pair(&fields, "times", report), pair(&fields, "values", report)];
            CosineProfile::new(times?, values?).map(Reference::Cosine)
        }
        "bezier" => {
            let fields = node.fields(&["times", "values"], report)?;
            let (times, values) =
                (pair(&fields, "times", report), fields.numbers("values", report));
            Bezier::new(times?, values).map(Reference::Bezier)
        }
        "fourier" => {
            let known = &["frequency_rad_s", "frequencies_rad_s", "offset", "sines", "cosines"];
            fourier(&node.fields(known, report)?, report)
        }
        "log" => logged(&node.fields(&["file", "column", "between"], report)?, logs, report)?,
        _ => sequence(&node.fields(&["parts", "repeat"], report)?, logs, report),
    })
}

fn cubic(
    fields: &Fields<'_>,
    report: &mut Report,
) -> Option<Result<Reference, denavit_plants::Error>> {
    let [times, values] = ["times", "values"].map(|key| fields.numbers(key, report));
    let ends = match fields.get("end_rates") {
        Some(_) => pair(fields, "end_rates", report)?.map(EndCondition::Rate),
        None => [EndCondition::Natural; 2],
    };
    Some(CubicSpline::new(times, values, ends).map(Reference::Cubic))
}

fn quintic(fields: &Fields<'_>, report: &mut Report) -> Result<Reference, denavit_plants::Error> {
    let [times, values] = ["times", "values"].map(|key| fields.numbers(key, report));
    let still = |key: &str, report: &mut Report| match fields.get(key) {
        Some(node) => node.numbers(report),
        None => vec![0.0; times.len()],
    };
    let (rates, accelerations) = (still("rates", report), still("accelerations", report));
    QuinticSpline::new(times, values, &rates, &accelerations).map(Reference::Quintic)
}

/// A series of multiples of one frequency, or of frequencies of its own.
fn fourier(fields: &Fields<'_>, report: &mut Report) -> Result<Reference, denavit_plants::Error> {
    let offset = fields.get("offset").and_then(|node| node.finite(report)).unwrap_or(0.0);
    let own = fields.get("frequencies_rad_s").map(|node| node.numbers(report));
    if let (true, Some(both)) = (own.is_some(), fields.get("frequency_rad_s")) {
        both.wrong_kind::<(), _>("either frequency_rad_s or frequencies_rad_s", report);
    }
    let [sines, cosines] = ["sines", "cosines"].map(|key| fields.numbers(key, report));
    let made = match own {
        Some(frequencies) => Fourier::with_frequencies(frequencies, offset, sines, cosines),
        None => {
            let frequency =
                fields.required_number("frequency_rad_s", ranges::FREQUENCY_RAD_S, report);
            Fourier::new(frequency, offset, sines, cosines)
        }
    };
    made.map(Reference::Fourier)
}

#[derive(Clone, Copy)]
enum Interpolation {
    Cubic,
    Linear,
    Hold,
}

/// A column of a log over its time.
fn logged(
    fields: &Fields<'_>,
    logs: &mut Logs<'_>,
    report: &mut Report,
) -> Option<Result<Reference, denavit_plants::Error>> {
    let [file, column] = ["file", "column"].map(|key| fields.require(key, report));
    let (file, column) = (file?, column?);
    let (file_name, name) = (file.text(report)?, column.text(report)?);
    let meanings = [Interpolation::Cubic, Interpolation::Linear, Interpolation::Hold];
    let word = fields.get("between");
    let word = word.and_then(|n| n.choice(&["cubic", "linear", "hold"], &meanings, report));
    let log = match logs.get(file_name) {
        Ok(log) => log,
        Err(cause) => {
            report.push(file.at(), cause.clone());
            return None;
        }
    };
    let Some(values) = log.column(name) else {
        let near = nearest(name, log.columns.iter().map(String::as_str)).map(str::to_owned);
        report.push(column.at(), Cause::UnknownColumn(name.to_owned(), near));
        return None;
    };
    if let Some(row) = values.iter().position(|value| !value.is_finite()) {
        report.push(column.at(), Cause::EmptyCell(name.to_owned(), log.line_of_row(row)));
        return None;
    }
    let times = log.column("t")?;
    Some(match word.unwrap_or(Interpolation::Cubic) {
        Interpolation::Cubic => {
            CubicSpline::new(times, values, [EndCondition::Natural; 2]).map(Reference::Cubic)
        }
        Interpolation::Linear => Samples::new(times, values, Between::Line).map(Reference::Samples),
        Interpolation::Hold => Samples::new(times, values, Between::Hold).map(Reference::Samples),
    })
}

fn sequence(
    fields: &Fields<'_>,
    logs: &mut Logs<'_>,
    report: &mut Report,
) -> Result<Reference, denavit_plants::Error> {
    let items = fields.require("parts", report).map_or_else(Vec::new, |node| node.items(report));
    let mut parts = Vec::new();
    for item in items {
        let Some(part) = item.fields(&["duration_s", "reference"], report) else { continue };
        let duration_s = part.required_number("duration_s", ranges::PART_S, report);
        let reference = part.require("reference", report);
        let reference = reference.and_then(|node| read(node, logs, report));
        parts.extend(reference.map(|reference| Part { duration_s, reference }));
    }
    Sequence::new(parts, fields.flag("repeat", report)).map(Reference::Sequence)
}

fn pair(fields: &Fields<'_>, key: &'static str, report: &mut Report) -> Option<[f64; 2]> {
    let numbers = fields.numbers(key, report);
    let pair = <[f64; 2]>::try_from(numbers);
    pair.map_err(|numbers| {
        report.push(fields.place(key), Cause::wrong_length(2, numbers.len()));
    })
    .ok()
}
