//! `denavit decompose`: f and B, of models and of given equations.

use super::{Directory, Run, answer, json, run_in};
use denavit::expr::text::parse;
use denavit::expr::{Dag, Floats, SymbolClass, evaluate};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

fn texts(list: &Value) -> Vec<String> {
    let list = list.as_array().expect("a list");
    list.iter().map(|text| text.as_str().expect("a text").to_owned()).collect()
}

/// The value of a formula at a point that depends on the names alone.
fn value(formula: &str) -> f64 {
    let mut dag = Dag::new();
    let mut resolve = |dag: &mut Dag, name: &str| Some(dag.symbol(name, SymbolClass::Geometry));
    let expr = parse(&mut dag, formula, &mut resolve).expect(formula);
    let at = |name: &str| {
        let mixed = name.bytes().fold(7_u32, |sum, byte| sum * 31 % 1009 + u32::from(byte));
        Some(0.3 + f64::from(mixed % 997) / 500.0)
    };
    evaluate(&dag, &[expr], &mut Floats::new(at)).expect(formula)[0]
}

/// f^T B theta0, equation by equation.
fn right_sides(found: &Value) -> Vec<f64> {
    let functions: Vec<f64> = texts(&found["functions"]).iter().map(|f| value(f)).collect();
    let columns: Vec<f64> = texts(&found["columns"]).iter().map(|c| value(c)).collect();
    let mut sums = vec![0.0; found["equations"].as_array().expect("equations").len()];
    for entry in found["entries"].as_array().expect("entries") {
        let at = |key: &str| entry[key].as_u64().expect("a number") as usize;
        let factor = value(entry["value"].as_str().expect("a formula"));
        sums[at("equation")] += functions[at("function")] * factor * columns[at("column")];
    }
    sums
}

/// A.86, and that zeta = f^T B theta0 is A.79 and A.80 again.
#[test]
fn equations_of_the_thesis_have_its_functions_and_come_together_again() {
    for basis in ["product", "fourier"] {
        let found = json(&["decompose", "double_pendulum_drives", "--basis", basis, "--json"]);
        let left: Vec<f64> = texts(&found["left"]).iter().map(|side| value(side)).collect();
        for (row, equation) in texts(&found["equations"]).iter().enumerate() {
            let (torque, right) = equation.split_once('=').expect("an equation");
            let ours = left[row] - right_sides(&found)[row];
            assert!((ours - (value(torque) - value(right))).abs() < 1e-11, "{basis}: {equation}");
        }
        if basis == "product" {
            assert_eq!((&found["rows"], &found["nonzeros"]), (&22.into(), &19.into()));
            let printed = [
                "cos(th1)*cos(th2)",
                "sin(th1)*sin(th2)",
                "th1dd*cos(th2)",
                "th2dd*cos(th2)",
                "cos(th1)",
                "th1dd",
                "th2dd",
                "th1d",
                "sign(th1d)",
                "th2d",
                "sign(th2d)",
            ];
            let found: BTreeSet<String> = texts(&found["functions"]).into_iter().collect();
            assert_eq!(found, printed.map(str::to_owned).into());
        }
    }
}

/// Without the Coriolis terms there are fewer functions; sizes are those of the count that
/// another program made.
#[test]
fn models_have_the_counted_functions_in_the_smallest_basis() {
    for (arguments, basis, functions) in [
        (&["planar_2r", "--terms", "inertia,gravity"][..], "fourier", 10),
        (&["planar_2r"], "fourier", 16),
        (&["planar_2r", "--basis", "product"], "product", 18),
        (&["puma560", "--terms", "inertia,gravity"], "cumulated", 865),
    ] {
        let found = json(&[&["decompose", "--json"][..], arguments].concat());
        let names = texts(&found["functions"]);
        assert_eq!((&found["basis"], names.len()), (&basis.into(), functions), "{arguments:?}");
        let distinct: BTreeSet<String> = names.into_iter().collect();
        assert_eq!(distinct.len(), functions, "{arguments:?}");
    }
}

#[test]
fn what_is_short_is_printed_and_what_is_long_is_summed_up() {
    for (arguments, name) in [
        (&["decompose", "double_pendulum_drives", "--basis", "product", "--echelon"][..], "drives"),
        (&["decompose", "double_pendulum", "--terms", "inertia,gravity"], "double_pendulum"),
    ] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"));
        let path = path.join(format!("tests/golden/decompose_{name}.txt"));
        let printed = answer(arguments);
        if std::env::var_os("UPDATE_EXPECT").is_some() {
            std::fs::write(&path, &printed).expect("the golden file");
        }
        let golden = std::fs::read_to_string(&path).expect("the golden file");
        assert_eq!(printed, golden, "{arguments:?}; UPDATE_EXPECT=1 writes it anew");
    }
    let long = answer(&["decompose", "puma560"]);
    assert!(long.lines().count() < 5 && long.contains("JSON"), "{long}");
}

