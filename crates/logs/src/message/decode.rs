//! Numbers out of the bytes of a message (CDR, as ROS 2 writes it).

use super::definition::{Field, Kind, Number};
use super::layout::{Layout, Part};
use byteorder::{BigEndian, ByteOrder, LittleEndian};
use cdr_encoding::CdrDeserializer;
use serde::de::{DeserializeSeed, Deserializer, Error, SeqAccess, Visitor};
use std::fmt;

/// What stood in a message; used again for the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Decoded {
    seconds: f64,
    nanoseconds: f64,
    /// Names of joints, each with [`END`] behind it.
    pub(super) names: String,
    pub(super) joints: usize,
    pub(super) ones: Vec<f64>,
    pub(super) eachs: Vec<Vec<f64>>,
}

/// The end of a name.
pub(super) const END: char = '\u{0}';

impl Decoded {
    /// The time of the message, 0 if it has none \[ns\].
    pub(super) fn stamp_ns(&self) -> i64 {
        // whole numbers of 32 bits each
        self.seconds as i64 * 1_000_000_000 + self.nanoseconds as i64
    }

    fn clear(&mut self, layout: &Layout) {
        (self.seconds, self.nanoseconds, self.joints) = (0.0, 0.0, 0);
        self.names.clear();
        self.ones.resize(layout.ones.len(), f64::NAN);
        self.eachs.resize(layout.eachs.len(), Vec::new());
        self.eachs.iter_mut().for_each(Vec::clear);
    }
}

/// Bytes before a message that say how it is written, and those that may be behind it to fill up.
const HEAD: usize = 4;
const MOST_PADDING: usize = 3;

/// Reads a message. The error is a sentence about it.
pub(crate) fn decode(layout: &Layout, bytes: &[u8], into: &mut Decoded) -> Result<(), String> {
    into.clear(layout);
    let Some((head, body)) = bytes.split_at_checked(HEAD) else {
        return Err(format!("has {} bytes, fewer than any message", bytes.len()));
    };
    let used = match head[..2] {
        [0, 0] => parts::<BigEndian>(layout, body, into),
        [0, 1] => parts::<LittleEndian>(layout, body, into),
        _ => return Err(format!("is written as {:02x}{:02x}, which is not CDR", head[0], head[1])),
    };
    let used = used.map_err(|error| match error {
        cdr_encoding::Error::Eof => "ends before its fields do".to_owned(),
        error => format!("is no CDR of its kind: {error}"),
    })?;
    match body.len().saturating_sub(used) {
        0..=MOST_PADDING => Ok(()),
        more => Err(format!("has {more} bytes behind its fields")),
    }
}

/// The bytes that were used.
fn parts<O: ByteOrder>(
    layout: &Layout,
    body: &[u8],
    into: &mut Decoded,
) -> Result<usize, cdr_encoding::Error> {
    let mut source = CdrDeserializer::<O>::new(body);
    for part in &layout.parts {
        let source = &mut source;
        match part {
            Part::Seconds(number) => into.seconds = number.deserialize(source)?,
            Part::Nanoseconds(number) => into.nanoseconds = number.deserialize(source)?,
            Part::One(number, at) => into.ones[*at] = number.deserialize(source)?,
            Part::Each(number, at) => {
                source.deserialize_seq(Numbers(*number, &mut into.eachs[*at]))?
            }
            Part::Names => {
                into.joints = source.deserialize_seq(Names(&mut into.names))?;
            }
            Part::Skip(kind) => kind.deserialize(source)?,
        }
    }
    Ok(source.bytes_consumed())
}

/// A number of any kind as f64.
struct AsNumber;

impl Visitor<'_> for AsNumber {
    type Value = f64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number")
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<f64, E> {
        Ok(value as f64)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<f64, E> {
        Ok(value as f64)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<f64, E> {
        Ok(value)
    }
}

impl<'de> DeserializeSeed<'de> for Number {
    type Value = f64;

    fn deserialize<D: Deserializer<'de>>(self, source: D) -> Result<f64, D::Error> {
        match self {
            Self::U8 => source.deserialize_u8(AsNumber),
            Self::I8 => source.deserialize_i8(AsNumber),
            Self::U16 => source.deserialize_u16(AsNumber),
            Self::I16 => source.deserialize_i16(AsNumber),
            Self::U32 => source.deserialize_u32(AsNumber),
            Self::I32 => source.deserialize_i32(AsNumber),
            Self::U64 => source.deserialize_u64(AsNumber),
            Self::I64 => source.deserialize_i64(AsNumber),
            Self::F32 => source.deserialize_f32(AsNumber),
            Self::F64 => source.deserialize_f64(AsNumber),
        }
    }
}

/// Numbers, pushed.
struct Numbers<'a>(Number, &'a mut Vec<f64>);

impl<'de> Visitor<'de> for Numbers<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("numbers")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut source: A) -> Result<(), A::Error> {
        while let Some(value) = source.next_element_seed(self.0)? {
            self.1.push(value);
        }
        Ok(())
    }
}

/// Names, put end to end; their number.
struct Names<'a>(&'a mut String);

impl<'de> Visitor<'de> for Names<'_> {
    type Value = usize;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("names")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut source: A) -> Result<usize, A::Error> {
        let mut count = 0;
        while source.next_element_seed(Name(self.0))?.is_some() {
            count += 1;
        }
        Ok(count)
    }
}

struct Name<'a>(&'a mut String);

impl<'de> DeserializeSeed<'de> for Name<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, source: D) -> Result<(), D::Error> {
        source.deserialize_str(self)
    }
}

impl Visitor<'_> for Name<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a name")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<(), E> {
        match text.contains(END) {
            false => self.0.push_str(text),
            true => self.0.push_str(&text.replace(END, "\u{fffd}")),
        }
        self.0.push(END);
        Ok(())
    }
}

/// What is passed over.
impl<'de> DeserializeSeed<'de> for &Kind {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, source: D) -> Result<(), D::Error> {
        match self {
            Kind::Number(number) => number.deserialize(source).map(|_| ()),
            Kind::Text => source.deserialize_str(IgnoredText),
            // a message without fields has one byte
            Kind::Group(fields) if fields.is_empty() => Number::U8.deserialize(source).map(|_| ()),
            Kind::Group(fields) => source.deserialize_tuple(fields.len(), Passed(fields)),
            Kind::Array(of, length) => source.deserialize_tuple(*length, Same(of)),
            Kind::Sequence(of) => match **of {
                // images and the like, at once
                Kind::Number(Number::U8 | Number::I8) => source.deserialize_bytes(IgnoredText),
                _ => source.deserialize_seq(Same(of)),
            },
        }
    }
}

struct IgnoredText;

impl Visitor<'_> for IgnoredText {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("text or bytes")
    }

    fn visit_str<E: Error>(self, _: &str) -> Result<(), E> {
        Ok(())
    }

    fn visit_bytes<E: Error>(self, _: &[u8]) -> Result<(), E> {
        Ok(())
    }
}

struct Passed<'a>(&'a [Field]);

impl<'de> Visitor<'de> for Passed<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("fields")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut source: A) -> Result<(), A::Error> {
        for field in self.0 {
            source.next_element_seed(&field.kind)?;
        }
        Ok(())
    }
}

struct Same<'a>(&'a Kind);

impl<'de> Visitor<'de> for Same<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an array")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut source: A) -> Result<(), A::Error> {
        while source.next_element_seed(self.0)?.is_some() {}
        Ok(())
    }
}
