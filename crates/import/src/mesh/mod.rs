//! Meshes of collision shapes: where their corners are, and which of them are the sole.

mod obj;
mod sole;
mod stl;

pub(crate) use sole::sole;

use crate::exact::Vector;
use crate::fault::clip;

/// Most corners of a file, those that several triangles share counted in each.
const MAX_CORNERS: usize = 2_000_000;

/// The corners of a mesh, each once. The end of its name says what format it has.
pub(crate) fn corners(name: &str, bytes: &[u8]) -> Result<Vec<Vector>, String> {
    let ending = name.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase());
    let found = match ending.as_deref() {
        Some("stl") => stl::corners(bytes)?,
        Some("obj") => obj::corners(bytes)?,
        Some(other) => return Err(format!("no STL or OBJ, but .{}", clip(other))),
        None => return Err("its name does not end in .stl or .obj".to_owned()),
    };
    if found.is_empty() {
        return Err("it has no corner".to_owned());
    }
    Ok(found)
}

/// Takes a corner, if there are not too many already.
fn push<T>(found: &mut Vec<T>, corner: T) -> Result<(), String> {
    if found.len() == MAX_CORNERS {
        return Err(format!("it has more than {MAX_CORNERS} corners"));
    }
    found.push(corner);
    Ok(())
}
