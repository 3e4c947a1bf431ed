//! Compiled code against the interpreters, bit for bit.

mod angles;
mod compare;
mod operations;
mod random;
mod robots;
