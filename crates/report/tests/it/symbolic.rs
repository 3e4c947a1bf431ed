//! What the compiler finds, as documents, without the command.

use denavit_codegen::derive::{EquationOptions, MotionEquations};
use denavit_codegen::emit::{Language, SourceError, SourceOptions, Sources};
use denavit_codegen::function::FunctionName;
use denavit_codegen::fundamental::{DEFAULT_MEMORY_BYTES, Expansion};
use denavit_codegen::model::{Robot, equations, read};
use denavit_codegen::program::{CodeError, CodeOptions, Lowered, States};
use denavit_codegen::regressor::{BaseOptions, EquationsBase, ProvenBase};
use denavit_plants::shipped;
use denavit_report::symbolic::{
    BaseReport, GivenBaseReport, ShippedKind, counts_text, equations_json, equations_text,
    evaluated_json, model_text, shipped_table, sources_json,
};
use serde_json::to_value;
use std::path::Path;

/// What no effects come to.
const NO_EFFECTS: &[&str] = &[];

fn robot(name: &str) -> Robot {
    read(name, shipped::find(name).unwrap().text.as_bytes()).unwrap()
}

#[test]
fn a_model_and_its_equations_are_told() {
    let robot = robot("double_pendulum");
    assert!(model_text(&robot).starts_with("double_pendulum, hash "));
    let equations = MotionEquations::derive(&robot, &EquationOptions::default()).unwrap();
    let text = equations_text(&robot, &equations);
    assert!(text.starts_with("double_pendulum: tau = D qdd + C qd + G"), "{text}");
    let json = to_value(equations_json(&robot, &equations)).unwrap();
    assert_eq!(json["functions"]["mass_matrix"]["shape"], serde_json::json!([2, 2]));
}

#[test]
fn base_parameters_are_listed_alike_for_people_and_programs() {
    let found = ProvenBase::find(robot("double_pendulum"), &BaseOptions::default()).unwrap();
    let report = BaseReport::new(&found);
    let json = to_value(report.json(NO_EFFECTS)).unwrap();
    assert_eq!(json["certificate"]["verified"], true);
    let (text, markdown) = (report.text(NO_EFFECTS), report.markdown());
    for parameter in json["parameters"].as_array().unwrap() {
        let formula = parameter["expression"].as_str().unwrap();
        assert!(text.contains(formula) && markdown.contains(formula), "{formula}");
    }
}

#[test]
fn base_parameters_of_equations_are_compared_with_them() {
    let shipped = shipped::find_equations("double_pendulum_drives").unwrap();
    let given = equations::read(shipped.name, shipped.text.as_bytes()).unwrap();
    let memory_bytes = DEFAULT_MEMORY_BYTES;
    let mut expansion = Expansion { memory_bytes, progress: &mut |_| {} };
    let found = EquationsBase::find(&given, &[], &mut expansion).unwrap();
    let report = GivenBaseReport::new(&given, &found);
    let json = to_value(report.json()).unwrap();
    assert_eq!(json["rank"], found.theta.rank());
    assert!(report.text().contains("with the equations checked modulo"));
}

#[test]
fn code_is_emitted_counted_and_evaluated_in_one_call_each() {
    let robot = robot("double_pendulum");
    let options = SourceOptions { language: Language::C, ..SourceOptions::default() };
    let sources = Sources::new(&robot, &options, Path::new("pendulum.c")).unwrap();
    let json = to_value(sources_json(&robot, &options, &sources)).unwrap();
    assert_eq!([&json["file"], &json["beside"]], ["pendulum.c", "pendulum.h"]);
    let refused = Sources::new(&robot, &options, Path::new("pendulum.rs"));
    assert!(matches!(refused, Err(SourceError::FileName(_))));

    let table = counts_text(&robot.name, options.code.flavour, &sources.lowered.counts());
    assert!(table.contains("\ninverse_dynamics "), "{table}");

    let functions = [FunctionName::MassMatrix];
    let found = States::at_rest(&robot).evaluate(&robot, &functions).unwrap();
    let json = to_value(evaluated_json(&robot, &found)).unwrap();
    let rows = json["states"][0]["mass_matrix"]["mass_matrix"].as_array().unwrap().len();
    assert_eq!(rows, 2);
    assert!(States::read(br#"{"states": [{"q": [1.0]}]}"#, &robot).is_err());
}

#[test]
fn functions_that_a_model_has_not_are_an_error_with_a_way_out() {
    let functions = vec![FunctionName::ContactJacobian];
    let options = CodeOptions { functions, ..CodeOptions::default() };
    let error = Lowered::new(&robot("double_pendulum"), &options).unwrap_err();
    assert!(matches!(error, CodeError::NoFunction(_)));
    assert!(error.to_string().contains("hint: contacts are declared"), "{error}");
}

#[test]
fn every_shipped_model_is_listed() {
    let listed = ShippedKind::Models.listed();
    assert_eq!(shipped_table(&listed).len(), shipped::MODELS.len());
}
