//! Doubts about logs: what they may be other than they are taken for.

mod columns;
mod policy;

pub(crate) use columns::misread_apart;
pub use columns::{ExchangedColumns, GivenValues, MisreadColumns, Misreading, misread_columns};
