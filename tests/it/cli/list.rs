//! `denavit list` says what is shipped.

use super::answer;
use denavit::shipped;

#[test]
fn everything_shipped_is_listed_with_its_description() {
    let listed: serde_json::Value = serde_json::from_str(&answer(&["list", "--json"])).unwrap();
    let listed = listed.as_array().unwrap();
    let kinds = [
        ("model", shipped::MODELS),
        ("scenario", shipped::SCENARIOS),
        ("gait", shipped::GAITS),
        ("controller", shipped::CONTROLLERS),
    ];
    for (kind, all) in kinds {
        for one in all {
            let found = listed.iter().find(|l| l["kind"] == kind && l["name"] == one.name);
            let found = found.unwrap_or_else(|| panic!("{kind} {}", one.name));
            assert!(!found["description"].as_str().unwrap().is_empty(), "{kind} {}", one.name);
        }
    }
    let effects = listed.iter().filter(|one| one["kind"] == "effect").count();
    assert_eq!(effects, denavit::effect::catalogue().len());
}

#[test]
fn one_kind_is_listed_alone() {
    let text = answer(&["list", "gaits"]);
    assert!(text.contains("tulip_walk") && !text.contains("puma560"), "{text}");
}
