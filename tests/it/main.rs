//! Tests of the whole: the command, and the code that it emits.

#[path = "../blind/mod.rs"]
mod blind;
mod blind_battery;
mod cli;
mod contact;
mod diagnose;
mod effect;
mod emitted;
mod excite;
mod identify;
mod report;
mod simulate;
mod singular_values;
mod tidy;
mod time_stepping;
mod trees;
mod walk;
