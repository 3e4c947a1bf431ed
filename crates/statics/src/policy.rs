//! The numbers that decide what is said of measurements at rest.

/// Factors of torques and of angles that are tried.
pub(crate) const OF_TORQUES: [f64; 7] = [-1.0, 1e-3, 1e-2, 0.1, 10.0, 100.0, 1e3];

/// See [`OF_TORQUES`].
pub(crate) const OF_ANGLES: [f64; 3] =
    [-1.0, std::f64::consts::PI / 180.0, 180.0 / std::f64::consts::PI];

/// What the nominal parameters leave of the torques must be more than this share, and fall to
/// this share of it and to less than this.
pub(crate) const FAR: f64 = 0.2;

/// See [`FAR`].
pub(crate) const BETTER: f64 = 0.5;

/// See [`FAR`].
pub(crate) const NEAR: f64 = 0.32;

/// Times the model's mass that no mistake of a model is.
pub(crate) const OTHER_UNIT: f64 = 100.0;
