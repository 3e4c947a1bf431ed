//! Evidence against densities of whole covariances.

mod weigh;
