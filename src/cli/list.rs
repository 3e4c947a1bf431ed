//! `denavit list`: what is shipped.

use super::Answer;
use super::failure::Failure;
use super::json::write_json;
use clap::{Args, ValueEnum};
use denavit::report::symbolic::{ShippedKind, shipped_table};
use std::io::Write;

/// List what is shipped: models, scenarios, gaits, controllers, effects
///
/// Each has a name that other commands take in place of a file.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit list
  denavit list scenarios
  denavit list models --json")]
pub(crate) struct Arguments {
    /// Only these
    #[arg(value_name = "KIND")]
    kind: Option<Kind>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Robots
    Models,
    /// Simulations
    Scenarios,
    /// Gaits to be designed
    Gaits,
    /// What drove robots
    Controllers,
    /// Equations as text
    Equations,
    /// The catalogue of physics that models may lack
    Effects,
}

impl Kind {
    fn shipped(self) -> ShippedKind {
        match self {
            Self::Models => ShippedKind::Models,
            Self::Scenarios => ShippedKind::Scenarios,
            Self::Gaits => ShippedKind::Gaits,
            Self::Controllers => ShippedKind::Controllers,
            Self::Equations => ShippedKind::Equations,
            Self::Effects => ShippedKind::Effects,
        }
    }
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let kinds = arguments.kind.map_or(ShippedKind::ALL.to_vec(), |kind| vec![kind.shipped()]);
    let listed: Vec<_> = kinds.into_iter().flat_map(ShippedKind::listed).collect();
    if arguments.json {
        write_json(out, &listed)?;
    } else {
        write!(out, "{}", shipped_table(&listed))?;
    }
    Ok(Answer::Done)
}
