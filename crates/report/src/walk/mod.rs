//! Pictures of gaits and their stability.

mod capture_reach;
mod heat_map;
mod return_map;
mod unit_circle;

pub use capture_reach::CaptureReach;
pub use heat_map::HeatMap;
pub use return_map::ReturnMapPicture;
pub use unit_circle::UnitCircle;
