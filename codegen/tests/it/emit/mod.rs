//! Emitted Rust as text. That it compiles and computes is tested by the package `denavit`.

mod c;
mod compiled;
mod golden;
mod programs;
mod recount;
mod text;
