//! The numbers that decide what motion is taken for exciting, each with its unit and where it is
//! from.

/// `check.rs`: Whether a trajectory keeps the limits.
pub(crate) mod check {
    /// A direction of the parameters is not excited if its singular value, of columns scaled to
    /// length 1, is below this share of the largest: identification takes no smaller one for
    /// excited (`solve::DEAD` there).
    pub(crate) const DEAD: f64 = 1e-9;
}

/// `lib.rs`: Trajectories that excite what is to be identified (thesis 3.2.3).
pub(crate) mod excite {
    /// Sharpness of the limits of the two solutions, and the share of the evaluations of the
    /// first.
    pub(crate) const SHARPNESS: [f64; 2] = [40.0, 200.0];

    /// See [`SHARPNESS`].
    pub(crate) const FIRST_SHARE: f64 = 0.4;

    /// Share of each limit that stays unused on the solver's grid.
    pub(crate) const RESERVE: f64 = 0.004;

    /// The use of limits that a motion is made smaller to: what remains is for what happens
    /// between the samples of a check.
    pub(crate) const SAFE: f64 = 1.0 - 1e-4;
}

/// `objective.rs`: How well a motion excites: condition number and determinant of the
/// stacked regressor, and their derivatives by its entries.
pub(crate) mod objective {
    /// ln of what counts as infinite: 1e26.
    pub(crate) const LARGEST_LOG: f64 = 60.0;
}

/// `options.rs`: What an excitation is asked for, compared with what the model can do.
pub(crate) mod options {
    /// Laps that are looked for: longer than a robot's shaking, and shorter than a day \[s\].
    pub(crate) const DURATIONS_S: std::ops::RangeInclusive<f64> = 0.01..=1e4;
}

/// `problem.rs`: The optimisation problem: objective and limits as functions of the
/// coordinates of all joints that move, with their derivatives.
pub(crate) mod problem {
    /// Length by which a missing height is divided \[m\].
    pub(crate) const HEIGHT_M: f64 = 0.1;
}

/// `stack.rs`: From motion to the stacked regressor W, and back: from derivatives by the
/// entries of W to derivatives by the motion.
pub(crate) mod stack {
    /// Width of a smooth sign, of the largest speed of the joint.
    pub(crate) const SIGN_WIDTH: f64 = 0.02;
}

/// `space.rs`: Spaces of trajectories, and the conditions that their ends keep.
pub(crate) mod space {
    /// Below this share a direction of conditions is rounding of others.
    pub(crate) const ROUNDING: f64 = 1e-9;
}
