//! The enumerations `Link`, `Foot` and `Contact`.

use super::template;
use crate::emit::arrays::{Place, list};
use crate::emit::context::Context;
use crate::emit::names::{Names, RUST};
use crate::emit::selectors::{Selector, contacts, links};

/// `Link` and `Foot`, if a function is chosen by them, and `Contact`, if the robot has contacts.
pub(super) fn items(context: &Context<'_>) -> Vec<String> {
    let mut items = Vec::new();
    for selector in Selector::ALL {
        let links = links(context, selector);
        if !links.is_empty() {
            items.push(enumeration(selector.type_name(), selector.doc(), &links));
        }
    }
    let contacts = contacts(context);
    if !contacts.is_empty() {
        let doc = "A contact point; its discriminant is its place in positions and Jacobians.";
        items.push(enumeration("Contact", doc, &contacts));
    }
    items
}

/// The variant of each name.
pub(super) fn variants(names: &[&str]) -> Vec<String> {
    let mut taken = Names::fields(RUST);
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
