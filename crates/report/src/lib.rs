//! What people look at: tables and pictures.
//!
//! - [`Table`], [`paragraph`]: columns and lines of text; [`Ordered`]: objects of JSON
//! - [`Values`]: the numbers behind a model's expressions
//! - [`Pose`], [`picture`]: a robot drawn with the frames of its links
//! - [`excitation_picture`]: a trajectory with its limits, and how it was found
//! - [`effects_page`]: the catalogue of effects
//! - [`html`]: reports as one page that needs nothing from elsewhere
//! - [`torque_picture`], [`motion_picture`]: measured torques and motions beside those of a model;
//!   [`IdentificationPage`]: all of an estimate
//! - [`inspection_page`]: a model, whose joints a reader moves
//! - [`Gallery`]: the results of a folder
//! - [`DiagnosisPage`]: what a model lacks, with torques before and after
//! - [`symbolic`]: what the compiler finds, as text, JSON, Markdown and LaTeX
//! - [`answer`]: what use cases answer, as text, JSON, pictures and pages
//!
//! Nothing here prints; text is handed to whoever does.

pub mod answer;
mod camera;
mod cells;
mod diagnosis;
mod effects;
mod gallery;
pub mod html;
mod identification;
mod inspection;
mod jointed;
mod label;
mod ordered;
mod outline;
mod paragraph;
mod picture;
mod png;
mod pose;
mod quaternion;
mod run;
mod scene;
mod shapes;
mod space;
mod svg;
pub mod symbolic;
mod table;
mod two_stage;
mod values;
mod walk;

pub use denavit_numerics::{percent, short};
pub use diagnosis::{DiagnosisPage, DiagnosisSource, verdict_paragraph};
pub use effects::effects_page;
pub use gallery::Gallery;
pub use identification::{IdentificationPage, SimulationPart};
pub use inspection::inspection_page;
pub use ordered::Ordered;
pub use paragraph::paragraph;
pub use picture::picture;
pub use png::{can_draw_png, png};
pub use pose::Pose;
pub use run::{
    ExcitationPicture, TorquePicture, excitation_picture, motion_picture, torque_picture,
};
pub use table::{Align, Table};
pub use two_stage::TwoStagePage;
pub use values::Values;
