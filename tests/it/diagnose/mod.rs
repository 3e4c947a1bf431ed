//! What a model lacks.

mod elastic;
mod held;
mod laws;
mod search;
