//! Hypotheses compared by what they predict.
//!
//! Measured signals of some channels are seen as spectra, in which stationary noise is independent
//! from line to line. Each channel has bands, and each band of a channel is a cell with a variance
//! of its own that no hypothesis knows beforehand. A hypothesis is a linear model: a known part,
//! and columns whose factors have the prior N(0, 1). Its evidence is the density that it gives the
//! data with all factors integrated out and with the most likely variances (type II maximum
//! likelihood; MacKay 1992), so that a hypothesis pays for what it could have explained and did
//! not have to.
//!
//! - [`Layout`]: channels, bands and the rows of spectra in them
//! - [`Base`]: the data with the columns that every hypothesis has
//! - [`Terms`]: what one effect adds to that
//! - [`Base::weigh`]: the evidence of a set of terms; [`Glance`]: a first look at many
//! - [`Told`]: the evidence of a linear model of rows that are condensed to their products
//! - [`policy`]: the numbers that decide a verdict

mod base;
mod condensed;
mod filtered;
mod gaussian;
mod glance;
mod layout;
mod orthant;
pub mod policy;
mod terms;
mod unpredicted;
mod weigh;

pub use base::Base;
pub use condensed::{Condensed, Told};
pub use filtered::Filtered;
pub use glance::{Glance, Seen};
pub use layout::{Layout, Spectrum};
pub use terms::Terms;
pub use unpredicted::Unpredicted;
pub use weigh::Weighed;
