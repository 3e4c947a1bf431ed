//! Shapes of links for pages: triangles in the frames of links, no more than a page has room for.

mod obj;
mod solids;
mod stl;
mod thin;

use crate::html::base64;
use crate::space::Vec3;
use denavit_numerics::least_and_most;
use denavit_workflow::{DrawnForm, LookOfLink, Shapes};
use serde::Serialize;
use std::collections::BTreeSet;
use thin::{Thinned, thinned};

/// Triangles of a page: about 800 kB.
const MOST_DRAWN: usize = 60_000;

/// Triangles that are read, of a file and of all.
const MOST_READ: usize = 2_000_000;

/// No link is longer \[m\]: a file in millimetres is.
const LONGEST_M: f64 = 100.0;

/// Three corners \[m\].
type Triangle = [Vec3; 3];

/// What the script draws of a shape, in the frame of its link.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SceneShape {
    /// The number of its link; -1 for the base.
    link: i64,
    pub(crate) low: Vec3,
    pub(crate) high: Vec3,
    /// Corners as 16 bits for each axis, from the lowest to the highest; in base 64.
    corners: String,
    /// Three corners for each triangle, as 16 or 32 bits; in base 64.
    triangles: String,
    is_wide: bool,
}

/// What a robot looks like.
#[derive(Clone, Debug, Default)]
pub(crate) struct Looks {
    pub(crate) shapes: Vec<SceneShape>,
    /// Whether all of it is there: the rows of the table are drawn beside what is not whole.
    pub(crate) is_whole: bool,
    /// What a reader should know of it.
    pub(crate) remarks: Vec<String>,
}

impl Looks {
    /// Of shapes whose frames have these numbers among the links of a scene: none for the base.
    pub(crate) fn new(shapes: &Shapes, number: &dyn Fn(&str) -> Option<i64>) -> Self {
        let mut looks = Self { remarks: shapes.remarks.clone(), ..Self::default() };
        looks.is_whole = looks.remarks.is_empty();
        let mut soups: Vec<(i64, Vec<Triangle>)> = Vec::new();
        let mut unknown = BTreeSet::new();
        let mut room = MOST_READ;
        for one in &shapes.shapes {
            let link = match one.shape.frame.as_deref() {
                None => Some(number("base").unwrap_or(-1)),
                Some(name) => {
                    let found = number(name);
                    if found.is_none() {
                        unknown.insert(name);
                    }
                    found
                }
            };
            let Some(link) = link else { continue };
            match triangles(one, room) {
                Ok(found) => {
                    room -= found.len();
                    soups.push((link, found));
                }
                Err(why) => looks.miss(why),
            }
        }
        if !unknown.is_empty() {
            let names: Vec<&str> = unknown.into_iter().take(5).collect();
            looks.miss(format!(
                "the model has no link {}: its shapes are left out",
                names.join(", ")
            ));
        }
        let read: usize = soups.iter().map(|(_, soup)| soup.len()).sum();
        let (drawn, cell) = thinned(&soups, MOST_DRAWN);
        let count: usize = drawn.iter().map(|(_, one)| one.triangles.len()).sum();
        if let Some(cell) = cell {
            looks.remarks.push(format!(
                "{read} triangles are drawn as {count}: corners within {:.1} mm are one",
                1e3 * cell
            ));
        }
        looks.shapes = drawn.into_iter().filter_map(|(link, one)| shown(link, &one)).collect();
        looks
    }

    fn miss(&mut self, why: String) {
        self.is_whole = false;
        self.remarks.push(why);
    }
}

/// The triangles of a shape in the frame of its link.
fn triangles(one: &LookOfLink, room: usize) -> Result<Vec<Triangle>, String> {
    let own = match (&one.shape.form, &one.mesh) {
        (DrawnForm::Mesh(file, scale), mesh) => {
            let bytes = mesh.as_ref().map_or(&[][..], |mesh| mesh);
            let said = |why: String| format!("the mesh {file} is not shown: {why}");
            let found = of_file(file, bytes, room).map_err(said)?;
            let scaled = |corner: Vec3| [0, 1, 2].map(|axis| corner[axis] * scale[axis]);
            let found: Vec<Triangle> = found.iter().map(|corners| corners.map(scaled)).collect();
            long_or_wrong(&found).map_err(said)?;
            found
        }
        (DrawnForm::Box(half), _) => solids::block(*half),
        (DrawnForm::Sphere(radius), _) => solids::sphere(*radius),
        (DrawnForm::Ellipsoid(half), _) => solids::ellipsoid(*half),
        (DrawnForm::Cylinder([radius, half]), _) => solids::cylinder(*radius, *half),
        (DrawnForm::Capsule([radius, half]), _) => solids::capsule(*radius, *half),
    };
    let placed = &one.shape.placed;
    let put = |corner: Vec3| {
        placed.map(|[x, y, z, at]| x * corner[0] + y * corner[1] + z * corner[2] + at)
    };
    Ok(own.iter().map(|corners| corners.map(put)).collect())
}

