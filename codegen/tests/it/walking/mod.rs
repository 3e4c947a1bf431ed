//! The functions for walking: exact laws modulo p, closed forms, numbers of an engine.

mod balance;
mod center_of_mass;
mod closed_forms;
mod contact_derivatives;
mod engine_values;
mod foot;
