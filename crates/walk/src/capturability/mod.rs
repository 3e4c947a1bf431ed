//! In how many steps a linear inverted pendulum with feet can come to rest (Koolen, de Boer,
//! Rebula, Goswami, Pratt 2012, International Journal of Robotics Research 31(9)).
//!
//! The capture point c = x + x'/w, with w = sqrt(g / z), moves away from the centre of pressure p:
//! c' = w (c - p). All places are along x, forward from the ankle of the foot that stands; the sole
//! reaches from -heel to toe, and p is inside. A step puts the other ankle at a place s that is
//! not farther than the longest step, not earlier than the least step time T after the last one;
//! from then on c is measured from there. Impacts, swinging legs and angular momentum are left out.
//!
//! - [`StepLimits`]: what a robot can do
//! - [`Capturability`]: the capture points from which N steps are enough
//! - [`CaptureRegion`]: where the foot may land

mod limits;
mod reach;
mod region;

pub use limits::StepLimits;
pub use reach::{Capturability, Steps};
pub use region::CaptureRegion;
