//! Files that import each other in a circle are one idea, and stand in one folder.

use super::{assert_none, root, rust_files, shown};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The path of a module within its crate: `["motion", "slipping"]`; empty for the crate itself.
type Module = Vec<String>;

/// The modules of a crate: which file, what it imports for itself, what it hands on.
#[derive(Default)]
struct Crate {
    files: BTreeMap<Module, PathBuf>,
    imports: BTreeMap<Module, Vec<String>>,
    exports: BTreeMap<Module, Vec<String>>,
}

impl Crate {
    fn read(source: &Path) -> Self {
        let mut read = Self::default();
        for file in rust_files(&shown(source)) {
            let inside = file.strip_prefix(source).unwrap().with_extension("");
            let mut module: Module =
                inside.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            if module.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
                module.pop();
            }
            let (imports, exports) = imported(&code(&fs::read_to_string(&file).unwrap()));
            read.imports.insert(module.clone(), imports);
            read.exports.insert(module.clone(), exports);
            read.files.insert(module, file);
        }
        read
    }

    /// The module that a path which is written in `from` leads to, through what modules hand on.
    fn target(&self, from: &Module, path: &str, steps: usize) -> Option<Module> {
        let mut parts: Vec<&str> = path.split("::").collect();
        let mut at = match parts[0] {
            "crate" => Module::new(),
            "super" | "self" => from.clone(),
            first if self.files.contains_key(&child(from, first)) => from.clone(),
            _ => return None,
        };
        while let Some(&first) = parts.first() {
            match first {
                "crate" | "self" => {}
                "super" => {
                    at.pop();
                }
                name if self.files.contains_key(&child(&at, name)) => at = child(&at, name),
                _ => break,
            }
            parts.remove(0);
        }
        // what a module only hands on belongs to where it comes from
        let from_elsewhere = parts.first().and_then(|name| {
            let named = |export: &&String| export.rsplit("::").next() == Some(name);
            let export = self.exports.get(&at)?.iter().find(named)?;
            (steps < 8).then(|| self.target(&at, export, steps + 1)).flatten()
        });
        from_elsewhere.or(Some(at).filter(|at| self.files.contains_key(at)))
    }

    fn edges(&self) -> BTreeMap<Module, BTreeSet<Module>> {
        let of = |(module, imports): (&Module, &Vec<String>)| {
            let targets = imports.iter().filter_map(|path| self.target(module, path, 0));
            (module.clone(), targets.filter(|target| target != module).collect())
        };
        self.imports.iter().map(of).collect()
    }

    /// The folders that a module is at home in: where its file is, and what it is the head of.
    fn homes(&self, module: &Module) -> BTreeSet<Module> {
        let mut homes = BTreeSet::from([module[..module.len().saturating_sub(1)].to_vec()]);
        let is_head = |other: &Module| other.len() > module.len() && other.starts_with(module);
        if self.files.keys().any(is_head) {
            homes.insert(module.clone());
        }
        homes
    }
}

fn child(module: &Module, name: &str) -> Module {
    module.iter().cloned().chain([name.to_owned()]).collect()
}

/// The text without comments and without tests of its own.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    text.lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n")
}

/// Paths that a text imports or names, and those that it hands on.
fn imported(code: &str) -> (Vec<String>, Vec<String>) {
    let (mut imports, mut exports) = (Vec::new(), Vec::new());
    let mut rest = String::new();
    for statement in code.split_inclusive(';') {
        let begin = statement.rfind("use ").filter(|&at| {
            let before = statement[..at].trim_end();
            statement.ends_with(';')
                && (before.is_empty()
                    || before.ends_with(['}', ';', ']', '{', ')'])
                    || before.ends_with("pub"))
        });
        let Some(begin) = begin else {
            rest += statement;
            continue;
        };
        let before = statement[..begin].trim_end();
        let is_handed_on = before.ends_with("pub")
            || before.ends_with("pub(crate)")
            || before.ends_with("pub(super)");
        let list = if is_handed_on { &mut exports } else { &mut imports };
        spread("", statement[begin + 4..].trim_end_matches(';'), list);
        rest += &statement[..begin];
    }
    for word in rest.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':')) {
        if word.starts_with("crate::") || word.starts_with("super::") {
            imports.push(word.trim_end_matches(':').to_owned());
        }
    }
    (imports, exports)
}