/// A.93, entry 2 with the sign of docs/evidence/errata.md, in this order.
const A93: [&str; 8] = [
    "c2*m2",
    "c1*m1 - (m1*c1^2 + I1)/l1",
    "m2 + (m1*c1^2 + I1)/l1^2",
    "c2^2*m2 + I2",
    "BM1",
    "Fc1",
    "BM2",
    "Fc2",
];

fn is_a93(parameters: &Value) {
    let parameters = parameters.as_array().expect("parameters");
    assert_eq!(parameters.len(), 8);
    for (parameter, formula) in parameters.iter().zip(A93) {
        let ours = value(parameter["expression"].as_str().expect("a formula"));
        assert!((ours - value(formula)).abs() < 1e-12, "{parameter}: {formula}");
        let members = parameter["members"].as_object().expect("members");
        let sum: f64 = members
            .iter()
            .map(|(name, factor)| value(name) * value(factor.as_str().expect("a factor")))
            .sum();
        assert!((sum - ours).abs() < 1e-12, "{parameter}");
        assert_eq!(parameter["alone"], members.len() == 1);
    }
}

#[test]
fn equations_have_the_base_parameters_of_the_thesis() {
    let keep = "c2*m2,c1*m1,m2,c1^2*m1 + I1,c2^2*m2 + I2";
    let base = json(&["base", "double_pendulum_drives", "--keep", keep, "--json"]);
    assert_eq!((&base["model"], &base["rank"]), (&"double_pendulum_drives".into(), &8.into()));
    is_a93(&base["parameters"]);
    assert_eq!(base["certificate"]["verified"], true);
    let dependent = &base["dependent"][0];
    assert_eq!(dependent["name"], "I1 + m1*c1^2");
    // column 4 = -(1/l1) column 2 + (1/l1^2) column 3
    let relation = value(dependent["relation"].as_str().expect("a formula"));
    assert!((relation - value("-c1*m1/l1 + m2/l1^2")).abs() < 1e-12, "{dependent}");
    let units: Vec<&str> = base["parameters"]
        .as_array()
        .expect("parameters")
        .iter()
        .map(|parameter| parameter["unit"].as_str().expect("a unit"))
        .collect();
    assert_eq!(units[4..], ["N m s/rad", "N m", "N m s/rad", "N m"]);
    let again = ["--basis", "product", "--echelon", "--keep", keep, "--json"];
    let found = json(&[&["decompose", "double_pendulum_drives"][..], &again].concat());
    is_a93(&found["echelon"]["parameters"]);
    let said = answer(&["base", "double_pendulum_drives"]);
    assert!(said.contains("8 base parameters of 9 columns"), "{said}");
}

/// Two routes: elimination of B here, the structure of the tree there.
#[test]
fn models_have_the_base_parameters_of_the_other_route() {
    for (model, with, rank) in
        [("double_pendulum", "friction", 8), ("planar_2r", "friction,rotor,offset", 13)]
    {
        let found = json(&["decompose", model, "--with", with, "--echelon", "--json"]);
        let base = json(&["base", model, "--with", with, "--json"]);
        assert_eq!(found["columns"], base["columns"], "{model}");
        assert_eq!(found["echelon"]["rank"], rank, "{model}");
        assert_eq!(found["echelon"]["zero"], base["zero"], "{model}");
        let names = |parameters: &Value| -> Vec<Value> {
            let list = parameters.as_array().expect("parameters");
            list.iter().map(|parameter| parameter["name"].clone()).collect()
        };
        let (ours, theirs) = (&found["echelon"]["parameters"], &base["parameters"]);
        assert_eq!(names(ours), names(theirs), "{model}");
    }
}

#[test]
fn f_and_b_are_set_as_a_document() {
    let directory = Directory::new("decompose-latex");
    let arguments = ["decompose", "double_pendulum_drives", "--latex", "drives.tex", "--echelon"];
    let run = run_in(&directory.path, &arguments);
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
    assert!(run.stdout.ends_with("wrote drives.tex\n"), "{}", run.stdout);
    let text = std::fs::read_to_string(directory.path.join("drives.tex")).expect("the document");
    assert!(text.contains(r"\documentclass") && text.trim_end().ends_with(r"\end{document}"));
    let same = answer(&["decompose", "double_pendulum_drives", "--echelon", "--latex", "-"]);
    assert_eq!(same, text);
}

