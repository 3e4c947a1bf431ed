//! Evidence against densities of whole covariances.

mod condensed;
mod weigh;
