//! The enumerations `Link` and `Contact`.

use super::{Context, per_link, template};
use crate::emit::arrays::{Place, list};
use crate::emit::names::Names;

/// `Link`, if a function is chosen by link, and `Contact`, if the robot has contact points.
pub(super) fn items(context: &Context<'_>) -> Vec<String> {
    let mut items = Vec::new();
    let links = links(context);
    if !links.is_empty() {
        items.push(enumeration("Link", "A link of the robot.", &links));
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
pub(super) fn links<'a>(context: &Context<'a>) -> Vec<&'a str> {
    let mut links = Vec::new();
    for (_, link) in per_link(context.program) {
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
