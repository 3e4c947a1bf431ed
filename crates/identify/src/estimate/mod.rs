//! Estimation: base parameters of conditioned logs, with errors that say what they mean.
//!
//! - [`Condensed`]: logs as triangles of joints and parts
//! - [`estimate`]: least squares, weighted, robust, by instruments, with noise on both sides
//! - [`OneEquation`]: least squares of one equation alone
//! - [`Errors`]: standard errors for residuals that are correlated
//! - [`SlowRows`]: what is left out near reversals
//! - [`validate`]: what is left of the torques
//! - [`ContradictingLog`]: logs that no parameters explain together with the others
//! - [`unexplained_joints`]: whose torque is as good as unexplained
//! - [`long`]: logs that are too long to be held at once
//! - [`consistent()`]: the nearest bodies that exist

mod comparison;
mod condensed;
mod consistent;
mod contradiction;
mod errors;
mod filter_error;
mod half_cutoff;
mod held_out;
mod instruments;
mod least_squares;
mod left_out;
mod left_over;
mod likelihood;
pub mod long;
mod noise_bias;
mod nominal;
mod one_equation;
mod own_estimate;
mod report;
mod robust;
mod rows;
mod total;
mod unexplained;
mod validate;
mod weights;
mod widening;

pub use condensed::Condensed;
pub use consistent::{Consistent, consistent};
pub(crate) use contradiction::contradicting_logs;
pub use contradiction::{ContradictingJoint, ContradictingLog, Likeness, Standing};
pub use errors::Errors;
pub(crate) use filter_error::filter_errors;
pub use half_cutoff::HalfCutoff;
pub(crate) use held_out::HeldOut;
pub(crate) use least_squares::long_enough;
pub use least_squares::{Estimate, Method, Options, estimate};
pub(crate) use left_out::biased_frictions;
pub use left_out::{SlowRows, is_biased};
pub(crate) use left_over::lacking;
pub use noise_bias::NoiseOfLog;
pub(crate) use noise_bias::noise_of_positions;
pub(crate) use nominal::{is_of_joints, nominal_values};
pub use one_equation::OneEquation;
pub use report::{Convergence, IdentifiedParameter, Status, convergence, parameters};
pub use robust::Loss;
pub use rows::{Block, BlockMaker};
pub(crate) use rows::{Coulomb, coulomb};
pub use unexplained::{Judgement, ShownLogs, Unexplained, unexplained_joints};
pub use validate::{JointResidual, LAGS, Validation, validate};
