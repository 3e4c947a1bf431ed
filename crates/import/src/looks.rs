//! What readers of descriptions find of the looks of links, in exact numbers.

use crate::exact::Vector;
use crate::place::Pose;
use crate::solid::Solid;
use crate::tree::Tree;

/// A shape with its pose in the frame of its link, before the link has a row.
pub(crate) struct LinkShape {
    pub(crate) place: Pose,
    pub(crate) form: LinkForm,
}

pub(crate) enum LinkForm {
    Solid(Solid),
    Mesh(String, Vector),
}

/// A tree, and what its links look like: each by its place in the tree.
pub(crate) struct TreeLooks {
    pub(crate) tree: Tree,
    pub(crate) looks: Vec<(usize, Vec<LinkShape>)>,
    pub(crate) remarks: Vec<String>,
}
