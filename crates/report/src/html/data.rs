//! Data of a page as JSON inside an element that no browser runs.

use serde::{Serialize, Serializer};

/// Digits of a value that is drawn: a pixel is a thousandth of a picture.
const DIGITS: usize = 5;
/// Digits of a time: milliseconds after hours.
const TIME_DIGITS: usize = 8;

/// JSON that ends no element and no line, whatever names are in it.
pub(super) fn embedded(data: &impl Serialize) -> String {
    let text = serde_json::to_string(data).expect("numbers, names and lists are JSON");
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            // outside of strings JSON has none of these
            '<' | '>' | '&' | '\u{2028}' | '\u{2029}' => {
                safe += &format!("\\u{:04x}", u32::from(letter));
            }
            _ => safe.push(letter),
        }
    }
    safe
}

/// Bytes as text (RFC 4648, base 64).
pub(crate) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |at: usize| u32::from(three.get(at).copied().unwrap_or(0));
        let all = byte(0) << 16 | byte(1) << 8 | byte(2);
        for place in 0..4 {
            let letter = LETTERS[(all >> (18 - 6 * place) & 63) as usize];
            text.push(if place > three.len() { '=' } else { char::from(letter) });
        }
    }
    text
}

/// A number in few digits; none where it is no number.
fn rounded(value: f64, digits: usize) -> Option<f64> {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    let short: f64 = text.parse().ok()?;
    // -0 would be written as it is
    short.is_finite().then_some(short + 0.0)
}

/// A number in steps of a power of ten; none where it is no number.
pub(crate) fn with_decimals(value: f64, decimals: usize) -> Brief {
    let short: Option<f64> = format!("{value:.decimals$}").parse().ok();
    Brief(short.filter(|short| short.is_finite()).map(|short| short + 0.0))
}

/// A number in the digits of a curve; none where it is no number.
pub(crate) fn with_digits(value: f64) -> Brief {
    Brief(rounded(value, DIGITS))
}

/// Writes a number as short as it is: whole numbers without a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Brief(Option<f64>);

impl Serialize for Brief {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            None => serializer.serialize_none(),
            Some(value) if value.fract() == 0.0 && value.abs() < 1e15 => {
                serializer.serialize_i64(value as i64)
            }
            Some(value) => serializer.serialize_f64(value),
        }
    }
}

/// Values of a curve, in few digits.
pub(super) fn values<S: Serializer>(list: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(list.iter().map(|&value| with_digits(value)))
}

/// What curves are over.
pub(super) fn times<S: Serializer>(list: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(list.iter().map(|&value| Brief(rounded(value, TIME_DIGITS))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_end_neither_element_nor_line() {
        let text = embedded(&["</script><!--", "\u{2028}&"]);
        assert_eq!(text, r#"["\u003c/script\u003e\u003c!--","\u2028\u0026"]"#);
        let back: [String; 2] = serde_json::from_str(&text).expect("JSON");
        assert_eq!(back[0], "</script><!--");
    }

    #[test]
    fn bytes_are_as_the_standard_has_them() {
        let words = ["", "f", "fo", "foo", "foob", "fooba", "foobar"];
        let texts = words.map(|word| base64(word.as_bytes()));
        assert_eq!(texts, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
    }

    #[test]
    fn numbers_are_short() {
        let list = [1.0, -0.0, 0.123_456_789, f64::NAN].map(|value| Brief(rounded(value, 5)));
        assert_eq!(embedded(&list), "[1,0,0.12346,null]");
    }
}
