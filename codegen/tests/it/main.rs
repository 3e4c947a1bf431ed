//! The tests of the compiler, one module for each stage.

mod alias;
mod counts;
mod decomposition;
mod definite;
mod emit;
mod engine_values;
mod latex;
mod laws;
mod methods;
mod model;
mod program;
mod regressor;
mod robots;
mod singular_values;
mod thesis;
mod trees;
mod varying_inertia;
mod walking;
