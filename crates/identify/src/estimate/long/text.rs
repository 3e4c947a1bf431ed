//! Rows of a piece of a long log as JSON, so that pieces are condensed where the log is and added
//! elsewhere. Numbers are printed with all their digits, and read as they were.

use super::super::condensed::Condensed;
use super::LongRows;
use crate::error::{Error, ErrorKind};
use crate::policy::long::LARGEST;
use denavit_measure::LogIndex;
use denavit_numerics::least_squares::Triangle;
use denavit_plants::regression::RegressionModel;
use serde_json::{Value, json};
use std::fmt;

/// Rows of a triangle, at most: more than a century at 1 MHz.
const MOST_ROWS: usize = 1 << 52;

fn wrong(reason: impl fmt::Display) -> Error {
    Error::new(ErrorKind::Piece, reason.to_string())
}

impl LongRows {
    /// As JSON: triangles by their columns, from the top to the diagonal.
    pub fn to_json(&self) -> Value {
        let Self { condensed, all, torque_squares, samples } = self;
        json!({
            "counted": condensed_json(condensed),
            "all": all.iter().map(triangle_json).collect::<Vec<_>>(),
            "torque_squares": torque_squares,
            "samples": samples,
        })
    }

    /// Of a model, from JSON.
    ///
    /// # Errors
    /// It is something else, or of another model.
    pub fn of_json(model: &RegressionModel, value: &Value) -> Result<Self, Error> {
        let samples = value["samples"].as_u64().ok_or_else(|| wrong("`samples` is no count"))?;
        let joints = model.joints.len();
        let torque_squares = numbers(&value["torque_squares"], joints, "`torque_squares`")?;
        if torque_squares.iter().any(|squares| *squares < 0.0) {
            return Err(wrong("`torque_squares` has a number below 0"));
        }
        Ok(Self {
            condensed: condensed_of_json(model, &value["counted"])?,
            all: of_joints(model, &value["all"])?,
            torque_squares,
            samples: usize::try_from(samples).map_err(wrong)?,
        })
    }
}

fn condensed_json(condensed: &Condensed) -> Value {
    let parts = condensed.parts.iter().map(|part| {
        let joints: Vec<Value> = part.iter().map(triangle_json).collect();
        Value::from(joints)
    });
    json!({
        "parts": parts.collect::<Vec<_>>(),
        "end_s": condensed.end_s,
        "independent": condensed.independent[0],
        "row_s": condensed.row_s[0],
    })
}

fn condensed_of_json(model: &RegressionModel, value: &Value) -> Result<Condensed, Error> {
    let parts = list(&value["parts"], "`parts`")?.iter().map(|part| of_joints(model, part));
    let parts = parts.collect::<Result<Vec<_>, _>>()?;
    let number = |key: &str| {
        let found = value[key].as_f64().filter(|found| found.is_finite());
        found.ok_or_else(|| wrong(format!("`{key}` is no number")))
    };
    let end_s = numbers(&value["end_s"], parts.len(), "`end_s`")?;
    let (independent, row_s) = (number("independent")?, number("row_s")?);
    let is_in_order = end_s.windows(2).all(|pair| pair[0] < pair[1]);
    let is_share = (f64::MIN_POSITIVE..=1.0).contains(&independent);
    if !(is_in_order && is_share && row_s > 0.0) {
        return Err(wrong("times, or shares of rows, that no log has"));
    }
    Ok(Condensed {
        log_of_part: vec![LogIndex(0); parts.len()],
        end_s,
        parts,
        independent: vec![independent],
        row_s: vec![row_s],
        rank: model.rank(),
        pattern: model.pattern().to_vec(),
    })
}

fn of_joints(model: &RegressionModel, value: &Value) -> Result<Vec<Triangle>, Error> {
    let (joints, pattern) = (list(value, "a triangle for each joint")?, model.pattern());
    if joints.len() != pattern.len() {
        let (its, own) = (joints.len(), pattern.len());
        return Err(wrong(format!("it has {its} joints, and the model {own}")));
    }
    let both = joints.iter().zip(pattern);
    both.map(|(one, places)| triangle_of_json(one, places.len())).collect()
}

fn list<'a>(value: &'a Value, what: &str) -> Result<&'a Vec<Value>, Error> {
    value.as_array().ok_or_else(|| wrong(format!("{what} is no list")))
}

fn numbers(value: &Value, count: usize, what: &str) -> Result<Vec<f64>, Error> {
    let all: Option<Vec<f64>> = list(value, what)?.iter().map(Value::as_f64).collect();
    let all = all.filter(|all| all.iter().all(|one| one.is_finite()));
    let all = all.ok_or_else(|| wrong(format!("{what} has something that is no number")))?;
    match all.len() == count {
        true => Ok(all),
        false => Err(wrong(format!("{what} has {} numbers instead of {count}", all.len()))),
    }
}

fn triangle_json(one: &Triangle) -> Value {
    let size = one.width() + 1;
    let entry = |(row, column): (usize, usize)| one.matrix()[(row, column)];
    let places = (0..size).flat_map(|column| (0..=column).map(move |row| (row, column)));
    json!({
        "rows": one.rows(),
        "r": places.map(entry).collect::<Vec<_>>(),
        "sums": one.sums().as_slice(),
    })
}

fn triangle_of_json(value: &Value, width: usize) -> Result<Triangle, Error> {
    let size = width + 1;
    let rows = value["rows"].as_u64().and_then(|rows| usize::try_from(rows).ok());
    let rows = rows.ok_or_else(|| wrong("`rows` is no count"))?;
    let entries = numbers(&value["r"], size * (size + 1) / 2, "`r`")?;
    let sums = numbers(&value["sums"], size, "`sums`")?;
    let is_empty = entries.iter().chain(&sums).all(|entry| *entry == 0.0);
    // their squares are to be numbers, and no rows are no sums
    let is_possible = entries.iter().all(|entry| entry.abs() < LARGEST);
    if !is_possible || rows == 0 && !is_empty || rows > MOST_ROWS {
        return Err(wrong("a triangle that no rows have"));
    }
    Ok(Triangle::of_entries(&entries, sums, rows))
}
