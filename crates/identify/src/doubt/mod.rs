//! Doubts about logs: what they may be other than they are taken for.

mod agreement;
mod columns;
mod compared;
mod policy;
mod unexplained;

pub(crate) use agreement::{Agreement, agreement};
pub use agreement::{ContradictingJoint, ContradictingLog, Likeness, Standing};
pub(crate) use columns::misread_apart;
pub use columns::{ExchangedColumns, GivenValues, MisreadColumns, Misreading, misread_columns};
pub(crate) use compared::{Compared, Spectra};
pub use unexplained::Unexplained;
pub(crate) use unexplained::{Judged, lacking_text};
