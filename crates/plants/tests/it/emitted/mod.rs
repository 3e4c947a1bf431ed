//! Emitted code against the interpreters, bit for bit, on all functions of the generated modules.

mod flat;
mod fused;
mod golden;
mod modules;
mod outside;
mod walking;
