//! The chain to one link of a tree.

use crate::fault::{Cause, Faults, clip, listed};
use crate::tree::Tree;
use denavit_codegen::expr::text::nearest;

/// Leaves the links on the way to a tip, and what is fixed to them.
pub(crate) fn cut(tree: &mut Tree, tip: &str, at: usize, faults: &mut Faults) {
    let has_name = |link: &crate::tree::TreeLink| link.name.as_deref() == Some(tip);
    let Some(mut link) = tree.links.iter().position(has_name) else {
        let names = tree.links.iter().filter_map(|link| link.name.as_deref());
        let said = format!("`options.tip`: no link is called `{}`", clip(tip));
        let cause = match nearest(tip, names) {
            Some(name) => Cause::with_hint(said, format!("did you mean `{name}`?")),
            None => Cause::new(said),
        };
        return faults.push(at, cause);
    };
    let mut kept = vec![false; tree.links.len()];
    kept[link] = true;
    while let Some(parent) = tree.links[link].parent {
        kept[parent] = true;
        link = parent;
    }
    let mut left = Vec::new();
    for (at, link) in tree.links.iter().enumerate() {
        let Some(parent) = link.parent.filter(|&parent| kept[parent] && !kept[at]) else {
            continue;
        };
        match &link.joint {
            None => kept[at] = kept[parent],
            Some(joint) => left.push(joint.name.clone()),
        }
    }
    if !left.is_empty() {
        tree.notes.push(format!("left out is what these joints carry: {}", listed(&left)));
    }
    let gone = tree.contacts.iter().filter(|point| !kept[point.link]);
    let gone: Vec<String> = gone.map(|point| point.name.clone()).collect();
    if !gone.is_empty() {
        let said = "`options.contacts`: `options.tip` leaves out what these points are on";
        faults.push(at, Cause::new(format!("{said}: {}", listed(&gone))));
    }
    // places after what is left out has gone
    let mut places = vec![0; tree.links.len()];
    let mut count = 0;
    for (at, place) in places.iter_mut().enumerate() {
        *place = count;
        count += usize::from(kept[at]);
    }
    let mut at = 0;
    tree.links.retain(|_| {
        at += 1;
        kept[at - 1]
    });
    for link in &mut tree.links {
        link.parent = link.parent.map(|parent| places[parent]);
    }
    tree.contacts.retain(|point| kept[point.link]);
    for point in &mut tree.contacts {
        point.link = places[point.link];
    }
}
