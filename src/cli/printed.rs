//! What the command prints: control characters that a file or a flag brought along are shown, and
//! reach no terminal.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{self, BufWriter, Stderr, StderrLock, Write};

/// A writer of text, or of JSON, that passes everything on but control characters, of which it
/// passes ends of lines and tabs. Others become `\u001b`, which is right within JSON too.
pub(crate) struct Printed<W: Write>(W);

impl<W: Write> Printed<W> {
    pub(crate) fn new(writer: W) -> Self {
        Self(writer)
    }

    /// The writer, with all that was passed on.
    pub(crate) fn into_inner(self) -> W {
        self.0
    }
}

/// Standard error.
pub(crate) fn standard_error() -> Printed<BufWriter<StderrLock<'static>>> {
    Printed::new(BufWriter::new(Stderr::lock(&io::stderr())))
}

/// Text with its control characters shown.
pub(crate) fn shown(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::new();
    for character in text.chars() {
        match is_hidden(character) {
            // writing to a string cannot fail
            true => {
                let _ = write!(shown, "\\u{:04x}", u32::from(character));
            }
            false => shown.push(character),
        }
    }
    Cow::Owned(shown)
}

/// Control characters, and those by which a terminal sets text in another order than it has.
fn is_hidden(character: char) -> bool {
    match character {
        '\n' | '\t' => false,
        '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => true,
        character => character.is_control(),
    }
}

impl<W: Write> Write for Printed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.write_all(bytes).map(|()| bytes.len())
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        for chunk in bytes.utf8_chunks() {
            self.0.write_all(shown(chunk.valid()).as_bytes())?;
            // no text of ours: whoever writes bytes means them
            self.0.write_all(chunk.invalid())?;
        }
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(text: &[u8]) -> Vec<u8> {
        let mut out = Printed::new(Vec::new());
        out.write_all(text).expect("memory");
        out.0
    }

    #[test]
    fn control_characters_are_shown() {
        let text = "a\x1b[31mb\rc\u{9b}d\u{7f}e\u{202e}f".as_bytes();
        assert_eq!(printed(text), br"a\u001b[31mb\u000dc\u009bd\u007fe\u202ef");
    }

    #[test]
    fn all_else_passes_byte_by_byte() {
        for text in ["a\n\tb: 3 °, α µ \u{1f916}\n".as_bytes(), b"\xff\xfe half \xc2", b""] {
            assert_eq!(printed(text), text);
        }
    }

    #[test]
    fn what_is_shown_is_json_within_json() {
        let text = serde_json::to_vec("\u{1b}\u{7f}\u{9b}").expect("JSON");
        let back: String = serde_json::from_slice(&printed(&text)).expect("JSON");
        assert_eq!(back, "\u{1b}\u{7f}\u{9b}");
    }
}
