//! Identification: from motion to parameters.
//!
//! - [`excite`]: trajectories that excite what is to be identified

pub mod excite;
