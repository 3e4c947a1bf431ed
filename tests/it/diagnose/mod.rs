//! What a model lacks.

mod laws;
mod search;
