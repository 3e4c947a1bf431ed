//! Reads JSON documents by key, noting every fault of form with its place: the one reader of all
//! formats.
//!
//! [`read_document`] goes from bytes to what a format makes of them. A [`Node`] is a value with its
//! readings, [`Fields`] is an object whose keys have been checked. A format may have causes C of
//! its own; faults of form are those of [`Cause`], of which a C is made. A reading that finds a
//! fault notes it and answers nothing, so that one answer lists all faults.

use super::fault::{Cause, FileError};
use super::json::{self, Json, JsonError, Value};
use super::report::Report;
use crate::expr::text::nearest;
use crate::number::{Rational, parse_decimal};
use num_traits::ToPrimitive;
use std::borrow::Cow;
use std::collections::BTreeSet;

/// Reads a JSON document from its bytes: what `build` makes of it, if nothing is wrong with it.
/// `file` is its name, for messages alone.
pub fn read_document<C: From<Cause>, T>(
    file: &str,
    source: &[u8],
    build: impl FnOnce(Node<'_>, &mut Report<C>) -> Option<T>,
) -> Result<T, FileError<C>> {
    let mut report = Report::default();
    let root = match json::parse(source) {
        Ok(root) => root,
        Err(JsonError { at, cause }) => {
            report.push(at, Cause::from(cause).into());
            return Err(report.into_error(file, source, None));
        }
    };
    find_duplicate_keys(&root, &mut report);
    match build(Node(&root), &mut report) {
        Some(made) if report.is_empty() => Ok(made),
        _ => Err(report.into_error(file, source, Some(&root))),
    }
}

/// The words that may stand in a place, each with its meaning.
pub struct Word<'w, T> {
    /// What the word says.
    pub what: &'static str,
    /// The words.
    pub known: &'static [&'static str],
    /// Their meanings, in the same order.
    pub values: &'w [T],
}

/// A value.
#[derive(Clone, Copy, Debug)]
pub struct Node<'v>(pub &'v Json<'v>);

/// An object; its keys have been checked.
#[derive(Clone, Copy, Debug)]
pub struct Fields<'v> {
    entries: &'v [(Cow<'v, str>, Json<'v>)],
    at: usize,
}

impl<'v> Node<'v> {
    /// Where the value begins.
    pub fn at(self) -> usize {
        self.0.start
    }

    /// Notes that something else should stand here.
    pub fn wrong_kind<T, C: From<Cause>>(
        self,
        expected: &'static str,
        report: &mut Report<C>,
    ) -> Option<T> {
        let cause = Cause::WrongKind { expected, found: self.0.value.kind() };
        report.push(self.at(), cause.into());
        None
    }

