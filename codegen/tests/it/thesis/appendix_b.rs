//! Appendix B: what its listing does as it is printed, and what comes out instead.

use crate::robots::repository;
use denavit_codegen::expr::{Dag, SymbolClass, text};
use denavit_codegen::fundamental::{Basis, DEFAULT_MEMORY_BYTES, Expansion, equal};
use denavit_codegen::model::equations::read;
use denavit_codegen::regressor::Theta;
use denavit_codegen::regressor::equations::{EquationsRegressor, equations_regressor};

fn regressor(source: &[u8]) -> EquationsRegressor {
    let equations = read("equations.json", source).unwrap_or_else(|error| panic!("{error}"));
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
    equations_regressor(&equations, Basis::Product, &mut expansion).expect("polynomials")
}

/// A.79 and A.80, with the columns in the order of A.84.
fn pendulum() -> (EquationsRegressor, Theta) {
    let path = repository().join("models/equations/double_pendulum_drives.json");
    let mut found = regressor(&std::fs::read(path).unwrap());
    let keep = ["c2*m2", "c1*m1", "m2", "c1^2*m1 + I1", "c2^2*m2 + I2"];
    let theta = found.theta(&keep).expect("small");
    (found, theta)
}

/// One equation `0 = ..` in variables x, y, knowns l1, k and unknowns a, b, l10.
fn equation(right: &str) -> EquationsRegressor {
    let source = format!(
        r#"{{"format": "denavit-equations/1", "name": "one",
 "variables": {{"x": {{}}, "y": {{}}}}, "knowns": {{"l1": 1, "k": 2}},
 "unknowns": {{"a": {{}}, "b": {{}}, "l10": {{}}}}, "equations": ["0 = {right}"]}}"#
    );
    regressor(source.as_bytes())
}

fn parse(dag: &mut Dag, source: &str) -> denavit_codegen::expr::ExprId {
    let mut resolve = |dag: &mut Dag, name: &str| match dag.find_symbol(name) {
        Some(id) => Some(dag.symbol_expr(id)),
        None => Some(dag.symbol(name, SymbolClass::Geometry)),
    };
    text::parse(dag, source, &mut resolve).expect(source)
}

/// The listing's ending, on the columns `parameters` (`1` for what has no unknowns): y, and the
/// columns that stay.
///
/// `n = find(ts==1, 1); if isempty(n) .. y = Ds(:,n); Ds(:,n) = []; else y = zeros(..); end`, as
/// printed or with `~isempty(n)`.
fn known_column<'a>(parameters: &[&'a str], as_printed: bool) -> (Option<usize>, Vec<&'a str>) {
    let n = parameters.iter().position(|parameter| *parameter == "1");
    let moves = if as_printed { n.is_none() } else { n.is_some() };
    // Deleting the columns of an empty list deletes none.
    let y = n.filter(|_| moves);
    let kept = parameters.iter().enumerate().filter(|(column, _)| y != Some(*column));
    (y, kept.map(|(_, parameter)| *parameter).collect())
}

#[test]
fn the_conditions_on_emptiness_are_inverted() {
    let columns = ["a", "1", "b"];
    assert_eq!(known_column(&columns, true), (None, columns.to_vec()), "y = 0, 1 is an unknown");
    let (y, kept) = known_column(&columns, false);
    assert_eq!((y, kept), (Some(1), vec!["a", "b"]));
    // `if isempty(D{i,j}) Ds(i,j) = sym(..)`, and the same for Bt: of the entries of R0 = [a: x,
    // b: 0] the empty one alone would be taken over.
    let cells = [Some("x"), None];
    let taken = |as_printed: bool| -> Vec<&str> {
        cells.iter().filter(|cell| cell.is_none() == as_printed).flatten().copied().collect()
    };
    assert_eq!((taken(true), taken(false)), (vec![], vec!["x"]));
    let found = equation("a*x + k*y + b*y");
    assert_eq!(found.column_names(), ["a", "b"]);
}

