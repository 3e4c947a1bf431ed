//! The equations of motion as linear functions of what is unknown.

pub mod equations;
mod pull;

pub use pull::{
    Equation, MatterEntry, MatterRegressor, MotionTerms, fixed_base_regressor, torso_regressor,
};
