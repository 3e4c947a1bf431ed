//! Effects: the catalogue, its laws as numbers.

mod catalogue;
mod finer;
mod laws;
mod robot;
mod states;
mod transmission;
