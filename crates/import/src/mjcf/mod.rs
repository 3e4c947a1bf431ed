//! MJCF: bodies in bodies, with what rigid-body trees have of it.

mod body;
mod contacts;
mod frame;
mod geom;
mod joint;
mod looks;
mod mass;
mod meshes;
mod refused;
mod settings;

use crate::Include;
use crate::body::settle;
use crate::chain;
use crate::fault::{Cause, Faults, listed};
use crate::looks::TreeLooks;
use crate::options::{BaseChoice, Options};
use crate::tree::{Tree, TreeLink};
use crate::xml::Element;
use body::{Geoms, Reader, Scope};
use denavit_codegen::number::Rational;
use num_traits::ToPrimitive;
use settings::Settings;
use std::collections::{BTreeMap, BTreeSet};

/// A whole number, 0 where there is none.
fn whole(value: &Rational) -> i64 {
    value.to_integer().to_i64().unwrap_or(0)
}

/// The tree of a file; nothing if it is at fault. `included` are the files that it includes.
pub(crate) fn tree<'s>(
    file: &str,
    root: Element<'s>,
    included: BTreeMap<String, Element<'s>>,
    options: &Options,
    include: &mut Include<'_>,
    faults: &mut Faults,
) -> Option<Tree> {
    let settings = Settings::read(root, included, faults);
    let Read { mut tree, geoms, .. } = read(file, root, &settings, options.base, faults);
    contacts::find(&mut tree, &geoms, &settings, options, include, faults);
    if let Some(tip) = &options.tip {
        chain::cut(&mut tree, tip, root.at(), faults);
    }
    if tree.links.iter().all(|link| link.joint.is_none()) && !tree.floats {
        faults.push(root.at(), Cause::new("nothing moves: no body has a joint"));
    }
    faults.is_empty().then_some(tree)
}

/// What the bodies of a file look like; nothing if it is at fault.
pub(crate) fn looks<'s>(
    file: &str,
    root: Element<'s>,
    included: BTreeMap<String, Element<'s>>,
    faults: &mut Faults,
) -> Option<TreeLooks> {
    let settings = Settings::read(root, included, faults);
    let found = read(file, root, &settings, Options::default().base, faults);
    faults.is_empty().then(|| looks::of(found, &settings))
}

/// What the bodies of a file are.
struct Read<'s> {
    tree: Tree,
    /// Geoms of each body, by its name.
    geoms: BTreeMap<String, Geoms<'s>>,
    /// Geoms of the world, where what moves stands on it.
    ground: Vec<(Element<'s>, Scope<'s>)>,
}

fn read<'s>(
    file: &str,
    root: Element<'s>,
    settings: &Settings<'s>,
    base: BaseChoice,
    faults: &mut Faults,
) -> Read<'s> {
    let sections = settings.children(root);
    refused::refuse(settings, &sections, faults);
    let of = |name: &'static str| sections.iter().copied().filter(move |one| one.name() == name);
    let driven = of("actuator")
        .flat_map(|actuators| settings.children(actuators))
        .filter_map(|actuator| actuator.get("joint").or(actuator.get("jointinparent")))
        .map(|joint| joint.text);
    let driven: BTreeSet<&str> = driven.collect();
    let acting = refused::acting(settings, &of("actuator").collect::<Vec<_>>(), faults);
    let name = root.get("model").map_or("robot", |name| name.text);
    let tree = Tree {
        name: name.to_owned(),
        description: format!("Imported from {file} (MJCF)."),
        gravity: settings.gravity.clone(),
        floats: false,
        links: Vec::new(),
        notes: Vec::new(),
        contacts: Vec::new(),
    };
    let mut reader = Reader::new(settings, tree, driven, base, faults);
    let ground = bodies(&mut reader, root, &of("worldbody").collect::<Vec<_>>());
    let (snapped, notes, geoms) = (reader.snapped, reader.notes, reader.geoms);
    let mut tree = reader.tree;
    mass::scale(&mut tree, settings);
    let mut note = |said: &str, names: &[String]| {
        if !names.is_empty() {
            tree.notes.push(format!("{said}: {}", listed(names)));
        }
    };
    note(
        "angles within rounding of a quarter turn are quarter turns",
        &[snapped, notes.snapped].concat(),
    );
    note(
        "tensors turned by what is no quarter turn are rounded at 17 digits",
        &notes.bodies.rounded,
    );
    note("moments of inertia that no body has are kept as they are", &notes.bodies.accepted);
    note("forces of the fluid around it are no part of a model, and are left out", &settings.fluid);
    note("what actuators do by themselves is for a controller file, and is left out", &acting);
    if notes.shaped > 0 {
        let masses = match notes.shaped {
            1 => "the mass of a body is that of its shapes".to_owned(),
            count => format!("masses of {count} bodies are those of their shapes"),
        };
        tree.notes.push(format!("{masses}, at 17 digits"));
    }
    settle(&mut tree, faults);
    Read { tree, geoms, ground }
}

