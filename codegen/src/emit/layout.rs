//! Filling of templates: frames of text with named places, and nothing that computes.
//!
//! A place is written `{{name}}`. Alone on its line it takes a value of many lines, each indented
//! like the place; with an empty value the line goes. A name that is not given, or given and not
//! used, is an error: a template and its caller never drift apart.

use std::fmt;

/// Why a template and its values do not fit: always a fault of ours, never of the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TemplateError {
    /// The template has a place for which there is no value.
    Unknown(String),
    /// A value was given for which the template has no place.
    Unused(String),
    /// A place is opened and not closed.
    Unclosed,
}

impl fmt::Display for TemplateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(name) => write!(f, "no value for {{{{{name}}}}}"),
            Self::Unused(name) => write!(f, "no place {{{{{name}}}}} for a value"),
            Self::Unclosed => write!(f, "a place is not closed"),
        }
    }
}

impl std::error::Error for TemplateError {}

/// A template of ours, filled by the caller that it was written for.
pub(super) fn template(text: &str, values: &[(&str, &str)]) -> String {
    fill(text, values).expect("a template and its caller fit")
}

/// The template with its places filled.
pub fn fill(template: &str, values: &[(&str, &str)]) -> Result<String, TemplateError> {
    let mut used = vec![false; values.len()];
    let mut text = String::new();
    for line in template.split_inclusive('\n') {
        match alone(line) {
            Some((indent, name)) => {
                let value = find(name, values, &mut used)?;
                for part in value.lines() {
                    let indent = if part.is_empty() { "" } else { indent };
                    text.extend([indent, part, "\n"]);
                }
            }
            None => fill_line(line, values, &mut used, &mut text)?,
        }
    }
    match used.iter().position(|used| !used) {
        Some(row) => Err(TemplateError::Unused(values[row].0.to_owned())),
        None => Ok(text),
    }
}

/// The indentation and the name of a place that stands alone on its line.
fn alone(line: &str) -> Option<(&str, &str)> {
    let content = line.trim_end_matches('\n');
    let place = content.trim_start_matches(' ');
    let name = place.strip_prefix("{{")?.strip_suffix("}}")?;
    (!name.contains("{{")).then(|| (&content[..content.len() - place.len()], name))
}

fn fill_line(
    line: &str,
    values: &[(&str, &str)],
    used: &mut [bool],
    text: &mut String,
) -> Result<(), TemplateError> {
    let mut rest = line;
    while let Some((before, place)) = rest.split_once("{{") {
        let (name, after) = place.split_once("}}").ok_or(TemplateError::Unclosed)?;
        text.extend([before, find(name, values, used)?]);
        rest = after;
    }
    text.push_str(rest);
    Ok(())
}

fn find<'a>(
    name: &str,
    values: &[(&str, &'a str)],
    used: &mut [bool],
) -> Result<&'a str, TemplateError> {
    let row = values.iter().position(|(known, _)| *known == name);
    let row = row.ok_or_else(|| TemplateError::Unknown(name.to_owned()))?;
    used[row] = true;
    Ok(values[row].1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_alone_on_its_line_indents_all_lines_of_its_value() {
        let template = "fn {{name}}() {\n    {{body}}\n}\n";
        let filled = fill(template, &[("name", "f"), ("body", "a;\n\nb;")]);
        assert_eq!(filled.unwrap(), "fn f() {\n    a;\n\n    b;\n}\n");
    }

    #[test]
    fn an_empty_value_takes_its_line_away() {
        assert_eq!(fill("a\n  {{x}}\nb{{x}}\n", &[("x", "")]).unwrap(), "a\nb\n");
    }

    #[test]
    fn a_value_is_not_searched_for_places() {
        assert_eq!(fill("{{x}}", &[("x", "{{y}}")]).unwrap(), "{{y}}\n");
        assert_eq!(fill("<{{x}}>", &[("x", "{{y}}")]).unwrap(), "<{{y}}>");
    }

    #[test]
    fn what_does_not_fit_is_named() {
        assert_eq!(fill("{{x}}", &[]), Err(TemplateError::Unknown("x".to_owned())));
        assert_eq!(fill("", &[("x", "")]), Err(TemplateError::Unused("x".to_owned())));
        assert_eq!(fill("a {{x", &[("x", "")]), Err(TemplateError::Unclosed));
    }
}
