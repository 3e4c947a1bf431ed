//! The tests of the compiler, one module for each stage.

mod program;
