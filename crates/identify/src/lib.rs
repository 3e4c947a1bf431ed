//! Identification: from motion to parameters, with honest errors (thesis chapter 3).
//!
//! - [`leave_out_idle_motors`]: torques of joints that a brake holds
//! - [`estimate`]: base parameters with their errors, and what they leave unexplained
//! - [`doubt`]: what logs may be other than they are taken for
//! - [`identify`]: all of it at once
//! - [`Error`]: why there is no answer, of all of these

pub mod doubt;
mod error;
pub mod estimate;
mod identification;
mod idle;
mod long;
mod noisy_logs;
mod odd_log;
mod policy;

pub use error::{Error, ErrorKind};
pub use identification::{Estimated, Identification, LeftOutRows, Request, estimated, identify};
pub use idle::leave_out_idle_motors;
