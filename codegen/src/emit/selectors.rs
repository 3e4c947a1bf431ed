//! By what functions of links are chosen: `Link` and `Foot`; and the names of contact points.

use super::context::Context;
use crate::function::FunctionName;

/// Which links a function of links has a part for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Selector {
    /// All of them.
    Link,
    /// Those that carry contact points.
    Foot,
}

impl Selector {
    pub(super) const ALL: [Self; 2] = [Self::Link, Self::Foot];

    /// By which links a function is chosen.
    pub(super) fn of(function: FunctionName) -> Self {
        match function {
            FunctionName::FootRotationIndicator => Self::Foot,
            _ => Self::Link,
        }
    }

    /// Its enumeration.
    pub(super) fn type_name(self) -> &'static str {
        match self {
            Self::Link => "Link",
            Self::Foot => "Foot",
        }
    }

    /// The argument of the functions.
    pub(super) fn argument(self) -> &'static str {
        match self {
            Self::Link => "link",
            Self::Foot => "foot",
        }
    }

    pub(super) fn doc(self) -> &'static str {
        match self {
            Self::Link => "A link of the robot.",
            Self::Foot => "A link of the robot that carries contact points.",
        }
    }
}

/// The names of the links that a function is chosen by, each once.
pub(super) fn links<'a>(context: &Context<'a>, selector: Selector) -> Vec<&'a str> {
    let mut links = Vec::new();
    let program = context.program;
    let chosen = program.routines.iter().filter(|made| Selector::of(made.name) == selector);
    for link in chosen.filter_map(|routine| routine.link.as_deref()) {
        if !links.contains(&link) {
            links.push(link);
        }
    }
    links
}

/// The names of the contact points.
pub(super) fn contacts<'a>(context: &Context<'a>) -> Vec<&'a str> {
    context.robot.contacts.values().map(|contact| contact.name.as_str()).collect()
}
