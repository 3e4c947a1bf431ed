//! Reads the values of JSON objects by key, noting every fault of form.

use super::fault::Cause;
use super::file::{Entry, Name, Scalar};
use super::json::{Json, Value};
use super::report::Report;
use crate::expr::text::nearest;
use std::borrow::Cow;

/// The words that may stand in a place, each with its meaning.
pub(crate) struct Word<T: 'static> {
    /// What the word says.
    pub(crate) what: &'static str,
    /// The words.
    pub(crate) known: &'static [&'static str],
    /// Their meanings, in the same order.
    pub(crate) values: &'static [T],
}

impl<T: Copy> Word<T> {
    /// The meaning of a word.
    pub(crate) fn read(&self, json: &Json, report: &mut Report) -> Option<T> {
        let found = text_of(json, report)?;
        match self.known.iter().position(|known| *known == found.text) {
            Some(index) => Some(self.values[index]),
            None => {
                let cause = Cause::UnknownWord {
                    what: self.what,
                    nearest: nearest(&found.text, self.known.iter().copied()),
                    found: found.text.into_owned(),
                    known: self.known,
                };
                report.push(json.start, cause);
                None
            }
        }
    }
}

/// The entries of an object, by key.
pub(crate) struct Fields<'j, 'a> {
    entries: &'j [(Cow<'a, str>, Json<'a>)],
    at: usize,
}

