//! Model files as people write them: an object on one line where it fits.

use std::fmt::Write;

/// Widest line.
const WIDTH: usize = 100;

/// A value.
pub(crate) enum Json {
    /// A number, true or false, as it is written.
    Raw(String),
    Text(String),
    List(Vec<Json>),
    Object(Vec<(&'static str, Json)>),
    /// An object whose keys are names of the model.
    Named(Vec<(String, Json)>),
}

impl Json {
    /// A text.
    pub(crate) fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// A number, or an expression.
    pub(crate) fn scalar(text: String) -> Self {
        if crate::exact::decimal(&text).is_some() { Self::Raw(text) } else { Self::Text(text) }
    }

    /// The value as a file.
    pub(crate) fn file(&self) -> String {
        let mut text = String::new();
        self.write(&mut text, 0, 0);
        text.push('\n');
        text
    }

    fn entries(&self) -> Option<Vec<(Option<&str>, &Json)>> {
        match self {
            Self::Raw(_) | Self::Text(_) => None,
            Self::List(items) => Some(items.iter().map(|item| (None, item)).collect()),
            Self::Object(entries) => {
                Some(entries.iter().map(|(key, value)| (Some(*key), value)).collect())
            }
            Self::Named(entries) => {
                Some(entries.iter().map(|(key, value)| (Some(key.as_str()), value)).collect())
            }
        }
    }

    /// Writes the value, which begins after `before` characters of its line.
    fn write(&self, text: &mut String, indent: usize, before: usize) {
        let Some(entries) = self.entries() else { return self.write_leaf(text) };
        let (open, close) = if matches!(self, Self::List(_)) { ('[', ']') } else { ('{', '}') };
        let line = self.line();
        if entries.is_empty() || (indent > 0 && before + line.len() < WIDTH) {
            text.push_str(&line);
            return;
        }
        text.push(open);
        for (at, (key, value)) in entries.iter().enumerate() {
            text.push_str(if at == 0 { "\n" } else { ",\n" });
            let inner = indent + 2;
            text.extend(std::iter::repeat_n(' ', inner));
            let mut start = inner;
            if let Some(key) = key {
                let name = format!("{}: ", quoted(key));
                start += name.len();
                text.push_str(&name);
            }
            value.write(text, inner, start);
        }
        text.push('\n');
        text.extend(std::iter::repeat_n(' ', indent));
        text.push(close);
    }

    fn write_leaf(&self, text: &mut String) {
        match self {
            Self::Raw(number) => text.push_str(number),
            Self::Text(said) => text.push_str(&quoted(said)),
            _ => {}
        }
    }

    fn line(&self) -> String {
        let mut text = String::new();
        let Some(entries) = self.entries() else {
            self.write_leaf(&mut text);
            return text;
        };
        let (open, close) = if matches!(self, Self::List(_)) { ('[', ']') } else { ('{', '}') };
        text.push(open);
        for (at, (key, value)) in entries.iter().enumerate() {
            if at > 0 {
                text.push_str(", ");
            }
            if let Some(key) = key {
                text.push_str(&format!("{}: ", quoted(key)));
            }
            text.push_str(&value.line());
        }
        text.push(close);
        text
    }
}

fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            c if c.is_control() => {
                // writing to a string does not fail
                let _ = write!(quoted, "\\u{:04x}", c as u32);
            }
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_objects_stand_on_one_line() {
        let long = Json::List((0..30).map(|_| Json::Raw("1.25".into())).collect());
        let short =
            Json::Object(vec![("x", Json::scalar("pi/2".into())), ("y", Json::text("a\"\n"))]);
        let file = Json::Object(vec![("short", short), ("long", long)]).file();
        let mut lines = file.lines();
        assert_eq!(lines.nth(1), Some("  \"short\": {\"x\": \"pi/2\", \"y\": \"a\\\"\\u000a\"},"));
        assert_eq!(lines.next(), Some("  \"long\": ["));
        assert_eq!(lines.next(), Some("    1.25,"));
    }
}
