//! Masses of shapes.

use super::frame::{Snapped, pose};
use super::settings::{Attributes, Settings};
use crate::exact::{Matrix, Vector, pi, product, root, transposed};
use crate::fault::{Cause, Faults, clip};
use crate::place::{Pose, matrix, shortest};
use denavit_codegen::number::{Rational, integer, ratio};
use num_traits::{Signed, Zero};

/// Mass, centre and tensor about it, in the axes of the body.
pub(crate) struct Lump {
    pub(crate) mass: Rational,
    pub(crate) com: Vector,
    pub(crate) inertia: Matrix,
}

/// A shape about its own centre: volume, and the moments of a mass of 1.
struct Shape {
    volume: Rational,
    moments: Vector,
}

/// The mass of a geom; nothing where it has none.
pub(crate) fn lump(
    geom: &Attributes<'_>,
    settings: &Settings<'_>,
    outer: &Pose,
    body: &str,
    snapped: &mut Snapped,
    faults: &mut Faults,
) -> Option<Lump> {
    let group = geom.number("group", faults).map_or(0, |group| super::whole(&group));
    if group < settings.groups[0] || group > settings.groups[1] {
        return None;
    }
    let mass = geom.number("mass", faults);
    let density = geom.number("density", faults).unwrap_or(integer(1000));
    if mass.as_ref().map_or(density.is_zero(), Zero::is_zero) {
        return None;
    }
    let kind = geom.get("type").map_or("sphere", |kind| kind.text);
    if matches!(kind, "plane" | "hfield") {
        return None;
    }
    let hollow = geom.get("shellinertia").is_some_and(|shell| shell.text == "true");
    if matches!(kind, "mesh" | "sdf") || geom.get("mesh").is_some() || hollow {
        let what = if hollow { "shell" } else { "mesh" };
        let said =
            format!("the mass of body `{}` is that of a {what}, which is not read", clip(body));
        faults.push(geom.at, Cause::with_hint(said, "give the body an <inertial>"));
        return None;
    }
    let mut place = pose(geom, settings, body, snapped, faults);
    let mut half_length = None;
    if let Some(ends) = geom.numbers::<6>("fromto", faults) {
        let from: Vector = std::array::from_fn(|k| ends[k].clone());
        let to: Vector = std::array::from_fn(|k| ends[3 + k].clone());
        let along: Vector = std::array::from_fn(|k| &from[k] - &to[k]);
        place.at = std::array::from_fn(|k| (&from[k] + &to[k]) / integer(2));
        let Some((turns, _)) = shortest(&along) else {
            faults.push(geom.at, Cause::new("`fromto` has no length"));
            return None;
        };
        place.turns = turns;
        half_length = Some(root(&along.iter().map(|x| x * x).sum()) / integer(2));
    }
    let shape = shape(kind, geom, half_length, faults)?;
    let mass = mass.unwrap_or_else(|| &density * &shape.volume);
    if mass.is_negative() {
        faults.push(
            geom.at,
            Cause::new(format!("a geom of body `{}` has a negative mass", clip(body))),
        );
        return None;
    }
    let whole = [&outer.turns[..], &place.turns].concat();
    let turn = matrix(&whole);
    let mut own = crate::exact::identity();
    (0..3).for_each(|k| own[k][k] = &shape.moments[k] * &mass);
    let inertia = product(&product(&turn, &own), &transposed(&turn));
    let moved = crate::exact::transformed(&matrix(&outer.turns), &place.at);
    let com = std::array::from_fn(|k| &outer.at[k] + &moved[k]);
    Some(Lump { mass, com, inertia })
}

