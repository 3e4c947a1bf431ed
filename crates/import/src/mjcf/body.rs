//! Bodies of MJCF as links of the tree.

use super::frame::{Snapped, pose};
use super::joint::{Freedom, joint};
use super::mass::{MassNotes, mass_of};
use super::settings::Settings;
use crate::fault::{Cause, Faults, clip};
use crate::options::BaseChoice;
use crate::place::Pose;
use crate::tree::{MAX_LINKS, Tree, TreeLink};
use crate::xml::Element;
use std::collections::{BTreeMap, BTreeSet};

/// What holds where an element stands: the class, and frames around it.
#[derive(Clone, Debug)]
pub(crate) struct Scope<'s> {
    pub(crate) class: Option<&'s str>,
    /// Frames around it, from the body that they are in.
    pub(crate) way: Vec<Pose>,
    /// The same as one pose, to fifty digits.
    pub(crate) frame: Pose,
}

/// What is in a body.
pub(crate) struct Contents<'s> {
    pub(crate) inertial: Option<Element<'s>>,
    pub(crate) joints: Vec<(Element<'s>, Scope<'s>)>,
    pub(crate) geoms: Vec<(Element<'s>, Scope<'s>)>,
    pub(crate) bodies: Vec<(Element<'s>, Scope<'s>)>,
}

/// What makes bodies of other elements.
const MAKERS: [&str; 5] = ["replicate", "attach", "composite", "flexcomp", "plugin"];

impl<'s> Scope<'s> {
    /// The scope of a body, with the class of its children.
    pub(crate) fn of(class: Option<&'s str>) -> Self {
        Self { class, way: Vec::new(), frame: Pose::identity() }
    }

    fn inside(&self, class: Option<&'s str>, pose: &Pose) -> Self {
        Self {
            class: class.or(self.class),
            way: [&self.way[..], std::slice::from_ref(pose)].concat(),
            frame: pose.within(&self.frame),
        }
    }
}

/// Reads bodies into a tree.
pub(crate) struct Reader<'s, 'f> {
    pub(crate) settings: &'f Settings<'s>,
    pub(crate) faults: &'f mut Faults,
    pub(crate) tree: Tree,
    pub(crate) driven: BTreeSet<&'s str>,
    pub(crate) base: BaseChoice,
    pub(crate) notes: MassNotes,
    pub(crate) snapped: Snapped,
    /// The geoms of each body, by its name.
    pub(crate) geoms: BTreeMap<String, Geoms<'s>>,
    unnamed: usize,
}

/// The geoms of a body.
pub(crate) struct Geoms<'s> {
    /// The place of the body in the tree, and in the file.
    pub(crate) link: usize,
    pub(crate) at: usize,
    pub(crate) all: Vec<(Element<'s>, Scope<'s>)>,
}

impl<'s, 'f> Reader<'s, 'f> {
    /// A reader with an empty tree.
    pub(crate) fn new(
        settings: &'f Settings<'s>,
        tree: Tree,
        driven: BTreeSet<&'s str>,
        base: BaseChoice,
        faults: &'f mut Faults,
    ) -> Self {
        let (notes, snapped) = (MassNotes::default(), Vec::new());
        let geoms = BTreeMap::new();
        Self { settings, faults, tree, driven, base, notes, snapped, geoms, unnamed: 0 }
    }

