//! What links look like: the shapes of a description, each in the frame of a row of the model.
//!
//! Pictures are drawn from these, and nothing is computed: here exact numbers become doubles.

use crate::exact::Vector;
use crate::fault::{Cause, Faults, clip};
use crate::looks::{LinkForm, LinkShape, TreeLooks};
use crate::options::{Mimic, Options};
use crate::place::matrix;
use crate::solid::Solid;
use crate::xml::{Element, Source};
use crate::{Error, Include, layout, mjcf, urdf, with_included};
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

/// What links look like.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawn {
    /// The shapes, in the order of the file.
    pub shapes: Vec<DrawnShape>,
    /// Shapes that are left out, each with the reason.
    pub remarks: Vec<String>,
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
    /// A cylinder with half a sphere on both ends: its radius, and half the length between them.
    Capsule([f64; 2]),
    /// Half of each axis.
    Ellipsoid([f64; 3]),
    /// A file, and the factor of each axis.
    Mesh(String, [f64; 3]),
}

impl DrawnForm {
    fn of_solid(solid: &Solid) -> Self {
        match solid {
            Solid::Box(half) => Self::Box(numbers(half)),
            Solid::Ellipsoid(half) => Self::Ellipsoid(numbers(half)),
            Solid::Sphere(radius) => Self::Sphere(to_f64(radius)),
            Solid::Cylinder { radius, half } => Self::Cylinder([radius, half].map(to_f64)),
            Solid::Capsule { radius, half } => Self::Capsule([radius, half].map(to_f64)),
        }
    }
}

fn numbers(vector: &Vector) -> [f64; 3] {
    vector.each_ref().map(to_f64)
}

/// What the links of a description look like: of a URDF their `visual` shapes, or else those that
/// they touch others with; of an MJCF what MuJoCo itself shows. `file` is its name, for messages;
/// `include` reads files that an MJCF includes. No mesh is read.
///
/// # Errors
/// All that is wrong with it.
pub fn shapes(file: &str, bytes: &[u8], include: &mut Include<'_>) -> Result<Drawn, Error> {
    let source = Source::read(file, bytes)?;
    let mut faults: Faults = Report::default();
    let refused = |faults: Faults| Err(Error::from(faults.into_error(file, bytes, None)));
    let Some(document) = source.document() else { return refused(faults) };
    let root = source.root(&document);
    let found = match root.name() {
        "robot" => of_urdf(file, root, &mut faults),
        "mujoco" => with_included(root, include, &mut faults, |included, _, faults| {
            mjcf::looks(file, root, included, faults)
        }),
        other => {
            let said = format!("<{}> is neither <robot> (URDF) nor <mujoco> (MJCF)", clip(other));
            faults.push(root.at(), Cause::new(said));
            None
        }
    };
    let Some(found) = found.filter(|_| faults.is_empty()) else { return refused(faults) };
    let frames = layout::layout(&found.tree).frames;
    let shapes = found.looks.into_iter().flat_map(|(link, shapes)| {
        let frame = frames[link].clone();
        shapes.into_iter().map(move |one| drawn_shape(frame.clone(), &one))
    });
    Ok(Drawn { shapes: shapes.collect(), remarks: found.remarks })
}

fn of_urdf(file: &str, root: Element<'_>, faults: &mut Faults) -> Option<TreeLooks> {
    // joints that follow others have the rows of joints of their own
    let options = Options { mimic: Mimic::Free, ..Options::default() };
    let tree = urdf::tree(file, root, &options, &mut crate::nothing_included, faults);
    let looks = urdf::looks(root, faults);
    let tree = tree?;
    let place = |name: &str| tree.links.iter().position(|one| one.name.as_deref() == Some(name));
    let looks = looks.into_iter().filter_map(|(name, shapes)| Some((place(&name)?, shapes)));
    let looks = looks.collect();
    Some(TreeLooks { tree, looks, remarks: Vec::new() })
}

fn drawn_shape(frame: Option<String>, shape: &LinkShape) -> DrawnShape {
    let form = match &shape.form {
        LinkForm::Solid(solid) => DrawnForm::of_solid(solid),
        LinkForm::Mesh(file, scale) => DrawnForm::Mesh(file.clone(), numbers(scale)),
    };
    let turn = matrix(&shape.place.turns);
    let at = numbers(&shape.place.at);
    let placed = std::array::from_fn(|row| {
        let [x, y, z] = numbers(&turn[row]);
        [x, y, z, at[row]]
    });
    DrawnShape { frame, placed, form }
}
