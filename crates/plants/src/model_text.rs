//! New values in the text of a model file, which else stays as it is.

use crate::regression::ModelParameter;
use denavit_codegen::model::json::{Json, Value, parse};
use denavit_codegen::model::{BodyEntry, Role};
use std::fmt::Write;
use std::ops::Range;

/// Where another entry of an object goes: after its last one, or after its bracket.
fn end(object: &Json<'_>) -> usize {
    object.entries().last().map_or(object.start + 1, |(_, last)| last.end)
}

/// A parameter with its new value, and its standard error if it is known by itself.
#[derive(Clone, Debug, PartialEq)]
pub struct NewValue<'a> {
    /// Which number of the file.
    pub parameter: &'a ModelParameter,
    /// Its value.
    pub value: f64,
    /// Its standard error.
    pub std: Option<f64>,
}

/// The text with new values; none if it is not the JSON of a model.
pub fn with_values(text: &str, values: &[NewValue<'_>]) -> Option<String> {
    let root = parse(text.as_bytes()).ok()?;
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    let mut inserted: Vec<(usize, String, String)> = Vec::new();
    for new in values {
        let written = written(new);
        match place(&root, new.parameter) {
            Some(Place::Value(span)) => edits.push((span, written)),
            Some(Place::Parts(value, std)) => {
                edits.push((value, number(new.value)));
                match (*std, new.std) {
                    (Place::Value(span), Some(std)) => edits.push((span, number(std))),
                    (Place::In(object, key), Some(std)) => {
                        inserted.push((object, key, number(std)));
                    }
                    _ => {}
                }
            }
            Some(Place::In(object, key)) => inserted.push((object, key, written)),
            None => missing_joint(&root, new.parameter, written, &mut inserted)?,
        }
    }
    for (at, text) in grouped(text, inserted) {
        edits.push((at..at, text));
    }
    edited(text, edits)
}

/// The text without entries of objects, each given by its JSON pointer; none if it has no such
/// entry.
pub fn without(text: &str, pointers: &[&str]) -> Option<String> {
    let root = parse(text.as_bytes()).ok()?;
    let removed = |pointer: &&str| {
        let (object, key) = pointer.rsplit_once('/')?;
        let object = object.split('/').skip(1).try_fold(&root, |node, key| match &node.value {
            Value::List(items) => items.get(key.parse::<usize>().ok()?),
            _ => node.get(key),
        })?;
        let entries = object.entries();
        let place = entries.iter().position(|(own, _)| own == key)?;
        let end = entries[place].1.end;
        Some(match place.checked_sub(1) {
            Some(before) => (entries[before].1.end..end, String::new()),
            None => {
                // with the comma before the next one
                let more = text.get(end..)?.find(',').filter(|_| entries.len() > 1);
                (object.start + 1..end + more.map_or(0, |at| at + 1), String::new())
            }
        })
    };
    let edits: Option<Vec<(Range<usize>, String)>> = pointers.iter().map(removed).collect();
    edited(text, edits?)
}

/// Where an effect goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewPlace<'a> {
    /// On the whole model.
    Model,
    /// On a link, or on the joint that has its name.
    Link(&'a str),
    /// On the link's side of the series spring of a joint.
    BehindSpring(&'a str),
    /// On a joint, with a second one.
    Pair(&'a str, &'a str),
}

/// An effect that the model is to have.
#[derive(Clone, Debug, PartialEq)]
pub struct NewEffect<'a> {
    /// The name of its definition.
    pub effect: &'a str,
    /// Its place.
    pub at: NewPlace<'a>,
    /// Its parameters: name, value, standard error if it is known.
    pub parameters: EffectValues<'a>,
}

/// Parameters of an effect: name, value, standard error if it is known.
pub type EffectValues<'a> = Vec<(&'a str, f64, Option<f64>)>;

