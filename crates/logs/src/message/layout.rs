//! What is taken from a message, in the order of its bytes: groups have no bytes of their own, so
//! that a message is a list.

use super::definition::{Definition, Field, Kind, Number};

/// What to do with the next part of a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// The seconds of its time.
    Seconds(Number),
    /// The rest of its time \[ns\].
    Nanoseconds(Number),
    /// The names of joints.
    Names,
    /// A number of a signal.
    One(Number, usize),
    /// Numbers of a signal of joints, one for each.
    Each(Number, usize),
    /// Nothing.
    Skip(Kind),
}

/// Where the numbers of a message stand.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Layout {
    pub(super) parts: Vec<Part>,
    /// The paths of signals of the message as a whole.
    pub(crate) ones: Vec<String>,
    /// The paths of signals of its joints.
    pub(crate) eachs: Vec<String>,
    /// Whether it has a time of its own.
    pub(crate) has_stamp: bool,
    /// Whether it names joints.
    pub(crate) has_names: bool,
}

impl Layout {
    pub(crate) fn new(definition: &Definition) -> Self {
        let names = |field: &Field| {
            let is_list = matches!(&field.kind, Kind::Sequence(of) if **of == Kind::Text);
            is_list && ["name", "joint_names"].contains(&field.name.as_str())
        };
        let mut layout = Self::default();
        let names = definition.fields.iter().position(names);
        layout.has_names = names.is_some();
        for (at, field) in definition.fields.iter().enumerate() {
            match &field.kind {
                _ if names == Some(at) => layout.parts.push(Part::Names),
                Kind::Group(fields) if field.name == "header" => layout.header(fields),
                _ => layout.add("", field),
            }
        }
        layout
    }

    /// Whether there is nothing to be taken from it.
    pub(crate) fn is_empty(&self) -> bool {
        self.ones.is_empty() && self.eachs.is_empty()
    }

    fn header(&mut self, fields: &[Field]) {
        for field in fields {
            match (&field.kind, is_time(&field.kind)) {
                (Kind::Group(time), Some(numbers)) if field.name == "stamp" && !self.has_stamp => {
                    debug_assert_eq!(time.len(), 2);
                    self.has_stamp = true;
                    self.parts.push(Part::Seconds(numbers[0]));
                    self.parts.push(Part::Nanoseconds(numbers[1]));
                }
                (kind, _) => self.parts.push(Part::Skip(kind.clone())),
            }
        }
    }

    fn add(&mut self, before: &str, field: &Field) {
        let path = format!("{before}{}", field.name);
        match &field.kind {
            Kind::Number(number) => {
                self.parts.push(Part::One(*number, self.ones.len()));
                self.ones.push(path);
            }
            // when a point of a trajectory is due is no signal
            Kind::Group(fields) if is_time(&field.kind).is_none() && !fields.is_empty() => {
                let before = format!("{path}/");
                fields.iter().for_each(|field| self.add(&before, field));
            }
            Kind::Sequence(of) if self.has_names => match **of {
                Kind::Number(number) => {
                    self.parts.push(Part::Each(number, self.eachs.len()));
                    self.eachs.push(path);
                }
                _ => self.parts.push(Part::Skip(field.kind.clone())),
            },
            kind => self.parts.push(Part::Skip(kind.clone())),
        }
    }
}

/// Numbers of 32 bits, which make no time that overflows.
fn is_short(number: &Number) -> bool {
    matches!(number, Number::I32 | Number::U32)
}

/// The numbers of a time, or a duration.
fn is_time(kind: &Kind) -> Option<[Number; 2]> {
    let Kind::Group(fields) = kind else { return None };
    match &fields[..] {
        [
            Field { name: seconds, kind: Kind::Number(a) },
            Field { name: rest, kind: Kind::Number(b) },
        ] if seconds == "sec" && rest == "nanosec" && [a, b].into_iter().all(is_short) => {
            Some([*a, *b])
        }
        _ => None,
    }
}
