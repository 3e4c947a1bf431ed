//! The enumerations `Link`, `Foot` and `Contact`.

use super::{Context, template};
use crate::emit::arrays::{Place, list};
use crate::emit::names::Names;
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

    fn doc(self) -> &'static str {
        match self {
            Self::Link => "A link of the robot.",
            Self::Foot => "A link of the robot that carries contact points.",
        }
    }
}

/// `Link` and `Foot`, if a function is chosen by them, and `Contact`, if the robot has contact
/// points.
pub(super) fn items(context: &Context<'_>) -> Vec<String> {
    let mut items = Vec::new();
    for selector in [Selector::Link, Selector::Foot] {
        let links = links(context, selector);
        if !links.is_empty() {
            items.push(enumeration(selector.type_name(), selector.doc(), &links));
        }
    }
    let contacts: Vec<&str> =
        context.robot.contacts.values().map(|contact| contact.name.as_str()).collect();
    if !contacts.is_empty() {
        let doc = "A contact point; its discriminant is its place in positions and Jacobians.";
        items.push(enumeration("Contact", doc, &contacts));
    }
    items
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

/// The variant of each name.
pub(super) fn variants(names: &[&str]) -> Vec<String> {
    let mut taken = Names::fields();
    names.iter().map(|name| taken.variant(name)).collect()
}

fn enumeration(name: &str, doc: &str, members: &[&str]) -> String {
    let variants = variants(members);
    let rows = || variants.iter().zip(members);
    let of = |line: &dyn Fn(&str, &str) -> String| -> String {
        rows().map(|(variant, member)| line(variant, member)).collect()
    };
    let all = variants.iter().map(|variant| vec![format!("Self::{variant}")]).collect();
    let mut all = list(all, Place { indent: 4, followed: true });
    all[1..].iter_mut().for_each(|line| line.insert_str(0, "    "));
    let all = all.join("\n");
    template(
        include_str!("../../../templates/rust/enumeration.rs.in"),
        &[
            ("doc", doc),
            ("name", name),
            ("count", &members.len().to_string()),
            ("variants", &of(&|variant, member| format!("/// {member:?}\n{variant},\n"))),
            ("all", &all),
            ("names", &of(&|variant, member| format!("Self::{variant} => {member:?},\n"))),
        ],
    )
}
