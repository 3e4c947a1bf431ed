//! Limit cycles by periodic optimal control.
//!
//! A step is a list of phases, each with its closed contacts, and impacts or releases between them;
//! at its end the legs swap and it begins again. Direct collocation makes of it a sparse nonlinear
//! program with exact derivatives, which sequential quadratic programming solves from straight
//! legs. The plan is then followed in closed loop, and gains are searched by which its Floquet
//! multipliers are as small as asked for.
//!
//! - [`design`](design()): from a [`LimitCycleProblem`] to a [`LimitCycle`] that walks
//! - [`scenario_text`]: the scenario file of a gait
//! - [`walk`]: a walk of a planned step in the simulator
//! - [`minimise`]: the solver, for any [`Program`]

mod cost;
mod design;
mod following;
mod gains;
mod guess;
mod interval_rows;
mod layout;
mod legs;
mod limits;
mod mechanics;
mod phases;
mod planned;
mod point_rows;
mod program;
mod quadratic;
mod rows;
mod scenario_text;
mod section;
mod sparse;
mod sqp;
mod stance_foot;
mod step;
mod transition_rows;

pub use crate::scenario_file::ScenarioHead;
pub use cost::CostKind;
pub use design::{LimitCycle, LimitCycleProblem, Stage, design};
pub use following::{Gains, Walk, control, simulation, walk};
pub use guess::Guess;
pub use legs::{Leg, Legs, Role};
pub use limits::StepLimits;
pub(crate) use phases::check as check_phases;
pub use phases::{Aspects, Axis, Phase, Transition, phases_of, transitions};
pub use planned::{PlannedPhase, PlannedStep};
pub use program::{Linearisation, Program};
pub use scenario_text::scenario_text;
pub use section::Cycle;
pub use sparse::Triplets;
pub use sqp::{Ending, Optimum, Settings, minimise};
