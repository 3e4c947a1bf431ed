//! XML with places: elements and attributes know where they stand in the file.
//!
//! roxmltree reads it: without a document type, so that nothing is expanded, and within bounds of
//! size, depth and number. Prefixes that nobody declared, as `xacro` leaves them, are declared
//! here, and places are those of the file as it is.

use crate::fault::{Cause, Faults, ImportError, clip};
use denavit_codegen::model::Report;
use roxmltree::{Attribute, Document, Error, Node, ParsingOptions};
use std::borrow::Cow;
use std::ops::Range;

/// Largest file that is read, in bytes.
const MAX_BYTES: usize = 16 << 20;
/// Most elements, attributes and texts.
const MAX_NODES: u32 = 500_000;
/// Deepest nesting of elements.
const MAX_DEPTH: usize = 200;
/// Most prefixes that are declared for a file.
const MAX_PREFIXES: usize = 16;

/// The text of a file, with declarations that it lacks.
pub(crate) struct Source<'a> {
    text: Cow<'a, str>,
    added: Added,
}

/// Declarations that a text has and its file lacks.
#[derive(Clone, Copy, Debug, Default)]
struct Added {
    /// Where they stand.
    at: usize,
    /// How long they are.
    length: usize,
}

/// An element of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Element<'s> {
    node: Node<'s, 's>,
    added: Added,
    /// Where another file is included that it is part of.
    within: Option<usize>,
}

/// A value of an attribute, with its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Text<'s> {
    pub(crate) text: &'s str,
    pub(crate) at: usize,
    /// How many bytes of the file it takes.
    pub(crate) length: usize,
}

impl<'a> Source<'a> {
    /// The text of a file, if it is XML within bounds.
    pub(crate) fn read(file: &str, bytes: &'a [u8]) -> Result<Self, ImportError> {
        let refuse = |at: usize, cause: Cause| {
            let mut report: Faults = Report::default();
            report.push(at, cause);
            report.into_error(file, bytes, None)
        };
        if bytes.len() > MAX_BYTES {
            let said = format!(
                "the file has {} bytes, more than the {MAX_BYTES} that are read",
                bytes.len()
            );
            return Err(refuse(
                0,
                Cause::with_hint(said, "such files have some hundred kilobytes"),
            ));
        }
        let text = std::str::from_utf8(bytes).map_err(|error| {
            let cause = Cause::with_hint("the file is not UTF-8 text", "save the file as UTF-8");
            refuse(error.valid_up_to(), cause)
        })?;
        let mut source = Self { text: Cow::Borrowed(text), added: Added::default() };
        for _ in 0..=MAX_PREFIXES {
            let error = match source.parse() {
                Ok(document) => {
                    let depth = deepest(&document);
                    if depth > MAX_DEPTH {
                        let said = format!("elements are nested more than {MAX_DEPTH} levels deep");
                        return Err(refuse(0, Cause::new(said)));
                    }
                    return Ok(source);
                }
                Err(error) => error,
            };
            let declared = match &error {
                Error::UnknownNamespace(prefix, _) => source.declared(prefix),
                _ => None,
            };
            match declared {
                Some(next) => source = next,
                None => {
                    let place = offset(&source.text, &error);
                    return Err(refuse(source_place(place, source.added), syntax(&error)));
                }
            }
        }
        Err(refuse(0, Cause::new(format!("more than {MAX_PREFIXES} prefixes are not declared"))))
    }

    fn parse(&self) -> Result<Document<'_>, Error> {
        let options = ParsingOptions { nodes_limit: MAX_NODES, ..ParsingOptions::default() };
        Document::parse_with_options(&self.text, options)
    }

    /// The document; that of [`Source::read`] was read before.
    pub(crate) fn document(&self) -> Option<Document<'_>> {
        self.parse().ok()
    }

    /// The text with a prefix declared in its first element.
    fn declared(&self, prefix: &str) -> Option<Self> {
        let at = match self.added {
            Added { at: 0, length: 0 } => after_first_name(&self.text)?,
            Added { at, .. } => at,
        };
        let declaration = format!(" xmlns:{prefix}=\"{prefix}\"");
        let mut text = self.text.clone().into_owned();
        text.insert_str(at, &declaration);
        let length = self.added.length + declaration.len();
        Some(Self { text: Cow::Owned(text), added: Added { at, length } })
    }

    /// The first element of the document.
    pub(crate) fn root<'s>(&self, document: &'s Document<'s>) -> Element<'s> {
        Element { node: document.root_element(), added: self.added, within: None }
    }

    /// The first element of a document that is included at a place of another one.
    pub(crate) fn included<'s>(&self, document: &'s Document<'s>, at: usize) -> Element<'s> {
        Element { within: Some(at), ..self.root(document) }
    }
}

/// A place of the file, of one in the text with what was added.
fn source_place(at: usize, added: Added) -> usize {
    if at >= added.at + added.length { at - added.length } else { at.min(added.at) }
}

/// Where the name of the first element ends.
fn after_first_name(text: &str) -> Option<usize> {
    let mut from = 0;
    loop {
        let start = from + text.get(from..)?.find('<')?;
        let rest = text.get(start..)?;
        let skipped = if rest.starts_with("<!--") {
            rest.find("-->")?
        } else if rest.starts_with("<?") || rest.starts_with("<!") {
            rest.find('>')?
        } else {
            let ends = |c: char| c.is_whitespace() || matches!(c, '>' | '/');
            return Some(start + rest.find(ends)?);
        };
        from = start + skipped + 1;
    }
}

