//! `denavit walk`: gaits, their stability, and what each criterion misses.

mod balance;
mod capturability;
mod capture_steps;
mod compare;
mod design;
mod number;
mod page;
mod poincare;
mod robustness;

use super::Answer;
use super::failure::Failure;
use clap::{Args, Subcommand};
use denavit::report::answer::BalanceCriterion;
use std::io::Write;

/// Walk: design gaits, and say whether they are stable
///
/// The criteria are those of the thesis's chapter 4; docs/reference/walking.md says what each
/// means.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  denavit walk poincare compass_gait")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Zero moment point: exact, from forces, and of the cart-table model (thesis 4.2.1)
    ///
    /// Periodic gaits are judged over one cycle from their fixed point.
    #[command(after_help = "\
Example:
  denavit walk zmp planar_biped_zmp_gait --svg zmp.svg")]
    Zmp(balance::Arguments),
    /// Foot rotation indicator (thesis 4.2.1)
    ///
    /// The point of the ground where its force would have to act to keep the foot still that
    /// stands (Goswami 1999), while exactly one foot does.
    #[command(after_help = "\
Example:
  denavit walk fri planar_biped_limit_cycle_gait")]
    Fri(balance::Arguments),
    /// Capture point of the linear inverted pendulum (thesis 4.2.4)
    #[command(after_help = "\
Example:
  denavit walk capture planar_biped_limit_cycle_gait")]
    Capture(balance::Arguments),
    /// Angular momentum about the centre of mass (thesis 4.2.3)
    #[command(after_help = "\
Example:
  denavit walk momentum planar_biped_limit_cycle_gait")]
    Momentum(balance::Arguments),
    Design(design::Arguments),
    Poincare(poincare::Arguments),
    Basin(robustness::BasinArguments),
    Push(robustness::PushArguments),
    Capturability(capturability::Arguments),
    CaptureSteps(capture_steps::Arguments),
    Compare(compare::Arguments),
    Page(page::Arguments),
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    match &arguments.command {
        Command::Zmp(arguments) => balance::run(BalanceCriterion::Zmp, arguments, out),
        Command::Fri(arguments) => balance::run(BalanceCriterion::Fri, arguments, out),
        Command::Capture(arguments) => balance::run(BalanceCriterion::Capture, arguments, out),
        Command::Momentum(arguments) => balance::run(BalanceCriterion::Momentum, arguments, out),
        Command::Design(arguments) => design::run(arguments, out),
        Command::Poincare(arguments) => poincare::run(arguments, out),
        Command::Basin(arguments) => robustness::run_basin(arguments, out),
        Command::Push(arguments) => robustness::run_push(arguments, out),
        Command::Capturability(arguments) => capturability::run(arguments, out),
        Command::CaptureSteps(arguments) => capture_steps::run(arguments, out),
        Command::Compare(arguments) => compare::run(arguments, out),
        Command::Page(arguments) => page::run(arguments, out),
    }
}
