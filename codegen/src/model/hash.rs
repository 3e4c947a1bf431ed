//! A hash of the content of a model file (FNV-1a, 64 bits): the same on every machine, blind to
//! whitespace, to escapes in strings and to how a number is written (`0.5`, `5e-1`).

use super::json::{Json, Value};
use crate::number::parse_decimal;

const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0000_0100_0000_01b3;

/// The hash of a value. The order of keys counts: it is the order of parameters.
pub(super) fn content_hash(root: &Json) -> u64 {
    let mut hash = OFFSET_BASIS;
    let mut feed = |bytes: &[u8]| {
        for &byte in bytes {
            hash = (hash ^ u64::from(byte)).wrapping_mul(PRIME);
        }
    };
    // depth is bounded by the reader, but a stack of our own needs no thought about it
    let mut waiting = vec![root];
    while let Some(json) = waiting.pop() {
        match &json.value {
            Value::Null => feed(b"n"),
            Value::Bool(value) => feed(if *value { b"t" } else { b"f" }),
            Value::Number(text) => {
                feed(b"#");
                match parse_decimal(text) {
                    Ok(number) => feed(number.to_string().as_bytes()),
                    Err(_) => feed(text.as_bytes()),
                }
            }
            Value::Text(text) => feed_text(text, &mut feed),
            Value::List(items) => {
                feed(b"[");
                feed(&(items.len() as u64).to_le_bytes());
                waiting.extend(items.iter().rev());
            }
            Value::Object(entries) => {
                feed(b"{");
                feed(&(entries.len() as u64).to_le_bytes());
                entries.iter().for_each(|(key, _)| feed_text(key, &mut feed));
                waiting.extend(entries.iter().rev().map(|(_, value)| value));
            }
        }
    }
    hash
}

/// Length first, so that neighbours cannot flow into each other.
fn feed_text(text: &str, feed: &mut impl FnMut(&[u8])) {
    feed(b"\"");
    feed(&(text.len() as u64).to_le_bytes());
    feed(text.as_bytes());
}

#[cfg(test)]
mod tests {
    use super::super::json::parse;
    use super::*;

    fn hash(text: &str) -> u64 {
        content_hash(&parse(text.as_bytes()).expect("JSON"))
    }

    #[test]
    fn only_content_counts() {
        let reference = hash(r#"{"a": [0.5, "x"], "b": null}"#);
        assert_eq!(reference, hash("{\"a\":[5e-1,\n\"\\u0078\"],\"b\":null}"));
        for other in [
            r#"{"a": [0.5, "y"], "b": null}"#,
            r#"{"a": [0.5], "b": "x"}"#,
            r#"{"b": null, "a": [0.5, "x"]}"#,
            r#"{"a": ["0.5", "x"], "b": null}"#,
        ] {
            assert_ne!(reference, hash(other), "{other}");
        }
    }

    #[test]
    fn the_empty_list_hashes_as_published_fnv_does() {
        // FNV-1a of the nine bytes "[" and eight zeros, by the definition of the hash
        let expected = b"[\0\0\0\0\0\0\0\0"
            .iter()
            .fold(OFFSET_BASIS, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME));
        assert_eq!(hash("[]"), expected);
    }
}
