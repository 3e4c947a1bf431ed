//! Use cases as single calls: a robot and data in, an answer out.
//!
//! - [`Files`]: reads robots ([`RobotFile`]) and what they refer to, their [`Shapes`] too
//! - [`Logs`]: which logs, and how they are read; a [`LogSource`] is a file, or in memory
//! - [`identify()`]: parameters from logs, by [`IdentifyOptions`]; [`identify_two_stage`] and
//!   [`identify_statics`] for springs, and for measurements at rest
//! - [`identify_long`]: the same from a log that may be larger than the memory; [`LongLog`] has its
//!   parts for many machines
//! - [`diagnose()`]: what a model lacks, by [`DiagnoseOptions`]
//! - [`excite()`]: a trajectory that shows the parameters; [`simulate()`]: a run of a scenario
//! - [`LogBeside`]: a log to be looked at beside a run
//! - [`check_excitation`]: a trajectory that there is, against limits
//! - [`design_gait`], [`judge_run`], [`judge_log`]: gaits, and balance along runs and logs
//! - [`gait_basin`], [`push_gait`], [`push_stepping_robot`]: what gaits endure;
//!   [`compare_criteria`]: what each criterion says of a run
//! - [`Observer`]: hears of progress as data, and may stop the work, which then returns what it has
//! - [`Error`]: why there is no answer, with its kind and hints
//!
//! Nothing here prints, and no option is taken from anywhere but the arguments of a call.
//!
//! ```
//! use denavit_workflow::{Files, Silent, simulate};
//! use std::path::Path;
//!
//! // a path, or the name of a shipped scenario
//! let mut scenario = Files::default().scenario(Path::new("double_pendulum"))?;
//! let run = simulate(&mut scenario, &mut Silent)?;
//! assert!(scenario.broken(&run).is_empty(), "every law that is audited holds");
//! let t = run.log.column("t").expect("times");
//! println!("{} rows, the last at {} s", t.len(), t[t.len() - 1]);
//! # Ok::<(), denavit_workflow::Error>(())
//! ```

mod beside;
mod diagnose;
mod error;
mod excite;
mod faults;
mod files;
mod identify;
mod known_columns;
mod logs;
mod mistaken;
mod observer;
mod robot_file;
mod scenario;
mod shapes;
mod simulate;
mod walk;

pub use beside::LogBeside;
pub use denavit_import::{DrawnForm, DrawnShape};
pub use diagnose::{Completed, DiagnoseOptions, Diagnosed, NamedEffect, diagnose};
pub use error::{Error, ErrorKind, Hint, RobotFaults};
pub use excite::{check_excitation, excite};
pub use faults::{PlacedFault, faults_of};
pub use files::{Files, Input, ModelText, described, effects_folder, reason};
pub use identify::{
    Conditions, Controlled, FilterChoice, Identified, IdentifyOptions, LongLog, LongPlan, NotMoved,
    PieceRows, STATICS_FORMAT, SimulationGap, StaticsFound, TwoStageFound, identify, identify_long,
    identify_statics, identify_two_stage, statics_schema,
};
pub use logs::{LogSource, Logs};
pub use mistaken::{FileKind, Mistaken};
pub use observer::{Observer, Progress, Silent, Stage};
pub use robot_file::{EffectUse, RobotFile, WholeRobot};
pub use shapes::{LookOfLink, Shapes};
pub use simulate::{simulate, step_of};
pub use walk::{
    Designed, Gait, GaitBasin, GaitCurves, GaitQuantity, JudgeOptions, Judged, PushQuestion,
    PushedGait, Starts, compare_criteria, design_gait, gait_basin, judge_log, judge_run, push_gait,
    push_stepping_robot,
};
