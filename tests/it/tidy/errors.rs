//! Each package of the laboratory has one public error, which is opaque and says its kind.

use super::{assert_none, root, rust_files, shown};
use std::fs;

/// Public types that are errors of the standard library beside the one of their package, and why.
const BESIDE: [(&str, &str, &str); 5] = [
    ("simulate", "Breakdown", "how a run ended, which `Stop` carries: an answer"),
    ("simulate", "ContactFailure", "why contacts have no forces, which `Breakdown` carries"),
    ("simulate", "NotPositiveDefinite", "the coordinate at which a factorisation fails"),
    ("simulate", "StepFailure", "why one step has no impulses: its caller chooses what to do"),
    ("report", "FormulaError", "the one of its package: a formula that is not typeset"),
];

/// The types for which a text implements the error trait.
fn errors(text: &str) -> Vec<&str> {
    let of_line = |line: &'_ str| -> Option<usize> {
        let trait_of = ["impl std::error::Error for ", "impl Error for "];
        trait_of.iter().find(|start| line.starts_with(**start)).map(|start| start.len())
    };
    let name = |line| {
        let rest: &str = &text[line..];
        let rest = &rest[of_line(rest.lines().next()?)?..];
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_'))?;
        Some(&rest[..end])
    };
    let mut starts: Vec<usize> = text.match_indices('\n').map(|(at, _)| at + 1).collect();
    starts.insert(0, 0);
    starts.into_iter().filter_map(name).collect()
}

/// Whether a text defines a type for everybody.
fn is_public(text: &str, name: &str) -> bool {
    ["struct", "enum"].iter().any(|kind| {
        let start = format!("pub {kind} {name}");
        text.lines().any(|line| {
            let rest = line.strip_prefix(&start);
            rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
        })
    })
}

#[test]
fn a_package_has_one_public_error() {
    let (mut faults, mut used) = (Vec::new(), Vec::new());
    let folders = fs::read_dir(root().join("crates")).unwrap();
    let mut packages: Vec<String> =
        folders.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    packages.sort();
    for package in &packages {
        let mut own = Vec::new();
        for path in rust_files(&format!("crates/{package}/src")) {
            let text = fs::read_to_string(&path).unwrap();
            for name in errors(&text).into_iter().filter(|name| is_public(&text, name)) {
                match BESIDE.iter().find(|one| (one.0, one.1) == (package.as_str(), name)) {
                    Some(one) => used.push(one.1),
                    None => own.push((name.to_owned(), shown(&path), text.clone())),
                }
            }
        }
        let beside: Vec<&(String, String, String)> =
            own.iter().filter(|(name, ..)| name != "Error").collect();
        faults.extend(beside.iter().map(|(name, place, _)| format!("{place}: {name}")));
        let Some((_, place, text)) = own.iter().find(|(name, ..)| name == "Error") else {
            continue;
        };
        let is_opaque = text.contains("pub struct Error(Box<") || package == "logs";
        let has_kind = text.contains("pub fn kind(&self) -> ErrorKind")
            && text.contains("#[non_exhaustive]\npub enum ErrorKind");
        if !(is_opaque && has_kind) {
            faults.push(format!("{place}: an error without a kind, or with public parts"));
        }
    }
    for (package, name, _) in BESIDE.iter().filter(|one| !used.contains(&one.1)) {
        faults.push(format!("{package}: {name} is no public error any more"));
    }
    assert_none(&faults, "public errors beside the one of their package");
}

#[test]
fn errors_are_found_where_they_are() {
    let text = "pub struct Error(Box<X>);\nimpl std::error::Error for Error {}\nenum Y {}\n\
                impl std::error::Error for Y {}\npub(crate) struct Z;\nimpl Error for Z {\n";
    assert_eq!(errors(text), ["Error", "Y", "Z"]);
    let public: Vec<&str> = errors(text).into_iter().filter(|name| is_public(text, name)).collect();
    assert_eq!(public, ["Error"]);
    assert!(!is_public("pub struct Errors;", "Error"));
}
