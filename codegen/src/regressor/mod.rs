//! The equations of motion as linear functions of what is unknown.

mod decompose;
pub mod equations;
mod pull;

pub use decompose::{RobotDecomposition, decompose_robot};
pub use pull::{
    Equation, MatterEntry, MatterRegressor, MotionTerms, TorsoMotion, fixed_base_regressor,
    torso_regressor,
};
