//! Cycles of walking robots: fixed points of return maps and their stability (thesis 4.2.2).
//!
//! - [`analyse`]: all of it for a scenario
//! - [`ReturnMap`]: from a section of the cycle to the next
//! - [`fixed_point`]: the state that comes back to itself
//! - [`by_differences`], [`by_variation`]: the linearised return map, in two independent ways
//! - [`multipliers`]: its eigenvalues with their directions
//! - [`converge`]: returns from off the cycle
//! - [`doubling`]: where a cycle of twice the steps branches off

mod analysis;
mod chart;
mod convergence;
mod cycle;
mod doubling;
mod multipliers;
mod rhythm;
mod section;
mod symmetry;
mod wording;

pub use analysis::{PoincareAnalysis, PoincareOptions, WantedSection, analyse};
pub use chart::Chart;
pub use convergence::{Convergence, converge};
pub use cycle::{FixedPoint, by_differences, by_variation, fixed_point};
pub use doubling::doubling;
pub use multipliers::{Fate, Multiplier, multipliers};
pub use rhythm::{NotPeriodic, Rhythm};
pub use section::{ReturnMap, Returned, Section};
pub use symmetry::Symmetry;
pub use wording::{Share, shares};
