//! The numbers that decide what is said of logs: all in tables, whose page is made from the code,
//! and how many stand elsewhere.

use super::{root, rust_files};
use std::fs;

/// A constant of the table: its name, its value as it is written, and what it is.
struct Entry {
    name: String,
    value: String,
    text: String,
}

fn entries(source: &str) -> Vec<Entry> {
    let (mut all, mut text, mut open) = (Vec::new(), Vec::new(), String::new());
    let mut module = String::new();
    for line in source.lines().map(str::trim) {
        if let Some(doc) = line.strip_prefix("/// ") {
            text.push(doc.to_owned());
            continue;
        }
        let declared = ["pub const ", "pub(crate) const ", "pub(super) const "];
        if let Some(rest) = declared.iter().find_map(|start| line.strip_prefix(start)) {
            open = format!("{rest} ");
        } else if !open.is_empty() {
            open += &format!("{line} ");
        }
        if let Some(name) = line.strip_prefix("pub(crate) mod ") {
            module = format!("{}::", name.trim_end_matches(" {"));
            text.clear();
        } else if !open.is_empty() && line.ends_with(';') {
            let (name, rest) = open.split_once(':').expect("a type");
            let (_, value) = rest.split_once(" = ").expect("a value");
            let value = value.trim().trim_end_matches(';').to_owned();
            let text = std::mem::take(&mut text).join(" ");
            assert!(!text.is_empty(), "{module}{name} says not what it is");
            all.push(Entry { name: format!("{module}{name}"), value, text });
            open.clear();
        } else if line == "}" {
            module.clear();
        } else if line.is_empty() {
            text.clear();
        }
    }
    all
}

/// The packages that judge logs, and motion for them; what their numbers are of, and the fewest
/// that a table which was read has.
const TABLES: [(&str, &str, usize); 7] = [
    ("evidence", "Hypotheses and names", 20),
    ("diagnose", "What is reported of what was found", 20),
    ("identify", "Estimates, doubts about logs", 20),
    ("elastic", "Springs and motors", 3),
    ("statics", "Measurements at rest", 3),
    ("measure", "Logs and filters", 20),
    ("excite", "Motion that excites", 5),
];

fn page() -> String {
    let mut page = String::from(
        "# The numbers that decide\n\n\
         Made from the tables `policy.rs` of seven packages (`UPDATE_EXPECT=1 cargo test --release \
         --test it policy` writes it anew).\n",
    );
    for (package, what, fewest) in TABLES {
        let mut files = rust_files(&format!("crates/{package}/src"));
        files.retain(|path| path.ends_with("policy.rs"));
        files.sort();
        let read = |path: &std::path::PathBuf| entries(&fs::read_to_string(path).unwrap());
        let entries: Vec<Entry> = files.iter().flat_map(read).collect();
        assert!(entries.len() > fewest, "the table of {package} has {} entries", entries.len());
        page += &format!("\n## {what} (`crates/{package}`)\n");
        for Entry { name, value, text } in entries {
            let text = text.replace("\\[", "[").replace("\\]", "]").replace("[`", "`");
            let text = text.replace("`]", "`");
            page += &format!("\n**{name}** = {value}\n: {text}\n");
        }
    }
    page
}

#[test]
fn the_page_of_the_policy_is_that_of_the_code() {
    let page = page();
    let path = root().join("docs/reference/policy.md");
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        fs::write(&path, &page).unwrap();
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert!(written == page, "{}: UPDATE_EXPECT=1 writes it anew", path.display());
}

/// Constants of floating point and literals in comparisons that stand outside the table, in the
/// packages that judge logs. They may become fewer.
const MOST_ELSEWHERE: usize = 40;

#[test]
fn numbers_outside_the_policy_do_not_become_more() {
    let mut count = 0;
    for (package, ..) in TABLES {
        for path in rust_files(&format!("crates/{package}/src")) {
            if path.ends_with("policy.rs") {
                continue;
            }
            let source = fs::read_to_string(&path).unwrap();
            let code = source.split("#[cfg(test)]").next().unwrap_or_default();
            count += code.lines().filter(|line| is_number(line)).count();
        }
    }
    assert!(count <= MOST_ELSEWHERE, "{count} numbers outside policy.rs, not {MOST_ELSEWHERE}");
}

fn is_number(line: &str) -> bool {
    let line = line.trim();
    if line.starts_with("//") {
        return false;
    }
    let is_constant = line.contains("const ") && line.contains("f64");
    let words: Vec<&str> = line.split_whitespace().collect();
    let compared = words.windows(2).any(|pair| {
        let is_sign = ["<", ">", "<=", ">="].contains(&pair[0]);
        let literal = pair[1].trim_end_matches([',', ')', ';', '{']);
        is_sign && literal.contains(['.', 'e']) && literal.parse::<f64>().is_ok_and(|x| x != 0.0)
    });
    is_constant || compared
}

#[test]
fn constants_and_compared_literals_are_numbers() {
    assert!(is_number("const LEAST: f64 = 0.3;") && is_number("if share > 0.95 {"));
    assert!(!is_number("if share > 0.0 {") && !is_number("let x = 0.5 * y;"));
    assert!(!is_number("// const LEAST: f64 = 0.3;"));
}
