//! Shapes of bodies, and their masses.

use super::frame::{Snapped, pose};
use super::settings::{Attributes, Settings};
use crate::exact::{Matrix, Vector, product, root, transposed};
use crate::fault::{Cause, Faults, clip};
use crate::place::{Pose, matrix, shortest};
use crate::solid::Solid;
use denavit_codegen::number::{Rational, integer};
use num_traits::{Signed, Zero};

/// Mass, centre and tensor about it, in the axes of the body.
pub(crate) struct Lump {
    pub(crate) mass: Rational,
    pub(crate) com: Vector,
    pub(crate) inertia: Matrix,
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
    let (place, solid) = placed(geom, settings, outer, body, snapped, faults)?;
    let (volume, moments) = solid.volume_and_moments();
    let mass = mass.unwrap_or_else(|| &density * &volume);
    if mass.is_negative() {
        let said = format!("a geom of body `{}` has a negative mass", clip(body));
        faults.push(geom.at, Cause::new(said));
        return None;
    }
    let turn = matrix(&place.turns);
    let mut own = crate::exact::identity();
    (0..3).for_each(|k| own[k][k] = &moments[k] * &mass);
    let inertia = product(&product(&turn, &own), &transposed(&turn));
    Some(Lump { mass, com: place.at, inertia })
}

/// Whether a geom touches others at all.
pub(crate) fn touches(geom: &Attributes<'_>, faults: &mut Faults) -> bool {
    let mut is_on = |key| geom.number(key, faults).is_none_or(|bits| !bits.is_zero());
    let of_type = is_on("contype");
    is_on("conaffinity") || of_type
}

/// A geom as a solid, and its pose in the body; nothing where it is none.
pub(crate) fn placed(
    geom: &Attributes<'_>,
    settings: &Settings<'_>,
    outer: &Pose,
    body: &str,
    snapped: &mut Snapped,
    faults: &mut Faults,
) -> Option<(Pose, Solid)> {
    let kind = geom.get("type").map_or("sphere", |kind| kind.text);
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
    let solid = solid(kind, geom, half_length, faults)?;
    Some((place.within(outer), solid))
}

fn solid(
    kind: &str,
    geom: &Attributes<'_>,
    half_length: Option<Rational>,
    faults: &mut Faults,
) -> Option<Solid> {
    let given: Vec<Rational> = match geom.size() {
        None => Vec::new(),
        Some((size, words)) => {
            let found = words.into_iter().map(crate::exact::decimal).collect();
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
    let mut size = size.into_iter();
    let mut next = || size.next().unwrap_or_default();
    Some(match kind {
        "sphere" => Solid::Sphere(next()),
        "capsule" => Solid::Capsule { radius: next(), half: next() },
        "cylinder" => Solid::Cylinder { radius: next(), half: next() },
        "box" => Solid::Box([next(), next(), next()]),
        _ => Solid::Ellipsoid([next(), next(), next()]),
    })
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
