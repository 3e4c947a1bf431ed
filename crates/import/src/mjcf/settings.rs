//! What holds for a whole file: settings of the compiler, gravity, default classes, included files.

use crate::exact::Vector;
use crate::fault::{Cause, Faults, clip};
use crate::urdf::{number, numbers, wrong};
use crate::xml::{Element, Text};
use denavit_codegen::number::{Rational, integer, ratio};
use num_traits::Zero;
use std::collections::BTreeMap;

/// Attributes of elements that a class gives where an element has none: by element and attribute.
type Class<'s> = BTreeMap<(&'s str, &'s str), Text<'s>>;

/// Where the mass of a body comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FromGeoms {
    /// From its geoms, if it says nothing itself.
    Auto,
    Always,
    Never,
}

/// The settings.
pub(crate) struct Settings<'s> {
    pub(crate) degrees: bool,
    pub(crate) euler: String,
    pub(crate) autolimits: bool,
    pub(crate) from_geoms: FromGeoms,
    pub(crate) groups: [i64; 2],
    pub(crate) balances: bool,
    pub(crate) bounds: [Rational; 2],
    pub(crate) total: Option<Rational>,
    pub(crate) gravity: Vector,
    /// Forces of a fluid that the file has and a model has not.
    pub(crate) fluid: Vec<String>,
    /// Meshes that geoms may have.
    pub(crate) meshes: Vec<Element<'s>>,
    folder: MeshFolder,
    classes: BTreeMap<&'s str, Class<'s>>,
    included: BTreeMap<String, Element<'s>>,
}

/// Where files of meshes are.
#[derive(Default)]
struct MeshFolder {
    of_meshes: Option<String>,
    of_assets: String,
    is_stripped: bool,
}

/// The class of what names none.
const MAIN: &str = "main";

impl<'s> Settings<'s> {
    /// Reads the settings of a file; `included` are the files that it includes.
    pub(crate) fn read(
        root: Element<'s>,
        included: BTreeMap<String, Element<'s>>,
        faults: &mut Faults,
    ) -> Self {
        let zero = || integer(0);
        let mut settings = Self {
            degrees: true,
            euler: "xyz".to_owned(),
            autolimits: true,
            from_geoms: FromGeoms::Auto,
            groups: [0, 5],
            balances: false,
            bounds: [zero(), zero()],
            total: None,
            gravity: [zero(), zero(), ratio(-981, 100)],
            fluid: Vec::new(),
            meshes: Vec::new(),
            folder: MeshFolder::default(),
            classes: BTreeMap::from([(MAIN, Class::new())]),
            included,
        };
        for element in settings.children(root) {
            match element.name() {
                "compiler" => settings.compiler(element, faults),
                "option" => settings.option(element, faults),
                "default" => settings.class(element, None, 0, faults),
                "asset" => {
                    let meshes = settings.children(element).into_iter();
                    settings.meshes.extend(meshes.filter(|asset| asset.name() == "mesh"));
                }
                _ => {}
            }
        }
        settings
    }

