//! Values of a model into the URDF that it was made of: every other byte stays.

use super::Exported;
use super::values::{BodyNumbers, Numbers, left_out};
use crate::body::{entries, tensor};
use crate::error::Error;
use crate::exact::{decimal, product, transposed, written};
use crate::fault::listed;
use crate::layout::{Layout, layout};
use crate::names::identifier;
use crate::nothing_included;
use crate::options::{BaseChoice, Mimic, Options};
use crate::place::{Turn, is_quarter, matrix};
use crate::tree::{Tree, TreeBody};
use crate::urdf;
use crate::xml::{Element, Source};
use denavit_codegen::model::{Base, LinkId, Report, Robot};
use denavit_codegen::number::Rational;
use num_traits::Zero;
use std::ops::Range;

/// What is written in place of some bytes.
type Edit = (Range<usize>, String);

const ENTRIES: [&str; 6] = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];

/// The description with the values of a model. Masses, centres of mass and inertias of its links,
/// damping and friction of its joints become those of the model where they are others.
pub fn export_into(robot: &Robot, file: &str, description: &[u8]) -> Result<Exported, Error> {
    let source = Source::read(file, description)?;
    let mut faults = Report::default();
    let base = if robot.base == Base::Fixed { BaseChoice::Fixed } else { BaseChoice::Floating };
    let options = Options { base, mimic: Mimic::Free, ..Options::default() };
    let document = source.document();
    let root = document.as_ref().map(|document| source.root(document));
    let Some(root) = root.filter(|root| root.name() == "robot") else {
        return Err(Error::unsaid(format!("{file} is no URDF: values go into a URDF")));
    };
    let Some(tree) = urdf::tree(file, root, &options, &mut nothing_included, &mut faults) else {
        return Err(faults.into_error(file, description, None).into());
    };
    let mut writer = Writer {
        numbers: Numbers::new(robot)?,
        layout: layout(&tree),
        text: std::str::from_utf8(description).unwrap_or_default(),
        edits: Vec::new(),
        missing: Vec::new(),
        joined: Vec::new(),
    };
    for element in root.children() {
        match element.name() {
            "link" => writer.link(element, &tree),
            "joint" => writer.joint(element, &tree),
            _ => {}
        }
    }
    let mut notes: Vec<String> = left_out(robot).into_iter().collect();
    if !writer.missing.is_empty() {
        notes.push(format!("the model has no row for these: {}", listed(&writer.missing)));
    }
    if !writer.joined.is_empty() {
        let said = "these carry masses that are joined with others, and stay as they are";
        notes.push(format!("{said}: {}", listed(&writer.joined)));
    }
    if writer.missing.len() >= tree.links.len() {
        return Err(Error::unsaid(format!("no row is that of a link of {file}")));
    }
    Ok(Exported { text: writer.written(), notes })
}

struct Writer<'s> {
    numbers: Numbers,
    layout: Layout,
    text: &'s str,
    edits: Vec<Edit>,
    missing: Vec<String>,
    joined: Vec<String>,
}

