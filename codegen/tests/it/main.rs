//! The tests of the compiler, one module for each stage.

mod model;
mod program;
