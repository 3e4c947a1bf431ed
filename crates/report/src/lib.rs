//! What people look at: tables and pictures.
//!
//! - [`Table`], [`paragraph`]: columns and lines of text
//! - [`Values`]: the numbers behind a model's expressions
//! - [`Pose`], [`picture`]: a robot drawn with the frames of its links
//! - [`excitation_picture`]: a trajectory with its limits, and how it was found
//! - [`run_picture`]: a run: stick figures, joints and their references, contact forces
//! - [`effects_page`]: the catalogue of effects
//! - [`html`]: reports as one page that needs nothing from elsewhere
//! - [`torque_picture`], [`motion_picture`]: measured torques and motions beside those of a model;
//!   [`convergence_picture`]: how an
//!   estimate came about; [`IdentificationPage`]: all of it
//! - [`identified_text`], [`identified_json`], [`diagnosed_text`], [`diagnosed_json`], ..: answers
//!   as text and as JSON; [`DiagnosisFolder`]: the files of a diagnosis
//! - [`DiagnosisPage`]: what a model lacks, with [`diagnosis_picture`] of torques before and after
//! - [`BalancePicture`]: points of balance and support polygon over time
//! - [`GaitPicture`]: joint angles of a planned gait with its postures marked
//! - [`UnitCircle`], [`HeatMap`]: Floquet multipliers of a gait, and what disturbances do to it
//!
//! Nothing here prints; text is handed to whoever does.

mod answer;
mod camera;
mod cells;
mod diagnosis;
mod effects;
pub mod html;
mod identification;
mod label;
mod outline;
mod paragraph;
mod picture;
mod pose;
mod run;
mod scene;
mod space;
mod svg;
mod table;
mod two_stage;
mod values;
mod walk;

pub use answer::{
    BalanceCriterion, BasinAnswer, CapturabilityAnswer, DIAGNOSIS_FILES, DiagnosisFolder,
    ExcitationAnswer, Ordered, PushAnswer, balance_events, balance_json, balance_picture,
    balance_series, balance_text, basin_json, basin_log, basin_picture, basin_text,
    capturability_json, capturability_picture, capturability_text, capture_steps_json,
    capture_steps_text, comparison_json, comparison_page, comparison_text, cycle_json, cycle_text,
    designed_json, designed_picture, designed_text, diagnosed_json, diagnosed_text, drawn_run,
    excited_json, excited_text, gait_page, identified_doubts, identified_json, identified_text,
    is_stable, multipliers_picture, push_json, push_picture, push_text, returns_picture, run_json,
    run_text, statics_json, statics_text, two_stage_json, two_stage_text,
};
pub use denavit_numerics::{percent, short};
pub use diagnosis::{DiagnosisPage, verdict_paragraph};
pub use effects::effects_page;
pub use identification::{IdentificationPage, SimulationPart};
pub use paragraph::paragraph;
pub use picture::picture;
pub use pose::Pose;
pub use run::{
    BalanceCurve, BalancePicture, ExcitationPicture, GaitCurve, GaitPicture, RunPicture,
    TorquePicture, convergence_picture, diagnosis_picture, excitation_picture, motion_picture,
    run_picture, torque_picture,
};
pub use table::{Align, Table};
pub use two_stage::TwoStagePage;
pub use values::Values;
pub use walk::{CaptureReach, HeatMap, ReturnMapPicture, UnitCircle};
