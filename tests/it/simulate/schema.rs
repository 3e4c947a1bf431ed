//! The JSON Schema of scenarios against an independent validator.

use denavit::shipped;
use denavit::simulate::scenario;
use serde_json::Value;

fn validator() -> jsonschema::Validator {
    let schema: Value = serde_json::from_str(scenario::schema()).expect("the schema is JSON");
    jsonschema::draft202012::meta::validate(&schema).expect("the schema is one of draft 2020-12");
    jsonschema::draft202012::new(&schema).expect("a schema")
}

#[test]
fn shipped_scenarios_are_of_the_schema() {
    let validator = validator();
    for shipped in shipped::SCENARIOS {
        let scenario: Value = serde_json::from_str(shipped.text).expect("JSON");
        if let Err(error) = validator.validate(&scenario) {
            panic!("{}: {}: {error}", shipped.name, error.instance_path());
        }
    }
}

/// Faults of form: the schema refuses them, and so does the reader.
#[test]
fn schema_and_reader_agree_on_form() {
    let validator = validator();
    let load = |name: &str| {
        let model = shipped::find(name).ok_or("no such model")?;
        Ok(model.text.as_bytes().to_vec())
    };
    let reference = |text: &str| {
        format!("\"control\": {{\"joints\": {{\"link1\": {{\"kp\": 1, \"reference\": {text}}}}}}}")
    };
    for (entries, is_right) in [
        (String::new(), true),
        ("\"scheme\": \"time_stepping\"".to_owned(), true),
        ("\"scheme\": \"steps\"".to_owned(), false),
        ("\"time_stepping\": {\"step_s\": 0.01, \"method\": \"anitescu\"}".to_owned(), true),
        ("\"time_stepping\": {\"step_s\": 0}".to_owned(), false),
        ("\"time_stepping\": {\"implicit_damping\": 1.5}".to_owned(), false),
        ("\"time_stepping\": {\"tolerances\": {\"energy\": 1}}".to_owned(), false),
        ("\"tolerances\": {\"cone_n\": 1e-3}".to_owned(), true),
        ("\"gait\": {\"march\": {}}".to_owned(), false),
        ("\"gait\": {\"weight_shift_step\": {\"phases_s\": [1, 2]}}".to_owned(), false),
        (reference("{\"polynomial\": [0, 1]}"), true),
        (reference("{\"polynomial\": 1}"), false),
        (reference("{\"log\": {\"file\": \"a.csv\"}}"), false),
        (reference("{\"spline\": {}}"), false),
        ("\"seed\": -1".to_owned(), false),
    ] {
        let separator = if entries.is_empty() { "" } else { ", " };
        let text = format!(
            "{{\"format\": \"denavit-scenario/1\", \"model\": \"planar_2r\", \"duration_s\": 1\
             {separator}{entries}}}"
        );
        let value: Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(validator.is_valid(&value), is_right, "{text}");
        let read = scenario::read("test.json", text.as_bytes(), &load);
        assert_eq!(read.is_ok(), is_right, "{text}");
    }
}