/// `y = Ds(:,n)`: what is moved to the other side changes its sign.
#[test]
fn the_known_column_needs_a_minus_sign() {
    let mut found = equation("a*x + k*y");
    let (left, moved, printed) =
        (found.left[0], parse(&mut found.dag, "-k*y"), parse(&mut found.dag, "k*y"));
    assert_eq!(equal(&mut found.dag, left, moved), Ok(true));
    assert_eq!(equal(&mut found.dag, left, printed), Ok(false));
}

/// `while i<=size(Bt,2) if (Bt(i,i)==1) delete column i; else i = i+1; end end`, on B_E, as printed
/// or with ~=1. Returns the columns that stay.
fn loop_of_the_listing(theta: &Theta, order: &[usize], as_printed: bool) -> Vec<usize> {
    let mut stay = order.to_vec();
    let mut i = 0;
    while i < stay.len() {
        let entry = theta.echelon.rows.get(i).and_then(|row| row.get(&stay[i]));
        let is_one = entry.is_some_and(|entry| entry.is_one());
        if is_one == as_printed {
            stay.remove(i);
        } else {
            i += 1;
        }
    }
    stay
}

#[test]
fn the_loop_deletes_the_pivots() {
    let (found, theta) = pendulum();
    let dependent: Vec<usize> = theta.dependent().collect();
    let [dependent] = dependent[..] else { panic!("one column depends on others") };
    // The order of A.84: column 4 depends.
    let mut order = theta.echelon.pivots.clone();
    order.insert(3, dependent);
    assert_eq!(order.len(), found.parameters.len());
    assert_eq!(loop_of_the_listing(&theta, &order, false), theta.echelon.pivots);
    let printed = loop_of_the_listing(&theta, &order, true);
    assert!(printed.contains(&dependent) && !printed.contains(&order[0]), "{printed:?}");
}

/// `if isempty(m) f = [f;a]; B{length(f),n,r} = ..; if n<=size(B,2) .. end`: without an else, what
/// belongs to a function that is there already is never stored. (`[Bm,n,r e..]` for
/// `[B{m,n,r} e..]` is no expression of the language at all.)
#[test]
fn without_an_else_entries_of_known_functions_are_lost() {
    let (found, _) = pendulum();
    let mut terms: Vec<_> = found
        .decomposition
        .columns
        .iter()
        .enumerate()
        .flat_map(|(column, entries)| entries.iter().map(move |e| (e.equation, column, e.function)))
        .collect();
    terms.sort_unstable();
    let mut functions = Vec::new();
    let mut stored = 0;
    for (_, _, function) in &terms {
        if !functions.contains(function) {
            functions.push(*function);
            stored += 1;
        }
    }
    assert_eq!((terms.len(), stored), (19, 11), "one entry of each function is stored");
}

/// `isk = [isk strfind(mds, kp{k})]`: a name within another name is found.
#[test]
fn names_are_found_within_names() {
    let strfind = |text: &str, name: &str| text.contains(name);
    assert!(strfind("l10", "l1") && strfind("m10", "m1"), "l10 is taken for the known l1");
    let found = equation("l10*x + a*l1*y");
    assert_eq!(found.column_names(), ["a", "l10"]);
}

/// `pmop = sort([strfind(e,'+') strfind(e,'-') ..])`: an equation is cut at every sign.
#[test]
fn signs_within_terms_cut_them_apart() {
    for (term, entries) in [("a*sin(x - y)", 2), ("a*x^(-2)", 1), ("1e-3*a*x", 1)] {
        let pieces: Vec<&str> = term.split(['+', '-']).collect();
        assert_eq!(pieces.len(), 2, "{term}");
        let mut dag = Dag::new();
        let mut resolve = |dag: &mut Dag, name: &str| Some(dag.symbol(name, SymbolClass::Geometry));
        let mut readable = |piece: &str| text::parse(&mut dag, piece, &mut resolve).is_ok();
        assert!(!pieces.iter().all(|piece| readable(piece)), "{pieces:?}");
        let found = equation(term);
        assert_eq!(
            (found.column_names(), found.decomposition.nonzeros()),
            (vec!["a".into()], entries)
        );
    }
}
