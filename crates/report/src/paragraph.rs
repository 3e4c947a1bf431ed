//! Paragraphs of text.

/// Columns of a line.
const WIDTH: usize = 100;

/// The words of `text` on lines that begin with `first`, then with `rest`, without a line break at
/// the end.
pub fn paragraph(first: &str, rest: &str, text: &str) -> String {
    let mut lines = vec![first.to_owned()];
    let mut is_empty = true;
    for word in text.split_whitespace() {
        let line = lines.last().map_or("", String::as_str);
        let length = line.chars().count() + 1 + word.chars().count();
        if length > WIDTH && !is_empty {
            lines.push(rest.to_owned());
            is_empty = true;
        }
        if let Some(line) = lines.last_mut() {
            if !is_empty {
                line.push(' ');
            }
            line.push_str(word);
            is_empty = false;
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_text_is_broken_between_words() {
        let text = "word ".repeat(30);
        let lines: Vec<String> = paragraph("- ", "  ", &text).lines().map(str::to_owned).collect();
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[0], format!("- {}", "word ".repeat(19)).trim_end());
        assert_eq!(lines[1].split_whitespace().count(), 11);
        assert!(lines[1].starts_with("  word"));
    }
}