    /// What is in a body, through frames and included files.
    pub(crate) fn contents(&mut self, body: Element<'s>, scope: Scope<'s>) -> Contents<'s> {
        let (inertial, joints) = (None, Vec::new());
        let mut found = Contents { inertial, joints, geoms: Vec::new(), bodies: Vec::new() };
        self.collect(body, scope, &mut found);
        found
    }

    fn collect(&mut self, element: Element<'s>, scope: Scope<'s>, found: &mut Contents<'s>) {
        for child in self.settings.children(element) {
            match child.name() {
                "inertial" => found.inertial = found.inertial.or(Some(child)),
                "joint" | "freejoint" => found.joints.push((child, scope.clone())),
                "geom" => found.geoms.push((child, scope.clone())),
                "body" => found.bodies.push((child, scope.clone())),
                "frame" => {
                    let attributes = self.settings.with_class(child, scope.class, self.faults);
                    let owner = "a frame";
                    let place =
                        pose(&attributes, self.settings, owner, &mut self.snapped, self.faults);
                    let class = child.get("childclass").map(|class| class.text);
                    self.collect(child, scope.inside(class, &place), found);
                }
                "include" => {
                    let said = "this file is not included";
                    let hint = "files are included from the folder of the first one, and below it";
                    self.faults.push(child.at(), Cause::with_hint(said, hint));
                }
                name if MAKERS.contains(&name) => {
                    let said = format!("<{name}> is not read");
                    let hint = "save the file by MuJoCo itself, which writes out what it makes";
                    self.faults.push(child.at(), Cause::with_hint(said, hint));
                }
                _ => {}
            }
        }
    }

    /// Adds a body and all that it carries.
    pub(crate) fn push(&mut self, element: Element<'s>, parent: Option<usize>, scope: &Scope<'s>) {
        if self.tree.links.len() >= MAX_LINKS {
            if self.tree.links.len() == MAX_LINKS {
                let said = format!("the robot has more than {MAX_LINKS} links");
                self.faults.push(element.at(), Cause::new(said));
            }
            return;
        }
        let name = match element.get("name") {
            Some(name) => name.text.to_owned(),
            None => {
                self.unnamed += 1;
                format!("body{}", self.unnamed)
            }
        };
        let class = element.get("childclass").map(|class| class.text).or(scope.class);
        let contents = self.contents(element, Scope::of(class));
        let attributes = self.settings.with_class(element, None, self.faults);
        let place = pose(&attributes, self.settings, &name, &mut self.snapped, self.faults);
        if attributes.nonzero("gravcomp", self.faults).is_some() {
            let said = format!("body `{}` has gravcomp, which a model has not", clip(&name));
            self.faults.push(element.at(), Cause::new(said));
        }
        let inertial = contents.inertial;
        let body =
            mass_of(&name, inertial, &contents.geoms, self.settings, &mut self.notes, self.faults);
        let mut before = [&scope.way[..], &[place]].concat();
        let freedoms = match parent {
            // what floats has its joint generated
            None => Vec::new(),
            Some(_) => self.freedoms(&name, &contents, &mut before),
        };
        let mut parent = parent;
        let count = freedoms.len();
        for (place, freedom) in freedoms.into_iter().enumerate() {
            let is_last = place + 1 == count;
            before.extend(freedom.before);
            self.tree.links.push(TreeLink {
                name: is_last.then(|| name.clone()),
                parent,
                before: std::mem::take(&mut before),
                joint: Some(freedom.joint),
                after: freedom.after,
                body: body.clone().filter(|_| is_last),
                is_joined: false,
            });
            parent = Some(self.tree.links.len() - 1);
        }
        if count == 0 {
            let link = TreeLink::fixed(&name, parent, before);
            self.tree.links.push(TreeLink { body, ..link });
        }
        let own = self.tree.links.len() - 1;
        let geoms = Geoms { link: own, at: element.at(), all: contents.geoms };
        if self.geoms.insert(name, geoms).is_some()
            && let Some(name) = element.get("name")
        {
            let said = format!("two bodies are called `{}`", clip(name.text));
            self.faults.push(name.at, Cause::new(said));
        }
        for (child, scope) in contents.bodies {
            self.push(child, Some(own), &scope);
        }
    }

    /// The joints of a body, each with the poses around it.
    fn freedoms(
        &mut self,
        body: &str,
        contents: &Contents<'s>,
        before: &mut Vec<Pose>,
    ) -> Vec<Freedom> {
        let mut found = Vec::new();
        for (place, (element, scope)) in contents.joints.iter().enumerate() {
            if !scope.way.is_empty() {
                let said = format!("a joint of body `{}` stands in a <frame>", clip(body));
                self.faults.push(element.at(), Cause::with_hint(said, "move it out of the frame"));
            }
            let name = match element.get("name") {
                Some(name) => name.text.to_owned(),
                None if contents.joints.len() == 1 => format!("{body}_joint"),
                None => format!("{body}_joint{}", place + 1),
            };
            let attributes = self.settings.with_class(*element, scope.class, self.faults);
            let is_free = element.name() == "freejoint"
                || attributes.get("type").is_some_and(|kind| kind.text == "free");
            if is_free {
                if self.base == BaseChoice::Fixed {
                    self.tree.notes.push(format!("body {} does not move freely", clip(body)));
                    continue;
                }
                // its position is that in the world, whatever place the body has
                before.clear();
            }
            let is_driven = self.driven.contains(name.as_str());
            let made = joint(&name, &attributes, is_free, is_driven, self.settings, self.faults);
            if made.iter().any(|freedom| freedom.is_snapped) {
                self.snapped.push(name);
            }
            found.extend(made);
        }
        found
    }
}
