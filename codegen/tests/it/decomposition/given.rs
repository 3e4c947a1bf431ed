//! Files of equations: what they become, and what is said about wrong ones.

use crate::robots::repository;
use denavit_codegen::expr::{Dag, ExprId, text};
use denavit_codegen::fundamental::{Basis, DEFAULT_MEMORY_BYTES, Expansion, FourierError, equal};
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
    let theta = found.theta(&keep).expect("small");
    assert_eq!((theta.rank(), theta.dependent().collect::<Vec<_>>()), (8, vec![1]));
    assert!(found.holds(&theta).expect("there are values"));
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
    for (&value, source) in theta.parameters.iter().zip(expected) {
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
    for wanted in ["b", "c", "a + ", "a*y", ""] {
        let error = found.theta(&[wanted]).expect_err("no such column");
        assert!(error.to_string().contains("the columns are a"), "{error}");
    }
}

#[test]
fn equations_without_unknowns_have_no_regressor() {
    let equations = read("test.json", file(r#""x = k*y""#).as_bytes()).unwrap();
    let error = regressor(&equations).expect_err("nothing to be found");
    assert!(matches!(&error, EquationsError::NoUnknowns { name } if name == "test"), "{error}");
    // What cancels is not there.
    let equations = read("test.json", file(r#""x = a*y - y*a + k""#).as_bytes()).unwrap();
    assert!(matches!(regressor(&equations), Err(EquationsError::NoUnknowns { .. })));
}

#[test]
fn what_cannot_be_written_out_is_told() {
    for (equation, error) in [
        ("x = a/((x + y)^2 - x^2 - 2*x*y - y^2)", FourierError::DivisionByZero),
        ("x = a*((y^64)^64)^2", FourierError::ExponentTooLarge),
        ("x = a*cos(9000*y) + b*cos(y)", FourierError::ExponentTooLarge),
    ] {
        let equations = read("test.json", file(&format!("\"{equation}\"")).as_bytes())
            .unwrap_or_else(|error| panic!("{equation}: {error}"));
        let found = regressor(&equations).expect_err(equation);
        let name = "test".to_owned();
        assert_eq!(found, EquationsError::Fourier { name, error }, "{equation}");
    }
}

/// Parts of angles, angles that are products, and functions that are taken as they stand.
#[test]
fn what_was_eliminated_is_still_what_was_given() {
    for equation in [
        "0 = a*cos(x/2) + b*cos(x)",
        "y = a*cos(x/3)*cos(x/2)^2 + b*cos(pi/5 + x)",
        "0 = a*cos(k/2 + x/3)*sin(x/(2*k)) + b*cos(k)*sin(x/k)",
        "0 = a*cos(x*y/4) + b*cos(k*x) + a*b*cos(x*y)",
        "x = (a + b)^3*tan(y) + a*sqrt(x) + b*exp(-abs(y))",
        "x = a*x/(x + y) + b*k/(1 + k)*y",
    ] {
        let equations = read("test.json", file(&format!("\"{equation}\"")).as_bytes())
            .unwrap_or_else(|error| panic!("{error}"));
        let mut found = regressor(&equations).unwrap_or_else(|error| panic!("{error}"));
        let theta = found.theta::<&str>(&[]).expect("small");
        assert_eq!(found.holds(&theta), Ok(true), "{equation}");
        // Another sum is something else.
        let mut wrong = theta.clone();
        wrong.parameters[0] = found.dag.one();
        assert_eq!(found.holds(&wrong), Ok(false), "{equation}");
    }
}

/// Relations between functions that the canonical form does not know are seen at points.
#[test]
fn columns_that_only_points_show_to_depend_are_refused() {
    for (equation, rank, at_points) in [
        ("y = a*sin(x)^2/cos(x)^2 + b/cos(x)^2 + a*b", 3, 2),
        ("y = a*tan(x) + b*sin(x)/cos(x)", 2, 1),
    ] {
        let equations = read("test.json", file(&format!("\"{equation}\"")).as_bytes())
            .unwrap_or_else(|error| panic!("{error}"));
        let mut found = regressor(&equations).unwrap_or_else(|error| panic!("{error}"));
        let theta = found.theta::<&str>(&[]).expect("small");
        let name = "test".to_owned();
        let expected = EquationsError::Related { name, rank, at_points };
        assert_eq!(found.holds(&theta), Err(expected), "{equation}");
    }
}

/// Units of products, where all their factors have one.
#[test]
fn columns_have_the_units_of_their_products() {
    let source = file(r#""x = a^2*b*y + b*x""#)
        .replace(r#""a": {}"#, r#""a": {"unit": "m"}"#)
        .replace(r#""b": {}"#, r#""b": {"unit": "kg"}"#);
    let equations = read("test.json", source.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    let found = regressor(&equations).expect("polynomials");
    let kg_m2 = denavit_codegen::model::Unit::parse("kg m^2").unwrap().dimension();
    assert_eq!(found.units, [kg_m2.to_string(), "kg".to_owned()]);
    let bare = read("test.json", file(r#""x = a*b*y""#).as_bytes()).unwrap();
    assert_eq!(regressor(&bare).expect("polynomials").units, [""]);
}

/// A variable named after another one is its rate: it is set so.
#[test]
fn rates_are_known_by_their_names() {
    use denavit_codegen::emit::latex::{Notation, write_expression};
    let source = file(r#""x = a*xd + b*xdd + k*yd""#)
        .replace(r#""y": {}"#, r#""xd": {}, "xdd": {}, "yd": {}"#);
    let equations = read("test.json", source.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
    let notation = Notation::of_equations(&equations.dag);
    let set = |variable: usize| {
        write_expression(&equations.dag, equations.variables[variable].symbol, &notation)
    };
    assert_eq!([set(0), set(1), set(2)], ["x", r"\dot{x}", r"\ddot{x}"]);
    assert!(!set(3).contains("dot"), "there is no y");
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
    assert!(said.contains("docs/reference/equations.md"), "{said}");
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
