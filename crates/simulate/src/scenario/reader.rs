//! Numbers in ranges, by the compiler's reader of JSON documents.

use super::fault::Cause;
use super::ranges::Range;
use denavit_codegen::model::{self, Fields, Node, Word};

/// The faults found so far.
pub type Report = model::Report<Cause>;

/// What a value says as floating-point numbers and words.
pub trait NodeNumbers: Sized {
    /// The value, if it is a number, however large.
    fn any_number(self) -> Option<f64>;

    /// The value, if it is a finite number.
    fn finite(self, report: &mut Report) -> Option<f64>;

    /// A number of this range.
    fn number_in(self, range: Range, report: &mut Report) -> Option<f64>;

    /// The numbers of a list.
    fn numbers(self, report: &mut Report) -> Vec<f64>;

    /// One of some words, each with its meaning.
    fn choice<T: Copy>(
        self,
        known: &'static [&'static str],
        meanings: &[T],
        report: &mut Report,
    ) -> Option<T>;
}

impl NodeNumbers for Node<'_> {
    fn any_number(self) -> Option<f64> {
        self.number_text()?.parse().ok()
    }

    fn finite(self, report: &mut Report) -> Option<f64> {
        self.number(|text| text.parse().ok().filter(|number: &f64| number.is_finite()), report)
    }

    fn number_in(self, range: Range, report: &mut Report) -> Option<f64> {
        let number = self.finite(report)?;
        if !range.contains(number) {
            report.push(self.at(), Cause::OutsideRange(number, range));
            return None;
        }
        Some(number)
    }

    fn numbers(self, report: &mut Report) -> Vec<f64> {
        self.items(report).into_iter().filter_map(|item| item.finite(report)).collect()
    }

    fn choice<T: Copy>(
        self,
        known: &'static [&'static str],
        meanings: &[T],
        report: &mut Report,
    ) -> Option<T> {
        self.word(&Word { what: "word", known, values: meanings }, report)
    }
}

/// What the keys of an object say as numbers.
pub trait FieldsNumbers {
    /// A number of this range; `absent` stands in for it, and for a fault.
    fn number(&self, key: &str, range: Range, absent: f64, report: &mut Report) -> f64;

    /// A number of this range that must be there; the largest stands in for a fault.
    fn required_number(&self, key: &'static str, range: Range, report: &mut Report) -> f64;

    /// A list of so many numbers of this range.
    fn array<const N: usize>(
        &self,
        key: &str,
        range: Range,
        absent: [f64; N],
        report: &mut Report,
    ) -> [f64; N];

    /// A whole number of this range.
    fn count(&self, key: &str, range: Range, absent: usize, report: &mut Report) -> usize;

    /// The numbers of a list that must be there.
    fn numbers(&self, key: &'static str, report: &mut Report) -> Vec<f64>;
}

impl FieldsNumbers for Fields<'_> {
    fn number(&self, key: &str, range: Range, absent: f64, report: &mut Report) -> f64 {
        self.get(key).and_then(|node| node.number_in(range, report)).unwrap_or(absent)
    }

    fn required_number(&self, key: &'static str, range: Range, report: &mut Report) -> f64 {
        let node = self.require(key, report);
        node.and_then(|node| node.number_in(range, report)).unwrap_or(range.most)
    }

    fn array<const N: usize>(
        &self,
        key: &str,
        range: Range,
        absent: [f64; N],
        report: &mut Report,
    ) -> [f64; N] {
        let items = self.get(key).and_then(|node| node.array::<N, _>(report));
        let mut values = absent;
        for (value, item) in values.iter_mut().zip(items.into_iter().flatten()) {
            *value = item.number_in(range, report).unwrap_or(*value);
        }
        values
    }

    fn count(&self, key: &str, range: Range, absent: usize, report: &mut Report) -> usize {
        let node = self.get(key).filter(|node| node.number_in(range, report).is_some());
        node.and_then(|node| node.count(report)).unwrap_or(absent)
    }

    fn numbers(&self, key: &'static str, report: &mut Report) -> Vec<f64> {
        self.require(key, report).map_or_else(Vec::new, |node| node.numbers(report))
    }
}

/// Notes a tag that is missing or of another format.
pub fn check_format(fields: &Fields<'_>, expected: &'static str, report: &mut Report) {
    match fields.get("format") {
        Some(node) => node.tag(expected, report),
        None => report.push(fields.at(), Cause::NoFormat(expected)),
    }
}
