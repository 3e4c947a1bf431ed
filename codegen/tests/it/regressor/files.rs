//! What is written of base parameters: certificates by their schema, formulas read back.

use super::{INERTIAL, base, rigid};
use crate::robots::{load, shipped};
use denavit_codegen::expr::text;
use denavit_codegen::fundamental::equal;
use denavit_codegen::regressor::{Certificate, certificate};
use serde_json::Value;

#[test]
fn certificates_are_of_their_schema_and_come_back() {
    let schema: Value = serde_json::from_str(certificate::schema()).unwrap();
    jsonschema::draft202012::meta::validate(&schema).unwrap();
    let validator = jsonschema::draft202012::new(&schema).unwrap();
    for name in ["double_pendulum", "puma560", "scara"] {
        let robot = load(name);
        let written = Certificate::new(&robot, INERTIAL, &base(&robot, INERTIAL), false);
        let mut value = serde_json::to_value(&written).unwrap();
        assert!(validator.is_valid(&value), "{name}");
        let back: Certificate = serde_json::from_value(value.clone()).unwrap();
        assert_eq!(back, written);
        value["pivots"][0]["joint"] = Value::from(-1);
        assert!(!validator.is_valid(&value), "{name}");
    }
}

/// The formulas that people read are the sums that are proved.
#[test]
fn formulas_read_back_are_the_sums() {
    for name in shipped() {
        let mut found = base(&rigid(load(&name)), INERTIAL);
        let own = found.parameters.iter().map(|p| (found.sum_text(&p.parts), p.expression));
        let others = found.dependent.iter().map(|d| (found.sum_text(&d.parts), d.expression));
        let formulas: Vec<_> = own.chain(others).collect();
        let dag = &mut found.regressor.dag;
        for (formula, expected) in formulas {
            let resolve = &mut |dag: &mut denavit_codegen::expr::Dag, name: &str| {
                let id = dag.find_symbol(name)?;
                Some(dag.symbol_expr(id))
            };
            let read = text::parse(dag, &formula, resolve)
                .unwrap_or_else(|error| panic!("{name}: {formula}: {error}"));
            assert!(equal(dag, read, expected).unwrap(), "{name}: {formula}");
        }
    }
}
