//! Meshes of geoms: assets by name, whose files stand in a folder of their own.

use super::settings::{Attributes, Settings};
use crate::Include;
use crate::contact::{Shape, meshed};
use crate::exact::Vector;
use crate::fault::{Cause, Faults, clip};
use denavit_codegen::number::Rational;
use num_traits::{One, Zero};

/// The mesh of a geom, as its file has it, which is what the geom's pose is of.
pub(crate) fn of_geom(
    geom: &Attributes<'_>,
    settings: &Settings<'_>,
    include: &mut Include<'_>,
    faults: &mut Faults,
) -> Option<Shape> {
    let hint = "write \"contacts\" into the model file";
    let asset = asset(geom, settings, hint, faults)?;
    meshed(&asset.path, asset.at, asset.scale.as_ref(), include, faults)
}

/// The file of a mesh.
pub(crate) struct Asset {
    /// From the folder of the description.
    pub(crate) path: String,
    /// Where the file is named.
    at: usize,
    pub(crate) scale: Option<Vector>,
}

/// The file of a geom's mesh; `hint` is the way out where it has none.
pub(crate) fn asset(
    geom: &Attributes<'_>,
    settings: &Settings<'_>,
    hint: &str,
    faults: &mut Faults,
) -> Option<Asset> {
    let Some(wanted) = geom.get("mesh") else {
        faults.push(geom.at, Cause::new("a geom of the type mesh has no `mesh`"));
        return None;
    };
    let is_it = |asset: &Attributes<'_>| name(asset) == Some(wanted.text);
    let assets = settings.meshes.iter().map(|&asset| settings.with_class(asset, None, faults));
    let Some(asset) = assets.collect::<Vec<_>>().into_iter().find(is_it) else {
        let said = format!("no mesh is called `{}`", clip(wanted.text));
        faults.push(wanted.at, Cause::new(said));
        return None;
    };
    let Some(file) = asset.get("file") else {
        let said = format!("the mesh `{}` has no file", clip(wanted.text));
        faults.push(asset.at, Cause::with_hint(said, hint));
        return None;
    };
    let before = faults.count();
    let scale: Option<Vector> = asset.numbers("scale", faults);
    if is_moved(&asset, faults) {
        let said = format!("the mesh `{}` has `refpos` or `refquat`", clip(wanted.text));
        faults.push(asset.at, Cause::with_hint(said, format!("move the geom instead, or {hint}")));
    }
    if faults.count() > before {
        return None;
    }
    Some(Asset { path: settings.mesh_path(file.text), at: file.at, scale })
}

/// The name of an asset: that of its file, if it has none.
fn name<'s>(asset: &Attributes<'s>) -> Option<&'s str> {
    if let Some(name) = asset.get("name") {
        return Some(name.text);
    }
    let file = asset.get("file")?.text;
    let last = file.rsplit(['/', '\\']).next().unwrap_or(file);
    Some(last.rsplit_once('.').map_or(last, |(stem, _)| stem))
}

fn is_moved(asset: &Attributes<'_>, faults: &mut Faults) -> bool {
    let at = asset.numbers::<3>("refpos", faults);
    let turn = asset.numbers::<4>("refquat", faults);
    let is_turned =
        |[w, rest @ ..]: &[Rational; 4]| !w.is_one() || rest.iter().any(|part| !part.is_zero());
    at.is_some_and(|at| at.iter().any(|x| !x.is_zero())) || turn.as_ref().is_some_and(is_turned)
}
