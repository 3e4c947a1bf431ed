//! Contact points of bodies, from the geoms that touch others.

use super::body::Geoms;
use super::frame::pose;
use super::geom::{placed, touches};
use super::meshes;
use super::settings::Settings;
use crate::Include;
use crate::contact::{Shape, Wanted, touch, unknown, wanted};
use crate::fault::{Faults, clip};
use crate::options::Options;
use crate::place::Pose;
use crate::tree::Tree;
use std::collections::BTreeMap;

/// Adds the points of the bodies that were asked for.
pub(crate) fn find(
    tree: &mut Tree,
    bodies: &BTreeMap<String, Geoms<'_>>,
    settings: &Settings<'_>,
    options: &Options,
    include: &mut Include<'_>,
    faults: &mut Faults,
) {
    for wanted in wanted(options) {
        let Some(body) = bodies.get(wanted) else {
            let said = format!("no body is called `{}`", clip(wanted));
            faults.push(0, unknown(&said, wanted, bodies.keys().map(String::as_str)));
            continue;
        };
        let before = faults.count();
        let shapes = shapes(wanted, body, settings, include, faults);
        if faults.count() == before {
            let lacks = "no geom that touches others";
            let link = Wanted { name: wanted, link: body.link, at: body.at, lacks };
            touch(tree, &link, &shapes, faults);
        }
    }
}

fn shapes(
    name: &str,
    body: &Geoms<'_>,
    settings: &Settings<'_>,
    include: &mut Include<'_>,
    faults: &mut Faults,
) -> Vec<(Pose, Shape)> {
    let mut found = Vec::new();
    for (geom, scope) in &body.all {
        let geom = settings.with_class(*geom, scope.class, faults);
        let kind = geom.get("type").map_or("sphere", |kind| kind.text);
        if matches!(kind, "plane" | "hfield" | "sdf") || !touches(&geom, faults) {
            continue;
        }
        // what turns of it are snapped is said where its mass is read
        let mut snapped = Vec::new();
        if kind == "mesh" {
            let place = pose(&geom, settings, name, &mut snapped, faults).within(&scope.frame);
            let shape = meshes::of_geom(&geom, settings, include, faults);
            found.extend(shape.map(|shape| (place, shape)));
        } else if geom.get("mesh").is_none() {
            let solid = placed(&geom, settings, &scope.frame, name, &mut snapped, faults);
            found.extend(solid.map(|(place, solid)| (place, Shape::Solid(solid))));
        }
    }
    found
}
