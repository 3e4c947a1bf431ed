//! What is no rigid-body tree: refused by name, with the reason, or left out with a note.

use super::settings::Settings;
use crate::fault::{Cause, Faults, clip};
use crate::xml::Element;

/// Notes everything of a file that would change its dynamics and has no place in a model.
pub(crate) fn refuse<'s>(settings: &Settings<'s>, sections: &[Element<'s>], faults: &mut Faults) {
    for section in sections {
        match section.name() {
            "equality" => {
                settings.children(*section).into_iter().for_each(|one| equality(one, faults))
            }
            "tendon" => settings.children(*section).into_iter().for_each(|one| {
                tendon(settings, one, faults);
            }),
            "deformable" => {
                let said = "deformable bodies are no rigid bodies";
                faults.push(section.at(), Cause::new(said));
            }
            "include" => {
                let said = "this file is not included";
                let hint = "files are included from the folder of the first one, and below it";
                faults.push(section.at(), Cause::with_hint(said, hint));
            }
            _ => {}
        }
    }
}

fn equality(constraint: Element<'_>, faults: &mut Faults) {
    if constraint.get("active").is_some_and(|active| active.text == "false") {
        return;
    }
    let name =
        constraint.get("name").map_or(String::new(), |name| format!(" `{}`", clip(name.text)));
    let said = format!("the equality constraint{name} ({}) closes a loop", clip(constraint.name()));
    let hint = "a model is a tree: remove it, or set active=\"false\", and the model is free of it";
    faults.push(constraint.at(), Cause::with_hint(said, hint));
}

/// Tendons that pass on what actuators do are no part of a model; those that pull by themselves
/// would be.
fn tendon<'s>(settings: &Settings<'s>, tendon: Element<'s>, faults: &mut Faults) {
    let attributes = settings.with_class(tendon, None, faults);
    for key in ["stiffness", "damping", "frictionloss", "armature"] {
        let pulls = attributes.get(key).is_some_and(|value| {
            value.text.split_whitespace().any(|word| word.parse::<f64>() != Ok(0.0))
        });
        if pulls {
            let name =
                tendon.get("name").map_or(String::new(), |name| format!(" `{}`", clip(name.text)));
            let said = format!("the tendon{name} has {key}, which acts on several joints");
            faults.push(tendon.at(), Cause::with_hint(said, "remove it from the file"));
        }
    }
}

/// Names of the actuators that do more than pass a torque on, each once.
pub(crate) fn acting<'s>(
    settings: &Settings<'s>,
    sections: &[Element<'s>],
    faults: &mut Faults,
) -> Vec<String> {
    let all = sections.iter().flat_map(|section| settings.children(*section));
    let mut found = Vec::new();
    for one in all.filter(|one| one.name() != "motor") {
        let attributes = settings.with_class(one, None, faults);
        let is = |key, plain| attributes.get(key).is_none_or(|value| value.text == plain);
        let passes_on = is("biastype", "none") && is("gaintype", "fixed") && is("dyntype", "none");
        if one.name() == "general" && passes_on {
            continue;
        }
        let name = one.get("name").or(one.get("joint"));
        let name = name.map_or_else(|| one.name().to_owned(), |name| name.text.to_owned());
        if !found.contains(&name) {
            found.push(name);
        }
    }
    found
}
