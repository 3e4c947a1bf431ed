//! The JSON Schema of gait files against an independent validator, and against the reader.

use denavit_plants::shipped;
use denavit_walk::gait_file::{read_gait, schema};
use serde_json::{Value, json};

fn validator() -> jsonschema::Validator {
    let schema: Value = serde_json::from_str(schema()).expect("the schema is JSON");
    jsonschema::draft202012::meta::validate(&schema).expect("the schema is one of draft 2020-12");
    jsonschema::draft202012::new(&schema).expect("a schema")
}

#[test]
fn shipped_gaits_are_of_the_schema() {
    let validator = validator();
    for shipped in shipped::GAITS {
        let gait: Value = serde_json::from_str(shipped.text).expect("JSON");
        if let Err(error) = validator.validate(&gait) {
            panic!("{}: {}: {error}", shipped.name, error.instance_path());
        }
        let read = read_gait(shipped.name, shipped.text.as_bytes()).unwrap();
        assert_eq!(read.name, shipped.name);
    }
}

/// Faults of form, and numbers outside their ranges: the schema refuses them, and so does the
/// reader.
#[test]
fn schema_and_reader_agree() {
    let validator = validator();
    let posture = json!({"center_of_mass_m": 0.0, "swing_foot_m": [0.1, 0]});
    let primitives = json!({"hip_height_m": 0.5, "postures": [posture, posture]});
    let pendulum = json!({"step_length_m": 0.1, "step_s": 0.8, "center_of_mass_height_m": 0.6});
    let mut cases = vec![
        ("primitives", primitives.clone(), true),
        ("inverted_pendulum", pendulum.clone(), true),
        ("primitives", with(&primitives, "/postures", json!([posture])), false),
        ("primitives", with(&primitives, "/join", json!("glue")), false),
        ("primitives", with(&primitives, "/join", json!("bezier")), true),
        ("primitives", with(&primitives, "/postures/0/swing_foot_m", json!([0])), false),
        ("primitives", with(&primitives, "/postures/0/swing_foot_m", json!([0, -1e-9])), false),
        ("primitives", with(&primitives, "/postures/0/pitch", json!(1)), false),
        ("primitives", with(&primitives, "/postures/1/name", json!("b")), true),
        ("primitives", json!({"hip_height_m": 0.5}), false),
        ("inverted_pendulum", json!({"step_length_m": 0.1, "step_s": 0.8}), false),
        ("inverted_pendulum", with(&pendulum, "/standing_s", json!([1, 2, 3])), false),
        ("inverted_pendulum", with(&pendulum, "/steps", json!(2.5)), false),
        ("march", json!({}), false),
    ];
    let schema: Value = serde_json::from_str(schema()).expect("JSON");
    let kinds = [
        ("primitives", &primitives),
        ("inverted_pendulum", &pendulum),
        ("divergent_component", &space()),
    ];
    for (kind, own) in kinds {
        let properties = schema["properties"][kind]["properties"].as_object().unwrap();
        let mut count = 0;
        for (key, stated) in properties {
            let limits = (stated["minimum"].as_f64(), stated["maximum"].as_f64());
            let (Some(least), Some(most)) = limits else { continue };
            let pointer = format!("/{key}");
            let below = if least == 0.0 { -1e-9 } else { least - 0.5 * least.abs() };
            for (value, is_right) in
                [(least, true), (most, true), (below, false), (2.0 * most, false)]
            {
                let value = if (key == "steps" || key == "corrections") && value.fract() == 0.0 {
                    json!(value as i64)
                } else {
                    json!(value)
                };
                cases.push((kind, with(own, &pointer, value), is_right));
                count += 1;
            }
        }
        assert!(count > 20, "{kind}: {count}");
    }
    assert_agreed(&validator, cases);
}

#[test]
fn schema_and_reader_agree_on_footsteps() {
    let (space, validator) = (space(), validator());
    let listed = |footsteps: Value| {
        let mut listed = json!({"step_s": 0.8, "center_of_mass_height_m": 0.6});
        listed["footsteps"] = footsteps;
        listed
    };
    let cases = vec![
        ("divergent_component", space.clone(), true),
        ("divergent_component", with(&space, "/footsteps", json!([{}])), false),
        ("divergent_component", with(&space, "/ends", json!("on_last_foot")), false),
        ("divergent_component", listed(json!([{}])), true),
        ("divergent_component", listed(json!([])), false),
        ("divergent_component", listed(json!([{"width_m": 0}])), false),
        ("divergent_component", with(&listed(json!([{}])), "/steps", json!(3)), false),
        ("divergent_component", with(&space, "/corrections", json!(11)), false),
        ("divergent_component", with(&space, "/first_swing", json!("both")), false),
    ];
    assert_agreed(&validator, cases);
}

/// A walk in space whose steps are alike.
fn space() -> Value {
    json!({"step_length_m": 0.1, "step_s": 0.8, "center_of_mass_height_m": 0.6})
}

/// A gait with another value at a place.
fn with(gait: &Value, pointer: &str, value: Value) -> Value {
    let mut gait = gait.clone();
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    gait.pointer_mut(parent).unwrap()[key] = value;
    gait
}

/// Kinds with their gaits, and whether these are right: for the schema and for the reader.
fn assert_agreed(validator: &jsonschema::Validator, cases: Vec<(&str, Value, bool)>) {
    for (kind, gait, is_right) in cases {
        let all = json!({"format": "denavit-gait/1", "model": "planar_biped", kind: gait});
        assert_eq!(validator.is_valid(&all), is_right, "{all}");
        let read = read_gait("test.json", all.to_string().as_bytes());
        assert_eq!(read.is_ok(), is_right, "{all}: {:?}", read.err().map(|e| e.to_string()));
    }
}
