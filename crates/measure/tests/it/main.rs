//! Tests of reading and conditioning logs.

mod laps;
