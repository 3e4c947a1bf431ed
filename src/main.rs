//! The `denavit` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    keep_freed_memory();
    denavit::cli::run()
}

/// A signal of a log is some hundred kilobytes. The allocator of glibc gives blocks of that size
/// back to the system, which clears them for the next signal: up to a fifth of a diagnosis' time.
/// It keeps blocks as large as the largest that was ever freed, below 32 MiB; nothing is written
/// to this one. Other allocators take no notice.
fn keep_freed_memory() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(31 << 20)));
}
