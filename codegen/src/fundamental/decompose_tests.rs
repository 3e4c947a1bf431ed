//! Decompositions hold the matrix that they came from, in every basis.

use super::*;
use crate::expr::random::{Kind, build, recipes};
use crate::expr::{Dag, ExprId, Residues, SymbolClass, SymbolId, angle_atoms, evaluate, text};
use proptest::prelude::*;

fn read(dag: &mut Dag, source: &str) -> ExprId {
    let mut resolve = |dag: &mut Dag, name: &str| {
        let is_known = ["l", "m", "alpha"].iter().any(|known| name.starts_with(known));
        let class = if is_known { SymbolClass::Geometry } else { SymbolClass::Configuration };
        Some(dag.symbol(name, class))
    };
    text::parse(dag, source, &mut resolve).expect(source)
}

fn try_all(
    dag: &mut Dag,
    rows: &[Vec<ExprId>],
    chains: &[Vec<ExprId>],
    memory_bytes: usize,
) -> Result<Vec<Decomposition>, FourierError> {
    let symbols = dag.symbols().clone();
    let is_known = |id: SymbolId| symbols[id].class == SymbolClass::Geometry;
    let matrix = Matrix { rows, is_known: &is_known, chains };
    let mut expansion = Expansion { memory_bytes, progress: &mut |_| {} };
    decompose(dag, &matrix, &Basis::ALL, &mut expansion)
}

/// f^T B, entry by entry.
fn recomposed(dag: &mut Dag, found: &Decomposition) -> Vec<Vec<ExprId>> {
    let functions: Vec<_> = found.functions.iter().map(|f| f.to_expr(dag)).collect();
    let coefficients: Vec<_> = found.coefficients.iter().map(|c| c.to_expr(dag)).collect();
    let mut rows = vec![vec![dag.zero(); found.columns.len()]; found.equations];
    for (column, entries) in found.columns.iter().enumerate() {
        for entry in entries {
            let function = functions[entry.function as usize];
            let product = dag.mul(coefficients[entry.coefficient as usize], function);
            let place = &mut rows[entry.equation as usize][column];
            *place = dag.add(*place, product);
        }
    }
    rows
}

fn assert_same(dag: &Dag, left: &[Vec<ExprId>], right: &[Vec<ExprId>]) {
    let texts = || right.concat().iter().map(|&expr| text::print(dag, expr)).collect::<Vec<_>>();
    for seed in 1..4 {
        let at = |rows: &[Vec<ExprId>]| evaluate(dag, &rows.concat(), &mut Residues::new(seed));
        let (left, right) = (at(left), at(right));
        assert!(left.is_ok(), "{left:?}");
        assert_eq!(left, right, "{:?}", texts());
    }
}

fn check(sources: &[&str], chain: &[&str]) -> Vec<Decomposition> {
    let mut dag = Dag::new();
    let row: Vec<ExprId> = sources.iter().map(|source| read(&mut dag, source)).collect();
    let chain: Vec<ExprId> = chain.iter().map(|name| read(&mut dag, name)).collect();
    let found = try_all(&mut dag, std::slice::from_ref(&row), &[chain], DEFAULT_MEMORY_BYTES)
        .expect("small");
    for decomposition in &found {
        let rows = recomposed(&mut dag, decomposition);
        assert_same(&dag, &rows, std::slice::from_ref(&row));
    }
    found
}

#[test]
fn each_basis_has_its_own_functions() {
    let found = check(&["l1*cos(q1)*cos(q2)", "l1*cos(q1 + q2)"], &["q1", "q2"]);
    let sizes: Vec<_> = found.iter().map(|f| (f.basis, f.functions.len(), f.nonzeros())).collect();
    // cos(q1+q2), cos(q1-q2) | c1 c2, s1 s2 | with phi = q1 + q2: c1^2 cp + c1 s1 sp, cp
    let expected = [(Basis::Fourier, 2, 3), (Basis::Product, 2, 3), (Basis::Cumulated, 3, 3)];
    assert_eq!(sizes, expected);
}

#[test]
fn higher_powers_and_many_angles_come_apart() {
    check(
        &["cos(q1)^5*sin(q2)^3 - l2", "sin(3*q1 - 2*q2 + q3)*q1d", "cos(q3 + pi/2)"],
        &["q1", "q2", "q3"],
    );
}

#[test]
fn known_angles_stay_in_the_coefficients() {
    let found = check(&["l1*cos(q1 + alpha1)", "sin(2*alpha1 - alpha2 - q1)/m2"], &[]);
    assert_eq!(found.len(), 2, "no two angles are in one group");
    for decomposition in &found {
        assert_eq!(decomposition.functions.len(), 2, "cos q1 and sin q1");
    }
}

