//! Gaits: designed, judged, and disturbed.

mod design;
mod endurance;
mod judge;

pub use design::{Designed, Gait, GaitCurves, GaitQuantity, design_gait};
pub use endurance::{
    GaitBasin, PushQuestion, PushedGait, Starts, compare_criteria, gait_basin, push_gait,
    push_stepping_robot,
};
pub use judge::{JudgeOptions, Judged, judge_log, judge_run};
