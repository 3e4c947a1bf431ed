//! Where things are in MJCF: a position, and a turn in one of five ways.

use super::settings::{Attributes, Settings};
use crate::exact::Vector;
use crate::fault::{Cause, Faults};
use crate::place::{Angle, Made, Pose, Turn, about, onto_axes, shortest};
use crate::urdf::wrong;
use crate::xml::Text;
use denavit_codegen::number::{Rational, integer};
use num_traits::{Signed, Zero};

/// Turns that were within rounding of quarter turns.
pub(crate) type Snapped = Vec<String>;

/// The pose of an element; `owner` is whose it is, for notes.
pub(crate) fn pose(
    attributes: &Attributes<'_>,
    settings: &Settings<'_>,
    owner: &str,
    snapped: &mut Snapped,
    faults: &mut Faults,
) -> Pose {
    let mut pose = Pose::identity();
    if let Some(at) = attributes.numbers("pos", faults) {
        pose.at = at;
    }
    let before = faults.count();
    let found = turns(attributes, settings, faults);
    match found {
        Some((turns, is_snapped)) => {
            if is_snapped {
                snapped.push(owner.to_owned());
            }
            pose.turns = turns;
        }
        None if faults.count() == before => {
            faults.push(attributes.at, Cause::new("this direction has no length"));
        }
        None => {}
    }
    pose
}

fn turns(
    attributes: &Attributes<'_>,
    settings: &Settings<'_>,
    faults: &mut Faults,
) -> Option<(Vec<Turn>, bool)> {
    if let Some(quat) = attributes.get("quat") {
        let [w, x, y, z] = crate::urdf::numbers(quat, "`quat`", faults)?;
        return of_quaternion(&w, &x, &y, &z);
    }
    if let Some(value) = attributes.get("axisangle") {
        let parts: Vec<&str> = value.text.split_whitespace().collect();
        let [x, y, z, angle] = crate::urdf::numbers(value, "`axisangle`", faults)?;
        let text = parts.last().copied().unwrap_or_default();
        let made = angle_of(text, &angle, settings)?;
        let (turns, is_snapped) = about(&[x, y, z], made.angle)?;
        return Some((turns, is_snapped || made.is_snapped));
    }
    if let Some(axes) = attributes.get("xyaxes") {
        let all: [Rational; 6] = crate::urdf::numbers(axes, "`xyaxes`", faults)?;
        return of_axes(&all);
    }
    if let Some(axis) = attributes.get("zaxis") {
        return shortest(&crate::urdf::numbers(axis, "`zaxis`", faults)?);
    }
    match attributes.get("euler") {
        Some(angles) => of_euler(angles, settings, faults),
        None => Some((Vec::new(), false)),
    }
}

/// An angle in the unit of the file.
pub(crate) fn angle_of(text: &str, value: &Rational, settings: &Settings<'_>) -> Option<Made> {
    if value.abs() > integer(1_000_000) {
        return None;
    }
    match settings.degrees {
        true => Some(Angle::degrees(value.clone())),
        false => Angle::radians(text),
    }
}

/// The columns of the matrix of a quaternion of any length.
fn of_quaternion(
    w: &Rational,
    x: &Rational,
    y: &Rational,
    z: &Rational,
) -> Option<(Vec<Turn>, bool)> {
    if [w, x, y, z].iter().all(|part| part.is_zero()) {
        return None;
    }
    let two = integer(2);
    let across = [w * w + x * x - y * y - z * z, (x * y + w * z) * &two, (x * z - w * y) * &two];
    let up = [(x * y - w * z) * &two, w * w - x * x + y * y - z * z, (y * z + w * x) * &two];
    Some(onto_axes(&across, &up))
}

/// x, and y made to stand at a right angle to it.
fn of_axes(all: &[Rational; 6]) -> Option<(Vec<Turn>, bool)> {
    let x: Vector = std::array::from_fn(|k| all[k].clone());
    let y: Vector = std::array::from_fn(|k| all[3 + k].clone());
    let dot = |a: &Vector, b: &Vector| -> Rational { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let square = dot(&x, &x);
    if square.is_zero() {
        return None;
    }
    let along = dot(&x, &y) / square;
    let y: Vector = std::array::from_fn(|k| &y[k] - &along * &x[k]);
    (!dot(&y, &y).is_zero()).then(|| onto_axes(&x, &y))
}

fn of_euler(
    angles: Text<'_>,
    settings: &Settings<'_>,
    faults: &mut Faults,
) -> Option<(Vec<Turn>, bool)> {
    let values: [Rational; 3] = crate::urdf::numbers(angles, "`euler`", faults)?;
    let mut turns = Vec::new();
    let mut is_snapped = false;
    for ((text, value), axis) in
        angles.text.split_whitespace().zip(&values).zip(settings.euler.chars())
    {
        let Some(made) = angle_of(text, value, settings) else {
            wrong(angles, "`euler`", "three angles", faults);
            return None;
        };
        is_snapped |= made.is_snapped;
        let about = match axis.to_ascii_lowercase() {
            'x' => 0,
            'y' => 1,
            _ => 2,
        };
        // small letters turn about the axes as they are then, large ones about those of the parent
        let at = if axis.is_ascii_lowercase() { turns.len() } else { 0 };
        turns.insert(at, Turn::new(about, made.angle));
    }
    turns.retain(|turn| turn.angle != Angle::zero());
    Some((turns, is_snapped))
}
