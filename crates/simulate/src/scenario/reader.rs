//! Reads JSON values by key, noting every fault with its place.

use super::fault::Cause;
use super::ranges::Range;
use denavit_codegen::expr::text::nearest;
use denavit_codegen::model;
use denavit_codegen::model::json::{Json, Value};
use std::borrow::Cow;

/// The faults found so far.
pub type Report = model::Report<Cause>;

/// A value.
#[derive(Clone, Copy, Debug)]
pub struct Node<'v>(pub &'v Json<'v>);

/// An object; its keys have been checked.
#[derive(Clone, Copy, Debug)]
pub struct Fields<'v> {
    entries: &'v [(Cow<'v, str>, Json<'v>)],
    /// Where it begins.
    pub at: usize,
}

impl<'v> Node<'v> {
    /// Where the value begins.
    pub fn at(self) -> usize {
        self.0.start
    }

    /// The value as an object that may have the keys `known`.
    pub fn fields(self, known: &'static [&'static str], report: &mut Report) -> Option<Fields<'v>> {
        let fields = self.members(report)?;
        for (key, value) in fields.entries {
            if !known.contains(&key.as_ref()) {
                let nearest = nearest(key, known.iter().copied());
                let key = key.clone().into_owned();
                let cause = model::Cause::UnknownKey { key, nearest, known };
                report.push(value.start, Cause::Form(cause));
            }
        }
        Some(fields)
    }

    /// The value as an object with any keys.
    pub fn members(self, report: &mut Report) -> Option<Fields<'v>> {
        match &self.0.value {
            Value::Object(entries) => Some(Fields { entries, at: self.at() }),
            _ => self.wrong_kind("an object", report),
        }
    }

    /// Notes that something else should stand here.
    pub fn wrong_kind<T>(self, expected: &'static str, report: &mut Report) -> Option<T> {
        let cause = model::Cause::WrongKind { expected, found: self.0.value.kind() };
        report.push(self.at(), Cause::Form(cause));
        None
    }

    /// The value, if it is a number, however large.
    pub fn as_number(self) -> Option<f64> {
        match self.0.value {
            Value::Number(text) => text.parse().ok(),
            _ => None,
        }
    }

    /// The value, if it is a finite number.
    pub fn number(self, report: &mut Report) -> Option<f64> {
        let Some(number) = self.as_number() else {
            return self.wrong_kind("a number", report);
        };
        if let (false, Value::Number(text)) = (number.is_finite(), &self.0.value) {
            report.push(self.at(), Cause::Form(model::Cause::NotFinite((*text).to_owned())));
            return None;
        }
        Some(number)
    }

    /// A number of this range.
    pub fn number_in(self, range: Range, report: &mut Report) -> Option<f64> {
        let number = self.number(report)?;
        if !range.contains(number) {
            report.push(self.at(), Cause::OutsideRange(number, range));
            return None;
        }
        Some(number)
    }

    /// The values of a list.
    pub fn items(self, report: &mut Report) -> Vec<Node<'v>> {
        match &self.0.value {
            Value::List(items) => items.iter().map(Node).collect(),
            _ => self.wrong_kind("a list", report).unwrap_or_default(),
        }
    }

    /// The numbers of a list.
    pub fn numbers(self, report: &mut Report) -> Vec<f64> {
        self.items(report).into_iter().filter_map(|item| item.number(report)).collect()
    }

    /// The value, if it is a string.
    pub fn text(self, report: &mut Report) -> Option<&'v str> {
        match &self.0.value {
            Value::Text(text) => Some(text),
            _ => self.wrong_kind("a string", report),
        }
    }

    /// One of some words, each with its meaning.
    pub fn word<T: Copy>(
        self,
        known: &'static [&'static str],
        meanings: &[T],
        report: &mut Report,
    ) -> Option<T> {
        let text = self.text(report)?;
        let index = known.iter().position(|word| *word == text);
        if index.is_none() {
            let nearest = nearest(text, known.iter().copied());
            let found = text.to_owned();
            let cause = model::Cause::UnknownWord { what: "word", found, known, nearest };
            report.push(self.at(), Cause::Form(cause));
        }
        index.map(|index| meanings[index])
    }
}

impl<'v> Fields<'v> {
    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<Node<'v>> {
        let found = self.entries.iter().find(|(known, _)| known == key);
        found.map(|(_, value)| Node(value))
    }

    /// Where the value of a key begins, or the object without it.
    pub fn place(&self, key: &str) -> usize {
        self.get(key).map_or(self.at, Node::at)
    }

    /// The value of a key that must be there.
    pub fn require(&self, key: &'static str, report: &mut Report) -> Option<Node<'v>> {
        let node = self.get(key);
        if node.is_none() {
            report.push(self.at, Cause::Form(model::Cause::MissingKey(key)));
        }
        node
    }

    /// All entries, in the order of the file.
    pub fn all(&self) -> impl Iterator<Item = (&'v str, Node<'v>)> + use<'v> {
        self.entries.iter().map(|(key, value)| (key.as_ref(), Node(value)))
    }

    /// A number of this range; `absent` stands in for it, and for a fault.
    pub fn number(&self, key: &str, range: Range, absent: f64, report: &mut Report) -> f64 {
        self.get(key).and_then(|node| node.number_in(range, report)).unwrap_or(absent)
    }

    /// A number of this range that must be there; the largest stands in for a fault.
    pub fn required_number(&self, key: &'static str, range: Range, report: &mut Report) -> f64 {
        let node = self.require(key, report);
        node.and_then(|node| node.number_in(range, report)).unwrap_or(range.most)
    }

    /// A list of so many numbers of this range.
    pub fn array<const N: usize>(
        &self,
        key: &str,
        range: Range,
        absent: [f64; N],
        report: &mut Report,
    ) -> [f64; N] {
        let Some(node) = self.get(key) else { return absent };
        let items = node.items(report);
        if items.len() != N {
            // what is no list has been reported already
            if matches!(node.0.value, Value::List(_)) {
                report.push(node.at(), Cause::wrong_length(N, items.len()));
            }
            return absent;
        }
        let mut values = absent;
        for (value, item) in values.iter_mut().zip(items) {
            *value = item.number_in(range, report).unwrap_or(*value);
        }
        values
    }

    /// A whole number of this range.
    pub fn count(&self, key: &str, range: Range, absent: usize, report: &mut Report) -> usize {
        let Some(node) = self.get(key) else { return absent };
        let Some(number) = node.number_in(range, report) else { return absent };
        let text = match node.0.value {
            Value::Number(text) => text,
            _ => "",
        };
        // a whole number may be written with an exponent
        let whole = (number.fract() == 0.0 && number < 9e15).then_some(number as usize);
        let count = text.parse().ok().or(whole);
        count.or_else(|| node.wrong_kind("a whole number", report)).unwrap_or(absent)
    }

    /// Whether the value of a key is `true`; absent is `false`.
    pub fn flag(&self, key: &str, report: &mut Report) -> bool {
        let Some(node) = self.get(key) else { return false };
        match node.0.value {
            Value::Bool(flag) => flag,
            _ => node.wrong_kind("true or false", report).unwrap_or_default(),
        }
    }

    /// The numbers of a list that must be there.
    pub fn numbers(&self, key: &'static str, report: &mut Report) -> Vec<f64> {
        self.require(key, report).map_or_else(Vec::new, |node| node.numbers(report))
    }
}
