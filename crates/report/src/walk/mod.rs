//! Pictures of gaits and their stability.

mod heat_map;
mod unit_circle;

pub use heat_map::HeatMap;
pub use unit_circle::UnitCircle;
