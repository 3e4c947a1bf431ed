//! What numbers need that belong to no robot.
//!
//! - [`Random`]: numbers from a seed, the same on every machine
//! - [`MinimumNorm`]: square systems of any rank
//! - [`Butterworth`], [`Decimator`]: filters that delay nothing
//! - [`Equations`]: linear equations with errors, and which unknowns or sums of them follow
//! - [`least_squares`]: rows condensed to triangles as they come, and what follows from them
//! - [`interval_factor`], [`least_by_chance`]: what chance makes of errors and variances
//! - [`long_run`], [`variance_of_sum`], [`time_alike`]: variances and samples where neighbours are
//!   alike
//! - [`rms`], [`mean`], [`variance`], [`median`], [`least_and_most`], [`products`]: numbers of a
//!   signal, or of two
//! - [`derivative`]: central differences; [`between`], [`cubic`], [`quintic`]: a signal between its
//!   samples
//! - [`extremes`]: the rows of long columns that a picture needs
//! - [`envelope`]: what is between the ends of a signal that chatters
//! - [`short`], [`percent`]: numbers as a person writes them

mod between;
mod butterworth;
mod decimate;
mod derivative;
mod envelope;
mod equations;
mod extremes;
pub mod least_squares;
mod minimum_norm;
mod random;
mod text;
mod variances;

pub use between::{between, cubic, quintic};
pub use butterworth::Butterworth;
pub use decimate::Decimator;
pub use derivative::derivative;
pub use envelope::{Span, envelope};
pub use equations::{Consequences, Determined, Equations};
pub use extremes::extremes;
pub use minimum_norm::MinimumNorm;
pub use random::Random;
pub use text::{percent, short};
pub use variances::{
    interval_factor, least_and_most, least_by_chance, long_run, mean, median, products, rms,
    time_alike, variance, variance_of_sum,
};
