//! Contact points of links, from the shapes that they touch others with.

use crate::exact::{Vector, rounded, transformed, transposed};
use crate::fault::{Cause, Faults, clip};
use crate::mesh::{corners, sole};
use crate::names::identifier;
use crate::options::Options;
use crate::place::{Pose, Turn, is_quarter, matrix};
use crate::solid::Solid;
use crate::tree::{Tree, TreeContact};
use crate::{Beside, Include};
use denavit_codegen::expr::text::nearest;
use num_traits::Zero;

/// What a link touches others with.
pub(crate) enum Shape {
    Solid(Solid),
    /// Corners of the mesh of this name.
    Mesh(String, Vec<Vector>),
}

/// A link that is to have contact points.
pub(crate) struct Wanted<'a> {
    pub(crate) name: &'a str,
    /// Its place in the tree, and in the file.
    pub(crate) link: usize,
    pub(crate) at: usize,
    /// What it has none of, where it has no solids.
    pub(crate) lacks: &'a str,
}

/// The links that are asked for, each once.
pub(crate) fn wanted(options: &Options) -> impl Iterator<Item = &String> {
    let all = &options.contacts;
    all.iter().enumerate().filter(|(at, name)| !all[..*at].contains(name)).map(|(_, name)| name)
}

/// The fault of a name of contacts that nothing has.
pub(crate) fn unknown<'n>(said: &str, name: &str, all: impl Iterator<Item = &'n str>) -> Cause {
    let said = format!("`options.contacts`: {said}");
    match nearest(name, all) {
        Some(near) => Cause::with_hint(said, format!("did you mean `{}`?", clip(near))),
        None => Cause::new(said),
    }
}

/// Adds the points of a link's shapes, each in its pose in the link.
pub(crate) fn touch(
    tree: &mut Tree,
    link: &Wanted<'_>,
    shapes: &[(Pose, Shape)],
    faults: &mut Faults,
) {
    let &Wanted { name, link, at, lacks } = link;
    if shapes.is_empty() {
        let said = format!("`{}` has {lacks}", clip(name));
        let hint = "write \"contacts\" into the model file";
        faults.push(at, Cause::with_hint(said, hint));
    }
    if tree.gravity.iter().all(Zero::is_zero) {
        let said = "without gravity no point of a link is its lowest";
        let hint = "write \"contacts\" into the model file";
        faults.push(at, Cause::with_hint(said, hint));
        return;
    }
    let down = down_in(tree, link);
    let mut points: Vec<Vector> = Vec::new();
    for (place, shape) in shapes {
        let own_down = transformed(&transposed(&matrix(&place.turns)), &down);
        let lowest = match shape {
            Shape::Solid(solid) => solid.lowest(&own_down),
            Shape::Mesh(file, corners) => {
                let sole = sole(corners, &own_down);
                tree.notes.push(sole.note(name, file));
                sole.points
            }
        };
        points.extend(lowest.iter().map(|point| in_link(place, point)));
    }
    for (at, point) in points.into_iter().enumerate() {
        let name = format!("{}_{}", identifier(name), at + 1);
        tree.contacts.push(TreeContact { name, link, at: point });
    }
}

/// The mesh of a file, each axis by its scale.
pub(crate) fn meshed(
    file: &str,
    at: usize,
    scale: Option<&Vector>,
    include: &mut Include<'_>,
    faults: &mut Faults,
) -> Option<Shape> {
    let found = include(Beside::Mesh(file)).and_then(|bytes| corners(file, &bytes));
    match found {
        Ok(mut corners) => {
            if let Some(scale) = scale {
                corners
                    .iter_mut()
                    .flat_map(|at| at.iter_mut().zip(scale))
                    .for_each(|(x, by)| *x *= by);
            }
            Some(Shape::Mesh(file.to_owned(), corners))
        }
        Err(why) => {
            let said = format!("the mesh {} is not read: {why}", clip(file));
            let hint = "say where the meshes are, or write \"contacts\" into the model file";
            faults.push(at, Cause::with_hint(said, hint));
            None
        }
    }
}

/// The direction of free fall in the frame of a link where all joints are at 0.
fn down_in(tree: &Tree, link: usize) -> Vector {
    let mut turns = Vec::new();
    let mut at = Some(link);
    while let Some(link) = at.map(|at| &tree.links[at]) {
        let mut own: Vec<_> = link.before.iter().flat_map(|pose| pose.turns.clone()).collect();
        if let Some(joint) = &link.joint {
            // its frame is turned where its variable is 0
            let back = joint.axis.iter().rev();
            own.extend(joint.axis.iter().cloned());
            own.push(Turn::new(2, joint.zero.0.clone()));
            own.extend(back.map(|turn| Turn::new(turn.axis, turn.angle.clone().negated())));
        }
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