/// Reads all bodies: on the world, whose geoms these are, or on the one that floats.
fn bodies<'s>(
    reader: &mut Reader<'s, '_>,
    root: Element<'s>,
    worlds: &[Element<'s>],
) -> Vec<(Element<'s>, Scope<'s>)> {
    let (mut tops, mut ground) = (Vec::new(), Vec::new());
    for world in worlds {
        let class = world.get("childclass").map(|class| class.text);
        let contents = reader.contents(*world, Scope::of(class));
        tops.extend(contents.bodies);
        ground.extend(contents.geoms);
    }
    if let Some((body, scope)) = floating(reader, root, &tops) {
        reader.tree.floats = true;
        reader.push(body, None, &scope);
        return Vec::new();
    }
    reader.tree.links.push(TreeLink::fixed("world", None, Vec::new()));
    for (body, scope) in tops {
        reader.push(body, Some(0), &scope);
    }
    ground
}

/// The body that floats, if all that moves stands on it.
fn floating<'s>(
    reader: &mut Reader<'s, '_>,
    root: Element<'s>,
    tops: &[(Element<'s>, Scope<'s>)],
) -> Option<(Element<'s>, Scope<'s>)> {
    let moves = |body: &Element<'s>| {
        body.everything().any(|part| matches!(part.name(), "joint" | "freejoint"))
    };
    let moving: Vec<&(Element<'s>, Scope<'s>)> =
        tops.iter().filter(|(body, _)| moves(body)).collect();
    if reader.base == BaseChoice::Fixed {
        return None;
    }
    let single = match moving[..] {
        [one] => Some(one),
        [] if tops.len() == 1 => tops.first(),
        _ => None,
    };
    let Some((body, scope)) = single else {
        if reader.base == BaseChoice::Floating {
            reader.faults.push(
                root.at(),
                Cause::new("`options.base=floating`: no single body stands on the world"),
            );
        }
        return None;
    };
    let class = body.get("childclass").map(|class| class.text).or(scope.class);
    let joints = reader.contents(*body, Scope::of(class)).joints;
    let is_free = |(element, scope): &(Element<'s>, Scope<'s>), reader: &mut Reader<'s, '_>| {
        let attributes = reader.settings.with_class(*element, scope.class, reader.faults);
        element.name() == "freejoint"
            || attributes.get("type").is_some_and(|kind| kind.text == "free")
    };
    match &joints[..] {
        [one] if is_free(one, reader) => Some((*body, scope.clone())),
        [] if reader.base == BaseChoice::Floating => Some((*body, scope.clone())),
        _ if reader.base == BaseChoice::Floating => {
            let said = "`options.base=floating`: the first body has joints of its own";
            reader.faults.push(body.at(), Cause::new(said));
            None
        }
        _ => None,
    }
}
