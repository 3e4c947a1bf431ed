//! Contact points of links, from their collision shapes.

use super::raw::{Raw, RawLink};
use super::values::{Snapped, numbers, pose, wrong};
use crate::contact::{NO_SHAPE, touch};
use crate::fault::{Cause, Faults, clip};
use crate::options::Options;
use crate::place::Pose;
use crate::solid::Solid;
use crate::tree::Tree;
use crate::xml::{Element, Text};
use denavit_codegen::number::{Rational, integer};
use num_traits::Signed;
use std::collections::BTreeMap;

/// Adds the points of the links that were asked for.
pub(crate) fn find(
    tree: &mut Tree,
    raw: &Raw<'_>,
    places: &BTreeMap<&str, usize>,
    options: &Options,
    faults: &mut Faults,
) {
    for wanted in &options.contacts {
        let link = raw.links.iter().find(|link| link.name.text == wanted);
        let (Some(link), Some(&place)) = (link, places.get(wanted.as_str())) else {
            let said =
                format!("`options.contacts`: no link of the model is called `{}`", clip(wanted));
            faults.push(0, Cause::new(said));
            continue;
        };
        let before = faults.count();
        let solids = solids(link, faults);
        if !touch(tree, wanted, place, &solids) && faults.count() == before {
            let said = format!("link `{}` has no collision box, sphere or cylinder", clip(wanted));
            faults.push(link.name.at, Cause::with_hint(said, NO_SHAPE));
        }
    }
}

fn solids(link: &RawLink<'_>, faults: &mut Faults) -> Vec<(Pose, Solid)> {
    let mut found = Vec::new();
    for collision in link.element.all("collision") {
        let mut news = Snapped::default();
        let place = pose(collision.first("origin"), link.name.text, &mut news, faults);
        let Some((geometry, place)) = collision.first("geometry").zip(place) else { continue };
        found.extend(solid(geometry, faults).map(|solid| (place, solid)));
    }
    found
}

fn solid(geometry: Element<'_>, faults: &mut Faults) -> Option<Solid> {
    let half = |value: &Rational| value / integer(2);
    if let Some(size) = geometry.first("box").and_then(|shape| shape.get("size")) {
        let size = numbers::<3>(size, "`size`", faults)?;
        return Some(Solid::Box(size.each_ref().map(half)));
    }
    if let Some(given) = geometry.first("sphere").and_then(|shape| shape.get("radius")) {
        return Some(Solid::Sphere(length(given, "`radius`", faults)?));
    }
    let cylinder = geometry.first("cylinder")?;
    let (radius, whole) = (cylinder.get("radius")?, cylinder.get("length")?);
    let radius = length(radius, "`radius`", faults);
    let whole = length(whole, "`length`", faults);
    Some(Solid::Cylinder { radius: radius?, half: half(&whole?) })
}

/// A length that is not below 0.
fn length(given: Text<'_>, what: &str, faults: &mut Faults) -> Option<Rational> {
    let [value] = numbers::<1>(given, what, faults)?;
    if value.is_negative() {
        wrong(given, what, "0 or more", faults);
        return None;
    }
    Some(value)
}
