//! Estimation: base parameters of conditioned logs, with errors that say what they mean.
//!
//! - [`Condensed`]: logs as triangles of joints and parts
//! - [`estimate`]: least squares, weighted, robust, by instruments, with noise on both sides
//! - [`Errors`]: standard errors for residuals that are correlated
//! - [`SlowRows`]: what is left out near reversals
//! - [`validate`]: what is left of the torques
//! - [`ContradictingLog`]: logs that no parameters explain together with the others
//! - [`unexplained_joints`]: whose torque is as good as unexplained
//! - [`long`]: logs that are too long to be held at once
//! - [`consistent()`]: the nearest bodies that exist

mod bounds;
mod comparison;
mod condensed;
mod consistent;
mod contradiction;
mod errors;
mod exceeding;
mod filter_error;
mod half_cutoff;
mod instruments;
mod least_squares;
mod left_out;
mod left_over;
mod likelihood;
pub mod long;
mod noise_bias;
mod nominal;
mod own_estimate;
mod report;
mod rests;
mod robust;
mod rows;
mod solve;
mod total;
mod triangle;
mod unexplained;
mod validate;
mod weights;
mod widening;

pub use condensed::Condensed;
pub use consistent::{Consistent, consistent};
pub use contradiction::{ContradictingJoint, ContradictingLog, Likeness, Standing};
pub(crate) use contradiction::{contradicting_held_out, contradicting_logs};
pub use errors::{Errors, interval_factor};
pub(crate) use exceeding::exceeding_joints;
pub(crate) use filter_error::filter_errors;
pub use half_cutoff::Change;
pub(crate) use least_squares::long_enough;
pub use least_squares::{Estimate, Method, Options, estimate};
pub use left_out::SlowRows;
pub(crate) use left_out::{biased_frictions, is_biased};
pub(crate) use left_over::no_noise;
pub(crate) use likelihood::noise_of_positions;
pub use noise_bias::NoiseOfLog;
pub(crate) use noise_bias::noise_in_torques;
pub(crate) use nominal::{is_of_joints, nominal_values};
pub(crate) use report::BIASING;
pub use report::{Convergence, HalfCutoff, IdentifiedParameter, Status, convergence, parameters};
pub use robust::Loss;
pub use rows::{Block, BlockMaker};
pub(crate) use rows::{Coulomb, coulomb};
pub use solve::{PriorRow, Solution, solve, stacked};
pub use triangle::Triangle;
pub use unexplained::{Judgement, ShownLogs, Unexplained, unexplained_joints};
pub use validate::{JointResidual, LAGS, Validation, validate};