/// The end of its name says what format a mesh has.
fn of_file(name: &str, bytes: &[u8], room: usize) -> Result<Vec<Triangle>, String> {
    let ending = name.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase());
    let found = match ending.as_deref() {
        Some("stl") => stl::triangles(bytes, room)?,
        Some("obj") => obj::triangles(bytes, room)?,
        Some("dae") => {
            return Err("COLLADA (.dae) is not read: save it as STL or OBJ".to_owned());
        }
        _ => return Err("its name ends in neither .stl nor .obj".to_owned()),
    };
    if found.is_empty() {
        return Err("it has no triangle".to_owned());
    }
    Ok(found)
}

fn long_or_wrong(found: &[Triangle]) -> Result<(), String> {
    let corners = || found.iter().flatten();
    if corners().flatten().any(|entry| !entry.is_finite()) {
        return Err("a corner of it is not finite".to_owned());
    }
    let most = |axis: usize| {
        let [low, high] = least_and_most(corners().map(|corner| corner[axis]));
        high - low
    };
    let long = [0, 1, 2].map(most).into_iter().fold(0.0, f64::max);
    if long > LONGEST_M {
        let hint = "a file in millimetres wants scale=\"0.001 0.001 0.001\"";
        return Err(format!("it is {long:.0} m long; {hint}"));
    }
    Ok(())
}

/// Takes a triangle, if there is room.
fn push(found: &mut Vec<Triangle>, triangle: Triangle, room: usize) -> Result<(), String> {
    if found.len() == room {
        return Err(format!("more than {MOST_READ} triangles in all are not read"));
    }
    found.push(triangle);
    Ok(())
}

/// Corners as shares of the way from the lowest to the highest of each axis.
fn shown(link: i64, one: &Thinned) -> Option<SceneShape> {
    let bound = |of: fn(f64, f64) -> f64, start: f64| {
        [0, 1, 2].map(|axis| one.corners.iter().map(|corner| corner[axis]).fold(start, of))
    };
    let (low, high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
    // what the script reads back is what the page says
    let [low, high] = [low, high].map(|end| end.map(|entry| f64::from(entry as f32)));
    let step = |corner: &Vec3, axis: usize| {
        let share = (corner[axis] - low[axis]) / (high[axis] - low[axis]);
        (65535.0 * if share.is_finite() { share } else { 0.0 }).round().clamp(0.0, 65535.0) as u16
    };
    let corners: Vec<u8> = one
        .corners
        .iter()
        .flat_map(|corner| [0, 1, 2].map(|axis| step(corner, axis)))
        .flat_map(u16::to_le_bytes)
        .collect();
    let is_wide = one.corners.len() > usize::from(u16::MAX);
    let places = one.triangles.iter().flatten();
    let triangles: Vec<u8> = match is_wide {
        true => places.flat_map(|&at| at.to_le_bytes()).collect(),
        false => places.flat_map(|&at| (at as u16).to_le_bytes()).collect(),
    };
    let (corners, triangles) = (base64(&corners), base64(&triangles));
    let shape = SceneShape { link, low, high, corners, triangles, is_wide };
    (!one.triangles.is_empty()).then_some(shape)
}

impl SceneShape {
    /// The ends of what it fills, with the number of its link if it has one.
    pub(crate) fn ends(&self) -> (Option<usize>, [Vec3; 8]) {
        let end = |at: usize| {
            [0, 1, 2].map(|axis| if at >> axis & 1 == 0 { self.low[axis] } else { self.high[axis] })
        };
        (usize::try_from(self.link).ok(), std::array::from_fn(end))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_mesh_says_why() {
        let said = |name: &str, bytes: &[u8]| of_file(name, bytes, 100).expect_err("no mesh");
        assert!(said("a.dae", b"<COLLADA/>").contains("save it as STL or OBJ"));
        assert!(said("a.step", b"").contains("neither .stl nor .obj"));
        assert!(said("a", b"").contains("neither"));
        assert!(said("a.stl", b"").contains("no STL"));
        assert!(said("a.obj", b"v 1 2 3\n").contains("no triangle"));
        let far = [[[0.0; 3], [200.0, 0.0, 0.0], [0.0, 1.0, 0.0]]];
        assert!(long_or_wrong(&far).expect_err("long").contains("0.001 0.001 0.001"));
        let lost = [[[0.0; 3], [f64::NAN, 0.0, 0.0], [0.0, 1.0, 0.0]]];
        assert!(long_or_wrong(&lost).expect_err("lost").contains("not finite"));
    }

    #[test]
    fn corners_come_back_from_sixteen_bits() {
        let corners = vec![[0.0, -1.0, 0.5], [1.0, 1.0, 0.5], [0.25, 0.0, 0.5]];
        let one = Thinned { corners, triangles: vec![[0, 1, 2]] };
        let shape = shown(3, &one).expect("a triangle");
        assert_eq!((shape.low, shape.high), ([0.0, -1.0, 0.5], [1.0, 1.0, 0.5]));
        let steps = [0u16, 0, 0, 65535, 65535, 0, 16384, 32768, 0];
        let bytes: Vec<u8> = steps.iter().flat_map(|step| step.to_le_bytes()).collect();
        assert_eq!(shape.corners, base64(&bytes));
    }
}
