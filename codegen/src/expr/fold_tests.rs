//! The laws of `fold.rs` and `fold_functions.rs`: each has its cases under its own name in
//! `tests/fixtures/fold`, each is exact, and none adds operations.

use super::random::{Kind, build, recipes};
use super::text::{parse_with, print};
use super::*;
use crate::arena::Handle;
use crate::number::Residue;
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Stores a node as it is: the graph that the laws are compared with. (An exponent is a number and
/// no negation.)
fn as_it_is(dag: &mut Dag, node: Node) -> ExprId {
    match node {
        Node::Neg(a) if dag.as_constant(a).is_some() => dag.make(node),
        _ => dag.intern(node),
    }
}

/// The same, but what holds numbers alone is folded: modulo p an angle is read by its structure,
/// and `(-7)*pi/(1 + 1)` should be one number there.
fn as_it_is_but_numbers(dag: &mut Dag, node: Node) -> ExprId {
    let mut has_symbols = matches!(node, Node::Symbol(_));
    node.for_each_operand(|operand| has_symbols |= !dag.classes(operand).is_empty());
    if has_symbols { dag.intern(node) } else { dag.make(node) }
}

fn read(dag: &mut Dag, text: &str, make: fn(&mut Dag, Node) -> ExprId) -> ExprId {
    let resolve = &mut |dag: &mut Dag, name: &str| {
        let class = match name {
            "a" | "b" | "c" | "d" => SymbolClass::Configuration,
            _ => SymbolClass::Geometry,
        };
        Some(dag.symbol(name, class))
    };
    parse_with(dag, text, resolve, make).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn fixtures() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/fold");
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty());
    files
}

#[test]
fn each_law_folds_as_its_fixture_says() {
    for file in fixtures() {
        let old = fs::read_to_string(&file).unwrap();
        let (mut new, mut case) = (String::new(), None);
        for line in old.lines() {
            let is_case = new.contains("---") && !line.is_empty() && !line.starts_with("---");
            match (is_case, case, line.starts_with("= ")) {
                (true, None, false) => case = Some(line),
                (true, Some(text), true) => {
                    case = None;
                    let mut dag = Dag::new();
                    let expr = read(&mut dag, text, Dag::make);
                    new.push_str(&format!("= {}\n", print(&dag, expr)));
                    continue;
                }
                (true, ..) => panic!("{}: a case is a text and `= ` what it is", file.display()),
                (false, ..) => {}
            }
            new.push_str(line);
            new.push('\n');
        }
        if std::env::var_os("UPDATE_EXPECT").is_some() {
            fs::write(&file, &new).unwrap();
        } else {
            for (number, (new, old)) in new.lines().zip(old.lines()).enumerate() {
                assert_eq!(new, old, "{}:{}", file.display(), number + 1);
            }
        }
    }
}

/// The texts of all cases with their laws.
fn cases() -> Vec<(String, String)> {
    let mut cases = Vec::new();
    for file in fixtures() {
        let mut law = None;
        for line in fs::read_to_string(file).unwrap().lines() {
            match (line.strip_prefix("--- "), &law) {
                (Some(name), _) => law = Some(name.to_owned()),
                (None, Some(law)) if !line.is_empty() && !line.starts_with("= ") => {
                    cases.push((law.clone(), line.to_owned()));
                }
                _ => {}
            }
        }
    }
    cases
}

#[test]
fn no_law_is_without_cases() {
    let covered: BTreeSet<String> = cases().into_iter().map(|(law, _)| law).collect();
    let sources = [include_str!("fold.rs"), include_str!("fold_functions.rs")];
    let mut laws = BTreeSet::new();
    for line in sources.iter().flat_map(|source| source.lines()) {
        if let Some(comment) = line.trim().strip_prefix("// ")
            && (comment.contains(" = ") || comment.contains("+-"))
        {
            laws.insert(comment.to_owned());
        }
    }
    assert_eq!(covered, laws);
}

/// Values over `f64` at a point that depends on `seed`, by the expressions as they stand.
fn floats(dag: &Dag, exprs: &[ExprId], seed: u64) -> Result<Vec<f64>, EvaluateError> {
    let mut ring = Floats::new(|name: &str| {
        let key = name.bytes().fold(seed, |key, byte| key * 31 + u64::from(byte));
        Some(Residue::scrambled(seed, key).value() as f64 / Residue::MODULUS as f64 * 4.0 - 2.0)
    });
    evaluate(dag, exprs, &mut ring)
}

#[test]
fn each_law_is_exact() {
    // Functions of numbers are arbitrary modulo p; their laws are held against floating point.
    const OF_NUMBERS: [&str; 9] =
        ["tanh 0", "exp 0", "log 1", "sqrt(k^2)", "abs k", "sign k", "(k,", "(k <", "(a <"];
    for (law, text) in cases() {
        let mut dag = Dag::new();
        let pair = [read(&mut dag, &text, as_it_is), read(&mut dag, &text, Dag::make)];
        let exact = [read(&mut dag, &text, as_it_is_but_numbers), pair[1]];
        for seed in 1..4 {
            let values = floats(&dag, &pair, seed).unwrap();
            assert!((values[0] - values[1]).abs() < 1e-12, "{law}: {text}: {values:?}");
            let selects_itself = law.contains("(a, a)") || law.contains("(c, a, a)");
            if !selects_itself && !OF_NUMBERS.iter().any(|part| law.contains(part)) {
                let values = evaluate(&dag, &exact, &mut Residues::new(seed)).unwrap();
                assert_eq!(values[0], values[1], "{law}: {text}");
            }
        }
    }
}