/// The single paths of `a::{b, c::{d, e}}`.
fn spread(before: &str, tree: &str, paths: &mut Vec<String>) {
    let tree = tree.trim();
    let Some((head, list)) = tree.split_once('{') else {
        let name = tree.split(" as ").next().unwrap_or_default().trim();
        if !name.is_empty() {
            paths.push(format!("{before}{name}"));
        }
        return;
    };
    let before = format!("{before}{}", head.trim());
    let list = list.trim_end().trim_end_matches('}');
    let (mut depth, mut start) = (0, 0);
    for (at, character) in list.char_indices() {
        match character {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                spread(&before, &list[start..at], paths);
                start = at + 1;
            }
            _ => {}
        }
    }
    // of the last one the brace was cut off, if it ends with one
    let last = &list[start..];
    let open = last.matches('{').count() - last.matches('}').count();
    spread(&before, &format!("{last}{}", "}".repeat(open)), paths);
}

/// Every module that is reached from `from`.
fn reached(edges: &BTreeMap<Module, BTreeSet<Module>>, from: &Module) -> BTreeSet<Module> {
    let (mut seen, mut pending) = (BTreeSet::new(), vec![from]);
    while let Some(at) = pending.pop() {
        for next in edges.get(at).into_iter().flatten() {
            if seen.insert(next.clone()) {
                pending.push(next);
            }
        }
    }
    seen
}

/// The circles of a crate whose files have no folder in common.
fn scattered_circles(read: &Crate) -> Vec<String> {
    let edges = read.edges();
    let reach: BTreeMap<&Module, BTreeSet<Module>> =
        edges.keys().map(|module| (module, reached(&edges, module))).collect();
    let mut circles = BTreeSet::new();
    for (module, others) in &reach {
        let back = |other: &&Module| reach.get(other).is_some_and(|reach| reach.contains(*module));
        let circle: BTreeSet<&Module> = others.iter().filter(back).collect();
        let homes = circle.iter().map(|module| read.homes(module));
        let shared = homes.reduce(|shared, own| shared.intersection(&own).cloned().collect());
        if shared.is_some_and(|shared| shared.is_empty()) {
            let files = circle.iter().map(|module| shown(&read.files[*module]));
            circles.insert(files.collect::<Vec<_>>().join(", "));
        }
    }
    circles.into_iter().collect()
}

#[test]
fn files_of_different_folders_import_each_other_in_no_circle() {
    let mut sources = vec![root().join("src"), root().join("codegen/src")];
    sources.extend(["runtime", "jit"].map(|name| root().join("codegen").join(name).join("src")));
    let crates = fs::read_dir(root().join("crates")).unwrap().map(Result::unwrap);
    sources.extend(crates.map(|entry| entry.path().join("src")));
    sources.sort();
    let mut faults = Vec::new();
    for source in sources {
        faults.extend(scattered_circles(&Crate::read(&source)));
    }
    assert_none(&faults, "files of different folders import each other");
}

#[test]
fn circles_are_seen_through_what_modules_hand_on() {
    let made = |files: &[(&str, &str)]| {
        let mut read = Crate::default();
        for (name, text) in files {
            let module: Module =
                name.split('/').filter(|part| !part.is_empty()).map(str::to_owned).collect();
            let (imports, exports) = imported(&code(text));
            read.imports.insert(module.clone(), imports);
            read.exports.insert(module.clone(), exports);
            read.files.insert(module, root().join(name));
        }
        scattered_circles(&read)
    };
    let head = ("", "mod a;\nmod b;\npub use a::one::One;\n");
    let one = ("a/one", "use crate::b::two::{Two, three};\npub struct One;\n");
    let two = ("b/two", "use crate::{One, other};\nfn f() {}\n");
    let heads = [("a", "pub mod one;"), ("b", "pub mod two;")];
    assert_eq!(made(&[head, one, two, heads[0], heads[1]]), ["a/one, b/two"]);
    let alone = ("b/two", "// use crate::One;\nfn f() {}\n");
    assert!(made(&[head, one, alone, heads[0], heads[1]]).is_empty());
    let named = ("b/two", "fn f() -> crate::a::one::One { crate::One }\n");
    assert_eq!(made(&[head, one, named, heads[0], heads[1]]), ["a/one, b/two"]);
    let inside = [("a/one", "use super::two::Two;"), ("a/two", "use super::one::One;")];
    assert!(made(&[heads[0], inside[0], inside[1]]).is_empty());
}
