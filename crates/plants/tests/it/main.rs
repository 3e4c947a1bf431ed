//! Robots as numbers: effects as laws on numbers, emitted code against interpreters.

mod effect;
mod emitted;
