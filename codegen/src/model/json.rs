//! JSON with places: every value knows where it stands in the source text.
//!
//! serde_json does the grammar; this tree adds what it drops: duplicate keys, the order of keys,
//! the text of numbers, and the offset of every value. Size, depth and number of values are
//! bounded, so that no input makes the reader slow or large.

use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::value::RawValue;
use std::borrow::Cow;
use std::fmt;

/// Largest file that is read, in bytes.
pub const MAX_BYTES: usize = 16 << 20;
/// Deepest nesting that is read; a model needs seven levels.
pub const MAX_DEPTH: usize = 32;
/// Most values that are read; a model of a hundred links has some five thousand.
pub const MAX_VALUES: usize = 200_000;

/// A value with its place.
#[derive(Clone, Debug)]
pub struct Json<'a> {
    /// What it is.
    pub value: Value<'a>,
    /// Byte offset of its first character in the file.
    pub start: usize,
    /// Byte offset after its last character.
    pub end: usize,
}

/// What a value is. Strings are unescaped, numbers are their text.
#[derive(Clone, Debug)]
pub enum Value<'a> {
    /// `null`.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// As it is written.
    Number(&'a str),
    /// Unescaped.
    Text(Cow<'a, str>),
    /// In file order.
    List(Vec<Json<'a>>),
    /// In file order; a repeated key is listed as often as it is written.
    Object(Vec<(Cow<'a, str>, Json<'a>)>),
}

impl<'a> Json<'a> {
    /// Byte offset of the value that this path of keys leads to, or as far as it leads.
    pub fn offset<'k>(&self, path: impl IntoIterator<Item = &'k str>) -> usize {
        let mut value = self;
        for part in path {
            match value.get(part) {
                Some(entry) => value = entry,
                None => break,
            }
        }
        value.start
    }

    /// The value of a key; none of what is no object, or has no such key.
    pub fn get(&self, key: &str) -> Option<&Self> {
        self.entries().iter().find(|(own, _)| own == key).map(|(_, value)| value)
    }

    /// The values of a list; nothing of what is none.
    pub fn items(&self) -> &[Self] {
        if let Value::List(items) = &self.value { items } else { &[] }
    }

    /// The keys of an object's entries with the offsets of their values.
    pub fn entries(&self) -> &[(Cow<'a, str>, Json<'a>)] {
        match &self.value {
            Value::Object(entries) => entries,
            _ => &[],
        }
    }
}

impl Value<'_> {
    /// The kind of value, with its article, for messages.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Null => "null",
            Self::Bool(_) => "a truth value",
            Self::Number(_) => "a number",
            Self::Text(_) => "a string",
            Self::List(_) => "a list",
            Self::Object(_) => "an object",
        }
    }
}

/// Why a text is not read as JSON, with the byte offset where reading stopped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JsonError {
    /// Byte offset.
    pub at: usize,
    /// Why.
    pub cause: JsonCause,
}

/// Why a text is not read as JSON.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum JsonCause {
    /// More than [`MAX_BYTES`]; holds the size in bytes.
    TooLarge(usize),
    /// Not UTF-8.
    NotUtf8,
    /// A byte order mark at its beginning.
    ByteOrderMark,
    /// Nested deeper than [`MAX_DEPTH`].
    TooDeep,
    /// More than [`MAX_VALUES`].
    TooManyValues,
    /// What serde_json says, without its position.
    Syntax(String),
}

/// Reads a whole file.
pub fn parse(bytes: &[u8]) -> Result<Json<'_>, JsonError> {
    if bytes.len() > MAX_BYTES {
        return Err(JsonError { at: 0, cause: JsonCause::TooLarge(bytes.len()) });
    }
    let text = std::str::from_utf8(bytes)
        .map_err(|error| JsonError { at: error.valid_up_to(), cause: JsonCause::NotUtf8 })?;
    if text.starts_with('\u{feff}') {
        return Err(JsonError { at: 0, cause: JsonCause::ByteOrderMark });
    }
    let mut reader = Reader { source: text, values: 0 };
    let raw: &RawValue = serde_json::from_str(text).map_err(|error| reader.syntax(text, &error))?;
    reader.value(raw, 0)
}

struct Reader<'a> {
    source: &'a str,
    values: usize,
}

