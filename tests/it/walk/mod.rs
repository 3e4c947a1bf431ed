//! Gaits: their postures meet their conditions, and the robot walks them.

mod weight_shift_step;
