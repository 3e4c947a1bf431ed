//! Robots as numbers: effects as laws on numbers, emitted code against interpreters, derivatives
//! against differences.

mod derivatives;
mod effect;
mod emitted;
