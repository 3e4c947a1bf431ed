//! Gaits: designed, and judged.

mod design;
mod judge;

pub use design::{Designed, Gait, GaitCurves, GaitQuantity, design_gait};
pub use judge::{JudgeOptions, Judged, judge_log, judge_run};
