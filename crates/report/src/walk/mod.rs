//! Pictures of gaits and their stability.

mod unit_circle;

pub use unit_circle::UnitCircle;