    /// The value as an object that may have the keys `known`.
    pub fn fields<C: From<Cause>>(
        self,
        known: &'static [&'static str],
        report: &mut Report<C>,
    ) -> Option<Fields<'v>> {
        let fields = self.members(report)?;
        for (key, node) in fields.all() {
            if !known.contains(&key) {
                let nearest = nearest(key, known.iter().copied());
                let cause = Cause::UnknownKey { key: key.to_owned(), nearest, known };
                report.push(node.at(), cause.into());
            }
        }
        Some(fields)
    }

    /// The value as an object with any keys.
    pub fn members<C: From<Cause>>(self, report: &mut Report<C>) -> Option<Fields<'v>> {
        match &self.0.value {
            Value::Object(entries) => Some(Fields { entries, at: self.at() }),
            _ => self.wrong_kind("an object", report),
        }
    }

    /// The values of a list; none if it is no list.
    pub fn items<C: From<Cause>>(self, report: &mut Report<C>) -> Vec<Node<'v>> {
        match &self.0.value {
            Value::List(items) => items.iter().map(Node).collect(),
            _ => self.wrong_kind("a list", report).unwrap_or_default(),
        }
    }

    /// The values of a list of N.
    pub fn array<const N: usize, C: From<Cause>>(
        self,
        report: &mut Report<C>,
    ) -> Option<[Node<'v>; N]> {
        let items = self.items(report);
        let found = items.len();
        let array = items.try_into().ok();
        // what is no list has been noted already
        if array.is_none() && matches!(self.0.value, Value::List(_)) {
            report.push(self.at(), Cause::WrongLength { expected: N, found }.into());
        }
        array
    }

    /// A text.
    pub fn text<C: From<Cause>>(self, report: &mut Report<C>) -> Option<&'v str> {
        match &self.0.value {
            Value::Text(text) => Some(text),
            _ => self.wrong_kind("a string", report),
        }
    }

    /// Notes a tag of another format.
    pub fn tag<C: From<Cause>>(self, expected: &'static str, report: &mut Report<C>) {
        if let Some(found) = self.text(report)
            && found != expected
        {
            let cause = Cause::WrongFormat { found: found.to_owned(), expected };
            report.push(self.at(), cause.into());
        }
    }

    /// The meaning of a word.
    pub fn word<T: Copy, C: From<Cause>>(
        self,
        words: &Word<'_, T>,
        report: &mut Report<C>,
    ) -> Option<T> {
        let found = self.text(report)?;
        let place = words.known.iter().position(|known| *known == found);
        if place.is_none() {
            let nearest = nearest(found, words.known.iter().copied());
            let (what, known, found) = (words.what, words.known, found.to_owned());
            report.push(self.at(), Cause::UnknownWord { what, nearest, found, known }.into());
        }
        place.map(|place| words.values[place])
    }

    /// `true` or `false`.
    pub fn flag<C: From<Cause>>(self, report: &mut Report<C>) -> Option<bool> {
        match self.0.value {
            Value::Bool(flag) => Some(flag),
            _ => self.wrong_kind("true or false", report),
        }
    }

    /// The text of a number, however large.
    pub fn number_text(self) -> Option<&'v str> {
        match self.0.value {
            Value::Number(text) => Some(text),
            _ => None,
        }
    }

    /// A number, as `parse` reads its text: nothing if it is not finite there.
    pub fn number<T, C: From<Cause>>(
        self,
        parse: impl FnOnce(&str) -> Option<T>,
        report: &mut Report<C>,
    ) -> Option<T> {
        let Some(text) = self.number_text() else {
            return self.wrong_kind("a number", report);
        };
        let number = parse(text);
        if number.is_none() {
            report.push(self.at(), Cause::NotFinite(text.to_owned()).into());
        }
        number
    }

    /// A whole number that is not negative, perhaps written with an exponent.
    pub fn count<C: From<Cause>>(self, report: &mut Report<C>) -> Option<usize> {
        let Some(text) = self.number_text() else {
            return self.wrong_kind("a number", report);
        };
        let number = parse_decimal(text).ok().filter(Rational::is_integer);
        let count = number.and_then(|number| number.to_usize());
        count.or_else(|| self.wrong_kind("a whole number", report))
    }

    /// Whether it is a text.
    pub fn is_text(self) -> bool {
        matches!(self.0.value, Value::Text(_))
    }

    /// Whether it is an object.
    pub fn is_object(self) -> bool {
        matches!(self.0.value, Value::Object(_))
    }
}

impl<'v> Fields<'v> {
    /// Where the object begins.
    pub fn at(&self) -> usize {
        self.at
    }

