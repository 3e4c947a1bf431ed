//! Diagnosis: where computed and measured torques disagree, which effect is missing, and what
//! cannot be told.
//!
//! - [`Signals`]: logs, filtered
//! - [`Nominal`]: what the model says, and how sure it is
//! - [`Data`]: both as rows
//! - [`NoiseFloor`], [`Gap`]: how far they are apart, and how far they must be
//! - [`Candidate`], [`Law`]: what may be missing
//! - [`Problem`]: fits of effects with the model's own uncertainty eliminated
//! - [`search()`]: which effects are missing

mod alias;
mod between;
mod candidate;
mod catalogue;
mod curve;
mod data;
mod diagnosis;
mod drive_law;
mod driven;
mod effects_found;
mod elastic;
mod errors;
mod evidence;
mod excitation;
mod experiment;
mod family;
mod fault;
mod floor;
mod followed;
mod gap;
mod given;
mod held;
mod joint_law;
mod law;
mod nominal;
mod problem;
mod profile;
mod regime;
mod repeat;
mod round;
mod rows;
mod search;
mod signals;
mod simulated;
mod standstill;
mod state;
mod structure;
mod turning;

pub use alias::{ExactAliases, Named};
pub use candidate::{Candidate, starts};
pub use catalogue::{candidates, spring_candidates};
pub use curve::Curve;
pub use data::{Data, ModelTorques, RowResponse, Stretch};
pub use diagnosis::{Diagnosis, Gaps, Request, Verdict, diagnose};
pub use effects_found::{EffectValue, FoundEffect, GivenEffect};
pub use elastic::{BeforeSprings, SeriesSpring, before_springs};
pub use evidence::{block_costs, by_ranks, paired};
pub use excitation::Visible;
pub use experiment::{Experiment, ExperimentOptions, NoExperiment};
pub use family::{Alternative, family};
pub use fault::DiagnosisError;
pub use floor::{NoiseFloor, rms};
pub use gap::{Gap, share_closed};
pub use given::{Belief, given_candidates};
pub use law::{Law, Motion, Response};
pub use nominal::{Nominal, Phi, Spring, Uncertain, Uncertainty};
pub use problem::{Fitted, Found, Problem, View};
pub use regime::{Part, Regime, Where, where_left};
pub use rows::PerJoint;
pub use search::{Outcome, Scored, Screen, SearchOptions, Step, Stop, score, search};
pub use signals::{Filters, Signals};
pub use simulated::{MotionGap, MotionGaps, Moved, NotMoved};
pub use state::{Setting, State, Taken, Trial};
pub use structure::Structure;
