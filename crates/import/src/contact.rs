//! Contact points of links, from the shapes that they touch others with.

use crate::exact::{Vector, rounded, transformed, transposed};
use crate::names::identifier;
use crate::place::{Pose, is_quarter, matrix};
use crate::solid::Solid;
use crate::tree::{Tree, TreeContact};

/// What to do where a link has no shape that gives points.
pub(crate) const NO_SHAPE: &str = "meshes are not read: write \"contacts\" into the model file";

/// Adds the points of a link's solids, each in its pose in the link; whether there are any.
pub(crate) fn touch(tree: &mut Tree, name: &str, link: usize, solids: &[(Pose, Solid)]) -> bool {
    let down = down_in(tree, link);
    let points = solids.iter().flat_map(|(place, solid)| {
        let own_down = transformed(&transposed(&matrix(&place.turns)), &down);
        solid.lowest(&own_down).into_iter().map(|point| in_link(place, &point))
    });
    let points: Vec<Vector> = points.collect();
    let found = !points.is_empty();
    for (at, point) in points.into_iter().enumerate() {
        let name = format!("{}_{}", identifier(name), at + 1);
        tree.contacts.push(TreeContact { name, link, at: point });
    }
    found
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
    transformed(&transposed(&matrix(&turns)), &tree.gravity)
}

fn in_link(place: &Pose, point: &Vector) -> Vector {
    let moved = transformed(&matrix(&place.turns), point);
    let is_exact = is_quarter(&place.turns);
    std::array::from_fn(|k| {
        let sum = &place.at[k] + &moved[k];
        if is_exact { sum } else { rounded(&sum) }
    })
}
