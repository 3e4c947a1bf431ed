//! Where values stand in a JSON text that is known to be well formed.

use std::collections::BTreeSet;

/// The byte offset of every value by its pointer, in the order of the text, and the pointers of
/// keys that their object already has.
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    starts: Vec<(String, usize)>,
    pub(super) duplicates: Vec<(String, String)>,
}

impl Places {
    pub(super) fn new(text: &str) -> Self {
        let mut walk = Walk { bytes: text.as_bytes(), at: 0, places: Self::default() };
        walk.value(&mut String::new());
        walk.places
    }

    /// Line and column of the value of a pointer, or of the nearest value around it.
    pub(super) fn find(&self, text: &str, pointer: &str) -> (usize, usize, usize) {
        let mut pointer = pointer;
        let start = loop {
            if let Some((_, start)) = self.starts.iter().find(|(known, _)| known == pointer) {
                break *start;
            }
            match pointer.rfind('/') {
                Some(at) => pointer = &pointer[..at],
                None => break 0,
            }
        };
        let (line, column) = line_and_column(text, start);
        (line, column, start)
    }
}

/// Line and column, from 1, of a byte offset.
pub(super) fn line_and_column(text: &str, at: usize) -> (usize, usize) {
    let before = text.get(..at).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    (line, column)
}

/// A key or an index as a part of a pointer (RFC 6901).
pub(super) fn escaped(key: &str) -> String {
    key.replace('~', "~0").replace('/', "~1")
}

struct Walk<'a> {
    bytes: &'a [u8],
    at: usize,
    places: Places,
}

impl Walk<'_> {
    fn peek(&self) -> u8 {
        self.bytes.get(self.at).copied().unwrap_or(0)
    }

    fn skip_space(&mut self) {
        while self.peek().is_ascii_whitespace() {
            self.at += 1;
        }
    }

    fn value(&mut self, pointer: &mut String) {
        self.skip_space();
        self.places.starts.push((pointer.clone(), self.at));
        match self.peek() {
            b'{' => self.members(pointer, b'}'),
            b'[' => self.members(pointer, b']'),
            b'"' => _ = self.text(),
            _ => {
                while !matches!(self.peek(), b',' | b'}' | b']' | 0)
                    && !self.peek().is_ascii_whitespace()
                {
                    self.at += 1;
                }
            }
        }
    }

    fn members(&mut self, pointer: &mut String, end: u8) {
        self.at += 1;
        let (mut seen, mut count) = (BTreeSet::new(), 0);
        loop {
            self.skip_space();
            match self.peek() {
                0 => return,
                c if c == end => {
                    self.at += 1;
                    return;
                }
                b',' => {
                    self.at += 1;
                    continue;
                }
                _ => {}
            }
            let length = pointer.len();
            let key = if end == b'}' { self.text() } else { count.to_string() };
            count += 1;
            pointer.push('/');
            pointer.push_str(&escaped(&key));
            if end == b'}' && !seen.insert(key.clone()) {
                self.places.duplicates.push((pointer.clone(), key));
            }
            if end == b'}' {
                self.skip_space();
                self.at += 1;
            }
            self.value(pointer);
            pointer.truncate(length);
        }
    }

    fn text(&mut self) -> String {
        let start = self.at;
        self.at += 1;
        while !matches!(self.peek(), b'"' | 0) {
            self.at += if self.peek() == b'\\' { 2 } else { 1 };
        }
        self.at = (self.at + 1).min(self.bytes.len());
        let quoted = String::from_utf8_lossy(&self.bytes[start.min(self.at)..self.at]);
        serde_json::from_str(&quoted).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_found_where_they_stand() {
        let text = "{\n \"a\": [1, {\"b/c\": 2}],\n \"a\": 3}";
        let places = Places::new(text);
        assert_eq!(places.find(text, "/a/1/b~1c").0, 2);
        assert_eq!(places.find(text, "/a/1/b~1c").1, 19);
        assert_eq!(places.find(text, "/a/7").1, 7);
        assert_eq!(places.duplicates, [("/a".to_owned(), "a".to_owned())]);
    }
}
