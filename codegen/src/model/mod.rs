//! Robot models: a file is read, checked, and becomes a [`Robot`] that cannot be wrong.
//!
//! 1. `json`: text to values with places, within bounds
//! 2. `file`: values to one type per object of the format (form)
//! 3. `check`: every rule of the format (content)
//! 4. [`robot`](Robot): what later stages see
//!
//! All faults are found in one run: [`ModelError`] lists them with file, line, column, JSON
//! pointer, cause and hint. [`remarks`] are what a model may say by mistake and is no fault.
//! docs/reference/model-file.md describes the format.

mod bake;
pub(crate) mod check;
pub(crate) mod entry;
pub mod equations;
mod fault;
pub(crate) mod file;
mod hash;
mod inertia;
pub mod json;
mod message;
mod parameter;
pub(crate) mod place_file;
pub(crate) mod reader;
mod remark;
mod report;
mod robot;
pub(crate) mod spelling;
mod tree;
mod unit;

pub use bake::{BakeError, bake, bake_geometry, bake_where, bake_zeros};
pub use check::meant_quarter_turns;
pub use fault::{Cause, Explained, Fault, FileError, MAX_FAULTS, ModelError};
pub use inertia::{Unphysical, find_fault};
pub use parameter::{BodyEntry, JointEntry, Parameter, ParameterId, Role};
pub use reader::{Fields, Node, Word, find_duplicate_keys, read_document};
pub use remark::{Remark, remarks};
pub use report::Report;
pub use robot::{
    About, AddedEffect, AddedValue, Base, Body, Contact, ContactId, Convention, Drive, EffectPlace,
    FallBody, Ground, Joint, JointKind, JointLaw, JointSpring, JointVariables, LawState, Limits,
    Link, LinkId, ReturnSpring, Robot, SeriesElastic, Side, SpringLaw, SpringSide, Terms,
    TorqueSide,
};
pub use tree::Tree;
pub use unit::{Dimension, Unit, UnitError};

use inertia::Violation;
use json::JsonCause;

/// The tag of a model file.
pub const FORMAT: &str = "denavit-model/1";

/// The JSON Schema (draft 2020-12) of a model file: its form, not its content.
pub fn schema() -> &'static str {
    include_str!("schema.json")
}

/// Reads a model file from its bytes. `file` is its name, for messages alone.
pub fn read(file: &str, source: &[u8]) -> Result<Robot, ModelError> {
    read_file(file, source, |_| ())
}

/// Reads a model whose numbers were estimated: as [`read`], but moments that violate the triangle
/// inequality are no fault, as no motion may tell them apart; energies are positive.
pub fn read_estimated(file: &str, source: &[u8]) -> Result<Robot, ModelError> {
    read_file(file, source, |model| {
        let links = model.links.iter_mut().filter_map(|link| link.body.as_mut());
        for body in links.chain(&mut model.base.body) {
            body.violation = Violation::Estimated;
        }
    })
}

fn read_file(
    file: &str,
    source: &[u8],
    prepare: impl FnOnce(&mut file::ModelFile<'_>),
) -> Result<Robot, ModelError> {
    reader::read_document(file, source, |root, report| {
        let mut model = file::ModelFile::read(root, report)?;
        prepare(&mut model);
        Some(check::check(&model, hash::content_hash(root.0), report))
    })
}

impl From<JsonCause> for Cause {
    fn from(cause: JsonCause) -> Self {
        match cause {
            JsonCause::TooLarge(bytes) => Self::FileTooLarge(bytes),
            JsonCause::NotUtf8 => Self::NotUtf8,
            JsonCause::ByteOrderMark => Self::ByteOrderMark,
            JsonCause::TooDeep => Self::TooDeep,
            JsonCause::TooManyValues => Self::TooManyValues,
            JsonCause::Syntax(message) => Self::Syntax(message),
        }
    }
}
