//! docs/reference/effects.md says what the files say, and its example is an effect.

use denavit_codegen::effect::{SHIPPED, catalogue, files, read, read_model};
use denavit_report::effects_page;
use std::fs;
use std::path::Path;

const MARK: &str = "UPDATE_EXPECT=1 writes it anew. -->\n\n";

fn page() -> (std::path::PathBuf, String) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference/effects.md");
    let text = fs::read_to_string(&path).expect("the page");
    (path, text)
}

#[test]
fn the_page_of_effects_is_that_of_their_files() {
    let (path, text) = page();
    let (head, listed) = text.split_once(MARK).expect("the mark");
    let made = effects_page(catalogue());
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        fs::write(&path, format!("{head}{MARK}{made}")).expect("writable");
    } else {
        assert!(
            listed == made,
            "docs/reference/effects.md is not fresh: UPDATE_EXPECT=1 writes it anew"
        );
    }
    assert!(SHIPPED.iter().all(|(name, _)| made.contains(&format!("### `{name}`:"))));
    assert!(made.contains(r"\frac{\partial \tau}{\partial"), "signatures");
}

#[test]
fn the_example_of_the_page_is_an_effect_that_models_may_have() {
    let (_, text) = page();
    let example = text.split("```json\n").nth(1).and_then(|rest| rest.split("```").next());
    let example = example.expect("an example");
    let effect = read("hose.json", example.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(effect.name, "hose");
    let linear: Vec<bool> = effect.parameters.iter().map(|parameter| parameter.linear).collect();
    assert_eq!(linear, [true, true, false]);
    let model = denavit_plants::shipped::find("planar_2r").expect("shipped").text;
    let first = read_model("model.json", model.as_bytes(), &[]).expect("a model");
    let name = &first.links.values().next().expect("a link").name;
    let added =
        format!(r#""effects": [{{"effect": "hose", "at": {{"link": "{name}"}}}}], "links""#);
    let with = model.replacen("\"links\"", &added, 1);
    assert!(read_model("model.json", with.as_bytes(), &[]).is_err(), "nobody ships it");
    let robot = read_model("model.json", with.as_bytes(), &[effect]).expect("a model");
    assert_eq!(robot.law_states().count(), 1);
    assert!(robot.find_parameter(&format!("slip_hose_{name}")).is_some());
}

#[test]
fn only_json_files_of_a_folder_are_effects() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/effects");
    assert_eq!(files(&folder).expect("readable").len(), SHIPPED.len());
    assert!(files(&folder.join("nowhere")).expect("no fault").is_empty());
}
