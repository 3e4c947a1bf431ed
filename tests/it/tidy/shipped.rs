//! docs/reference/shipped.md lists what is shipped.

use super::{assert_none, root};
use std::fs;

#[test]
fn the_page_lists_shipped_models_scenarios_and_gaits() {
    let page = fs::read_to_string(root().join("docs/reference/shipped.md")).unwrap();
    let mut missing = Vec::new();
    for (folder, title) in [
        ("models", "Shipped models: "),
        ("models/scenarios", "Shipped scenarios: "),
        ("models/gaits", "Shipped gaits: "),
    ] {
        let (_, list) = page.split_once(title).unwrap_or_else(|| panic!("{title}"));
        let (list, _) = list.split_once('\n').unwrap();
        for entry in fs::read_dir(root().join(folder)).unwrap().map(Result::unwrap) {
            let path = entry.path();
            let is_json = path.extension().is_some_and(|extension| extension == "json");
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            if is_json && !list.contains(&format!("`{name}`")) {
                missing.push(format!("{folder}/{name}"));
            }
        }
    }
    assert_none(&missing, "docs/reference/shipped.md lists all that is shipped");
}
