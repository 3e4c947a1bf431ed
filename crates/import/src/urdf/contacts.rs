//! Contact points of links, from their collision shapes.

use super::raw::{Raw, RawLink};
use super::values::{Snapped, numbers, pose, wrong};
use crate::Include;
use crate::contact::{Shape, Wanted, meshed, touch, unknown, wanted};
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
    include: &mut Include<'_>,
    faults: &mut Faults,
) {
    for wanted in wanted(options) {
        let link = raw.links.iter().find(|link| link.name.text == wanted);
        let (Some(link), Some(&place)) = (link, places.get(wanted.as_str())) else {
            let said = format!("no link of the model is called `{}`", clip(wanted));
            faults.push(0, unknown(&said, wanted, places.keys().copied()));
            continue;
        };
        let before = faults.count();
        let shapes = shapes(link, include, faults);
        if faults.count() == before {
            let lacks = "no collision shape";
            let link = Wanted { name: wanted, link: place, at: link.name.at, lacks };
            touch(tree, &link, &shapes, faults);
        }
    }
}

fn shapes(
    link: &RawLink<'_>,
    include: &mut Include<'_>,
    faults: &mut Faults,
) -> Vec<(Pose, Shape)> {
    let mut found = Vec::new();
    for collision in link.element.all("collision") {
        let mut news = Snapped::default();
        let place = pose(collision.first("origin"), link.name.text, &mut news, faults);
        let Some((geometry, place)) = collision.first("geometry").zip(place) else { continue };
        let shape = match geometry.first("mesh") {
            Some(mesh) => of_mesh(mesh, include, faults),
            None => solid(geometry, faults).map(Shape::Solid),
        };
        found.extend(shape.map(|shape| (place, shape)));
    }
    found
}

pub(super) fn solid(geometry: Element<'_>, faults: &mut Faults) -> Option<Solid> {
    let half = |value: &Rational| value / integer(2);
    if let Some(shape) = geometry.first("box") {
        let given = needed(shape, "size", faults)?;
        let size = numbers::<3>(given, "`size`", faults)?;
        if size.iter().any(Signed::is_negative) {
            wrong(given, "`size`", "0 or more", faults);
            return None;
        }
        return Some(Solid::Box(size.each_ref().map(half)));
    }
    if let Some(shape) = geometry.first("sphere") {
        return Some(Solid::Sphere(length(shape, "radius", faults)?));
    }
    let shape = geometry.first("cylinder")?;
    let (radius, whole) = (length(shape, "radius", faults), length(shape, "length", faults));
    Some(Solid::Cylinder { radius: radius?, half: half(&whole?) })
}

fn of_mesh(mesh: Element<'_>, include: &mut Include<'_>, faults: &mut Faults) -> Option<Shape> {
    let file = needed(mesh, "filename", faults)?;
    let scale = match mesh.get("scale") {
        Some(scale) => Some(numbers::<3>(scale, "`scale`", faults)?),
        None => None,
    };
    meshed(file.text, file.at, scale.as_ref(), include, faults)
}

/// An attribute that a shape cannot be without.
pub(super) fn needed<'s>(shape: Element<'s>, name: &str, faults: &mut Faults) -> Option<Text<'s>> {
    let found = shape.get(name);
    if found.is_none() {
        let said = format!("this {} has no `{name}`", clip(shape.name()));
        faults.push(shape.at(), Cause::new(said));
    }
    found
}

/// A length that is not below 0.
fn length(shape: Element<'_>, name: &str, faults: &mut Faults) -> Option<Rational> {
    let given = needed(shape, name, faults)?;
    let what = format!("`{name}`");
    let [value] = numbers::<1>(given, &what, faults)?;
    if value.is_negative() {
        wrong(given, &what, "0 or more", faults);
        return None;
    }
    Some(value)
}
