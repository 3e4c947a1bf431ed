//! Reads JSON values by key, noting every fault with its pointer.

use super::fault::Cause;
use super::place::escaped;
use denavit_codegen::expr::text::nearest;
use denavit_codegen::model::MAX_FAULTS;
use serde_json::{Map, Value};

/// The faults found so far, by pointer.
#[derive(Debug, Default)]
pub(super) struct Report {
    pub(super) faults: Vec<(String, Cause)>,
    /// How many more were found than are kept.
    pub(super) omitted: usize,
}

impl Report {
    /// How many faults there are.
    pub(super) fn count(&self) -> usize {
        self.faults.len() + self.omitted
    }

    pub(super) fn push(&mut self, pointer: &str, cause: Cause) {
        // garbage has millions
        match self.faults.len() < MAX_FAULTS {
            true => self.faults.push((pointer.to_owned(), cause)),
            false => self.omitted += 1,
        }
    }
}

/// A value with its pointer.
#[derive(Clone, Debug)]
pub(super) struct Node<'v> {
    pub(super) value: &'v Value,
    pub(super) pointer: String,
}

/// An object with its pointer; its keys have been checked.
#[derive(Clone, Debug)]
pub(super) struct Fields<'v> {
    map: &'v Map<String, Value>,
    pub(super) pointer: String,
}

impl<'v> Node<'v> {
    /// The value as an object that may have the keys `known`.
    pub(super) fn fields(
        &self,
        known: &'static [&'static str],
        report: &mut Report,
    ) -> Option<Fields<'v>> {
        let fields = self.members(report)?;
        for (key, _) in fields.map {
            if !known.contains(&key.as_str()) {
                let nearest = nearest(key, known.iter().copied());
                let cause = Cause::UnknownKey(key.clone(), nearest, known);
                report.push(&format!("{}/{}", self.pointer, escaped(key)), cause);
            }
        }
        Some(fields)
    }

    /// The value as an object with any keys.
    pub(super) fn members(&self, report: &mut Report) -> Option<Fields<'v>> {
        match self.value.as_object() {
            Some(map) => Some(Fields { map, pointer: self.pointer.clone() }),
            None => {
                report.push(&self.pointer, Cause::WrongKind("an object"));
                None
            }
        }
    }

    pub(super) fn number(&self, report: &mut Report) -> Option<f64> {
        let number = self.value.as_f64().filter(|number| number.is_finite());
        if number.is_none() {
            report.push(&self.pointer, Cause::WrongKind("a number"));
        }
        number
    }

    pub(super) fn items(&self, report: &mut Report) -> Vec<Node<'v>> {
        let Some(list) = self.value.as_array() else {
            report.push(&self.pointer, Cause::WrongKind("a list"));
            return Vec::new();
        };
        let node = |(index, value)| Node { value, pointer: format!("{}/{index}", self.pointer) };
        list.iter().enumerate().map(node).collect()
    }

    pub(super) fn numbers(&self, report: &mut Report) -> Vec<f64> {
        self.items(report).iter().filter_map(|item| item.number(report)).collect()
    }

    pub(super) fn text(&self, report: &mut Report) -> Option<&'v str> {
        let text = self.value.as_str();
        if text.is_none() {
            report.push(&self.pointer, Cause::WrongKind("a string"));
        }
        text
    }

    /// One of some words, each with its meaning.
    pub(super) fn word<T: Copy>(
        &self,
        words: &'static [&'static str],
        meanings: &[T],
        report: &mut Report,
    ) -> Option<T> {
        let text = self.text(report)?;
        let index = words.iter().position(|word| *word == text);
        if index.is_none() {
            report.push(&self.pointer, Cause::UnknownWord(text.to_owned(), words));
        }
        index.map(|index| meanings[index])
    }
}

impl<'v> Fields<'v> {
    pub(super) fn get(&self, key: &str) -> Option<Node<'v>> {
        let value = self.map.get(key)?;
        Some(Node { value, pointer: format!("{}/{}", self.pointer, escaped(key)) })
    }

    pub(super) fn require(&self, key: &'static str, report: &mut Report) -> Option<Node<'v>> {
        let node = self.get(key);
        if node.is_none() {
            report.push(&self.pointer, Cause::MissingKey(key));
        }
        node
    }

    /// All entries, by key in alphabetical order.
    pub(super) fn all(&self) -> impl Iterator<Item = (&'v str, Node<'v>)> + '_ {
        self.map.iter().map(|(key, value)| {
            let pointer = format!("{}/{}", self.pointer, escaped(key));
            (key.as_str(), Node { value, pointer })
        })
    }

    pub(super) fn number(&self, key: &str, absent: f64, report: &mut Report) -> f64 {
        self.get(key).and_then(|node| node.number(report)).unwrap_or(absent)
    }

    pub(super) fn positive(&self, key: &str, absent: f64, report: &mut Report) -> f64 {
        let number = self.number(key, absent, report);
        if number > 0.0 {
            return number;
        }
        report.push(&format!("{}/{key}", self.pointer), Cause::NotPositive);
        absent
    }

    pub(super) fn not_negative(&self, key: &str, absent: f64, report: &mut Report) -> f64 {
        let number = self.number(key, absent, report);
        if number >= 0.0 {
            return number;
        }
        report.push(&format!("{}/{key}", self.pointer), Cause::Negative);
        absent
    }

    /// A number from 0 to 1.
    pub(super) fn share(&self, key: &str, absent: f64, report: &mut Report) -> f64 {
        let number = self.not_negative(key, absent, report);
        if number > 1.0 {
            report.push(&format!("{}/{key}", self.pointer), Cause::AboveOne);
        }
        number
    }

    /// A list of so many numbers.
    pub(super) fn array<const N: usize>(
        &self,
        key: &str,
        absent: [f64; N],
        report: &mut Report,
    ) -> [f64; N] {
        let Some(node) = self.get(key) else { return absent };
        let before = report.count();
        let found = <[f64; N]>::try_from(node.numbers(report));
        found.unwrap_or_else(|found| {
            // a list with a wrong entry has been reported already
            if report.count() == before {
                report.push(&node.pointer, Cause::WrongLength(N, found.len()));
            }
            absent
        })
    }

    pub(super) fn count(&self, key: &str, absent: usize, report: &mut Report) -> usize {
        let Some(node) = self.get(key) else { return absent };
        let count = node.value.as_u64().and_then(|count| usize::try_from(count).ok());
        if count.is_none() {
            report.push(&node.pointer, Cause::WrongKind("a whole number that is not negative"));
        }
        count.unwrap_or(absent)
    }

    pub(super) fn flag(&self, key: &str, report: &mut Report) -> bool {
        let Some(node) = self.get(key) else { return false };
        let flag = node.value.as_bool();
        if flag.is_none() {
            report.push(&node.pointer, Cause::WrongKind("true or false"));
        }
        flag.unwrap_or(false)
    }

    pub(super) fn numbers(&self, key: &'static str, report: &mut Report) -> Vec<f64> {
        self.require(key, report).map_or_else(Vec::new, |node| node.numbers(report))
    }
}
