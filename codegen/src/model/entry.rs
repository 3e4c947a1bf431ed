//! What stands in files of models, effects and equations beside plain JSON: names, expressions,
//! and parameters with what is said of them.

use super::fault::Cause;
use super::json::Value;
use super::reader::{Fields, Node};
use super::report::Report;
use std::borrow::Cow;

/// A text with its place.
#[derive(Clone, Debug)]
pub(crate) struct Name<'v> {
    pub(crate) text: Cow<'v, str>,
    pub(crate) at: usize,
}

/// A number or an expression, with its place.
#[derive(Clone, Debug)]
pub(crate) struct Scalar<'v> {
    pub(crate) text: Cow<'v, str>,
    pub(crate) at: usize,
}

/// A parameter: its value and what the file says about it.
#[derive(Clone, Debug)]
pub(crate) struct Entry<'v> {
    pub(crate) value: Option<Scalar<'v>>,
    pub(crate) std: Option<Scalar<'v>>,
    pub(crate) known: Option<bool>,
    pub(crate) at: usize,
}

impl<'v> Name<'v> {
    /// The key of a value, which stands where the value does.
    pub(crate) fn of_key(key: &'v str, node: Node<'v>) -> Self {
        Self { text: Cow::Borrowed(key), at: node.at() }
    }
}

impl<'v> Node<'v> {
    fn name(self, report: &mut Report) -> Option<Name<'v>> {
        let text = self.text(report)?;
        Some(Name { text: Cow::Borrowed(text), at: self.at() })
    }

    /// Whether it is a number or a text.
    pub(crate) fn is_scalar(self) -> bool {
        matches!(self.0.value, Value::Text(_) | Value::Number(_))
    }

    /// A number or an expression.
    pub(crate) fn scalar(self, report: &mut Report) -> Option<Scalar<'v>> {
        let text = match &self.0.value {
            Value::Number(text) => text,
            Value::Text(text) => text.as_ref(),
            _ => return self.wrong_kind("a number or an expression", report),
        };
        Some(Scalar { text: Cow::Borrowed(text), at: self.at() })
    }

    /// A list of N numbers or expressions.
    pub(crate) fn scalars<const N: usize>(self, report: &mut Report) -> Option<[Scalar<'v>; N]> {
        all_of(self.array(report)?, |node| node.scalar(report))
    }

    /// A list of N parameters.
    pub(crate) fn entries<const N: usize>(self, report: &mut Report) -> Option<[Entry<'v>; N]> {
        all_of(self.array(report)?, |node| node.entry(report))
    }

    /// A parameter.
    pub(crate) fn entry(self, report: &mut Report) -> Option<Entry<'v>> {
        if self.is_scalar() {
            let value = self.scalar(report);
            return Some(Entry { value, std: None, known: None, at: self.at() });
        }
        if !self.is_object() {
            return self.wrong_kind("a number, an expression or an object", report);
        }
        let fields = self.fields(&["value", "std", "known"], report)?;
        let known = fields.get("known").and_then(|node| node.flag(report));
        Some(Entry {
            value: fields.scalar("value", report),
            std: fields.scalar("std", report),
            known,
            at: self.at(),
        })
    }
}

/// All values of a list; each is read, so that the faults of all are noted.
fn all_of<'v, T, const N: usize>(
    nodes: [Node<'v>; N],
    read: impl FnMut(Node<'v>) -> Option<T>,
) -> Option<[T; N]> {
    let values: Vec<T> = nodes.into_iter().filter_map(read).collect();
    values.try_into().ok()
}

impl<'v> Fields<'v> {
    /// A text that must be there.
    pub(crate) fn required_name(&self, key: &'static str, report: &mut Report) -> Name<'v> {
        self.require(key, report)
            .and_then(|node| node.name(report))
            .unwrap_or(Name { text: Cow::Borrowed(""), at: self.at() })
    }

    /// A text.
    pub(crate) fn name(&self, key: &str, report: &mut Report) -> Option<Name<'v>> {
        self.get(key).and_then(|node| node.name(report))
    }

    /// A number or expression.
    pub(crate) fn scalar(&self, key: &str, report: &mut Report) -> Option<Scalar<'v>> {
        self.get(key).and_then(|node| node.scalar(report))
    }

    /// Three numbers or expressions that must be there.
    pub(crate) fn required_triple(
        &self,
        key: &'static str,
        report: &mut Report<Cause>,
    ) -> Option<[Scalar<'v>; 3]> {
        self.require(key, report).and_then(|node| node.scalars(report))
    }

    /// A parameter.
    pub(crate) fn entry(&self, key: &str, report: &mut Report) -> Option<Entry<'v>> {
        self.get(key).and_then(|node| node.entry(report))
    }

    /// A parameter that must be there.
    pub(crate) fn required_entry(
        &self,
        key: &'static str,
        report: &mut Report,
    ) -> Option<Entry<'v>> {
        self.require(key, report).and_then(|node| node.entry(report))
    }
}