/// The text with more effects, and with other parameters of those that it has, which are given by
/// their numbers; none if it is not the JSON of a model.
pub fn with_effects(
    text: &str,
    effects: &[NewEffect<'_>],
    changed: &[(usize, EffectValues<'_>)],
) -> Option<String> {
    let root = parse(text.as_bytes()).ok()?;
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    for (number, values) in changed {
        let own = root.get("effects")?.items().get(*number)?;
        let values = values_text(values);
        edits.push(match own.get("parameters") {
            Some(known) => (known.start..known.end, values),
            None => (end(own)..end(own), format!(", \"parameters\": {values}")),
        });
    }
    let lines: Vec<String> = effects.iter().map(effect_text).collect();
    let (at, inserted) = match root.get("effects") {
        Some(known) => match known.items().last() {
            Some(last) => (last.end, format!(", {}", lines.join(", "))),
            None => (known.start + 1, lines.join(", ")),
        },
        None => {
            let blanks = indent(text.get(..end(&root))?);
            let list = match blanks {
                Some(blanks) => {
                    let line = format!(",\n{blanks}{blanks}");
                    format!("[\n{blanks}{blanks}{}\n{blanks}]", lines.join(&line))
                }
                None => format!("[{}]", lines.join(", ")),
            };
            let separator = blanks.map_or(", ".to_owned(), |blanks| format!(",\n{blanks}"));
            (end(&root), format!("{separator}\"effects\": {list}"))
        }
    };
    if !lines.is_empty() {
        edits.push((at..at, inserted));
    }
    edited(text, edits)
}

/// The text with pieces of it replaced.
fn edited(text: &str, mut edits: Vec<(Range<usize>, String)>) -> Option<String> {
    edits.sort_by_key(|(span, _)| (span.start, span.end));
    let mut result = String::with_capacity(text.len() + 64 * edits.len());
    let mut from = 0;
    for (span, new) in edits {
        result.push_str(text.get(from..span.start)?);
        result.push_str(&new);
        from = span.end;
    }
    result.push_str(text.get(from..)?);
    Some(result)
}

fn effect_text(new: &NewEffect<'_>) -> String {
    let quoted = |name: &str| serde_json::Value::from(name).to_string();
    let at = match new.at {
        NewPlace::Model => quoted("model"),
        NewPlace::Link(link) => format!("{{\"link\": {}}}", quoted(link)),
        NewPlace::BehindSpring(link) => {
            format!("{{\"link\": {}, \"side\": \"link\"}}", quoted(link))
        }
        NewPlace::Pair(link, second) => {
            format!("{{\"link\": {}, \"second\": {}}}", quoted(link), quoted(second))
        }
    };
    let (effect, values) = (quoted(new.effect), values_text(&new.parameters));
    format!("{{\"effect\": {effect}, \"at\": {at}, \"parameters\": {values}}}")
}

fn values_text(values: &[(&str, f64, Option<f64>)]) -> String {
    let text = |&(name, value, std): &(&str, f64, Option<f64>)| {
        format!("{}: {}", serde_json::Value::from(name), value_with_error(value, std))
    };
    format!("{{{}}}", values.iter().map(text).collect::<Vec<String>>().join(", "))
}

fn written(new: &NewValue<'_>) -> String {
    value_with_error(new.value, new.std)
}

fn value_with_error(value: f64, std: Option<f64>) -> String {
    match std {
        Some(std) => format!("{{\"value\": {}, \"std\": {}}}", number(value), number(std)),
        None => number(value),
    }
}

/// A number of JSON with twelve digits, which reading turns into the same number.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.11e}").parse().unwrap_or(value);
    format!("{:?}", rounded + 0.0)
}

/// Where a value stands, or goes.
enum Place {
    Value(Range<usize>),
    /// The value in an object, and the place of its standard error.
    Parts(Range<usize>, Box<Place>),
    /// A place within an object where another entry may stand, with its key.
    In(usize, String),
}

fn in_object(object: &Json<'_>, key: &str) -> Place {
    match object.get(key) {
        Some(node) => Place::Value(node.start..node.end),
        None => Place::In(end(object), key.to_owned()),
    }
}

fn place(root: &Json<'_>, parameter: &ModelParameter) -> Option<Place> {
    let link = parameter.link.as_deref();
    match parameter.role {
        Some(Role::Unknown | Role::Constant) => {
            let group = root.get("unknowns").filter(|node| node.get(&parameter.name).is_some());
            let own = group.or_else(|| root.get("constants"))?.get(&parameter.name)?;
            let std = Box::new(in_object(own, "std"));
            Some(match own.get("value") {
                Some(value) => Place::Parts(value.start..value.end, std),
                None if matches!(own.value, Value::Object(_)) => in_object(own, "value"),
                None => Place::Value(own.start..own.end),
            })
        }
        Some(Role::Body(_, entry)) => body_entry(body(root, link?)?, entry),
        _ => {
            let drive = root.get("drives").and_then(|drives| drives.get(link?));
            if parameter.name.starts_with("k_") {
                return Some(in_object(drive?.get("series_elastic")?, "stiffness"));
            }
            let key = drive_key(parameter)?;
            let joint = link_of(root, link?).and_then(|link| link.get("joint"));
            let damping = joint.and_then(|joint| joint.get("damping"));
            match damping.filter(|_| key == "viscous") {
                Some(damping) => Some(Place::Value(damping.start..damping.end)),
                None => Some(in_object(drive?, key)),
            }
        }
    }
}

fn link_of<'a>(root: &'a Json<'a>, name: &str) -> Option<&'a Json<'a>> {
    let is_named = |link: &&Json<'_>| {
        let own = link.get("name").map(|name| &name.value);
        matches!(own, Some(Value::Text(own)) if own == name)
    };
    root.get("links")?.items().iter().find(is_named)
}

fn body<'a>(root: &'a Json<'a>, link: &str) -> Option<&'a Json<'a>> {
    link_of(root, link).and_then(|link| link.get("body")).or_else(|| root.get("base")?.get("body"))
}

