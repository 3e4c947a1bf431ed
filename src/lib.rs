//! Symbolic robot dynamics from a Denavit-Hartenberg table.
