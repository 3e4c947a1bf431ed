//! Pictures of gaits and their stability.

mod capture_reach;
mod heat_map;
mod return_map;
mod unit_circle;

pub(crate) use capture_reach::CaptureReach;
pub(crate) use heat_map::HeatMap;
pub(crate) use return_map::ReturnMapPicture;
pub(crate) use unit_circle::UnitCircle;