impl Writer<'_> {
    fn find(&self, row: Option<&String>) -> Option<LinkId> {
        row.and_then(|row| self.numbers.robot.find_link(row))
    }

    fn link(&mut self, element: Element<'_>, tree: &Tree) {
        let Some(name) = element.get("name").map(|name| name.text) else { return };
        let Some(at) = tree.links.iter().position(|link| link.name.as_deref() == Some(name)) else {
            return;
        };
        let link = &tree.links[at];
        let (Some(before), Some(inertial)) = (&link.body, element.first("inertial")) else {
            return;
        };
        let row = self.layout.rows.iter().find(|row| row.body_of == Some(at));
        let row = row.map(|row| row.name.clone());
        if row.is_none() {
            return; // what the robot stands on has no row
        }
        // a joint that was locked has no row: the link has one of its own name then
        let locked = identifier(name);
        let place = self.find(row.as_ref()).or_else(|| self.find(Some(&locked)));
        let Some(found) = place.and_then(|row| self.numbers.body(row)) else {
            self.missing.push(name.to_owned());
            return;
        };
        if link.is_joined {
            self.joined.push(name.to_owned());
            return;
        }
        self.body(inertial, before, &found);
    }

    fn body(&mut self, inertial: Element<'_>, before: &TreeBody, found: &BodyNumbers) {
        if found.mass != before.mass {
            self.number(inertial.first("mass"), "value", &found.mass);
        }
        let origin = inertial.first("origin");
        if found.com != before.com {
            let text = found.com.each_ref().map(written).join(" ");
            match (origin, origin.and_then(|origin| origin.get("xyz"))) {
                (_, Some(xyz)) => self.edits.push((xyz.at..xyz.at + xyz.length, text)),
                (Some(origin), None) => self.attribute(origin, "xyz", &text),
                (None, None) => self.child(inertial, &format!("<origin xyz=\"{text}\"/>")),
            }
        }
        if found.inertia == before.inertia {
            return;
        }
        let turns = urdf::turns_of(origin);
        let inertia = back(&found.inertia, &turns);
        let tensor = inertial.first("inertia");
        for (key, value) in ENTRIES.into_iter().zip(&inertia) {
            let is_there = tensor.is_some_and(|tensor| tensor.get(key).is_some());
            if is_there || !value.is_zero() {
                self.number(tensor, key, value);
            }
        }
    }

    fn joint(&mut self, element: Element<'_>, tree: &Tree) {
        let Some(name) = element.get("name").map(|name| name.text) else { return };
        let is_own = |link: &crate::tree::TreeLink| {
            link.joint.as_ref().is_some_and(|joint| joint.name == name)
        };
        let Some(at) = tree.links.iter().position(is_own) else { return };
        let Some(row) = self.find(self.layout.joints[at].as_ref()) else {
            self.missing.push(name.to_owned());
            return;
        };
        let [viscous, coulomb] = self.numbers.friction(row);
        let dynamics = element.first("dynamics");
        let mut lacking = String::new();
        for (key, value) in [("damping", viscous), ("friction", coulomb)] {
            let given = dynamics.and_then(|dynamics| dynamics.get(key));
            let known = given.and_then(|given| decimal(given.text.trim())).unwrap_or_default();
            if known == value {
                continue;
            }
            match dynamics {
                Some(_) => self.number(dynamics, key, &value),
                None => lacking.push_str(&format!(" {key}=\"{}\"", written(&value))),
            }
        }
        if !lacking.is_empty() {
            self.child(element, &format!("<dynamics{lacking}/>"));
        }
    }

    /// A number in an attribute, which is added where it is not there.
    fn number(&mut self, element: Option<Element<'_>>, key: &str, value: &Rational) {
        let Some(element) = element else { return };
        let text = written(value);
        match element.get(key) {
            Some(known) => self.edits.push((known.at..known.at + known.length, text)),
            None => self.attribute(element, key, &text),
        }
    }

    /// A new attribute behind the name of an element.
    fn attribute(&mut self, element: Element<'_>, key: &str, text: &str) {
        let range = element.range();
        let inside = self.text.get(range.clone()).unwrap_or_default();
        let ends = |c: char| c.is_whitespace() || matches!(c, '>' | '/');
        let Some(after) = inside.find(ends) else { return };
        let at = range.start + after;
        self.edits.push((at..at, format!(" {key}=\"{text}\"")));
    }

    /// A new element in one that has others, before its end.
    fn child(&mut self, element: Element<'_>, text: &str) {
        let range = element.range();
        let inside = self.text.get(range.clone()).unwrap_or_default();
        let Some(before) = inside.rfind("</") else { return };
        let at = range.start + before;
        self.edits.push((at..at, text.to_owned()));
    }

    fn written(mut self) -> String {
        self.edits.sort_by_key(|(range, _)| (range.start, range.end));
        let (mut written, mut at) = (String::with_capacity(self.text.len()), 0);
        for (range, text) in &self.edits {
            written.push_str(self.text.get(at..range.start).unwrap_or_default());
            written.push_str(text);
            at = range.end;
        }
        written.push_str(self.text.get(at..).unwrap_or_default());
        written
    }
}

/// `R^T I R`: the tensor in the axes of the file's inertial frame.
fn back(inertia: &[Rational; 6], turns: &[Turn]) -> [Rational; 6] {
    if turns.is_empty() {
        return inertia.clone();
    }
    let turn = matrix(turns);
    let turned = entries(&product(&product(&transposed(&turn), &tensor(inertia)), &turn));
    if is_quarter(turns) { turned } else { turned.each_ref().map(crate::exact::rounded) }
}
