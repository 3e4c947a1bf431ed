//! `denavit decompose`: f and B, of models and of given equations.

use super::{Directory, Run, answer, json, run_in};
use denavit::expr::text::parse;
use denavit::expr::{Dag, Floats, SymbolClass, evaluate};
use serde_json::Value;
use std::collections::BTreeSet;

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
    let short = answer(&["decompose", "double_pendulum_drives"]);
    assert!(short.contains("zeta 1: tauM1 - IM1*N1*th1dd") && short.contains("\nf:\n"), "{short}");
    let long = answer(&["decompose", "puma560"]);
    assert!(long.lines().count() < 5 && long.contains("--json"), "{long}");
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
    let said = refused(&directory, &["inspect", "double_pendulum_drives"]);
    assert!(said.contains("hint: `double_pendulum`"), "{said}");
}
