//! What is wrong, one by one, of the text of an error.

use std::path::Path;

/// One thing that is wrong.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PlacedFault {
    /// The file, or the name of a model or scenario, that is to blame.
    pub file: Option<String>,
    /// Line, from 1.
    pub line: Option<usize>,
    /// Column in characters, from 1.
    pub column: Option<usize>,
    /// What is wrong.
    pub cause: String,
    /// What to do about it.
    pub hint: Option<String>,
}

/// What is wrong, of the form in which every error is printed: `FILE:LINE:COLUMN: CAUSE`, with
/// less of a place perhaps, and below it `  hint: HINT`.
pub fn faults_of(printed: &str) -> Vec<PlacedFault> {
    let mut all: Vec<PlacedFault> = Vec::new();
    for line in printed.lines() {
        match (line.strip_prefix("  hint: "), all.last_mut()) {
            // several ways out
            (Some(hint), Some(PlacedFault { hint: Some(before), .. })) => {
                before.push('\n');
                before.push_str(hint);
            }
            (Some(hint), Some(last)) => last.hint = Some(hint.to_owned()),
            // what goes on below a hint goes on with it
            (None, Some(last)) if line.starts_with("  ") => {
                let text = last.hint.as_mut().unwrap_or(&mut last.cause);
                text.push('\n');
                text.push_str(line.trim());
            }
            _ => all.push(fault(line)),
        }
    }
    all
}

fn fault(line: &str) -> PlacedFault {
    let bare = || PlacedFault { cause: line.to_owned(), ..PlacedFault::default() };
    let number = |text: &str| {
        let (rest, number) = text.rsplit_once(':')?;
        Some((rest.to_owned(), number.parse::<usize>().ok()?))
    };
    let Some((place, cause)) = line.split_once(": ") else { return bare() };
    let cause = cause.to_owned();
    if let Some((rest, last)) = number(place) {
        return match number(&rest) {
            Some((file, line)) => {
                let (file, line, column) = (Some(file), Some(line), Some(last));
                PlacedFault { file, line, column, cause, hint: None }
            }
            None => {
                PlacedFault { file: Some(rest), line: Some(last), cause, ..PlacedFault::default() }
            }
        };
    }
    // a name, or a file with blanks in its name; else a sentence with a colon
    let is_name = !place.is_empty() && !place.contains(char::is_whitespace);
    match is_name && !place.starts_with("--") || Path::new(place).exists() {
        true => PlacedFault { file: Some(place.to_owned()), cause, ..PlacedFault::default() },
        false => bare(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_read_as_they_are_printed() {
        let printed = "a/b.json:2:20: /x: nothing\n  hint: declare it:\n  more\nc.csv:7: a gap\n\
                       --prior: no\ntulip: none: of it\nthe model:3:4: wrong\nit is: so\n  \
                       hint: one way\n  hint: another";
        let found = faults_of(printed);
        let places: Vec<_> = found.iter().map(|one| (one.file.as_deref(), one.line)).collect();
        let expected = [
            (Some("a/b.json"), Some(2)),
            (Some("c.csv"), Some(7)),
            (None, None),
            (Some("tulip"), None),
            (Some("the model"), Some(3)),
            (None, None),
        ];
        assert_eq!(places, expected);
        assert_eq!(found[0].column, Some(20));
        assert_eq!(found[0].hint.as_deref(), Some("declare it:\nmore"));
        assert_eq!(found[3].cause, "none: of it");
        assert_eq!(found[5].hint.as_deref(), Some("one way\nanother"));
    }
}
