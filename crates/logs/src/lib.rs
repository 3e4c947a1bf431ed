//! Files of logs as tables: named columns of numbers on one clock. Robots are unknown here.
//!
//! - [`open`]: a log of any format: CSV, MCAP, Parquet, Arrow, a folder of a ROS 2 bag
//! - [`is_text`]: whether a file is text, by its first bytes
//! - [`open_csv`]: text alone, from any source
//! - [`MemoryLog`]: columns that a program has
//! - [`Log`]: what a log says of itself and which columns it has; [`Log::read`] reads some,
//!   [`Log::batches`] some rows at a time
//! - [`Error`]: all that is wrong with a file
//! - `write_mcap`: a table as messages of ROS 2

#[cfg(feature = "mcap")]
mod bag;
#[cfg(feature = "parquet")]
mod columnar;
mod csv;
mod error;
mod fault;
mod format;
#[cfg(feature = "mcap")]
mod intake;
#[cfg(feature = "mcap")]
mod mcap;
mod memory;
#[cfg(feature = "mcap")]
mod message;
mod opening;
mod remark;
mod source;
#[cfg(feature = "sqlite")]
mod sqlite;
mod table;

pub use csv::open_csv;
pub use error::{Error, ErrorKind};
pub use fault::FileFault;
pub use format::{is_text, open};
#[cfg(feature = "mcap")]
pub use mcap::{Rows as McapRows, write_mcap};
pub use memory::MemoryLog;
pub use opening::Opening;
pub use remark::FileRemark;
pub use source::{Batches, Column, Found, Known, Log};
pub use table::{Place, Table};
