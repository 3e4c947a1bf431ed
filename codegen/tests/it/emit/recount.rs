//! The operations of emitted text, counted again from the text alone.

use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::emit::rust::module;
use denavit_codegen::function::FunctionName;
use denavit_codegen::model;
use denavit_codegen::program::{Counts, code_counts, counts, lower};
use std::path::PathBuf;

pub(crate) fn models() -> Vec<PathBuf> {
    let directory = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../models");
    let entries = std::fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path());
    let is_model = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "json");
    let mut models: Vec<PathBuf> = entries.filter(is_model).collect();
    models.sort();
    assert!(models.len() >= 12);
    models
}

/// The statements of the function `name`, and of its parts if it has any.
fn statements<'a>(text: &'a str, name: &str) -> Vec<&'a str> {
    let is_head = |line: &&str| {
        let head = line.strip_prefix("pub ").unwrap_or(line).strip_prefix("fn ");
        let rest = head.and_then(|head| head.strip_prefix(name));
        rest.is_some_and(|rest| rest.starts_with('<') || rest.starts_with("_part_"))
    };
    let mut found = Vec::new();
    let mut lines = text.lines();
    while let Some(head) = lines.by_ref().find(is_head) {
        if !head.ends_with('{') {
            lines.by_ref().find(|line| line.starts_with(')')).unwrap();
        }
        found.extend(lines.by_ref().take_while(|line| *line != "}"));
    }
    assert!(!found.is_empty(), "{name}");
    found
}

fn recount(statements: &[&str]) -> Counts {
    let mut counts = Counts::default();
    for line in statements {
        // Constants are no operations, whatever their sign.
        if line.contains("from_f64(") {
            continue;
        }
        let count = |pattern: &str| line.matches(pattern).count();
        counts.mul += count(" * ");
        counts.add += count(" + ") + count(" - ");
        counts.div += count(" / ");
        counts.neg += count("-") - count(" - ") - count("->");
        let fused = [".product_plus(", ".product_minus(", ".minus_product("];
        let fused: usize = fused.iter().map(|pattern| count(pattern)).sum();
        counts.mul += fused;
        counts.add += fused;
        counts.sincos += count(".sincos()");
        let packs = line.split_once("S::sincos_all([").and_then(|(_, rest)| rest.split_once("])"));
        counts.sincos += packs.map_or(0, |(angles, _)| angles.split(", ").count());
        counts.sqrt += count(".sqrt()");
        let selections = ["S::select_", ".lesser(", ".greater(", ".abs()", ".sign()"];
        counts.select += selections.iter().map(|pattern| count(pattern)).sum::<usize>();
        let others =
            [".tangent()", ".arctangent2(", ".exponential()", ".logarithm()", ".hyperbolic"];
        counts.function += others.iter().map(|pattern| count(pattern)).sum::<usize>();
    }
    counts
}

#[test]
fn emitted_text_has_the_operations_that_are_counted() {
    for path in models() {
        let file = path.to_string_lossy();
        let robot = model::read(&file, &std::fs::read(&path).unwrap()).unwrap();
        let flavours = [Flavour::Tunable, Flavour::Sparse, Flavour::Baked];
        let wanted =
            [&FunctionName::ALL[..], &FunctionName::WALKING, &FunctionName::REGRESSORS].concat();
        for flavour in flavours {
            let Ok(derivation) = derive(&robot, flavour, &wanted) else {
                assert_eq!(flavour, Flavour::Baked, "only baking needs values");
                continue;
            };
            let program = lower(&derivation.dag, &derivation.functions).unwrap();
            let text = module(&derivation.robot, &program).unwrap();
            for routine in &program.routines {
                let name = routine.full_name();
                let stated = Counts { prelude: 0, ..counts(&program, routine) };
                let found = recount(&statements(&text, &name.to_ascii_lowercase()));
                assert_eq!(found, stated, "{name} of {file}, {flavour}");
                // The table of the header says so too.
                let row = text.lines().find(|line| {
                    line.strip_prefix("//     ").is_some_and(|row| row.starts_with(&name))
                });
                assert!(row.unwrap().contains(&format!(" {} ", stated.mul)), "{name}");
            }
            if flavour != Flavour::Baked && !program.parameters.is_empty() {
                let after = text.split("pub fn new(").nth(1).unwrap();
                let prelude: Vec<&str> =
                    after.lines().skip(1).take_while(|line| *line != "    }").collect();
                assert_eq!(recount(&prelude), code_counts(&program.prelude), "{file}");
            }
        }
    }
}