fn body_entry(body: &Json<'_>, entry: BodyEntry) -> Option<Place> {
    use BodyEntry::{ComX, ComY, ComZ, Mass};
    let axis = match entry {
        Mass => return Some(in_object(body, "mass")),
        ComX => 0,
        ComY => 1,
        ComZ => 2,
        _ => {
            let key = &entry.prefix()[1..];
            return match body.get("inertia") {
                Some(inertia) => Some(in_object(inertia, key)),
                None => Some(Place::In(end(body), format!("inertia.{key}"))),
            };
        }
    };
    match body.get("com") {
        Some(com) => com.items().get(axis).map(|node| Place::Value(node.start..node.end)),
        None => Some(Place::In(end(body), format!("com.{axis}"))),
    }
}

/// The key that a drive has for a joint parameter.
fn drive_key(parameter: &ModelParameter) -> Option<&'static str> {
    Some(match parameter.name.split('_').next()? {
        "fv" => "viscous",
        "fc" => "coulomb",
        "Ia" => "rotor_inertia",
        "off" => "offset",
        _ => return None,
    })
}

/// A joint parameter of a joint without a drive of its own.
fn missing_joint(
    root: &Json<'_>,
    parameter: &ModelParameter,
    written: String,
    inserted: &mut Vec<(usize, String, String)>,
) -> Option<()> {
    let link = parameter.link.as_deref()?;
    let key = drive_key(parameter)?;
    let (at, prefix) = match root.get("drives") {
        Some(drives) => (end(drives), String::new()),
        None => (end(root), "drives.".to_owned()),
    };
    inserted.push((at, format!("{prefix}{link}.{key}"), written));
    Some(())
}

/// Insertions at one place as text, keys with dots as objects in objects; entries of `com` that are
/// not given are 0.
fn grouped(text: &str, inserted: Vec<(usize, String, String)>) -> Vec<(usize, String)> {
    let mut places: Vec<usize> = inserted.iter().map(|(at, ..)| *at).collect();
    places.sort_unstable();
    places.dedup();
    let at_place = |at: usize| {
        let own = inserted.iter().filter(|(own, ..)| *own == at);
        let own: Vec<(Vec<&str>, &str)> =
            own.map(|(_, key, value)| (key.split('.').collect(), value.as_str())).collect();
        let new = entries(&own);
        // the first entry of an object, one on the line of the others, or one on a line of its own
        let before = &text[..at];
        let separator = match indent(before) {
            _ if before.ends_with('{') => String::new(),
            Some(indent) => format!(",\n{indent}"),
            None => ", ".to_owned(),
        };
        (at, separator + &new)
    };
    places.into_iter().map(at_place).collect()
}

/// The blanks before the entry of an object that ends here, if it has its line to itself.
fn indent(before: &str) -> Option<&str> {
    let mut depth = 0;
    let open = before.char_indices().rev().find(|(_, letter)| {
        depth += match letter {
            '}' | ']' => 1,
            '{' | '[' => -1,
            _ => 0,
        };
        depth < 0
    });
    let inner = &before[open.map_or(0, |(at, _)| at + 1)..];
    // entries on lines of their own begin with a line's end after the bracket
    let line = inner.strip_prefix('\n').or_else(|| inner.strip_prefix("\r\n"))?;
    Some(&line[..line.len() - line.trim_start_matches([' ', '\t']).len()])
}

fn entries(given: &[(Vec<&str>, &str)]) -> String {
    let mut heads: Vec<&str> = Vec::new();
    for (keys, _) in given {
        if !heads.contains(&keys[0]) {
            heads.push(keys[0]);
        }
    }
    let mut result = String::new();
    for (index, head) in heads.iter().enumerate() {
        let inner: Vec<(Vec<&str>, &str)> = given
            .iter()
            .filter(|(keys, _)| keys[0] == *head)
            .map(|(keys, value)| (keys[1..].to_vec(), *value))
            .collect();
        let separator = if index > 0 { ", " } else { "" };
        let value = match &inner[..] {
            [(keys, value)] if keys.is_empty() => (*value).to_owned(),
            _ if *head == "com" => {
                let axis = |axis: &str| {
                    let own = inner.iter().find(|(keys, _)| keys[0] == axis);
                    own.map_or("0", |(_, value)| value)
                };
                format!("[{}, {}, {}]", axis("0"), axis("1"), axis("2"))
            }
            _ => format!("{{{}}}", entries(&inner)),
        };
        // writing to a string cannot fail
        let _ = write!(result, "{separator}\"{head}\": {value}");
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_go_with_their_commas() {
        let text = r#"{"links": [{}, {"a": 1, "b": {"c": 2} , "d": [3]}]}"#;
        let of = |key: &str| without(text, &[&format!("/links/1/{key}")]);
        assert_eq!(of("a").as_deref(), Some(r#"{"links": [{}, { "b": {"c": 2} , "d": [3]}]}"#));
        assert_eq!(of("b").as_deref(), Some(r#"{"links": [{}, {"a": 1 , "d": [3]}]}"#));
        assert_eq!(of("d").as_deref(), Some(r#"{"links": [{}, {"a": 1, "b": {"c": 2}}]}"#));
        assert_eq!(of("b/c").as_deref(), Some(r#"{"links": [{}, {"a": 1, "b": {} , "d": [3]}]}"#));
        assert_eq!(of("e"), None);
    }
}
