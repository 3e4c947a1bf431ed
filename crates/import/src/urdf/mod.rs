//! URDF: links and joints by name, which become a tree.

mod contacts;
mod joint;
mod looks;
mod raw;
mod values;

pub(crate) use looks::looks;
pub(crate) use values::{number, numbers, wrong};

use crate::Include;
use crate::body;
use crate::chain;
use crate::fault::{Cause, Faults, clip, listed};
use crate::options::{BaseChoice, Options};
use crate::place::Turn;
use crate::tree::{MAX_LINKS, Tree, TreeLink};
use crate::xml::{Element, Text};
use denavit_codegen::expr::text::nearest;
use denavit_codegen::number::{integer, ratio};
use raw::Raw;
use std::collections::BTreeMap;
use values::Snapped;

/// The tree of a file; nothing if it is at fault.
pub(crate) fn tree(
    file: &str,
    robot: Element<'_>,
    options: &Options,
    include: &mut Include<'_>,
    faults: &mut Faults,
) -> Option<Tree> {
    let raw = raw::read(robot, faults);
    if raw.links.len() > MAX_LINKS {
        let said = format!("the robot has more than {MAX_LINKS} links");
        faults.push(robot.at(), Cause::new(said));
        return None;
    }
    let order = Order::find(&raw, robot, faults)?;
    let mut tree = Tree {
        name: raw.name.clone(),
        description: format!("Imported from {file} (URDF)."),
        gravity: [integer(0), integer(0), ratio(-981, 100)],
        floats: options.base == BaseChoice::Floating,
        links: Vec::new(),
        notes: Vec::new(),
        contacts: Vec::new(),
    };
    // the place of each link in the tree
    let mut places = BTreeMap::new();
    for &(link, joint) in &order.links {
        let found = &raw.links[link];
        let Some(joint) = joint.map(|joint| &raw.joints[joint]) else {
            let mut root = TreeLink::fixed(found.name.text, None, Vec::new());
            root.body = found.body.clone();
            tree.links.push(root);
            places.insert(found.name.text, 0);
            continue;
        };
        let Some(&parent) = places.get(joint.parent.text) else { continue };
        joint::push(&mut tree, joint, found, parent, &raw, options, faults);
        places.insert(found.name.text, tree.links.len() - 1);
    }
    notes(&mut tree, &raw);
    body::settle(&mut tree, faults);
    contacts::find(&mut tree, &raw, &places, options, include, faults);
    if let Some(tip) = &options.tip {
        chain::cut(&mut tree, tip, robot.at(), faults);
    }
    if tree.links.len() == 1 && !tree.floats {
        let hint = "`options.base=floating` makes a model of it: the base moves";
        faults
            .push(robot.at(), Cause::with_hint("the robot has one link, and nothing moves", hint));
    }
    faults.is_empty().then_some(tree)
}

/// The turns of an `origin`, for what has been read once without a fault.
pub(crate) fn turns_of(origin: Option<Element<'_>>) -> Vec<Turn> {
    let (mut snapped, mut faults) = (Snapped::default(), Faults::default());
    values::pose(origin, "", &mut snapped, &mut faults).map_or_else(Vec::new, |pose| pose.turns)
}

/// The links of a file, parents first, each with the joint that carries it.
struct Order {
    links: Vec<(usize, Option<usize>)>,
}

