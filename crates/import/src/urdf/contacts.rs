//! Contact points of links, from their collision boxes and spheres.

use super::raw::{Raw, RawLink};
use super::values::{Snapped, numbers, pose, wrong};
use crate::exact::{Vector, rounded, transformed};
use crate::fault::{Cause, Faults, clip};
use crate::names::identifier;
use crate::options::Options;
use crate::place::{Pose, is_quarter, matrix};
use crate::tree::{Tree, TreeContact};
use crate::xml::Element;
use denavit_codegen::number::{Rational, integer};
use num_traits::Zero;
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
        let down = down_in(tree, place);
        let points = points(link, &down, faults);
        if points.is_empty() {
            let said = format!("link `{}` has no collision box or sphere", clip(wanted));
            let hint = "meshes are not read: write \"contacts\" into the model file";
            faults.push(link.name.at, Cause::with_hint(said, hint));
        }
        for (at, point) in points.into_iter().enumerate() {
            let name = format!("{}_{}", identifier(wanted), at + 1);
            tree.contacts.push(TreeContact { name, link: place, at: point });
        }
    }
}

/// The direction of free fall in the frame of a link where all joints are at 0.
fn down_in(tree: &Tree, link: usize) -> Vector {
    let mut turns = Vec::new();
    let mut at = Some(link);
    while let Some(link) = at.map(|at| &tree.links[at]) {
        let mut own: Vec<_> = link.before.iter().flat_map(|pose| pose.turns.clone()).collect();
        own.extend(link.after.iter().flat_map(|pose| pose.turns.clone()));
        own.extend(turns);
        turns = own;
        at = link.parent;
    }
    transformed(&crate::exact::transposed(&matrix(&turns)), &tree.gravity)
}

fn points(link: &RawLink<'_>, down: &Vector, faults: &mut Faults) -> Vec<Vector> {
    let mut found = Vec::new();
    for collision in link.element.all("collision") {
        let mut news = Snapped::default();
        let place = pose(collision.first("origin"), link.name.text, &mut news, faults);
        let Some((geometry, place)) = collision.first("geometry").zip(place) else { continue };
        let turn = matrix(&place.turns);
        let own_down = transformed(&crate::exact::transposed(&turn), down);
        let inside = shape_points(geometry, &own_down, faults);
        found.extend(inside.into_iter().map(|point| in_link(&place, &point)));
    }
    found
}

fn in_link(place: &Pose, point: &Vector) -> Vector {
    let moved = transformed(&matrix(&place.turns), point);
    let is_exact = is_quarter(&place.turns);
    std::array::from_fn(|k| {
        let sum = &place.at[k] + &moved[k];
        if is_exact { sum } else { rounded(&sum) }
    })
}

/// The four corners of a box that are lowest, or the lowest point of a sphere.
fn shape_points(geometry: Element<'_>, down: &Vector, faults: &mut Faults) -> Vec<Vector> {
    let half = |value: &Rational| value / integer(2);
    let axis = (0..3).max_by_key(|&k| &down[k] * &down[k]).unwrap_or(2);
    let sign = integer(if down[axis] < Rational::zero() { -1 } else { 1 });
    if let Some(size) = geometry.first("box").and_then(|shape| shape.get("size")) {
        let Some(size) = numbers::<3>(size, "`size`", faults) else { return Vec::new() };
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        return [(1, 1), (1, -1), (-1, -1), (-1, 1)]
            .map(|(a, b)| {
                let mut point: Vector = std::array::from_fn(|_| Rational::zero());
                point[axis] = half(&size[axis]) * &sign;
                point[u] = half(&size[u]) * integer(a);
                point[v] = half(&size[v]) * integer(b);
                point
            })
            .to_vec();
    }
    if let Some(given) = geometry.first("sphere").and_then(|shape| shape.get("radius")) {
        let Some([radius]) = numbers::<1>(given, "`radius`", faults) else { return Vec::new() };
        if radius < Rational::zero() {
            wrong(given, "`radius`", "0 or more", faults);
            return Vec::new();
        }
        let length = crate::exact::root(&down.iter().map(|x| x * x).sum());
        if length.is_zero() {
            return Vec::new();
        }
        return vec![down.each_ref().map(|x| rounded(&(x / &length * &radius)))];
    }
    Vec::new()
}
