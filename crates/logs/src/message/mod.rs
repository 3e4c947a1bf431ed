//! Messages of ROS 2 as numbers: what a definition says, where its numbers stand in bytes (CDR),
//! and which columns they are.
//!
//! Nothing here knows a message's offsets: definitions are read as text, which a file has in it. Of
//! a few kinds the usual definition is known, for files without ([`usual`]).

mod convention;
mod decode;
mod definition;
mod join;
mod layout;
mod streams;
mod usual;

pub(crate) use convention::{CONTACTS, LINKS, MOTORS, short_kind};
pub(crate) use decode::{Decoded, decode};
pub(crate) use definition::Definition;
pub(crate) use layout::Layout;
pub(crate) use streams::{Received, Streams};
pub(crate) use usual::{CONTROLLER_STATE, JOINT_STATE, NUMBER, Usual, WRENCH, usual};