    /// The elements in an element, with those of included files in place.
    pub(crate) fn children(&self, element: Element<'s>) -> Vec<Element<'s>> {
        let mut found = Vec::new();
        self.collect(element, &mut found);
        found
    }

    fn collect(&self, element: Element<'s>, found: &mut Vec<Element<'s>>) {
        for child in element.children() {
            let file = child.get("file").filter(|_| child.name() == "include");
            match file.and_then(|file| self.included.get(file.text)) {
                // each file is included once: this ends
                Some(&root) => self.collect(root, found),
                None => found.push(child),
            }
        }
    }

    fn compiler(&mut self, element: Element<'s>, faults: &mut Faults) {
        for (key, value) in element.attributes() {
            match (key, value.text) {
                ("angle", "degree") => self.degrees = true,
                ("angle", "radian") => self.degrees = false,
                ("coordinate", "local") => {}
                ("coordinate", _) => {
                    let said = "coordinates are global, which is not read";
                    faults.push(value.at, Cause::with_hint(said, "save the file by MuJoCo itself"));
                }
                ("meshdir", text) => self.folder.of_meshes = Some(text.to_owned()),
                ("assetdir", text) => self.folder.of_assets = text.to_owned(),
                ("strippath", text) => self.folder.is_stripped = text == "true",
                ("eulerseq", text) if text.len() == 3 && text.chars().all(is_axis) => {
                    self.euler = text.to_owned();
                }
                ("autolimits", text) => self.autolimits = text == "true",
                ("balanceinertia", text) => self.balances = text == "true",
                ("inertiafromgeom", "auto") => self.from_geoms = FromGeoms::Auto,
                ("inertiafromgeom", "true") => self.from_geoms = FromGeoms::Always,
                ("inertiafromgeom", "false") => self.from_geoms = FromGeoms::Never,
                ("angle" | "eulerseq" | "inertiafromgeom", _) => {
                    wrong(value, &format!("`{key}`"), "one of its words", faults);
                }
                ("inertiagrouprange", _) => {
                    if let Some(range) = numbers::<2>(value, "`inertiagrouprange`", faults) {
                        self.groups = range.map(|end| crate::mjcf::whole(&end));
                    }
                }
                ("boundmass", _) => self.bounds[0] = number(value, key, faults).unwrap_or_default(),
                ("boundinertia", _) => {
                    self.bounds[1] = number(value, key, faults).unwrap_or_default();
                }
                ("settotalmass", _) => {
                    let total = number(value, key, faults);
                    self.total = total.filter(|total| *total > integer(0));
                }
                _ => {}
            }
        }
    }

    fn option(&mut self, element: Element<'s>, faults: &mut Faults) {
        if let Some(gravity) = element.get("gravity") {
            self.gravity = numbers(gravity, "`gravity`", faults).unwrap_or(self.gravity.clone());
        }
        let flag = element.first("flag").and_then(|flag| flag.get("gravity"));
        if flag.is_some_and(|flag| flag.text == "disable") {
            self.gravity = std::array::from_fn(|_| integer(0));
        }
        for key in ["density", "viscosity"] {
            let value = element.get(key).and_then(|value| number(value, key, faults));
            if value.is_some_and(|value| !value.is_zero()) {
                self.fluid.push(key.to_owned());
            }
        }
    }

    /// A class and those in it, which have what it has.
    fn class(
        &mut self,
        element: Element<'s>,
        parent: Option<&'s str>,
        depth: usize,
        faults: &mut Faults,
    ) {
        let name = match (element.get("class"), parent) {
            // the name of the first class is its own affair
            (None, None) => MAIN,
            (Some(name), _) => name.text,
            (None, Some(_)) => {
                faults.push(element.at(), Cause::new("<default> has no `class`"));
                return;
            }
        };
        let before = parent.unwrap_or(MAIN);
        let mut class = self.classes.get(before).cloned().unwrap_or_default();
        for child in self.children(element).into_iter().filter(|child| child.name() != "default") {
            class.extend(child.attributes().map(|(key, value)| ((child.name(), key), value)));
        }
        if parent.is_none() {
            self.classes.insert(MAIN, class.clone());
        }
        self.classes.insert(name, class);
        for child in self.children(element).into_iter().filter(|child| child.name() == "default") {
            if depth < 64 {
                self.class(child, Some(name), depth + 1, faults);
            }
        }
    }

    /// The path of a mesh's file, from the folder of the description.
    pub(crate) fn mesh_path(&self, file: &str) -> String {
        let folder = self.folder.of_meshes.as_ref().unwrap_or(&self.folder.of_assets);
        let last = file.rsplit(['/', '\\']).next().unwrap_or(file);
        let file = if self.folder.is_stripped { last } else { file };
        match folder.trim_end_matches('/') {
            "" => file.to_owned(),
            folder => format!("{folder}/{file}"),
        }
    }

    /// The attributes of an element with those of its class.
    pub(crate) fn with_class(
        &self,
        element: Element<'s>,
        inherited: Option<&'s str>,
        faults: &mut Faults,
    ) -> Attributes<'s> {
        let own = element.get("class");
        let name = own.map(|class| class.text).or(inherited).unwrap_or(MAIN);
        let class = self.classes.get(name);
        if let (None, Some(own)) = (class, own) {
            faults.push(own.at, Cause::new(format!("no class is called `{}`", clip(name))));
        }
        let mut values: BTreeMap<&'s str, Text<'s>> = BTreeMap::new();
        for (&(of, key), &value) in class.into_iter().flatten() {
            if of == element.name() {
                values.insert(key, value);
            }
        }
        // one way to say where something points replaces another one
        const TURNS: [&str; 5] = ["quat", "euler", "axisangle", "xyaxes", "zaxis"];
        if element.attributes().any(|(key, _)| TURNS.contains(&key)) {
            values.retain(|key, _| !TURNS.contains(key));
        }
        let of_class = values.get("size").copied();
        values.extend(element.attributes());
        Attributes { values, of_class, at: element.at() }
    }
}

/// Attributes of an element, its class among them.
pub(crate) struct Attributes<'s> {
    values: BTreeMap<&'s str, Text<'s>>,
    /// The size that the class gives: entries that the element does not give are its.
    of_class: Option<Text<'s>>,
    pub(crate) at: usize,
}

impl<'s> Attributes<'s> {
    /// The value of an attribute.
    pub(crate) fn get(&self, key: &str) -> Option<Text<'s>> {
        self.values.get(key).copied()
    }

    /// The words of its size: those of the class stand behind its own.
    pub(crate) fn size(&self) -> Option<(Text<'s>, Vec<&'s str>)> {
        let own = self.get("size")?;
        let mut words: Vec<&str> = own.text.split_whitespace().collect();
        let of_class = self.of_class.into_iter().flat_map(|size| size.text.split_whitespace());
        words.extend(of_class.skip(words.len()));
        Some((own, words))
    }

    /// A number, if it is there and right.
    pub(crate) fn number(&self, key: &str, faults: &mut Faults) -> Option<Rational> {
        self.get(key).and_then(|value| number(value, &format!("`{key}`"), faults))
    }

    /// Some numbers, if they are there and right.
    pub(crate) fn numbers<const N: usize>(
        &self,
        key: &str,
        faults: &mut Faults,
    ) -> Option<[Rational; N]> {
        self.get(key).and_then(|value| numbers(value, &format!("`{key}`"), faults))
    }

    /// A number that is there and not 0.
    pub(crate) fn nonzero(&self, key: &str, faults: &mut Faults) -> Option<Rational> {
        self.number(key, faults).filter(|value| *value != integer(0))
    }
}

fn is_axis(c: char) -> bool {
    matches!(c.to_ascii_lowercase(), 'x' | 'y' | 'z')
}