fn deepest(document: &Document<'_>) -> usize {
    let (mut depth, mut most) = (0_usize, 0_usize);
    let mut at = Some(document.root());
    // children first, then what comes after, then back up
    while let Some(node) = at {
        if let Some(child) = node.first_child() {
            depth += 1;
            most = most.max(depth);
            at = Some(child);
            continue;
        }
        let mut here = node;
        at = loop {
            if let Some(next) = here.next_sibling() {
                break Some(next);
            }
            match here.parent() {
                None => break None,
                Some(parent) => {
                    depth = depth.saturating_sub(1);
                    here = parent;
                }
            }
        };
    }
    most
}

/// The byte of an error's line and column.
fn offset(text: &str, error: &Error) -> usize {
    let place = error.pos();
    let (row, column) = (place.row.max(1) as usize, place.col.max(1) as usize);
    let before: usize = text.split_inclusive('\n').take(row - 1).map(str::len).sum();
    let line = text.get(before..).unwrap_or_default();
    let inside = line.char_indices().nth(column - 1).map_or(0, |(at, _)| at);
    before + inside
}

fn syntax(error: &Error) -> Cause {
    match error {
        Error::DtdDetected => Cause::with_hint(
            "the file has a document type, which is not read",
            "remove `<!DOCTYPE ..>`: entities are not expanded",
        ),
        Error::NodesLimitReached => {
            Cause::new(format!("the file has more than {MAX_NODES} elements"))
        }
        other => {
            let said = other.to_string();
            let said = said.split(" at ").next().unwrap_or_default();
            Cause::new(format!("not XML: {}", clip(said)))
        }
    }
}

impl<'s> Element<'s> {
    /// Its name, without prefix.
    pub(crate) fn name(&self) -> &'s str {
        self.node.tag_name().name()
    }

    /// The prefix of its name, as it was declared.
    pub(crate) fn space(&self) -> Option<&'s str> {
        self.node.tag_name().namespace()
    }

    /// Where it begins in the file.
    pub(crate) fn at(&self) -> usize {
        self.within.unwrap_or_else(|| source_place(self.node.range().start, self.added))
    }

    /// The bytes of the file that it takes.
    pub(crate) fn range(&self) -> Range<usize> {
        let range = self.node.range();
        source_place(range.start, self.added)..source_place(range.end, self.added)
    }

    /// The elements in it.
    pub(crate) fn children(&self) -> impl Iterator<Item = Element<'s>> + use<'s> {
        let element = *self;
        let elements = self.node.children().filter(Node::is_element);
        elements.map(move |node| Element { node, ..element })
    }

    /// The elements of a name in it.
    pub(crate) fn all(&self, name: &'static str) -> impl Iterator<Item = Element<'s>> + use<'s> {
        self.children().filter(move |child| child.name() == name)
    }

    /// The first element of a name in it.
    pub(crate) fn first(&self, name: &'static str) -> Option<Element<'s>> {
        self.all(name).next()
    }

    /// All elements below it, and itself.
    pub(crate) fn everything(&self) -> impl Iterator<Item = Element<'s>> + use<'s> {
        let element = *self;
        let elements = self.node.descendants().filter(Node::is_element);
        elements.map(move |node| Element { node, ..element })
    }

    /// An attribute's value, with its place.
    pub(crate) fn get(&self, name: &str) -> Option<Text<'s>> {
        self.node.attribute_node(name).map(|attribute| self.text_of(&attribute))
    }

    /// The text in it.
    pub(crate) fn content(&self) -> &'s str {
        self.node.text().unwrap_or_default().trim()
    }

    /// All attributes: their names and values.
    pub(crate) fn attributes(&self) -> impl Iterator<Item = (&'s str, Text<'s>)> + use<'s> {
        let element = *self;
        self.node.attributes().map(move |attribute| (attribute.name(), element.text_of(&attribute)))
    }

    fn text_of(&self, attribute: &Attribute<'s, 's>) -> Text<'s> {
        let at = source_place(attribute.range_value().start, self.added);
        let at = self.within.unwrap_or(at);
        let length = attribute.range_value().len();
        Text { text: attribute.value(), at, length }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        Source::read("r.xml", text.as_bytes()).err().expect("a refusal").to_string()
    }

    #[test]
    fn prefixes_that_nobody_declared_are_no_fault_and_places_stay() {
        let text =
            "<?xml version=\"1.0\"?>\n<robot name=\"r\">\n <x:a y=\"1\"/><b c=\"2\"/></robot>";
        let source = Source::read("r.urdf", text.as_bytes()).expect("XML");
        let document = source.document().expect("XML");
        let root = source.root(&document);
        let value = root.first("b").and_then(|b| b.get("c")).expect("the value");
        assert_eq!(&text[value.at..value.at + 1], "2");
        assert_eq!(root.first("a").and_then(|a| a.space()), Some("x"));
    }

    #[test]
    fn nothing_is_expanded_and_bounds_hold() {
        let bomb = "<!DOCTYPE r [<!ENTITY a \"b\">]><r>&a;</r>";
        assert!(refused(bomb).contains("document type"), "{}", refused(bomb));
        let deep = format!("{}{}", "<a>".repeat(100_000), "</a>".repeat(100_000));
        assert!(refused(&deep).contains("nested"));
        let wide = format!("<r>{}</r>", "<a/>".repeat(600_000));
        assert!(refused(&wide).contains("more than"));
        assert!(refused("<r>\n <a></r>").starts_with("r.xml:2:"));
        assert!(refused("not").contains("not XML"));
        assert!(Source::read("r.xml", b"<r>\xff</r>").is_err());
    }
}
