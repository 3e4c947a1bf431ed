//! The enumerations of links, feet and contact points.

use super::dialect::Dialect;
use super::{comment, remark};
use crate::emit::context::Context;
use crate::emit::layout::template;
use crate::emit::names::{C, Names, identifier};
use crate::emit::selectors::{Selector, contacts, links};

/// Those of which a function is chosen by, and that of contacts, if the robot has some.
pub(super) fn items(context: &Context<'_>, dialect: &Dialect) -> Vec<String> {
    let mut items = Vec::new();
    for selector in Selector::ALL {
        let links = links(context, selector);
        if !links.is_empty() {
            items.push(enumeration(dialect, selector.type_name(), selector.doc(), &links));
        }
    }
    let contacts = contacts(context);
    if !contacts.is_empty() {
        let doc = "A contact point; its value is its place in positions and Jacobians.";
        items.push(enumeration(dialect, "Contact", doc, &contacts));
    }
    items
}

/// The type of a selector.
pub(super) fn type_of(dialect: &Dialect, selector: Selector) -> String {
    match dialect.is_cpp {
        true => selector.type_name().to_owned(),
        false => format!("{}_{}", dialect.prefix, selector.argument()),
    }
}

/// How each member of a selector's enumeration is written where it is used.
pub(super) fn members(dialect: &Dialect, selector: Selector, links: &[&str]) -> Vec<String> {
    let name = selector.type_name();
    let written = |variant: String| match dialect.is_cpp {
        true => format!("{name}::{variant}"),
        false => variant,
    };
    variants(dialect, name, links).into_iter().map(written).collect()
}

/// The name of each member. Those of C share one namespace with everything else.
fn variants(dialect: &Dialect, name: &str, members: &[&str]) -> Vec<String> {
    let mut taken = Names::fields(C);
    if dialect.is_cpp {
        return members.iter().map(|member| taken.variant(member)).collect();
    }
    let prefix = format!("{}_{}", dialect.upper, name.to_ascii_uppercase());
    taken.claim(&format!("{prefix}_COUNT"));
    let variant = |member: &&str| {
        taken.unique(&format!("{prefix}_{}", identifier(member).to_ascii_uppercase()))
    };
    members.iter().map(variant).collect()
}

fn enumeration(dialect: &Dialect, name: &str, doc: &str, members: &[&str]) -> String {
    let variants = variants(dialect, name, members);
    let rows = variants.iter().zip(members);
    let variants: String = rows
        .map(|(variant, member)| remark(&comment(&format!("{member:?}"))) + variant + ",\n")
        .collect();
    // C has no comma after the last one where it is strict.
    let variants = variants.trim_end_matches(",\n");
    let count = members.len().to_string();
    let (lower, upper) = (name.to_ascii_lowercase(), name.to_ascii_uppercase());
    let values = [("doc", doc), ("variants", variants), ("upper_name", &upper), ("count", &count)];
    let (text, own) = match dialect.is_cpp {
        true => (include_str!("../../../templates/c/enumeration.hpp.in"), vec![("name", name)]),
        false => {
            let mut own = vec![("name", lower.as_str())];
            own.extend(dialect.filling());
            (include_str!("../../../templates/c/enumeration.h.in"), own)
        }
    };
    template(text, &[&values[..], &own].concat())
}