impl Order {
    fn find(raw: &Raw<'_>, robot: Element<'_>, faults: &mut Faults) -> Option<Self> {
        let links = named(raw, faults);
        let mut carriers: Vec<Option<usize>> = vec![None; raw.links.len()];
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); raw.links.len()];
        let mut is_whole = true;
        for (at, joint) in raw.joints.iter().enumerate() {
            let ends = [joint.parent, joint.child].map(|end| place(end, raw, &links, faults));
            let [Some(parent), Some(child)] = ends else {
                is_whole = false;
                continue;
            };
            if let Some(other) = carriers[child] {
                let other = raw.joints[other].name.text;
                let said = format!(
                    "link `{}` is already carried by joint `{}`",
                    clip(joint.child.text),
                    clip(other)
                );
                let hint = "a robot is a tree: a loop has to be cut";
                faults.push(joint.child.at, Cause::with_hint(said, hint));
                is_whole = false;
                continue;
            }
            carriers[child] = Some(at);
            children[parent].push(child);
        }
        if !is_whole || raw.is_partial {
            return None;
        }
        let roots: Vec<usize> =
            (0..raw.links.len()).filter(|&link| carriers[link].is_none()).collect();
        let [root] = roots[..] else {
            faults.push(robot.at(), no_single_root(raw, &roots));
            return None;
        };
        let mut order = vec![];
        let mut waiting = vec![root];
        while let Some(link) = waiting.pop() {
            order.push((link, carriers[link]));
            waiting.extend(children[link].iter().rev());
        }
        if order.len() < raw.links.len() {
            let is_left = |link: &usize| !order.iter().any(|(known, _)| known == link);
            let left: Vec<String> = (0..raw.links.len())
                .filter(is_left)
                .map(|link| raw.links[link].name.text.to_owned())
                .collect();
            faults.push(
                robot.at(),
                Cause::new(format!("these links carry each other: {}", listed(&left))),
            );
            return None;
        }
        Some(Self { links: order })
    }
}

/// The link of a name; notes that there is none.
fn place(
    end: Text<'_>,
    raw: &Raw<'_>,
    links: &BTreeMap<&str, usize>,
    faults: &mut Faults,
) -> Option<usize> {
    let found = links.get(end.text).copied();
    if found.is_none() {
        let names = raw.links.iter().map(|link| link.name.text);
        let said = format!("no link is called `{}`", clip(end.text));
        faults.push(
            end.at,
            match nearest(end.text, names) {
                Some(name) => Cause::with_hint(said, format!("did you mean `{name}`?")),
                None => Cause::new(said),
            },
        );
    }
    found
}

fn no_single_root(raw: &Raw<'_>, roots: &[usize]) -> Cause {
    if raw.links.is_empty() {
        return Cause::new("the robot has no link");
    }
    let names: Vec<String> =
        roots.iter().map(|&link| raw.links[link].name.text.to_owned()).collect();
    match names.is_empty() {
        true => {
            Cause::new("every link is carried by another one: a robot stands on one that is not")
        }
        false => Cause::with_hint(
            format!("these links are carried by no joint: {}", listed(&names)),
            "a robot stands on one link: join the others to it by joints",
        ),
    }
}

/// The links by name; notes names that are given twice.
fn named<'s>(raw: &Raw<'s>, faults: &mut Faults) -> BTreeMap<&'s str, usize> {
    let mut links = BTreeMap::new();
    for (at, link) in raw.links.iter().enumerate() {
        if links.insert(link.name.text, at).is_some() {
            let said = format!("two links are called `{}`", clip(link.name.text));
            faults.push(link.name.at, Cause::with_hint(said, "choose another name"));
        }
    }
    let mut joints = BTreeMap::new();
    for joint in &raw.joints {
        if joints.insert(joint.name.text, ()).is_some() {
            let said = format!("two joints are called `{}`", clip(joint.name.text));
            faults.push(joint.name.at, Cause::with_hint(said, "choose another name"));
        }
    }
    links
}

/// What is said of the whole file.
fn notes(tree: &mut Tree, raw: &Raw<'_>) {
    let bodies = &raw.bodies;
    let said = "angles within rounding of a quarter turn are quarter turns";
    let snapped = &raw.snapped;
    if !snapped.named.is_empty() {
        tree.notes.push(format!("{said}: {}", listed(&snapped.named)));
    }
    if snapped.fine > 0 {
        tree.notes.push(format!("{said}: {} that agree to ten digits", snapped.fine));
    }
    if !bodies.rounded.is_empty() {
        let said = "tensors turned by what is no quarter turn are rounded at 17 digits";
        tree.notes.push(format!("{said}: {}", listed(&bodies.rounded)));
    }
    if !bodies.accepted.is_empty() {
        let said = "moments of inertia that no body has are kept as they are";
        tree.notes.push(format!("{said}: {}", listed(&bodies.accepted)));
    }
}
