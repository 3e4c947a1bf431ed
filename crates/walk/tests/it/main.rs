//! Gaits: their postures meet their conditions, and the robot walks them.

mod event_driven_step;
mod gait_file;
mod limit_cycle;
mod weight_shift_step;
