//! The JSON Schema against an independent validator.

use super::{fixture, shipped_models};
use denavit_codegen::model;
use serde_json::Value;

fn validator() -> jsonschema::Validator {
    let schema: Value = serde_json::from_str(model::schema()).expect("the schema is JSON");
    jsonschema::draft202012::meta::validate(&schema).expect("the schema is one of draft 2020-12");
    jsonschema::draft202012::new(&schema).expect("a schema")
}

fn base() -> Value {
    let text = std::fs::read_to_string(fixture("broken/base.json")).expect("the base");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn shipped_models_and_fixtures_are_of_the_schema() {
    let validator = validator();
    assert!(validator.is_valid(&base()));
    let general = std::fs::read_to_string(fixture("general_6r.json")).expect("the general arm");
    for (name, text) in shipped_models().into_iter().chain([("general_6r".to_owned(), general)]) {
        let model: Value = serde_json::from_str(&text).expect("JSON");
        if let Err(error) = validator.validate(&model) {
            panic!("{name}: {}: {error}", error.instance_path());
        }
    }
}

/// Faults of form: the schema refuses them, and so does the reader.
#[test]
fn schema_and_reader_refuse_the_same_faults_of_form() {
    let validator = validator();
    let edits = [
        ("/format", "\"denavit-model/2\""),
        ("/name", "7"),
        ("/name", "\"my crane\""),
        ("/convention", "\"khalil\""),
        ("/gravity", "[0, 0]"),
        ("/gravity/2", "null"),
        ("/terms/1", "\"wind\""),
        ("/base", "\"free\""),
        ("/base", "{\"body\": {}}"),
        ("/links", "[]"),
        ("/links", "{}"),
        ("/links/0/joint", "{}"),
        ("/links/0/joint/type", "\"spherical\""),
        ("/links/0/joint/alpha", "[1]"),
        ("/links/0/joint/colour", "1"),
        ("/links/0/limits/position", "[1]"),
        ("/links/0/body/mass", "true"),
        ("/links/0/body/com", "[0]"),
        ("/links/0/body/inertia/yx", "0"),
        ("/links/0/body/about", "\"joint\""),
        ("/links/1/body/mass/known", "\"yes\""),
        ("/links/1/joint/spring", "{}"),
        ("/drives", "[]"),
        ("/drives/arm/series_elastic", "{\"stiffness\": 1}"),
        ("/drives/arm/return_spring/side", "\"left\""),
        ("/contacts/0", "{\"name\": \"tip\", \"link\": \"hook\"}"),
        ("/ground/slope", "0.1"),
        ("/effects/0/at", "\"everywhere\""),
        ("/effects/0/at", "{\"link\": \"arm\", \"contact\": \"tip\"}"),
    ];
    for (pointer, value) in edits {
        let mut model = base();
        set(&mut model, pointer, serde_json::from_str(value).expect("JSON"));
        assert!(!validator.is_valid(&model), "the schema allows {pointer} = {value}");
        let read = model::read("edited.json", model.to_string().as_bytes());
        assert!(read.is_err(), "the reader allows {pointer} = {value}");
    }
    for (pointer, key) in
        [("", "links"), ("", "gravity"), ("/links/0", "name"), ("/links/0/body", "about")]
    {
        let mut model = base();
        let object = model.pointer_mut(pointer).and_then(Value::as_object_mut).expect("an object");
        object.remove(key).expect("a key of the base");
        assert!(!validator.is_valid(&model), "the schema allows {pointer} without {key}");
        assert!(model::read("edited.json", model.to_string().as_bytes()).is_err());
    }
}

fn set(model: &mut Value, pointer: &str, value: Value) {
    if let Some(place) = model.pointer_mut(pointer) {
        *place = value;
        return;
    }
    let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
    let parent = model.pointer_mut(parent).and_then(Value::as_object_mut).expect("an object");
    parent.insert(key.to_owned(), value);
}