#[test]
fn the_schema_of_equations_is_printed() {
    let schema = json(&["schema", "equations"]);
    assert!(schema.to_string().contains("denavit-equations/1"));
    assert_eq!(schema, json(&["schema", "denavit-equations/1", "--json"]));
}

fn refused(directory: &Directory, arguments: &[&str]) -> String {
    let Run { code, stdout, stderr } = run_in(&directory.path, arguments);
    assert_eq!((code, stdout.as_str()), (Some(2), ""), "{arguments:?}: {stderr}");
    assert!(!stderr.contains("panicked"), "{stderr}");
    stderr
}

#[test]
fn what_does_not_fit_the_memory_or_has_no_such_basis_is_refused() {
    let directory = Directory::new("decompose");
    let said = refused(&directory, &["decompose", "iiwa", "--memory", "1"]);
    assert!(said.contains("1 MiB") && said.contains("hint: "), "{said}");
    let said = refused(&directory, &["decompose", "iiwa", "--basis", "cumulated"]);
    assert!(said.contains("parallel axes") && said.contains("hint: "), "{said}");
    let said = refused(&directory, &["decompose", "double_pendulum_drivers"]);
    assert!(said.contains("hint: `double_pendulum_drives`"), "{said}");
    // a good file for another command is said to be one
    let said = refused(&directory, &["inspect", "double_pendulum_drives"]);
    assert!(said.contains("a file of equations") && said.contains("denavit decompose"), "{said}");
}

/// Faults of equations, each with what is said about it.
#[test]
fn wrong_equations_are_told_where_and_why() {
    let file = |names: &str, equation: &str| {
        format!(
            r#"{{"format": "denavit-equations/1", "name": "wrong", "variables": {{"x": {{}}}},
 "knowns": {{"k": 2}}, "unknowns": {{{names}}}, "equations": ["{equation}"]}}"#
        )
    };
    let a = r#""a": {}"#;
    for (text, said) in [
        (file(a, "x = a*w"), "/equations/0: in \"a*w\": nothing is called `w`"),
        (file(a, "x = a*w"), "\"knowns\": {\"w\""),
        (file(a, "x = sin(a)"), "no polynomials in the unknown a"),
        (file(a, "x = k/a"), "no polynomials in the unknown a"),
        (file(a, "x = a/(k - k)"), "division by zero"),
        (file(a, "x = a/(x^2 - x*x)"), "division by zero"),
        (file(a, "x = a*x^100000"), "the exponent is larger than 64"),
        (file(a, "x = a*((x^64)^64)^2"), "too large to write out"),
        (file(a, "x = a*1e999999999"), "the number is beyond"),
        (file(a, "x = k*x"), "no equation has an unknown"),
        (file(a, "a*x"), "is not an equation"),
        (file(r#""a": {}, "a": {}"#, "x = a"), "a"),
        (file(r#""x": {}"#, "x = k"), "the name `x` is already that of another symbol"),
        (file(r#""k": {}"#, "x = k"), "the name `k` is already that of another symbol"),
        (file(r#""sin": {}"#, "x = k"), "sin"),
        (file(a, "x = a").replace("equations/1", "equations/9"), "denavit-equations/1"),
    ] {
        let directory = Directory::new("wrong-equations");
        std::fs::write(directory.path.join("wrong.json"), &text).expect("a file");
        for command in ["decompose", "base"] {
            let message = refused(&directory, &[command, "wrong.json"]);
            assert!(message.contains(said), "no `{said}` in:\n{message}");
        }
        assert_eq!(directory.files(), ["wrong.json"]);
    }
}

#[test]
fn options_that_do_not_fit_are_refused() {
    let directory = Directory::new("decompose-options");
    let said = refused(&directory, &["base", "double_pendulum_drives", "--terms", "gravity"]);
    assert!(said.contains("no --with, --terms"), "{said}");
    let said = refused(&directory, &["base", "double_pendulum_drives", "--keep", "m9"]);
    assert!(said.contains("there is no column m9"), "{said}");
    let said = refused(&directory, &["decompose", "planar_2r", "--echelon", "--keep", "m9"]);
    assert!(said.contains("no parameter m9"), "{said}");
    let said = refused(&directory, &["decompose", "planar_2r", "--keep", "m9"]);
    assert!(said.contains("--echelon"), "{said}");
    let said = refused(&directory, &["decompose", "iiwa", "--latex", "iiwa.tex"]);
    assert!(said.contains("too many for a document") && said.contains("hint: "), "{said}");
    assert!(directory.files().is_empty());
}