    /// The value of a key; of the first, if it is given twice.
    pub fn get(&self, key: &str) -> Option<Node<'v>> {
        let found = self.entries.iter().find(|(known, _)| known == key);
        found.map(|(_, value)| Node(value))
    }

    /// Where the value of a key begins, or the object without it.
    pub fn place(&self, key: &str) -> usize {
        self.get(key).map_or(self.at, Node::at)
    }

    /// All entries, in the order of the file.
    pub fn all(&self) -> impl ExactSizeIterator<Item = (&'v str, Node<'v>)> + use<'v> {
        self.entries.iter().map(|(key, value)| (key.as_ref(), Node(value)))
    }

    /// The value of a key that must be there.
    pub fn require<C: From<Cause>>(
        &self,
        key: &'static str,
        report: &mut Report<C>,
    ) -> Option<Node<'v>> {
        let node = self.get(key);
        if node.is_none() {
            report.push(self.at, Cause::MissingKey(key).into());
        }
        node
    }

    /// Checks the tag of the format, which must be there.
    pub fn format<C: From<Cause>>(&self, expected: &'static str, report: &mut Report<C>) {
        if let Some(node) = self.require("format", report) {
            node.tag(expected, report);
        }
    }

    /// A text.
    pub fn text<C: From<Cause>>(&self, key: &str, report: &mut Report<C>) -> Option<&'v str> {
        self.get(key).and_then(|node| node.text(report))
    }

    /// A text; empty if it is not there.
    pub fn text_or_empty<C: From<Cause>>(&self, key: &str, report: &mut Report<C>) -> String {
        self.text(key, report).unwrap_or_default().to_owned()
    }

    /// A list of texts.
    pub fn texts<C: From<Cause>>(&self, key: &str, report: &mut Report<C>) -> Vec<String> {
        self.items(key, report, |node, report| node.text(report).map(str::to_owned))
    }

    /// A word.
    pub fn word<T: Copy, C: From<Cause>>(
        &self,
        key: &str,
        words: &Word<'_, T>,
        report: &mut Report<C>,
    ) -> Option<T> {
        self.get(key).and_then(|node| node.word(words, report))
    }

    /// A word that must be there; the first of the words stands in for a fault.
    pub fn required_word<T: Copy, C: From<Cause>>(
        &self,
        key: &'static str,
        words: &Word<'_, T>,
        report: &mut Report<C>,
    ) -> T {
        let found = self.require(key, report).and_then(|node| node.word(words, report));
        found.unwrap_or(words.values[0])
    }

    /// `true` or `false`; false if it is not there.
    pub fn flag<C: From<Cause>>(&self, key: &str, report: &mut Report<C>) -> bool {
        self.get(key).and_then(|node| node.flag(report)).unwrap_or_default()
    }

    /// The values of a list; those that are at fault are left out.
    pub fn items<T, C: From<Cause>>(
        &self,
        key: &str,
        report: &mut Report<C>,
        read: impl FnMut(Node<'v>, &mut Report<C>) -> Option<T>,
    ) -> Vec<T> {
        self.get(key).map_or_else(Vec::new, |node| items_of(node, report, read))
    }

    /// The values of a list that must be there.
    pub fn required_items<T, C: From<Cause>>(
        &self,
        key: &'static str,
        report: &mut Report<C>,
        read: impl FnMut(Node<'v>, &mut Report<C>) -> Option<T>,
    ) -> Vec<T> {
        self.require(key, report).map_or_else(Vec::new, |node| items_of(node, report, read))
    }

    /// The entries of an object with any keys; those that are at fault are left out.
    pub fn members<T, C: From<Cause>>(
        &self,
        key: &str,
        report: &mut Report<C>,
        mut read: impl FnMut(&'v str, Node<'v>, &mut Report<C>) -> Option<T>,
    ) -> Vec<T> {
        let members = self.get(key).and_then(|node| node.members(report));
        let entries = members.iter().flat_map(Fields::all);
        entries.filter_map(|(key, node)| read(key, node, report)).collect()
    }
}

fn items_of<'v, T, C: From<Cause>>(
    node: Node<'v>,
    report: &mut Report<C>,
    mut read: impl FnMut(Node<'v>, &mut Report<C>) -> Option<T>,
) -> Vec<T> {
    node.items(report).into_iter().filter_map(|item| read(item, report)).collect()
}

/// Notes every key that an object has twice.
pub fn find_duplicate_keys<C: From<Cause>>(root: &Json, report: &mut Report<C>) {
    let mut waiting = vec![root];
    while let Some(json) = waiting.pop() {
        match &json.value {
            Value::List(items) => waiting.extend(items),
            Value::Object(entries) => {
                let mut seen = BTreeSet::new();
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

#[cfg(test)]
mod tests {
    use super::super::fault::Explained;
    use super::*;
    use std::fmt;

    /// The causes of a format that has ranges of numbers beside the faults of form.
    #[derive(Debug)]
    enum Own {
        Form(Cause),
        TooLarge(f64),
    }

    impl From<Cause> for Own {
        fn from(cause: Cause) -> Self {
            Self::Form(cause)
        }
    }

    impl fmt::Display for Own {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            match self {
                Self::Form(cause) => write!(f, "{cause}"),
                Self::TooLarge(number) => write!(f, "{number} is too large"),
            }
        }
    }

    impl Explained for Own {
        fn hint(&self) -> Option<String> {
            None
        }
    }

    const KEYS: &[&str] = &["format", "rate", "gain", "steps", "is_on", "scheme", "names", "ends"];
    const SCHEMES: Word<'_, u8> =
        Word { what: "scheme", known: &["euler", "heun"], values: &[1, 2] };

    fn finite(text: &str) -> Option<f64> {
        text.parse().ok().filter(|number: &f64| number.is_finite())
    }

    #[derive(Debug, PartialEq)]
    struct Made {
        rate: Option<f64>,
        steps: Option<usize>,
        is_on: bool,
        scheme: Option<u8>,
        names: Vec<String>,
        ends: Option<[f64; 2]>,
    }

    fn read(source: &str) -> Result<Made, String> {
        read_document("own.json", source.as_bytes(), |root, report: &mut Report<Own>| {
            let fields = root.fields(KEYS, report)?;
            fields.format("own/1", report);
            let rate = fields.require("rate", report).and_then(|node| {
                let rate = node.number(finite, report)?;
                if rate > 10.0 {
                    report.push(node.at(), Own::TooLarge(rate));
                }
                Some(rate)
            });
            let ends = fields.get("ends").and_then(|node| node.array(report)).map(|ends| {
                ends.map(|end: Node<'_>| end.number(finite, report).unwrap_or_default())
            });
            Some(Made {
                rate,
                steps: fields.get("steps").and_then(|node| node.count(report)),
                is_on: fields.flag("is_on", report),
                scheme: fields.word("scheme", &SCHEMES, report),
                names: fields.members("names", report, |name, node, report| {
                    node.text(report).map(|text| format!("{name}: {text}"))
                }),
                ends,
            })
        })
        .map_err(|error| error.to_string())
    }

    #[test]
    fn a_format_with_causes_of_its_own_is_read_by_the_same_reader() {
        let source = r#"{"format": "own/1", "rate": 2.5, "steps": 1e3, "is_on": true,
            "scheme": "heun", "names": {"a": "b"}, "ends": [-1, 1]}"#;
        let made = Made {
            rate: Some(2.5),
            steps: Some(1000),
            is_on: true,
            scheme: Some(2),
            names: vec!["a: b".to_owned()],
            ends: Some([-1.0, 1.0]),
        };
        assert_eq!(read(source), Ok(made));
    }

    #[test]
    fn faults_of_form_and_of_the_format_stand_in_one_list() {
        let source = "{\"format\": \"own/2\", \"rate\": 11, \"steps\": 1.5, \"is_on\": 1,\n\
            \"scheme\": \"hein\", \"names\": {\"a\": 1}, \"ends\": [1], \"rat\": 1e999,\n\
            \"rat\": 0}";
        assert_eq!(
            read(source).unwrap_err(),
            "own.json:1:12: /format: the format is `own/2`, not `own/1`\n\
             own.json:1:29: /rate: 11 is too large\n\
             own.json:1:42: /steps: expected a whole number, found a number\n\
             own.json:1:56: /is_on: expected true or false, found a number\n\
             own.json:2:11: /scheme: unknown scheme `hein`\n\
             own.json:2:34: /names/a: expected a string, found a number\n\
             own.json:2:46: /ends: expected 2 values, found 1\n\
             own.json:2:58: /rat: unknown key `rat`\n\
             own.json:3:8: /rat: the key `rat` is given twice\n\
             own.json:3:8: /rat: unknown key `rat`"
        );
        assert_eq!(read("[]").unwrap_err(), "own.json:1:1: expected an object, found a list");
        assert!(read("{").unwrap_err().contains("not JSON: EOF"));
        let huge = read("{\"format\": \"own/1\", \"rate\": 1e999}").unwrap_err();
        assert_eq!(huge, "own.json:1:29: /rate: `1e999` is not a finite number");
    }
}
