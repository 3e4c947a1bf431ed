//! `denavit list`: what is shipped.

use super::Answer;
use super::failure::Failure;
use super::json::write_json;
use clap::{Args, ValueEnum};
use denavit::report::{Align, Table};
use denavit::shipped::{self, ShippedModel};
use serde::Serialize;
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

const KINDS: [Kind; 6] =
    [Kind::Models, Kind::Scenarios, Kind::Gaits, Kind::Controllers, Kind::Equations, Kind::Effects];

/// Something shipped.
#[derive(Serialize)]
struct Listed {
    name: String,
    kind: &'static str,
    description: String,
}

impl Kind {
    fn word(self) -> &'static str {
        match self {
            Self::Models => "model",
            Self::Scenarios => "scenario",
            Self::Gaits => "gait",
            Self::Controllers => "controller",
            Self::Equations => "equations",
            Self::Effects => "effect",
        }
    }

    fn files(self) -> &'static [ShippedModel] {
        match self {
            Self::Models => shipped::MODELS,
            Self::Scenarios => shipped::SCENARIOS,
            Self::Gaits => shipped::GAITS,
            Self::Controllers => shipped::CONTROLLERS,
            Self::Equations => shipped::EQUATIONS,
            // each has been read already
            Self::Effects => &[],
        }
    }

    fn listed(self) -> Vec<Listed> {
        let kind = self.word();
        if self == Self::Effects {
            let all = denavit::effect::catalogue().iter();
            let of = |one: &denavit::effect::Effect| Listed {
                name: one.name.clone(),
                kind,
                description: one.title.clone(),
            };
            return all.map(of).collect();
        }
        let of = |one: &ShippedModel| Listed {
            name: one.name.to_owned(),
            kind,
            description: description(one.text),
        };
        self.files().iter().map(of).collect()
    }
}

/// What a file says of itself.
fn description(text: &str) -> String {
    let file = serde_json::from_str::<serde_json::Value>(text).unwrap_or_default();
    file["description"].as_str().unwrap_or_default().to_owned()
}

/// The first sentence, for a line of a table.
fn first_sentence(text: &str) -> &str {
    text.split_once(". ").map_or(text, |(first, _)| first).trim_end_matches('.')
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let kinds = arguments.kind.map_or(KINDS.to_vec(), |kind| vec![kind]);
    let listed: Vec<Listed> = kinds.into_iter().flat_map(Kind::listed).collect();
    if arguments.json {
        write_json(out, &listed)?;
        return Ok(Answer::Done);
    }
    let columns = ["kind", "name", ""].map(|name| (name, Align::Left));
    let mut table = Table::new(&columns);
    for one in &listed {
        let first = first_sentence(&one.description).to_owned();
        table.push(vec![one.kind.to_owned(), one.name.clone(), first]);
    }
    write!(out, "{table}")?;
    Ok(Answer::Done)
}
