//! Answers of use cases as text, as JSON and as pictures.

mod diagnosed;
mod diagnosed_json;
mod diagnosis_folder;
mod excited;
mod identified;
mod identified_json;
mod run;
mod run_joints;
mod run_page;
mod statics;
mod two_stage;
mod two_stage_json;
mod walk;

pub use crate::run::ShownWithRun;
pub use diagnosed::diagnosed_text;
pub use diagnosed_json::diagnosed_json;
pub use diagnosis_folder::{DIAGNOSIS_FILES, DiagnosisFolder};
pub use excited::{
    ExcitationAnswer, drawn_excitation, excited_json, excited_text, excited_trajectory,
};
pub use identified::{identified_doubts, identified_text};
pub use identified_json::identified_json;
pub use run::{drawn_at, drawn_run, run_json, run_text, window_of};
pub use run_page::run_page;
pub use statics::{statics_json, statics_text};
pub use two_stage::two_stage_text;
pub use two_stage_json::two_stage_json;
pub use walk::{
    BalanceCriterion, BasinAnswer, CapturabilityAnswer, PushAnswer, balance_events, balance_json,
    balance_picture, balance_series, balance_text, basin_json, basin_log, basin_picture,
    basin_text, capturability_json, capturability_picture, capturability_text, capture_steps_json,
    capture_steps_text, comparison_json, comparison_page, comparison_text, cycle_json, cycle_text,
    designed_json, designed_picture, designed_text, gait_page, is_stable, multipliers_picture,
    push_json, push_picture, push_text, returns_picture,
};
