//! Contact points of bodies, from the geoms that touch others.

use super::body::Touching;
use super::geom::{placed, touches};
use super::settings::Settings;
use crate::contact::{Wanted, touch, wanted};
use crate::fault::{Cause, Faults, clip};
use crate::options::Options;
use crate::place::Pose;
use crate::solid::Solid;
use crate::tree::Tree;
use std::collections::BTreeMap;

/// Adds the points of the bodies that were asked for.
pub(crate) fn find(
    tree: &mut Tree,
    bodies: &BTreeMap<String, Touching<'_>>,
    settings: &Settings<'_>,
    options: &Options,
    faults: &mut Faults,
) {
    for wanted in wanted(options) {
        let Some(body) = bodies.get(wanted) else {
            let said = format!("`options.contacts`: no body is called `{}`", clip(wanted));
            faults.push(0, Cause::new(said));
            continue;
        };
        let before = faults.count();
        let solids = solids(wanted, body, settings, faults);
        if faults.count() == before {
            let lacks = "no geom that touches others";
            let link = Wanted { name: wanted, link: body.link, at: body.at, lacks };
            touch(tree, &link, &solids, faults);
        }
    }
}

fn solids(
    name: &str,
    body: &Touching<'_>,
    settings: &Settings<'_>,
    faults: &mut Faults,
) -> Vec<(Pose, Solid)> {
    let mut found = Vec::new();
    for (geom, scope) in &body.geoms {
        let geom = settings.with_class(*geom, scope.class, faults);
        let kind = geom.get("type").map_or("sphere", |kind| kind.text);
        let is_solid = !matches!(kind, "plane" | "hfield" | "mesh" | "sdf");
        if is_solid && geom.get("mesh").is_none() && touches(&geom, faults) {
            // what turns of it are snapped is said where its mass is read
            let mut snapped = Vec::new();
            found.extend(placed(&geom, settings, &scope.frame, name, &mut snapped, faults));
        }
    }
    found
}
