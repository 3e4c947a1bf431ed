//! The shipped effects.

use super::{Effect, read};
use std::sync::OnceLock;

macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!("../../effects/", $name, ".json")))),*]
    };
}

/// Names and texts of the shipped effects, by name: the files of `models/effects`.
pub const SHIPPED: &[(&str, &str)] = &shipped![
    "capstan",
    "coriolis",
    "coulomb",
    "dahl",
    "load_friction",
    "payload",
    "stribeck",
    "torque_delay",
    "viscous",
];

/// The shipped effects, by name.
pub fn catalogue() -> &'static [Effect] {
    static CATALOGUE: OnceLock<Vec<Effect>> = OnceLock::new();
    CATALOGUE.get_or_init(|| {
        let read = |(name, text): &(&str, &str)| {
            let effect = read(name, text.as_bytes());
            effect.unwrap_or_else(|error| panic!("a shipped effect is at fault:\n{error}"))
        };
        SHIPPED.iter().map(read).collect()
    })
}

/// The shipped effect of that name.
pub fn find(name: &str) -> Option<&'static Effect> {
    catalogue().iter().find(|effect| effect.name == name)
}
