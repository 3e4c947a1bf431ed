//! Tests of reading and conditioning logs.

mod laps;
mod steps;
mod stretches;
