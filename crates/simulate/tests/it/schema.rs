//! The JSON Schema of scenarios against an independent validator.

use denavit_plants::shipped;
use denavit_simulate::{Tolerances, scenario};
use denavit_walk::read_scenario;
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
        ("\"gait\": {\"divergent_component\": [1, 2]}".to_owned(), false),
        ("\"gait\": {\"capture_step\": {}}".to_owned(), false),
        ("\"gait\": {}".to_owned(), false),
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

/// Every number of the schema with a range: where it stands, and its limits.
fn ranges(node: &Value, path: &mut Vec<String>, found: &mut Vec<(Vec<String>, [f64; 2])>) {
    if let (Some(least), Some(most)) = (node["minimum"].as_f64(), node["maximum"].as_f64()) {
        found.push((path.clone(), [least, most]));
    }
    if let Some(properties) = node["properties"].as_object() {
        for (key, inner) in properties {
            path.push(key.clone());
            let shared = inner["$ref"].as_str() == Some("#/$defs/tolerances");
            let tolerances: Value = serde_json::from_str(scenario::schema()).expect("JSON");
            let inner = if shared { &tolerances["$defs"]["tolerances"] } else { inner };
            let control = key == "control";
            let inner = if control { &tolerances["$defs"]["control"] } else { inner };
            ranges(inner, path, found);
            path.pop();
        }
    }
}

/// A scenario with one value at a place.
fn with_value(path: &[String], value: &str) -> String {
    let mut text = value.to_owned();
    for key in path.iter().rev() {
        text = format!("{{\"{key}\": {text}}}");
    }
    let given: Value = serde_json::from_str(&text).expect("JSON");
    let mut all: Value = serde_json::from_str(
        "{\"format\": \"denavit-scenario/1\", \"model\": \"planar_2r\", \"duration_s\": 0}",
    )
    .expect("JSON");
    let (key, value) = given.as_object().and_then(|given| given.iter().next()).expect("a key");
    all[key] = value.clone();
    if key == "cradle_balls" {
        all.as_object_mut().expect("an object").remove("model");
    }
    all.to_string()
}

/// The ranges that the schema states are those of the reader.
#[test]
fn schema_and_reader_agree_on_ranges() {
    let schema: Value = serde_json::from_str(scenario::schema()).expect("JSON");
    let mut found = Vec::new();
    ranges(&schema, &mut Vec::new(), &mut found);
    assert!(found.len() >= 50, "{}", found.len());
    let load = |name: &str| {
        let model = shipped::find(name).ok_or("no such model")?;
        Ok(model.text.as_bytes().to_vec())
    };
    for (path, [least, most]) in found {
        let pointer = format!("/{}: the number must be", path.join("/"));
        let outside = |value: f64| {
            let text = with_value(&path, &format!("{value:e}"));
            let read = read_scenario("test.json", text.as_bytes(), &load);
            read.err().is_some_and(|error| error.to_string().contains(&pointer))
        };
        for (limit, beyond) in [(least, least - 0.5 * least.abs().max(1e-9)), (most, 2.0 * most)] {
            assert!(!outside(limit), "{path:?}: {limit} is allowed");
            assert!(outside(beyond), "{path:?}: {beyond} is not allowed");
        }
    }
}

/// The tolerances that the schema states are those of a scenario that gives none.
#[test]
fn the_schema_states_the_tolerances() {
    let schema: Value = serde_json::from_str(scenario::schema()).expect("JSON");
    let properties = &schema["properties"];
    let [event, steps] =
        [&properties["tolerances"], &properties["time_stepping"]["properties"]["tolerances"]];
    for (stated, own) in [(event, Tolerances::default()), (steps, Tolerances::of_steps(1e-3))] {
        for (key, value) in [
            ("energy_j", own.energy_j),
            ("momentum_ns", own.momentum_ns),
            ("penetration_m", own.penetration_m),
            ("complementarity_nm", own.complementarity_nm),
            ("adhesion_n", own.adhesion_n),
            ("separation_m_s", own.separation_m_s),
            ("zmp_m", own.zmp_m),
            ("force_n", own.force_n),
            ("cone_n", own.cone_n),
            ("friction_angle_rad", own.friction_angle_rad),
        ] {
            let stated = stated["default"][key].as_f64().expect("a default");
            assert!((stated - value).abs() <= 1e-12 * value, "{key}: {stated}, {value}");
        }
    }
}

