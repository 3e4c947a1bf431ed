//! The symbolic compiler.