#[test]
fn known_sums_divide_as_one_factor() {
    let found = check(&["q1d/(l1 + l2) + 2*q1d/(l1 + l2)", "q1d/(l1*m1^2)"], &[]);
    assert_eq!((found[0].functions.len(), found[0].coefficients.len()), (1, 2));
}

#[test]
fn numbers_inside_a_product_are_part_of_the_multiple() {
    // The graph may write 2 (q2 sin q1) as q2 (2 sin q1): one angle all the same.
    check(
        &[
            "sin(q2*sin(q1))^2 + q2*sin(q2*sin(q1))",
            "cos(2*(q2*sin(q1)) - 3*q1)",
            "sin(q1*q2)*sin(q2)",
        ],
        &[],
    );
    let found = check(&["cos(2*(q1*q2)) - 2*cos(q1*q2)^2", "cos(q1*q1/q2)*sin(3*q1^2/q2)"], &[]);
    assert_eq!(found[0].columns[0].len(), 1, "it is -1");
}

#[test]
fn powers_of_many_factors_do_not_overflow() {
    let found = check(&["cos(80*q1) + sin(3*q1)"], &[]);
    let sizes: Vec<_> = found.iter().map(|f| f.functions.len()).collect();
    // cos 80 q, sin 3 q | c^0 to c^80 (T_80 has numbers near 2^79), s, c^2 s
    assert_eq!(sizes, [2, 43]);
}

#[test]
fn large_numbers_are_exact() {
    let found = check(&["(123456789*cos(q1) + 1/987654321)^6"], &[]);
    assert_eq!(found[0].functions.len(), 7, "1 and cos(k q1) up to k = 6");
}

#[test]
fn many_indeterminates_take_a_wider_key() {
    let sum: Vec<String> = (1..=60).map(|i| format!("cos(q{i})*p{i}^3")).collect();
    let found = check(&[&sum.join(" + ")], &[]);
    assert_eq!(found[0].functions.len(), 60);
}

#[test]
fn too_many_terms_are_a_clear_error() {
    let mut dag = Dag::new();
    let product: Vec<String> = (1..=24).map(|i| format!("(cos(q{i}) + p{i})")).collect();
    let expr = read(&mut dag, &product.join("*"));
    let error = try_all(&mut dag, &[vec![expr]], &[], 1 << 20).expect_err("16 million terms");
    assert!(matches!(error, FourierError::Memory { limit_bytes, .. } if limit_bytes == 1 << 20));
    assert!(error.to_string().contains("1 MiB"), "{error}");
}

#[test]
fn products_of_high_multiples_are_kept_within_memory() {
    // One term of the Fourier basis, some 1000^4 of the product basis.
    let mut dag = Dag::new();
    let expr = read(&mut dag, "cos(1000*q1 + 1000*q2 + 1000*q3 + 1000*q4)");
    let error = try_all(&mut dag, &[vec![expr]], &[], 1 << 22).expect_err("it does not fit");
    assert!(matches!(error, FourierError::Memory { limit_bytes, .. } if limit_bytes == 1 << 22));
}

#[test]
fn a_division_by_zero_is_an_error() {
    let mut dag = Dag::new();
    let expr = read(&mut dag, "1/((l1 + l2)^2 - l1^2 - 2*l1*l2 - l2^2)");
    let found = try_all(&mut dag, &[vec![expr]], &[], DEFAULT_MEMORY_BYTES);
    assert_eq!(found.err(), Some(FourierError::DivisionByZero));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// (a + b)^2 - a^2 - 2 a b - b^2 = 0, term by term, and a b is what its parts say it is.
    #[test]
    fn products_are_those_of_a_ring(recipe in recipes(Kind::Trigonometric, 12)) {
        let mut dag = Dag::new();
        let results = build(&mut dag, Kind::Trigonometric, &recipe, Dag::make);
        let (a, b) = (results[results.len() - 1], results[results.len() / 2]);
        let sum = dag.add(a, b);
        let square = dag.mul(sum, sum);
        let [aa, ab, bb] = [(a, a), (a, b), (b, b)].map(|(x, y)| dag.mul(x, y));
        let parts = [aa, ab, ab, bb].into_iter().fold(square, |rest, part| dag.sub(rest, part));
        let rows = vec![vec![parts, ab, a]];
        // At random points modulo p half an angle has a point of its own.
        let has_fractions = dag.topological(&rows[0]).into_iter().any(|expr| {
            let angle = layout::as_wave(&dag, expr).map(|(angle, _)| angle_atoms(&dag, angle));
            angle.is_some_and(|angle| angle.values().any(|multiple| !multiple.is_integer()))
        });
        if let Ok(found) = try_all(&mut dag, &rows, &[], 1 << 22) {
            for decomposition in &found {
                prop_assert!(decomposition.columns[0].is_empty());
                if !has_fractions {
                    let again = recomposed(&mut dag, decomposition);
                    assert_same(&dag, &again, &rows);
                }
            }
        }
    }
}