/// The control of a scenario by itself is a controller, and a file of it controls as it does.
#[test]
fn the_control_of_a_scenario_is_a_controller() {
    let schema: Value = serde_json::from_str(&scenario::controller_schema()).expect("JSON");
    jsonschema::draft202012::meta::validate(&schema).expect("the schema is one of draft 2020-12");
    let alone = jsonschema::draft202012::new(&schema).expect("a schema");
    let shipped = shipped::find_scenario("double_pendulum").expect("shipped");
    let mut inner: Value = serde_json::from_str(shipped.text).expect("JSON");
    inner["control"] = serde_json::json!({
        "format": scenario::CONTROLLER_FORMAT,
        "name": "holder",
        "period_s": 0.01,
        "joints": {"link1": {"kp": 5, "kd": 1, "damps": "rate", "reference": 0.3}},
    });
    inner["duration_s"] = 0.5.into();
    inner["tolerances"] = serde_json::json!({"energy_j": 1e-3});
    let text = inner["control"].to_string();
    assert!(alone.is_valid(&inner["control"]), "{text}");
    let mut outer = inner.clone();
    outer["control"] = "holder.json".into();
    for scenario in [&inner, &outer] {
        assert!(validator().is_valid(scenario), "{scenario}");
    }
    let load = |name: &str| match name {
        "holder.json" => Ok(text.clone().into_bytes()),
        name => {
            let model = shipped::find_referred(name).ok_or("no such model")?;
            Ok(model.text.as_bytes().to_vec())
        }
    };
    let logs = [inner, outer].map(|scenario| {
        let read = scenario::read("scenario.json", scenario.to_string().as_bytes(), &load);
        let mut scenario = read.unwrap_or_else(|error| panic!("{error}"));
        scenario.run().unwrap_or_else(|error| panic!("{error}")).log.to_csv()
    });
    assert!(logs[0] == logs[1]);
}

#[test]
fn faults_of_a_controller_have_their_place() {
    let robot = shipped::find("double_pendulum").expect("shipped");
    let robot = denavit_codegen::model::read("m", robot.text.as_bytes()).expect("sound");
    let plant = denavit_plants::plant_of(&robot, &[]).expect("a plant");
    let load = |_: &str| Err("no such file".to_owned());
    let said = |text: &str| {
        let read = scenario::read_controller("c.json", text.as_bytes(), plant.model(), &load);
        read.map(|_| ()).unwrap_err().to_string()
    };
    let wrong = said("{\"joints\": {\"lin1\": {\"kp\": -1, \"damps\": \"speed\"}}, \"gain\": 1}");
    for part in [
        "the key `format` is missing",
        "denavit-controller/1",
        "no joint is called `lin1`",
        "`link1` is meant",
        "gain",
        "c.json",
    ] {
        assert!(wrong.contains(part), "{part}: {wrong}");
    }
    let wrong = said(
        "{\"format\": \"denavit-controller/1\",\n \"joints\": {\"link1\": {\"kp\": -1, \"damps\": \
         \"speed\"}}}",
    );
    assert!(wrong.contains("c.json:2:") && wrong.contains("speed"), "{wrong}");
    assert!(said("{\"format\": \"denavit-scenario/1\"}").contains("denavit-controller/1"));
}

/// The example of docs/reference/scenario.md is a shipped file, as it is.
#[test]
fn the_page_shows_a_shipped_scenario() {
    let path =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference/scenario.md");
    let page = std::fs::read_to_string(path).expect("the page");
    let (_, rest) = page.split_once("```json\n").expect("an example");
    let (example, _) = rest.split_once("```").expect("its end");
    let shipped = shipped::find_scenario("rocking_block").expect("it is shipped");
    assert!(
        example == shipped.text,
        "docs/reference/scenario.md shows another file than is shipped"
    );
}
