//! The `denavit` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    denavit::cli::run()
}
