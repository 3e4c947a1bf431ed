//! Identification: from motion to parameters.
//!
//! - [`excite`]: trajectories that excite what is to be identified
//! - [`statics`]: what weighings and held postures say
//! - [`knowledge`]: equations of parameters from all sources, joined, and what follows from them

pub mod excite;
pub mod knowledge;
pub mod statics;
