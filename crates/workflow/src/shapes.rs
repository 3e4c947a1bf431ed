//! What a robot looks like: the shapes of its description, with the bytes of its meshes.

use crate::error::{Cause, Error};
use crate::files::Files;
use denavit_import::{Beside, DrawnForm, DrawnShape, is_description, shapes};
use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

/// Most bytes of all meshes.
const MOST_BYTES: usize = 64 << 20;

/// What a robot looks like.
#[derive(Clone, Debug, Default)]
pub struct Shapes {
    /// The shapes, in the order of the file.
    pub shapes: Vec<LookOfLink>,
    /// Shapes that are not there, each with the reason.
    pub remarks: Vec<String>,
}

/// A shape of a link.
#[derive(Clone, Debug)]
pub struct LookOfLink {
    /// Where it stands, and what it is.
    pub shape: DrawnShape,
    /// The file of its mesh, if it is one.
    pub mesh: Option<Rc<Vec<u8>>>,
}

impl Files {
    /// The shapes of a URDF or an MJCF. Its meshes lie beside it, or in `meshes`; one that is not
    /// read is a remark.
    ///
    /// # Errors
    /// Why the description is not read, or all that is wrong with it.
    pub fn shapes(&self, place: &Path, meshes: Option<&Path>) -> Result<Shapes, Error> {
        let (name, bytes) = self.description(place)?;
        let mut include = |named: Beside<'_>| self.of_description(place, meshes, named);
        let drawn = shapes(&name, &bytes, &mut include).map_err(Cause::Import)?;
        let mut found = Shapes { shapes: Vec::new(), remarks: drawn.remarks };
        let mut known: BTreeMap<String, Option<Rc<Vec<u8>>>> = BTreeMap::new();
        let mut room = MOST_BYTES;
        for shape in drawn.shapes {
            let DrawnForm::Mesh(file, _) = &shape.form else {
                found.shapes.push(LookOfLink { shape, mesh: None });
                continue;
            };
            let mesh = known.entry(file.clone()).or_insert_with(|| {
                let read = self.of_description(place, meshes, Beside::Mesh(file));
                let read = read.and_then(|bytes| match room.checked_sub(bytes.len()) {
                    Some(left) => {
                        room = left;
                        Ok(Rc::new(bytes))
                    }
                    None => Err(format!("all meshes have more than {} MiB", MOST_BYTES >> 20)),
                });
                let said = |why| found.remarks.push(format!("the mesh {file} is not shown: {why}"));
                read.map_err(said).ok()
            });
            if let Some(mesh) = mesh.clone() {
                found.shapes.push(LookOfLink { shape, mesh: Some(mesh) });
            }
        }
        Ok(found)
    }

    /// The shapes of `given`, or of the model itself where its file is a description; none
    /// otherwise.
    ///
    /// # Errors
    /// Those of [`Files::shapes`].
    pub fn shapes_of(
        &self,
        model: &Path,
        given: Option<&Path>,
        meshes: Option<&Path>,
    ) -> Result<Option<Shapes>, Error> {
        if let Some(given) = given {
            return self.shapes(given, meshes).map(Some);
        }
        let bytes = if model.is_file() { self.bytes(model)? } else { Vec::new() };
        if is_description(&bytes) { self.shapes(model, meshes).map(Some) } else { Ok(None) }
    }
}
