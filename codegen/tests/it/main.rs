//! The tests of the compiler, one module for each stage.

mod methods;
mod model;
mod models;
mod program;
mod thesis;
