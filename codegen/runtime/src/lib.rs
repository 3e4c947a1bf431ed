//! What emitted code needs at run time.
#![no_std]