impl<'a> Reader<'a> {
    fn value(&mut self, raw: &'a RawValue, depth: usize) -> Result<Json<'a>, JsonError> {
        let text = raw.get();
        let start = self.offset(text);
        self.values += 1;
        let refuse = |cause| Err(JsonError { at: start, cause });
        if self.values > MAX_VALUES {
            return refuse(JsonCause::TooManyValues);
        }
        if depth > MAX_DEPTH {
            return refuse(JsonCause::TooDeep);
        }
        let value = match text.as_bytes().first() {
            Some(b'{') => self.object(text, depth)?,
            Some(b'[') => self.list(text, depth)?,
            Some(b'"') => Value::Text(self.read::<Text<'a>>(text)?.0),
            Some(b't') => Value::Bool(true),
            Some(b'f') => Value::Bool(false),
            Some(b'n') => Value::Null,
            _ => Value::Number(text),
        };
        Ok(Json { value, start, end: start + text.len() })
    }

    fn list(&mut self, text: &'a str, depth: usize) -> Result<Value<'a>, JsonError> {
        let items = self.read::<Items<'a>>(text)?.0;
        let values: Result<_, _> =
            items.into_iter().map(|raw| self.value(raw, depth + 1)).collect();
        Ok(Value::List(values?))
    }

    fn object(&mut self, text: &'a str, depth: usize) -> Result<Value<'a>, JsonError> {
        let entries = self.read::<Entries<'a>>(text)?.0;
        let values: Result<_, _> = entries
            .into_iter()
            .map(|(key, raw)| Ok((key.0, self.value(raw, depth + 1)?)))
            .collect();
        Ok(Value::Object(values?))
    }

    fn read<T: Deserialize<'a>>(&self, text: &'a str) -> Result<T, JsonError> {
        serde_json::from_str(text).map_err(|error| self.syntax(text, &error))
    }

    /// Turns serde_json's line and column inside `text` into an offset of the file.
    fn syntax(&self, text: &'a str, error: &serde_json::Error) -> JsonError {
        let line_start: usize =
            text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum();
        let inside = (line_start + error.column().saturating_sub(1)).min(text.len());
        let at = self.offset(text) + inside;
        let said = error.to_string();
        let message = said.split(" at line ").next().unwrap_or(&said).to_owned();
        if message == TOO_MANY {
            return JsonError { at, cause: JsonCause::TooManyValues };
        }
        JsonError { at, cause: JsonCause::Syntax(message) }
    }

    /// Where a slice of the source begins.
    fn offset(&self, text: &str) -> usize {
        text.as_ptr() as usize - self.source.as_ptr() as usize
    }
}

const TOO_MANY: &str = "too many values";

struct Text<'a>(Cow<'a, str>);

impl<'de> Deserialize<'de> for Text<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TextVisitor;
        impl<'de> Visitor<'de> for TextVisitor {
            type Value = Text<'de>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a string")
            }
            fn visit_borrowed_str<E>(self, text: &'de str) -> Result<Text<'de>, E> {
                Ok(Text(Cow::Borrowed(text)))
            }
            fn visit_str<E>(self, text: &str) -> Result<Text<'de>, E> {
                Ok(Text(Cow::Owned(text.to_owned())))
            }
        }
        deserializer.deserialize_str(TextVisitor)
    }
}

struct Items<'a>(Vec<&'a RawValue>);

impl<'de> Deserialize<'de> for Items<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ItemsVisitor;
        impl<'de> Visitor<'de> for ItemsVisitor {
            type Value = Items<'de>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a list")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Items<'de>, A::Error> {
                let mut items = Vec::new();
                while let Some(item) = list.next_element()? {
                    if items.len() == MAX_VALUES {
                        return Err(serde::de::Error::custom(TOO_MANY));
                    }
                    items.push(item);
                }
                Ok(Items(items))
            }
        }
        deserializer.deserialize_seq(ItemsVisitor)
    }
}

struct Entries<'a>(Vec<(Text<'a>, &'a RawValue)>);

impl<'de> Deserialize<'de> for Entries<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct EntriesVisitor;
        impl<'de> Visitor<'de> for EntriesVisitor {
            type Value = Entries<'de>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "an object")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries<'de>, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    if entries.len() == MAX_VALUES {
                        return Err(serde::de::Error::custom(TOO_MANY));
                    }
                    entries.push(entry);
                }
                Ok(Entries(entries))
            }
        }
        deserializer.deserialize_map(EntriesVisitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cause(text: &str) -> (usize, JsonCause) {
        let error = parse(text.as_bytes()).expect_err("a broken text");
        (error.at, error.cause)
    }

    #[test]
    fn values_know_their_place_and_keep_their_text() {
        let source = "{\"a\": [1.50, \"\\u00e4\"],\n \"a\": null}";
        let json = parse(source.as_bytes()).expect("valid");
        let Value::Object(entries) = &json.value else { panic!("an object") };
        assert_eq!(entries.len(), 2, "both keys are kept");
        let Value::List(items) = &entries[0].1.value else { panic!("a list") };
        assert_eq!(&source[items[0].start..items[0].end], "1.50");
        assert!(matches!(&items[0].value, Value::Number("1.50")));
        assert!(matches!(&items[1].value, Value::Text(text) if text == "ä"));
        assert!(matches!(entries[1].1.value, Value::Null));
    }

    #[test]
    fn syntax_faults_are_placed() {
        let (at, cause_found) = cause("{\n \"a\": 1,,}");
        assert_eq!(at, 10);
        assert!(matches!(cause_found, JsonCause::Syntax(_)));
        let (at, _) = cause("{\n \"a\": {\"b\": \"\\ud800\"}}");
        assert!((14..=22).contains(&at), "inside the string, not at {at}");
    }

    #[test]
    fn bounds_hold() {
        let deep = format!("{}{}", "[".repeat(1_000_000), "]".repeat(1_000_000));
        assert_eq!(cause(&deep), (MAX_DEPTH + 1, JsonCause::TooDeep));
        let wide = format!("[{}0]", "0,".repeat(MAX_VALUES + 1));
        assert_eq!(cause(&wide).1, JsonCause::TooManyValues);
        let large = " ".repeat(MAX_BYTES + 1);
        assert_eq!(cause(&large).1, JsonCause::TooLarge(MAX_BYTES + 1));
        assert_eq!(parse(b"{\"a\": \"\xff\"}").expect_err("no UTF-8").at, 7);
        assert_eq!(cause("\u{feff}{}").1, JsonCause::ByteOrderMark);
    }
}