/// What is counted at run time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Counted {
    ring: usize,
    div: usize,
    functions: usize,
}

/// Operations of a graph, each node once; powers of one base are made from each other.
fn operations(dag: &Dag, outputs: &[ExprId]) -> Counted {
    let mut count = Counted::default();
    let mut powers = BTreeMap::<ExprId, BTreeSet<u32>>::new();
    for expr in dag.topological(outputs) {
        if !dag.is_run_time(expr) {
            continue;
        }
        match dag.node(expr) {
            Node::Constant(_) | Node::Pi | Node::Symbol(_) | Node::Neg(_) => {}
            Node::Add(..) | Node::Sub(..) | Node::Mul(..) => count.ring += 1,
            Node::Div(_, b) if dag.is_run_time(b) => count.div += 1,
            // By a parameter: its reciprocal is made once.
            Node::Div(..) => count.ring += 1,
            Node::Pow(a, n) => {
                powers.entry(a).or_default().insert(n);
            }
            Node::Unary(..) | Node::Binary(..) | Node::Select { .. } => count.functions += 1,
        }
    }
    count.ring += powers.into_values().map(multiplications_of_powers).sum::<usize>();
    count
}

/// Multiplications that make all these powers of one base.
fn multiplications_of_powers(wanted: BTreeSet<u32>) -> usize {
    let mut made = BTreeSet::from([1]);
    for target in wanted {
        let mut missing = vec![target];
        while let Some(&n) = missing.last() {
            let is_product = made.iter().any(|&m| m < n && made.contains(&(n - m)));
            if made.contains(&n) || is_product {
                made.insert(n);
                missing.pop();
            } else {
                let odd = made.iter().rev().find(|&&m| m < n && !m.is_multiple_of(2));
                missing.push(if n.is_multiple_of(2) { n / 2 } else { n - odd.unwrap_or(&1) });
            }
        }
    }
    made.len() - 1
}

/// Whether sines and cosines have values modulo p that obey all laws: the sine of `a*p + a*r` is
/// not that of `a*(p + r)` there.
fn angles_are_sums_of_symbols(dag: &Dag) -> bool {
    let is_number = |expr| dag.as_constant(expr).is_some();
    let all: Vec<ExprId> = (0..dag.len()).map(ExprId::from_index).collect();
    let is_linear = |expr: ExprId| match dag.node(expr) {
        Node::Mul(a, b) => is_number(a) || is_number(b),
        Node::Symbol(_) | Node::Neg(_) | Node::Add(..) | Node::Sub(..) => true,
        node => is_number(expr) || node == Node::Pi,
    };
    all.iter().all(|&expr| match dag.node(expr) {
        Node::Unary(_, a) => dag.topological(&[a]).into_iter().all(is_linear),
        _ => true,
    })
}

fn never_adds_operations(kind: Kind, recipe: &[random::Step]) -> Result<(), TestCaseError> {
    let (mut raw, mut folded) = (Dag::new(), Dag::new());
    let before = build(&mut raw, kind, recipe, as_it_is_but_numbers);
    let after = build(&mut folded, kind, recipe, Dag::make);
    let values = |dag: &Dag, exprs: &[ExprId]| evaluate(dag, exprs, &mut Residues::new(3));
    let (left, right) = (values(&raw, &before), values(&folded, &after));
    if left.is_ok() && right.is_ok() && angles_are_sums_of_symbols(&raw) {
        prop_assert_eq!(left, right);
    }
    let texts = || -> Vec<String> {
        let pairs = before.iter().zip(&after);
        pairs.map(|(&a, &b)| format!("{} -> {}", print(&raw, a), print(&folded, b))).collect()
    };
    // Powers are made of squares: x^4 costs two products, as everybody writes it, but above that
    // there may be one product less, as in (x^3)^3 or where x^3 is there and x^5 = x^2 x^3.
    let is_high = |&expr: &ExprId| matches!(folded.node(expr), Node::Pow(_, 5..));
    if folded.topological(&after).iter().any(is_high) {
        return Ok(());
    }
    // All results are wanted (so that every operand has another user), or the last one alone.
    for range in [0..before.len(), before.len() - 1..before.len()] {
        let x = operations(&raw, &before[range.clone()]);
        let y = operations(&folded, &after[range]);
        let fewer = y.ring + y.div <= x.ring + x.div;
        prop_assert!(
            fewer && y.div <= x.div && y.functions <= x.functions,
            "{:?} became {:?}: {:#?}",
            x,
            y,
            texts()
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn folding_polynomials_never_adds_operations(recipe in recipes(Kind::Polynomial, 24)) {
        never_adds_operations(Kind::Polynomial, &recipe)?;
    }

    #[test]
    fn folding_trigonometry_never_adds_operations(recipe in recipes(Kind::Trigonometric, 24)) {
        never_adds_operations(Kind::Trigonometric, &recipe)?;
    }

    /// What folding answers is folded: made again, it is the same node.
    #[test]
    fn folding_is_idempotent(recipe in recipes(Kind::Any, 40)) {
        let mut dag = Dag::new();
        build(&mut dag, Kind::Any, &recipe, Dag::make);
        for index in 0..dag.len() {
            let expr = ExprId::from_index(index);
            let node = dag.node(expr);
            prop_assert_eq!(dag.make(node), expr, "{:?}: {}", node, print(&dag, expr));
        }
    }
}
