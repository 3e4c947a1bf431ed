//! Formulas against hand-set ones; layout of documents.

use super::*;
use crate::expr::text::parse;
use crate::expr::{Dag, ExprId, SymbolClass};
use std::fs;
use std::path::Path;

fn class_of(name: &str) -> SymbolClass {
    let head = name.split('_').next().unwrap_or(name);
    match head.trim_end_matches(|c: char| c.is_ascii_digit()) {
        "q" => SymbolClass::Configuration,
        "th" if head.ends_with(|c: char| c.is_ascii_digit()) => SymbolClass::Configuration,
        "qd" | "thd" => SymbolClass::Rate,
        _ if head.starts_with("th") && head.ends_with('d') => SymbolClass::Rate,
        "qdd" => SymbolClass::Acceleration,
        "m" | "I" | "Ixx" => SymbolClass::Inertia,
        _ => SymbolClass::Geometry,
    }
}

fn read(dag: &mut Dag, text: &str) -> ExprId {
    let resolve = &mut |dag: &mut Dag, name: &str| Some(dag.symbol(name, class_of(name)));
    parse(dag, text, resolve).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn latex(text: &str) -> String {
    let mut dag = Dag::new();
    // The file's order: parameters are declared by name.
    for name in ["m1", "m2", "a1", "a2", "a3", "l1", "l2", "d1", "q1", "q2", "q3"] {
        read(&mut dag, name);
    }
    let expr = read(&mut dag, text);
    write_expression(&dag, expr, &Notation::of_names(&dag))
}

#[test]
fn expressions_are_set_as_their_fixture_says() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/latex/expressions.txt");
    let old = fs::read_to_string(&file).unwrap();
    let (mut new, mut case, mut count) = (String::new(), None, 0);
    for line in old.lines() {
        match case.take() {
            Some(text) => {
                new.push_str(&format!("= {}\n", latex(text)));
                count += 1;
                continue;
            }
            None if new.contains("---") && !line.is_empty() && !line.starts_with("---") => {
                case = Some(line);
            }
            None => {}
        }
        new.push_str(line);
        new.push('\n');
    }
    assert!(count > 30);
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        fs::write(&file, &new).unwrap();
    } else {
        for (number, (new, old)) in new.lines().zip(old.lines()).enumerate() {
            assert_eq!(new, old, "line {}", number + 1);
        }
    }
}

#[test]
fn no_letter_has_two_meanings() {
    let mut dag = Dag::new();
    let expr = read(&mut dag, "c1*cos(q1) + x2*sin(q1 + q2)");
    let notation = Notation::of_names(&dag);
    assert_eq!(write_expression(&dag, expr, &notation), r"c_1 \cos q_1 + x_2 \sin(q_1 + q_2)");
    assert_eq!(notation.intermediate(12), "y_{12}");
}

#[test]
fn from_ten_joints_on_numbers_are_separated() {
    let mut dag = Dag::new();
    let expr = read(&mut dag, "cos(q1 + q12) + cos(q2)");
    let notation = Notation::of_names(&dag);
    assert_eq!(write_expression(&dag, expr, &notation), "c_{1,12} + c_2");
}

#[test]
fn what_is_shared_or_long_is_named_once() {
    let mut dag = Dag::new();
    let shared = "(a1*c1 + a2*d1 + a3*l1)";
    let outputs = [
        read(&mut dag, &format!("{shared}*q1")),
        read(&mut dag, &format!("{shared}*q2 + select(q1 < 0, 1, 0)*{shared}")),
    ];
    let notation = Notation::of_names(&dag);
    let extent = Extent { shared: 60, longest: 400 };
    let written = write_expressions(&dag, &outputs, &notation, extent);
    let names: Vec<&str> = written.definitions.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["x_1", "x_2"]);
    let formulas: Vec<String> = written.outputs.iter().map(|terms| terms.join(" ")).collect();
    assert_eq!(formulas, ["x_1 q_1", "x_1 x_2 + x_1 q_2"]);
    // A long sum is cut into pieces that fit a line.
    let sum: Vec<String> = (0..100).map(|i| format!("a1*q1*qd1*(a2 + q2)*q{i}")).collect();
    let sum = read(&mut dag, &sum.join(" + "));
    let notation = Notation::of_names(&dag);
    let written = write_expressions(&dag, &[sum], &notation, extent);
    assert!(!written.definitions.is_empty());
    for (_, formula) in &written.definitions {
        assert!(super::expression::width(formula) < 900, "{formula}");
    }
}

#[test]
fn deep_expressions_do_not_overflow_the_stack() {
    let mut dag = Dag::new();
    let (q1, l1) = (read(&mut dag, "q1"), read(&mut dag, "l1"));
    let mut expr = q1;
    for _ in 0..20_000 {
        let sin = dag.sin(expr);
        expr = dag.add(sin, l1);
    }
    let extent = Extent { shared: 60, longest: 400 };
    let written = write_expressions(&dag, &[expr], &Notation::of_names(&dag), extent);
    assert!(written.definitions.len() > 100);
}

#[test]
fn plain_text_is_escaped() {
    assert_eq!(escape(r"50% of a_1 & b\c {x}"), r"50\% of a\_1 \& b\textbackslash{}c \{x\}");
    assert_eq!(escape("Hélouvry, 4 kg m^2 \u{4e2d}"), "Hélouvry, 4 kg m$^{2}$ ?");
}
