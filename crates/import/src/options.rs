//! What is asked of an import.

/// What the robot stands on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BaseChoice {
    /// What the file says: MJCF may say that it floats.
    #[default]
    AsDescribed,
    /// The world.
    Fixed,
    /// Nothing: six joints are generated.
    Floating,
}

/// What becomes of a joint that follows another one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mimic {
    /// It is a fault: a model file has no such joint.
    #[default]
    Refuse,
    /// It is fixed where it is when the other one is at 0.
    Lock,
    /// It is a joint of its own.
    Free,
}

/// What is asked of an import.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// What the robot stands on.
    pub base: BaseChoice,
    /// The link at the end of the chain that is wanted; all of the tree without one.
    pub tip: Option<String>,
    /// Links whose collision shapes become contact points: boxes, spheres, cylinders, meshes, and
    /// of MJCF capsules and ellipsoids, too.
    pub contacts: Vec<String>,
    /// What becomes of joints that follow others.
    pub mimic: Mimic,
}
