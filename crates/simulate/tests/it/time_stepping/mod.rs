//! Time stepping: closed forms are reached at the order of the scheme.

mod closed_forms;
mod gaits;
mod scenarios;
mod solvers;
mod systems;
mod tulip;
