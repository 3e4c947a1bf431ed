//! What links look like: their visual shapes, or those that they touch others with.

use super::contacts::{needed, solid};
use super::raw;
use super::values::{Snapped, numbers, pose};
use crate::fault::Faults;
use crate::looks::{LinkForm, LinkShape};
use crate::xml::Element;
use denavit_codegen::number::integer;

/// The shapes of each link, by its name.
pub(crate) fn looks(robot: Element<'_>, faults: &mut Faults) -> Vec<(String, Vec<LinkShape>)> {
    // what is wrong with the rest of the file is told by the tree
    let raw = raw::read(robot, &mut Faults::default());
    let mut all = Vec::new();
    for link in &raw.links {
        let name = link.name.text;
        let mut found = of(link.element, "visual", name, faults);
        if found.is_empty() {
            found = of(link.element, "collision", name, faults);
        }
        all.push((name.to_owned(), found));
    }
    all
}

fn of(link: Element<'_>, kind: &'static str, name: &str, faults: &mut Faults) -> Vec<LinkShape> {
    let mut found = Vec::new();
    for shape in link.all(kind) {
        let mut news = Snapped::default();
        let place = pose(shape.first("origin"), name, &mut news, faults);
        let Some((geometry, place)) = shape.first("geometry").zip(place) else { continue };
        let form = match geometry.first("mesh") {
            Some(mesh) => of_mesh(mesh, faults),
            None => solid(geometry, faults).map(LinkForm::Solid),
        };
        found.extend(form.map(|form| LinkShape { place, form }));
    }
    found
}

fn of_mesh(mesh: Element<'_>, faults: &mut Faults) -> Option<LinkForm> {
    let file = needed(mesh, "filename", faults)?;
    let scale = match mesh.get("scale") {
        Some(scale) => numbers::<3>(scale, "`scale`", faults)?,
        None => [1, 1, 1].map(integer),
    };
    Some(LinkForm::Mesh(file.text.to_owned(), scale))
}
