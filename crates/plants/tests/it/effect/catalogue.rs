//! The shipped effects: files, schema, faults.

use denavit_codegen::effect::{SHIPPED, catalogue, find, read, schema};
use std::collections::BTreeSet;
use std::path::Path;

#[test]
fn every_file_of_the_folder_is_an_effect_of_that_name() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/effects");
    let files: BTreeSet<String> = folder
        .read_dir()
        .expect("the folder is there")
        .map(|entry| entry.expect("an entry").path())
        .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
        .collect();
    let shipped: BTreeSet<String> = SHIPPED.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(shipped, files);
    for (effect, (name, _)) in catalogue().iter().zip(SHIPPED) {
        assert_eq!(effect.name, *name);
    }
}

#[test]
fn what_effects_are_confused_with_exists() {
    for effect in catalogue() {
        for confusion in &effect.confused_with {
            assert!(
                find(&confusion.effect).is_some(),
                "{}: nothing is called {}",
                effect.name,
                confusion.effect
            );
            assert!(confusion.reason.len() > 10, "{}: no reason", effect.name);
        }
    }
}

#[test]
fn the_schema_takes_what_the_reader_takes() {
    let schema: serde_json::Value = serde_json::from_str(schema()).expect("JSON");
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    for (name, text) in SHIPPED {
        let file: serde_json::Value = serde_json::from_str(text).expect("JSON");
        let faults: Vec<String> =
            validator.iter_errors(&file).map(|error| error.to_string()).collect();
        assert!(faults.is_empty(), "{name}: {faults:?}");
    }
    // faults of form: both refuse
    let (_, stribeck) = SHIPPED.iter().find(|(name, _)| *name == "stribeck").expect("shipped");
    for (from, to) in [
        ("\"kind\": \"torque\"", "\"kind\": \"torc\""),
        ("\"unit\": \"rate\",", ""),
        ("\"format\": \"denavit-effect/1\"", "\"format\": \"denavit-effect/2\""),
        ("\"title\"", "\"titel\""),
        ("\"torque\": \"fs", "\"torque\": true, \"x\": \"fs"),
    ] {
        let broken = stribeck.replacen(from, to, 1);
        assert_ne!(broken, *stribeck, "{from} is in the file");
        let file: serde_json::Value = serde_json::from_str(&broken).expect("JSON");
        assert!(!validator.is_valid(&file), "the schema takes {to}");
        assert!(read("broken.json", broken.as_bytes()).is_err(), "the reader takes {to}");
    }
}

/// What is said about a file, line by line.
fn faults(text: &str) -> String {
    read("own.json", text.as_bytes()).expect_err("a file at fault").to_string()
}

#[test]
fn all_faults_of_a_file_are_told_at_once_with_their_place() {
    let said = faults(
        r#"{
  "format": "denavit-effect/1", "name": "wobble", "title": "t", "description": "d",
  "source": "s", "kind": "torque", "at": "joint",
  "parameters": {
    "a": {"unit": "torque/rate", "description": "d", "nominal": 0, "bounds": [1, 0]},
    "b": {"unit": "mm", "description": "d", "nominal": 0, "bounds": [0, null]},
    "qd": {"unit": "1", "description": "d", "bounds": [0, 1]},
    "v": {"unit": "rate", "description": "d", "bounds": [0, 1], "start": [2, "pi"]}
  },
  "torque": "a*q + w",
  "refines": ["coulomb", "coulmb"],
  "moves": {"mass": 1}
}"#,
    );
    for (place, what) in [
        ("own.json:5:78: /parameters/a/bounds", "the lower end 1 is above the upper end 0"),
        ("/parameters/b/unit", "`mm` hides a factor"),
        ("/parameters/qd", "the name `qd` is already that of another quantity"),
        ("/parameters/qd", "the key `start` is missing"),
        ("/parameters/v/start/0", "the value 2 is out of bounds: it cannot be above 1"),
        ("/parameters/v/start/1", "\"pi\" is not a rational number"),
        ("/torque", "nothing is called `w`"),
        ("/refines/1", "no effect is called `coulmb`"),
        ("/moves", "an effect of the kind `torque` has no `moves`"),
    ] {
        let found = said.lines().any(|line| line.contains(place) && line.contains(what));
        assert!(found, "{place}: {what}\nnot in\n{said}");
    }
}

#[test]
fn keys_that_contradict_each_other_or_the_place_are_faults() {
    let law = |at: &str, kind: &str, law: &str| {
        format!(
            r#"{{"format": "denavit-effect/1", "name": "own", "title": "t", "description": "d",
            "source": "s", "kind": "{kind}", "at": "{at}",
            "parameters": {{"a": {{"unit": "1", "description": "d", "nominal": 0,
              "bounds": [0, null]}}}},
            {law}}}"#
        )
    };
    let both = r#""measured": {"channel": "tau", "value": "tau + a*tau", "true": "tau - a*tau"}"#;
    let said = faults(&law("joint", "measurement", both));
    assert!(said.contains("`true` stands in place of `value`"), "{said}");
    let second = r#""torque": "a*tau_load", "torque_2": "a*tau_load""#;
    let said = faults(&law("joint", "torque", second));
    assert!(said.contains("`torque_2` belongs to"), "{said}");
    assert!(read("own.json", law("joint_pair", "torque", second).as_bytes()).is_ok());
}

#[test]
fn units_of_a_law_must_fit_joints_that_turn_and_joints_that_slide() {
    let law = |unit: &str, torque: &str| {
        format!(
            r#"{{"format": "denavit-effect/1", "name": "own", "title": "t", "description": "d",
            "source": "s", "kind": "torque", "at": "joint",
            "parameters": {{"a": {{"unit": "{unit}", "description": "d", "nominal": 0,
              "bounds": [0, null]}}}},
            "torque": "{torque}"}}"#
        )
    };
    let reads = |unit: &str, torque: &str| read("own.json", law(unit, torque).as_bytes());
    assert!(reads("torque/rate", "a*qd").is_ok());
    assert!(reads("torque/position", "a*qd").is_err());
    // right where joints turn, because radians are numbers; wrong where they slide
    let error = reads("torque", "a*sin(q)").expect_err("a sine of a length").to_string();
    assert!(error.contains("a function of a quantity in m"), "{error}");
    assert!(reads("N m s/rad", "a*qd").is_err());
    // vanishing is decided on expressions
    let error = reads("torque", "a*sign(qd) + tau_load").expect_err("always there").to_string();
    assert!(error.contains("does not vanish"), "{error}");
}
