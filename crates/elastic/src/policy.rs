//! The numbers that decide what is said of readings of motors behind springs.

/// How far a motor may turn, of how far gear and joint say: springs are stiff.
pub(crate) const TURNS: [f64; 2] = [0.5, 2.0];

/// Angles that do not follow each other.
pub(crate) const OTHER: f64 = 0.5;

/// How far a spring of a model may be wrong.
pub(crate) const WRONG_SPRING: f64 = 2.5;

/// Standard errors that a stiffness is above 0.
pub(crate) const SURE: f64 = 5.0;
