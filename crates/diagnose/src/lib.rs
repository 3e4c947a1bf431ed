//! Diagnosis: where computed and measured torques disagree, which effect is missing, and what
//! cannot be told.
//!
//! - [`Signals`]: logs, filtered
//! - [`Nominal`]: what the model says, and how sure it is
//! - [`Gap`]: how far they are apart, and how far they must be
//! - [`Candidate`], [`Law`]: what may be missing
//! - [`diagnose()`]: which effects are missing, by their evidence

mod behind_law;
mod beside;
mod cancelling;
mod candidate;
mod catalogue;
mod columns;
mod curve;
mod data;
mod diagnosis;
mod drive_law;
mod effects_found;
mod elastic;
mod error;
mod exchange;
mod excitation;
mod experiment;
mod floor;
mod followed;
mod gap;
mod given;
mod hypothesis;
mod joint_law;
mod known;
mod law;
mod law_curve;
mod leftover;
mod load_slopes;
mod nominal;
mod policy;
mod reading_law;
mod regime;
mod rounds;
mod rows;
mod search;
mod signals;
mod simulated;
mod span;
mod spectra;
mod stand_in;
mod standstill;
mod state;
mod structure;
mod together;
mod turning;
mod unnamed;
mod verdict;
mod weighing;
mod worth;

pub use candidate::Candidate;
pub use catalogue::{candidates, spring_candidates};
pub use curve::{Curve, LoggedMotion};
pub use data::ModelTorques;
pub use diagnosis::{Diagnosis, Gaps, Progress, Request, diagnose};
pub use effects_found::{Alternative, EffectValue, FoundEffect, GivenEffect};
pub use elastic::{BeforeSprings, Spring, before_springs};
pub use error::{Error, ErrorKind};
pub use excitation::Visible;
pub use experiment::Experiment;
pub use gap::{Gap, share_closed};
pub use given::{Belief, given_candidates};
pub use law::{Law, Motion, Response};
pub use law_curve::{LawCurve, Quantity};
pub use leftover::Leftover;
pub use nominal::{Nominal, Phi};
pub use regime::{Part, Where};
pub use rows::PerJoint;
pub use search::Step;
pub use signals::{Filters, Signals};
pub use simulated::{MotionGap, MotionGaps, Moved};
pub use state::Taken;
pub use structure::Structure;
pub use verdict::Verdict;