fn shape(
    kind: &str,
    geom: &Attributes<'_>,
    half_length: Option<Rational>,
    faults: &mut Faults,
) -> Option<Shape> {
    let given: Vec<Rational> = match geom.get("size") {
        None => Vec::new(),
        Some(size) => {
            let found = size.text.split_whitespace().map(crate::exact::decimal).collect();
            let Some(found) = found else {
                crate::urdf::wrong(size, "`size`", "numbers", faults);
                return None;
            };
            found
        }
    };
    let round = matches!(kind, "capsule" | "cylinder");
    let mut size = given;
    if let Some(half) = half_length {
        // across it is as wide as its first size
        let width = size.first().cloned().unwrap_or_default();
        size = if round { vec![width, half] } else { vec![width.clone(), width, half] };
    }
    let needed = match kind {
        "sphere" => 1,
        _ if round => 2,
        "box" | "ellipsoid" => 3,
        _ => {
            faults.push(geom.at, Cause::new(format!("no geom has the type \"{}\"", clip(kind))));
            return None;
        }
    };
    if size.len() < needed || size[..needed].iter().any(|length| !length.is_positive()) {
        let said = format!("a {kind} needs {needed} sizes above 0");
        faults.push(geom.at, Cause::new(said));
        return None;
    }
    Some(solid(kind, &size))
}

/// Volume and moments of a solid of mass 1.
fn solid(kind: &str, size: &[Rational]) -> Shape {
    let square = |k: usize| &size[k] * &size[k];
    let (r, rr) = (&size[0], square(0));
    match kind {
        "sphere" => {
            let moment = &rr * ratio(2, 5);
            let moments = [moment.clone(), moment.clone(), moment];
            Shape { volume: pi() * ratio(4, 3) * &rr * r, moments }
        }
        "capsule" => {
            let height = &size[1] * integer(2);
            let volume = pi() * &rr * (&height + r * ratio(4, 3));
            let ends = r * integer(4) / (r * integer(4) + &height * integer(3));
            let middle = integer(1) - &ends;
            let round = &ends * &rr * ratio(2, 5);
            let away = &ends * &height * (r * integer(3) + &height * integer(2)) / integer(8);
            let across = &middle * (&rr * integer(3) + &height * &height) / integer(12);
            let across = across + &round + away;
            let along = middle * &rr / integer(2) + round;
            Shape { volume, moments: [across.clone(), across, along] }
        }
        "cylinder" => {
            let height = &size[1] * integer(2);
            let across = (&rr * integer(3) + &height * &height) / integer(12);
            let along = &rr / integer(2);
            Shape { volume: pi() * &rr * height, moments: [across.clone(), across, along] }
        }
        _ => {
            let is_box = kind == "box";
            let part = if is_box { ratio(1, 3) } else { ratio(1, 5) };
            let whole = &size[0] * &size[1] * &size[2];
            let volume = if is_box { whole * integer(8) } else { whole * pi() * ratio(4, 3) };
            let sum = |a: usize, b: usize| (square(a) + square(b)) * &part;
            Shape { volume, moments: [sum(1, 2), sum(0, 2), sum(0, 1)] }
        }
    }
}

/// All lumps as one.
pub(crate) fn together(lumps: &[Lump]) -> Option<Lump> {
    let mass: Rational = lumps.iter().map(|lump| &lump.mass).sum();
    if mass.is_zero() {
        return None;
    }
    let com: Vector = std::array::from_fn(|k| {
        lumps.iter().map(|lump| &lump.mass * &lump.com[k]).sum::<Rational>() / &mass
    });
    let mut inertia: Matrix = std::array::from_fn(|_| std::array::from_fn(|_| Rational::zero()));
    for lump in lumps {
        let off: Vector = std::array::from_fn(|k| &lump.com[k] - &com[k]);
        let square: Rational = off.iter().map(|x| x * x).sum();
        for row in 0..3 {
            for column in 0..3 {
                let own = if row == column { square.clone() } else { Rational::zero() };
                let away = &lump.mass * (own - &off[row] * &off[column]);
                inertia[row][column] += &lump.inertia[row][column] + away;
            }
        }
    }
    Some(Lump { mass, com, inertia })
}
