//! Files of equations: what they become, and what is said about wrong ones.

use crate::robots::repository;
use denavit_codegen::expr::{Dag, ExprId, text};
use denavit_codegen::fundamental::{Basis, DEFAULT_MEMORY_BYTES, Expansion, equal};
use denavit_codegen::model::equations::{Equations, is_equations_file, read, schema};
use denavit_codegen::regressor::equations::{
    EquationsError, EquationsRegressor, equations_regressor,
};

fn shipped() -> Vec<u8> {
    std::fs::read(repository().join("models/equations/double_pendulum_drives.json")).unwrap()
}

fn regressor(equations: &Equations) -> Result<EquationsRegressor, EquationsError> {
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
    equations_regressor(equations, Basis::Product, &mut expansion)
}

fn parse(dag: &mut Dag, source: &str) -> ExprId {
    let mut resolve = |dag: &mut Dag, name: &str| {
        let id = dag.find_symbol(name)?;
        Some(dag.symbol_expr(id))
    };
    text::parse(dag, source, &mut resolve).expect(source)
}

/// A file with these variables, knowns, unknowns and equations.
fn file(equations: &str) -> String {
    format!(
        r#"{{"format": "denavit-equations/1", "name": "test",
 "variables": {{"x": {{}}, "y": {{}}}}, "knowns": {{"k": 2}}, "unknowns": {{"a": {{}}, "b": {{}}}},
 "equations": [{equations}]}}"#
    )
}

fn faults(source: &str) -> String {
    read("test.json", source.as_bytes()).expect_err(source).to_string()
}

#[test]
fn the_file_of_the_double_pendulum_has_the_base_parameters_of_a93() {
    assert!(is_equations_file(&shipped()));
    let equations =
        read("double_pendulum_drives.json", &shipped()).unwrap_or_else(|e| panic!("{e}"));
    let mut found = regressor(&equations).expect("polynomials");
    assert_eq!(found.decomposition.functions.len(), 11);
    assert_eq!((found.decomposition.shape(), found.decomposition.nonzeros()), ((22, 9), 19));
    let keep = ["c2*m2", "c1*m1", "m2", "c1^2*m1 + I1", "c2^2*m2 + I2"];
    let (echelon, theta) = found.base_parameters(&keep).expect("small");
    assert_eq!(echelon.rank(), 8);
    let expected = [
        "c2*m2",
        "m1*c1 - 1/l1*(m1*c1^2 + I1)",
        "m2 + 1/l1^2*(m1*c1^2 + I1)",
        "c2^2*m2 + I2",
        "BM1",
        "Fc1",
        "BM2",
        "Fc2",
    ];
    assert_eq!(theta.len(), expected.len());
    for (&value, source) in theta.iter().zip(expected) {
        let expected = parse(&mut found.dag, source);
        assert_eq!(equal(&mut found.dag, value, expected), Ok(true), "{source}");
    }
    let left = found.left[0];
    let expected = parse(&mut found.dag, "tauM1 - IM1*N1*th1dd");
    assert_eq!(equal(&mut found.dag, left, expected), Ok(true));
}

/// Appendix B searched substrings and split at signs: l1 was found in l10, and sin(a - b) broke.
#[test]
fn names_within_names_and_signs_within_functions_are_read() {
    let source = file(r#""0 = a*x*sin(x - y) - ab*k1*x^2 + 1e-3*a + b/k""#)
        .replace(r#""k": 2"#, r#""k": 2, "k1": 3"#)
        .replace(r#""b": {}"#, r#""b": {}, "ab": {}"#);
    let equations = read("test.json", source.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    let found = regressor(&equations).expect("polynomials");
    assert_eq!(found.column_names(), ["a", "b", "ab"]);
    let sizes: Vec<usize> = found.decomposition.columns.iter().map(Vec::len).collect();
    // a: x s1 c2, x c1 s2, 1
    assert_eq!(sizes, [3, 1, 1]);
}

#[test]
fn unknowns_must_be_factors() {
    for (equation, unknown) in
        [("0 = sin(a*x)", "a"), ("x = y/b", "b"), ("x = sign(b)*y", "b"), ("x = y/(a + b)", "a")]
    {
        let equations = read("test.json", file(&format!("\"{equation}\"")).as_bytes()).unwrap();
        let error = regressor(&equations).expect_err(equation);
        let EquationsError::NotPolynomial { unknown: found, .. } = &error else {
            panic!("{error}")
        };
        assert_eq!(found, unknown, "{equation}");
    }
}

#[test]
fn a_column_to_keep_must_be_there() {
    let equations = read("test.json", file(r#""x = a*y""#).as_bytes()).unwrap();
    let mut found = regressor(&equations).expect("polynomials");
    let error = found.base_parameters(&["b"]).expect_err("no column b");
    assert!(error.to_string().contains("the columns are a"), "{error}");
}

#[test]
fn all_faults_are_told_at_once_with_their_places() {
    let said = faults(&file(r#""x + y", "a = = b", "x = c", "x = (y""#));
    for part in [
        "test.json:3:16: /equations/0: \"x + y\" is not an equation",
        "/equations/1: \"a = = b\" is not an equation",
        "/equations/2: ",
        "/equations/3: ",
        "write two expressions with one = between them",
    ] {
        assert!(said.contains(part), "{part} is missing in:\n{said}");
    }
    assert!(faults(&file("")).contains("there is no equation"));
    let said = faults(&file(r#""x = y""#).replace("equations/1", "equations/2"));
    assert!(said.contains("docs/equations.md"), "{said}");
    let said = faults(&file(r#""x = y""#).replace(r#""b": {}"#, r#""x": {}"#));
    assert!(said.contains("the name `x` is already that of another symbol"), "{said}");
    let said = faults(&file(r#""x = y""#).replace(r#""y": {}"#, r#""y": 3"#));
    assert!(said.contains("/variables/y: expected an object"), "{said}");
    assert!(faults("[]").contains("expected an object"));
    assert!(!is_equations_file(b"{\"format\": \"denavit-model/1\"}"));
}

#[test]
fn units_are_checked_where_they_are_given() {
    let units = file(r#""x = a + k""#)
        .replace(r#""a": {}"#, r#""a": {"unit": "kg"}"#)
        .replace(r#""k": 2"#, r#""k": {"value": 2, "unit": "m"}"#);
    assert!(faults(&units).contains("/equations/0"), "{}", faults(&units));
}

#[test]
fn the_schema_takes_the_shipped_file_and_refuses_other_keys() {
    let schema: serde_json::Value = serde_json::from_str(schema()).unwrap();
    let schema = jsonschema::validator_for(&schema).unwrap();
    let mut file: serde_json::Value = serde_json::from_slice(&shipped()).unwrap();
    assert!(schema.is_valid(&file));
    file["constants"] = serde_json::json!({});
    assert!(!schema.is_valid(&file));
}
