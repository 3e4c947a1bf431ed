//! Whatever the bytes, reading ends with a robot or with faults that can be printed.

use super::{fixture, shipped_models};
use denavit_codegen::model;
use proptest::prelude::*;
use proptest::sample::Index;
use std::sync::LazyLock;

static SOURCES: LazyLock<Vec<String>> = LazyLock::new(|| {
    let base = std::fs::read_to_string(fixture("broken/base.json")).expect("the base");
    shipped_models().into_iter().map(|(_, text)| text).chain([base]).collect()
});

/// Reads and, if there are faults, prints them: neither may panic, and an answer stays readable.
fn survives(source: &[u8]) -> Result<(), TestCaseError> {
    if let Err(error) = model::read("fuzzed.json", source) {
        let message = error.to_string();
        prop_assert!(message.starts_with("fuzzed.json:"), "{}", message);
        prop_assert!(!error.faults.is_empty() && error.faults.len() <= model::MAX_FAULTS);
        let ordered = error.faults.is_sorted_by_key(|fault| (fault.line, fault.column));
        prop_assert!(ordered, "{}", message);
        prop_assert!(message.lines().all(|line| line.chars().count() < 2000), "{}", message);
    }
    Ok(())
}

/// Pieces of model files, and things that look like them.
fn snippet() -> impl Strategy<Value = String> {
    let pieces = [
        "{",
        "}",
        "[",
        "]",
        ",",
        ":",
        "\"",
        "\\",
        "null",
        "true",
        "0",
        "-1",
        "1e400",
        "1e-400",
        "\"pi/2\"",
        "\"base\"",
        "\"m1*\"",
        "\"1/0\"",
        "\"(l1\"",
        "\"l1^l1\"",
        "\"2^64^64\"",
        "\"sin(l1)\"",
        "\"q_knee\"",
        "\"nan\"",
        "\"\\ud800\"",
        "\"\"",
        "[0, 0, 0]",
        "{}",
        "[]",
        "{\"value\": \"g\", \"std\": -1}",
        "\"floating\"",
        "\"fixed\"",
        "\"prismatic\"",
        "\"origin\"",
        "\"mm\"",
        "\"l1 + g\"",
        "9999999999999999999999999",
        "\"a\": 1,",
        "\"parent\": \"base_pitch\",",
        "\u{0}",
        "é",
        "\u{feff}",
    ];
    prop_oneof![
        4 => proptest::sample::select(pieces.to_vec()).prop_map(str::to_owned),
        1 => "[ -~]{0,12}",
        1 => "\"[a-z0-9+*/^(). -]{0,24}\"",
    ]
}

/// Replaces a stretch of the text (at character boundaries) by a snippet.
fn splice(text: &mut String, at: &Index, length: usize, with: &str) {
    let boundaries: Vec<usize> =
        text.char_indices().map(|(at, _)| at).chain([text.len()]).collect();
    let start = at.index(boundaries.len());
    let end = (start + length).min(boundaries.len() - 1);
    text.replace_range(boundaries[start]..boundaries[end], with);
}

/// The places of all scalars of a text: what stands between structure.
fn scalars(text: &str) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut start = 0;
    for (at, c) in text.char_indices() {
        if "{}[],:\n".contains(c) {
            let piece = &text[start..at];
            if !piece.trim().is_empty() {
                let lead = piece.len() - piece.trim_start().len();
                found.push((start + lead, start + piece.trim_end().len()));
            }
            start = at + c.len_utf8();
        }
    }
    found
}

/// A debug build reads a model in milliseconds, a release build in a tenth of that.
const CASES: u32 = if cfg!(debug_assertions) { 64 } else { 512 };

proptest! {
    #![proptest_config(ProptestConfig::with_cases(CASES))]

    #[test]
    fn random_bytes(source in proptest::collection::vec(any::<u8>(), 0..400)) {
        survives(&source)?;
    }

    #[test]
    fn random_snippets(pieces in proptest::collection::vec(snippet(), 0..60)) {
        survives(pieces.concat().as_bytes())?;
    }

    #[test]
    fn shipped_models_with_stretches_replaced(
        source in any::<Index>(),
        edits in proptest::collection::vec((any::<Index>(), 0usize..40, snippet()), 1..4),
    ) {
        let mut text = SOURCES[source.index(SOURCES.len())].clone();
        for (at, length, with) in &edits {
            splice(&mut text, at, *length, with);
        }
        survives(text.as_bytes())?;
    }

    #[test]
    fn shipped_models_with_values_replaced(
        source in any::<Index>(),
        edits in proptest::collection::vec((any::<Index>(), snippet()), 1..6),
    ) {
        let mut text = SOURCES[source.index(SOURCES.len())].clone();
        for (at, with) in &edits {
            let places = scalars(&text);
            if !places.is_empty() {
                let (start, end) = places[at.index(places.len())];
                text.replace_range(start..end, with);
            }
        }
        survives(text.as_bytes())?;
    }

    #[test]
    fn shipped_models_with_values_exchanged(
        source in any::<Index>(),
        exchanges in proptest::collection::vec((any::<Index>(), any::<Index>()), 1..6),
    ) {
        let mut text = SOURCES[source.index(SOURCES.len())].clone();
        for (from, to) in &exchanges {
            let places = scalars(&text);
            let (start, end) = places[from.index(places.len())];
            let piece = text[start..end].to_owned();
            let (start, end) = places[to.index(places.len())];
            text.replace_range(start..end, &piece);
        }
        survives(text.as_bytes())?;
    }

    #[test]
    fn any_expression_in_a_row(expression in "[ a-z0-9_+*/^(),.<=-]{0,60}") {
        let text = SOURCES[SOURCES.len() - 1].replace("\"boom/4\"", &format!("{expression:?}"));
        survives(text.as_bytes())?;
    }
}