impl<'j, 'a> Fields<'j, 'a> {
    /// The entries of an object that may have the keys `known`; none if it is no object.
    pub(crate) fn of(
        json: &'j Json<'a>,
        known: &'static [&'static str],
        report: &mut Report,
    ) -> Option<Self> {
        let entries = entries_of(json, report)?;
        for (key, value) in entries {
            if !known.contains(&key.as_ref()) {
                let nearest = nearest(key, known.iter().copied());
                let key = key.clone().into_owned();
                report.push(value.start, Cause::UnknownKey { key, nearest, known });
            }
        }
        Some(Self { entries, at: json.start })
    }

    /// Where the object begins.
    pub(crate) fn at(&self) -> usize {
        self.at
    }

    /// The value of a key; of the first, if it is given twice.
    pub(crate) fn get(&self, key: &str) -> Option<&'j Json<'a>> {
        self.entries.iter().find(|(known, _)| known == key).map(|(_, value)| value)
    }

    /// The value of a key that must be there.
    pub(crate) fn require(&self, key: &'static str, report: &mut Report) -> Option<&'j Json<'a>> {
        let value = self.get(key);
        if value.is_none() {
            report.push(self.at, Cause::MissingKey(key));
        }
        value
    }

    /// Checks the format tag.
    pub(crate) fn format(&self, expected: &'static str, report: &mut Report) {
        let Some(json) = self.require("format", report) else { return };
        let Some(tag) = text_of(json, report) else { return };
        if tag.text != expected {
            let found = tag.text.into_owned();
            report.push(json.start, Cause::WrongFormat { found, expected });
        }
    }

    /// A text that must be there.
    pub(crate) fn name(&self, key: &'static str, report: &mut Report) -> Name<'a> {
        self.require(key, report)
            .and_then(|json| text_of(json, report))
            .unwrap_or(Name { text: Cow::Borrowed(""), at: self.at })
    }

    /// A text.
    pub(crate) fn text(&self, key: &str, report: &mut Report) -> Option<Name<'a>> {
        self.get(key).and_then(|json| text_of(json, report))
    }

    /// A text; empty if it is not there.
    pub(crate) fn text_or_empty(&self, key: &str, report: &mut Report) -> String {
        self.text(key, report).map(|text| text.text.into_owned()).unwrap_or_default()
    }

    /// A list of texts.
    pub(crate) fn texts(&self, key: &str, report: &mut Report) -> Vec<String> {
        self.items(key, report, |json, report| Some(text_of(json, report)?.text.into_owned()))
    }

    /// A word.
    pub(crate) fn word<T: Copy>(
        &self,
        key: &str,
        words: &Word<T>,
        report: &mut Report,
    ) -> Option<T> {
        self.get(key).and_then(|json| words.read(json, report))
    }

    /// A word that must be there; the first of the words stands in for a fault.
    pub(crate) fn required_word<T: Copy>(
        &self,
        key: &'static str,
        words: &Word<T>,
        report: &mut Report,
    ) -> T {
        let found = self.require(key, report).and_then(|json| words.read(json, report));
        found.unwrap_or(words.values[0])
    }

    /// A number or expression.
    pub(crate) fn scalar(&self, key: &str, report: &mut Report) -> Option<Scalar<'a>> {
        self.get(key).and_then(|json| Self::scalar_of(json, report))
    }

    /// Three numbers or expressions that must be there.
    pub(crate) fn required_triple(
        &self,
        key: &'static str,
        report: &mut Report,
    ) -> Option<[Scalar<'a>; 3]> {
        self.require(key, report).and_then(|json| Self::tuple_of(json, report))
    }

    /// A parameter.
    pub(crate) fn entry(&self, key: &str, report: &mut Report) -> Option<Entry<'a>> {
        self.get(key).and_then(|json| entry_of(json, report))
    }

    /// A parameter that must be there.
    pub(crate) fn required_entry(
        &self,
        key: &'static str,
        report: &mut Report,
    ) -> Option<Entry<'a>> {
        self.require(key, report).and_then(|json| entry_of(json, report))
    }

    /// The values of a list; those that are at fault are left out.
    pub(crate) fn items<T>(
        &self,
        key: &str,
        report: &mut Report,
        read: impl FnMut(&Json<'a>, &mut Report) -> Option<T>,
    ) -> Vec<T> {
        self.get(key).map_or_else(Vec::new, |json| items_of(json, report, read))
    }

    /// The values of a list that must be there.
    pub(crate) fn required_items<T>(
        &self,
        key: &'static str,
        report: &mut Report,
        read: impl FnMut(&Json<'a>, &mut Report) -> Option<T>,
    ) -> Vec<T> {
        self.require(key, report).map_or_else(Vec::new, |json| items_of(json, report, read))
    }

    /// The entries of an object whose keys are names; those that are at fault are left out.
    pub(crate) fn members<T>(
        &self,
        key: &str,
        report: &mut Report,
        mut read: impl FnMut(Name<'a>, &'j Json<'a>, &mut Report) -> Option<T>,
    ) -> Vec<T> {
        let entries = self.get(key).and_then(|json| entries_of(json, report)).unwrap_or_default();
        entries
            .iter()
            .filter_map(|(key, json)| {
                read(Name { text: key.clone(), at: json.start }, json, report)
            })
            .collect()
    }

    /// Whether a value is a text.
    pub(crate) fn is_text(json: &Json) -> bool {
        matches!(json.value, Value::Text(_))
    }

    /// Whether a value is a number or a text.
    pub(crate) fn is_scalar(json: &Json) -> bool {
        matches!(json.value, Value::Text(_) | Value::Number(_))
    }

    /// A value that should be a number or an expression.
    pub(crate) fn scalar_of(json: &Json<'a>, report: &mut Report) -> Option<Scalar<'a>> {
        let text = match &json.value {
            Value::Number(text) => Cow::Borrowed(*text),
            Value::Text(text) => text.clone(),
            _ => return wrong_kind(json, "a number or an expression", report),
        };
        Some(Scalar { text, at: json.start })
    }

    /// A value that should be a list of N numbers or expressions.
    pub(crate) fn tuple_of<const N: usize>(
        json: &Json<'a>,
        report: &mut Report,
    ) -> Option<[Scalar<'a>; N]> {
        fixed_list(json, report, Self::scalar_of)
    }

    /// A value that should be a list of N parameters.
    pub(crate) fn entries_of<const N: usize>(
        json: &Json<'a>,
        report: &mut Report,
    ) -> Option<[Entry<'a>; N]> {
        fixed_list(json, report, entry_of)
    }
}

fn fixed_list<'a, T, const N: usize>(
    json: &Json<'a>,
    report: &mut Report,
    read: impl FnMut(&Json<'a>, &mut Report) -> Option<T>,
) -> Option<[T; N]> {
    if let Value::List(items) = &json.value
        && items.len() != N
    {
        report.push(json.start, Cause::WrongLength { expected: N, found: items.len() });
        return None;
    }
    items_of(json, report, read).try_into().ok()
}

fn entry_of<'a>(json: &Json<'a>, report: &mut Report) -> Option<Entry<'a>> {
    if Fields::is_scalar(json) {
        let value = Fields::scalar_of(json, report);
        return Some(Entry { value, std: None, known: None, at: json.start });
    }
    if !matches!(json.value, Value::Object(_)) {
        return wrong_kind(json, "a number, an expression or an object", report);
    }
    let fields = Fields::of(json, &["value", "std", "known"], report)?;
    let known = fields.get("known").and_then(|json| match json.value {
        Value::Bool(known) => Some(known),
        _ => wrong_kind(json, "true or false", report),
    });
    Some(Entry {
        value: fields.scalar("value", report),
        std: fields.scalar("std", report),
        known,
        at: json.start,
    })
}

fn items_of<'a, T>(
    json: &Json<'a>,
    report: &mut Report,
    mut read: impl FnMut(&Json<'a>, &mut Report) -> Option<T>,
) -> Vec<T> {
    match &json.value {
        Value::List(items) => items.iter().filter_map(|item| read(item, report)).collect(),
        _ => wrong_kind(json, "a list", report).unwrap_or_default(),
    }
}

fn entries_of<'j, 'a>(
    json: &'j Json<'a>,
    report: &mut Report,
) -> Option<&'j [(Cow<'a, str>, Json<'a>)]> {
    match &json.value {
        Value::Object(entries) => Some(entries),
        _ => wrong_kind(json, "an object", report),
    }
}

fn text_of<'a>(json: &Json<'a>, report: &mut Report) -> Option<Name<'a>> {
    match &json.value {
        Value::Text(text) => Some(Name { text: text.clone(), at: json.start }),
        _ => wrong_kind(json, "a string", report),
    }
}

fn wrong_kind<T>(json: &Json, expected: &'static str, report: &mut Report) -> Option<T> {
    report.push(json.start, Cause::WrongKind { expected, found: json.value.kind() });
    None
}

/// Notes every key that an object has twice.
pub fn find_duplicate_keys<C: From<Cause>>(root: &Json, report: &mut Report<C>) {
    let mut waiting = vec![root];
    while let Some(json) = waiting.pop() {
        match &json.value {
            Value::List(items) => waiting.extend(items),
            Value::Object(entries) => {
                let mut seen = std::collections::BTreeSet::new();
                for (key, value) in entries {
                    if !seen.insert(key) {
                        let key = key.clone().into_owned();
                        report.push(value.start, Cause::DuplicateKey(key).into());
                    }
                    waiting.push(value);
                }
            }
            _ => {}
        }
    }
}
