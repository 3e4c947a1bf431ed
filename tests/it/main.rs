//! Tests of the whole: the command, and the code that it emits.

mod cli;
mod contact;
mod emitted;
mod tidy;
mod time_stepping;
