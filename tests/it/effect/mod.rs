//! Effects: the catalogue, its laws as numbers.

mod catalogue;
mod laws;
mod page;
mod robot;
mod states;
mod transmission;
