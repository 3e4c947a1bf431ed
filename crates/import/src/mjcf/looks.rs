//! What bodies look like: the geoms that MuJoCo itself shows.

use super::Read;
use super::body::Scope;
use super::frame::pose;
use super::geom::placed;
use super::meshes;
use super::settings::{Attributes, Settings};
use super::whole;
use crate::exact::Vector;
use crate::fault::{Faults, clip};
use crate::looks::{LinkForm, LinkShape, TreeLooks};
use crate::xml::Element;
use denavit_codegen::number::integer;
use num_traits::Zero;

/// Groups up to this one are shown where nobody asks for others.
const LAST_SHOWN: i64 = 2;

/// What the links of a file look like.
pub(super) fn of(found: Read<'_>, settings: &Settings<'_>) -> TreeLooks {
    let Read { tree, geoms, ground } = found;
    let mut remarks = Vec::new();
    let mut looks = vec![(0, of_body("world", &ground, settings, &mut remarks))];
    for (name, geoms) in &geoms {
        looks.push((geoms.link, of_body(name, &geoms.all, settings, &mut remarks)));
    }
    // links in the order of the file
    looks.sort_by_key(|&(link, _)| link);
    TreeLooks { tree, looks, remarks }
}

/// The geoms of a body that are shown, or where there are none those that are not.
fn of_body(
    body: &str,
    geoms: &[(Element<'_>, Scope<'_>)],
    settings: &Settings<'_>,
    remarks: &mut Vec<String>,
) -> Vec<LinkShape> {
    let (mut shown, mut others) = (Vec::new(), Vec::new());
    for (element, scope) in geoms {
        let mut faults = Faults::default();
        let geom = settings.with_class(*element, scope.class, &mut faults);
        if has_no_end(&geom) || is_clear(&geom, &mut faults) {
            continue;
        }
        let group = geom.number("group", &mut faults).map_or(0, |group| whole(&group));
        let form = form(&geom, scope, settings, body, &mut faults);
        if !faults.is_empty() {
            let why = faults.into_error("", &[], None).faults;
            let why = why.first().map(|fault| fault.cause.to_string()).unwrap_or_default();
            remarks.push(format!("a geom of body `{}` is not shown: {why}", clip(body)));
        } else if let Some(form) = form {
            if group <= LAST_SHOWN { &mut shown } else { &mut others }.push(form);
        }
    }
    if shown.is_empty() { others } else { shown }
}

fn form(
    geom: &Attributes<'_>,
    scope: &Scope<'_>,
    settings: &Settings<'_>,
    body: &str,
    faults: &mut Faults,
) -> Option<LinkShape> {
    // what turns of it are snapped is said where the model is made
    let mut snapped = Vec::new();
    // a solid that is fitted to a mesh stands where the mesh does
    let is_mesh = geom.get("mesh").is_some() || kind(geom) == "mesh";
    if !is_mesh {
        let (place, solid) = placed(geom, settings, &scope.frame, body, &mut snapped, faults)?;
        return Some(LinkShape { place, form: LinkForm::Solid(solid) });
    }
    let place = pose(geom, settings, body, &mut snapped, faults).within(&scope.frame);
    let asset = meshes::asset(geom, settings, "save the mesh as a file", faults)?;
    let scale: Vector = asset.scale.unwrap_or_else(|| [1, 1, 1].map(integer));
    Some(LinkShape { place, form: LinkForm::Mesh(asset.path, scale) })
}

fn kind<'s>(geom: &Attributes<'s>) -> &'s str {
    geom.get("type").map_or("sphere", |kind| kind.text)
}

/// Ground, and what is no solid.
fn has_no_end(geom: &Attributes<'_>) -> bool {
    matches!(kind(geom), "plane" | "hfield" | "sdf")
}

fn is_clear(geom: &Attributes<'_>, faults: &mut Faults) -> bool {
    geom.numbers::<4>("rgba", faults).is_some_and(|[.., opaque]| opaque.is_zero())
}
