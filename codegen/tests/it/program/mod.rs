//! Lowering, scheduling, counting, interpreting.

mod code;
mod interpret;
pub(crate) mod two_link;
