//! What links look like: the shapes of a URDF, each in the frame of a row of the model.
//!
//! Pictures are drawn from these, and nothing is computed: here exact numbers become doubles.

use crate::exact::Vector;
use crate::fault::{Cause, Faults, clip};
use crate::options::{Mimic, Options};
use crate::place::{Pose, matrix};
use crate::solid::Solid;
use crate::xml::Source;
use crate::{Error, layout, urdf};
use denavit_codegen::model::Report;
use denavit_codegen::number::to_f64;

/// A shape of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnShape {
    /// The row of the model in whose frame it stands; none for the frame of the base.
    pub frame: Option<String>,
    /// Rows of its turn and its place: a point p of the shape is at `turn p + place` \[m\].
    pub placed: [[f64; 4]; 3],
    /// What it is.
    pub form: DrawnForm,
}

/// A form about its own centre; what is round is round about z \[m\].
#[derive(Clone, Debug, PartialEq)]
pub enum DrawnForm {
    /// Half of each edge.
    Box([f64; 3]),
    /// Its radius.
    Sphere(f64),
    /// Its radius, and half its length.
    Cylinder([f64; 2]),
    /// A file, and the factor of each axis.
    Mesh(String, [f64; 3]),
}

impl DrawnForm {
    fn of_solid(solid: &Solid) -> Option<Self> {
        match solid {
            Solid::Box(half) => Some(Self::Box(numbers(half))),
            Solid::Sphere(radius) => Some(Self::Sphere(to_f64(radius))),
            Solid::Cylinder { radius, half } => Some(Self::Cylinder([radius, half].map(to_f64))),
            // no URDF has them
            Solid::Ellipsoid(_) | Solid::Capsule { .. } => None,
        }
    }
}

/// A shape with its pose in the frame of its link, before the link has a row.
pub(crate) struct LinkShape {
    pub(crate) place: Pose,
    pub(crate) form: LinkForm,
}

pub(crate) enum LinkForm {
    Solid(Solid),
    Mesh(String, Vector),
}

fn numbers(vector: &Vector) -> [f64; 3] {
    vector.each_ref().map(to_f64)
}

/// What the links of a URDF look like: their `visual` shapes, or the shapes that they touch others
/// with. `file` is its name, for messages. No mesh is read.
///
/// # Errors
/// All that is wrong with it.
pub fn shapes(file: &str, bytes: &[u8]) -> Result<Vec<DrawnShape>, Error> {
    let source = Source::read(file, bytes)?;
    let mut faults: Faults = Report::default();
    let refused = |faults: Faults| Err(Error::from(faults.into_error(file, bytes, None)));
    let Some(document) = source.document() else { return refused(faults) };
    let root = source.root(&document);
    if root.name() != "robot" {
        let said = format!("<{}> is no <robot>: shapes are those of a URDF", clip(root.name()));
        faults.push(root.at(), Cause::new(said));
        return refused(faults);
    }
    // joints that follow others have the rows of joints of their own
    let options = Options { mimic: Mimic::Free, ..Options::default() };
    let tree = urdf::tree(file, root, &options, &mut crate::nothing_included, &mut faults);
    let looks = urdf::looks(root, &mut faults);
    let Some(tree) = tree.filter(|_| faults.is_empty()) else { return refused(faults) };
    let layout = layout::layout(&tree);
    let mut drawn = Vec::new();
    for (link, found) in looks {
        let place = tree.links.iter().position(|one| one.name.as_deref() == Some(&*link));
        let Some(place) = place else { continue };
        let frame = &layout.frames[place];
        drawn.extend(found.into_iter().filter_map(|one| drawn_shape(frame.clone(), &one)));
    }
    Ok(drawn)
}

fn drawn_shape(frame: Option<String>, shape: &LinkShape) -> Option<DrawnShape> {
    let form = match &shape.form {
        LinkForm::Solid(solid) => DrawnForm::of_solid(solid)?,
        LinkForm::Mesh(file, scale) => DrawnForm::Mesh(file.clone(), numbers(scale)),
    };
    let turn = matrix(&shape.place.turns);
    let at = numbers(&shape.place.at);
    let placed = std::array::from_fn(|row| {
        let [x, y, z] = numbers(&turn[row]);
        [x, y, z, at[row]]
    });
    Some(DrawnShape { frame, placed, form })
}
