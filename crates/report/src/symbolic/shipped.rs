//! What is shipped, as a list.

use crate::{Align, Table};
use denavit_codegen::effect::{Effect, catalogue};
use denavit_plants::shipped::{self, ShippedModel};
use serde::Serialize;

/// What can be shipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShippedKind {
    /// Robots.
    Models,
    /// Simulations.
    Scenarios,
    /// Gaits to be designed.
    Gaits,
    /// What drove robots.
    Controllers,
    /// Equations as text.
    Equations,
    /// The catalogue of physics that models may lack.
    Effects,
}

/// Something shipped; serialised, it is what a JSON document lists.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ShippedFile {
    name: String,
    kind: &'static str,
    description: String,
}

impl ShippedKind {
    /// All kinds, in the order of listings.
    pub const ALL: [Self; 6] = [
        Self::Models,
        Self::Scenarios,
        Self::Gaits,
        Self::Controllers,
        Self::Equations,
        Self::Effects,
    ];

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

    /// What is shipped of this kind.
    pub fn listed(self) -> Vec<ShippedFile> {
        let kind = self.word();
        if self == Self::Effects {
            let of = |one: &Effect| ShippedFile {
                name: one.name.clone(),
                kind,
                description: one.title.clone(),
            };
            return catalogue().iter().map(of).collect();
        }
        let of = |one: &ShippedModel| ShippedFile {
            name: one.name.to_owned(),
            kind,
            description: description(one.text),
        };
        self.files().iter().map(of).collect()
    }
}

/// What is shipped as a table: kind, name, and the first sentence of its description.
pub fn shipped_table(listed: &[ShippedFile]) -> Table {
    let columns = ["kind", "name", ""].map(|name| (name, Align::Left));
    let mut table = Table::new(&columns);
    for one in listed {
        let first = first_sentence(&one.description).to_owned();
        table.push(vec![one.kind.to_owned(), one.name.clone(), first]);
    }
    table
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
