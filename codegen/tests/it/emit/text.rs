//! Rules that emitted text keeps whatever the model is.

use super::recount::models;
use denavit_codegen::build_script::{BuildError, Request, generate, source};
use denavit_codegen::derive::Flavour;
use denavit_codegen::function::FunctionName;
use denavit_codegen::model;

fn emit(model_text: &str, request: &Request) -> Result<String, BuildError> {
    source(&model::read("test.json", model_text.as_bytes()).unwrap(), request)
}

/// A pendulum whose names are words of the language, or those of emitted code itself.
const AWKWARD: &str = include_str!("../../../../tests/fixtures/models/awkward.json");

#[test]
fn names_of_the_model_never_clash_with_words_of_the_language() {
    let text = emit(AWKWARD, &Request::default()).unwrap();
    for line in ["    pub live: S,", "    Type,", "    Self_,", "    Type2,", "    pub p: S,"] {
        assert!(text.lines().any(|found| found == line), "{line}");
    }
    assert!(text.contains("Self::Self_ => \"Self\","));
    assert!(text.contains("see <https://example.org> \\[1\\] \\<b>"));
    // Text of the model is data: no place of a template, no comment's end, no turned writing.
    assert!(text.contains("a break and hidden turns. */ {{items}}"));
    assert!(!text.contains('\u{202e}'));
}

#[test]
fn nothing_is_emitted_that_could_panic_allocate_or_need_more_than_the_runtime() {
    for path in models() {
        let file = path.to_string_lossy();
        let robot = model::read(&file, &std::fs::read(&path).unwrap()).unwrap();
        let text = source(&robot, &Request::default()).unwrap();
        let code: String = text.lines().filter(|line| !line.trim().starts_with("//")).collect();
        for word in
            ["unsafe", "panic", "unwrap", "expect", "assert", "std::", "alloc", "Vec", "Box", "#!["]
        {
            assert!(!code.contains(word), "{word} in {file}");
        }
        let imports: Vec<&str> = text.lines().filter(|line| line.starts_with("use ")).collect();
        assert!(imports.len() == 1 && imports[0].starts_with("use denavit_runtime::"), "{file}");
        // Every public item and field is documented.
        let lines: Vec<&str> = text.lines().map(str::trim).collect();
        for pair in lines.windows(2).filter(|pair| pair[1].starts_with("pub ")) {
            assert!(pair[0].starts_with("///") || pair[0].starts_with("#["), "{}", pair[1]);
        }
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{file}");
    }
}

/// The file gives no values, so none is made up.
#[test]
fn a_model_without_values_has_no_default_parameters() {
    let without = AWKWARD
        .replace("\"constants\": {", "\"unknowns\": {\"mu\": {\"unit\": \"kg\"}}, \"constants\": {")
        .replace("\"mass\": 0.5", "\"mass\": \"mu\"");
    let text = emit(&without, &Request::default()).unwrap();
    assert!(text.contains("pub struct ModelParameters<S>"));
    assert!(!text.contains("Default for"));
    let text = emit(AWKWARD, &Request::default()).unwrap();
    assert!(text.contains("Default for ModelParameters<S>"));
}

#[test]
fn only_the_functions_asked_for_are_emitted() {
    let functions = vec![FunctionName::GravityVector];
    let request = Request { flavour: Flavour::Baked, functions, ..Request::default() };
    let text = emit(AWKWARD, &request).unwrap();
    let found: Vec<&str> = text.lines().filter(|line| line.starts_with("pub fn ")).collect();
    assert_eq!(found.len(), 1);
    assert!(found[0].starts_with("pub fn gravity_vector<S: Scalar>("));
    assert!(!text.contains("ModelParameters") || text.contains("no `ModelParameters`"));
}

#[test]
fn what_cannot_be_read_or_written_is_said() {
    let nowhere = std::path::Path::new("no/such/model.json");
    let error = generate(nowhere, nowhere, &Request::default()).unwrap_err();
    assert!(matches!(error, BuildError::Read { .. }));
    assert!(error.to_string().starts_with("no/such/model.json: cannot read: "), "{error}");
    let model = models().remove(3);
    let error = generate(&model, nowhere, &Request::default()).unwrap_err();
    assert!(matches!(error, BuildError::Write { .. }), "{error}");
}
