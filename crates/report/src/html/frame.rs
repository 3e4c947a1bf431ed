//! The frame of a page: the template with the scripts and the style sheet that it carries.

use super::units::with_units;
use super::{Page, Part};
use minijinja::value::{Serde, Value};
use minijinja::{Environment, HtmlEscape};
use serde::Serialize;
use std::collections::BTreeMap;

/// The frame.
const TEMPLATE: &str = include_str!("../../templates/html/report.html.jinja");
/// What `crates/report/web` makes, with licences and versions inside.
const STYLE: &str = include_str!("../../templates/html/page.css");
const SCRIPT: &str = include_str!("../../templates/html/page.js");
const SCENE: &str = include_str!("../../templates/html/scene.js");
/// By which a page allows these, and nothing else.
const HASHES: &str = include_str!("../../templates/html/hashes.json");

/// The name by which the engine knows that text is escaped for HTML.
const NAME: &str = "report.html";

/// What the template fills in.
#[derive(Serialize)]
struct Frame<'a> {
    page: &'a Page,
    policy: String,
    style: &'a str,
    scripts: Vec<&'a str>,
}

/// The page as text.
pub(super) fn filled(page: &Page) -> String {
    let hashes: BTreeMap<&str, &str> = serde_json::from_str(HASHES).expect("made with the scripts");
    let hash = |name: &str| hashes.get(name).copied().expect("every file has its hash");
    let has_scene = page.has(|part| matches!(part, Part::Replay(_)));
    let mut scripts = vec![(SCRIPT, hash("page.js"))];
    scripts.extend(has_scene.then(|| (SCENE, hash("scene.js"))));
    let allowed: Vec<String> = scripts.iter().map(|(_, hash)| format!("'{hash}'")).collect();
    let policy = format!(
        "default-src 'none'; script-src {}; style-src '{}'; img-src data:; base-uri 'none'; \
         form-action 'none'{}",
        allowed.join(" "),
        hash("page.css"),
        if page.watches { "; connect-src 'self'" } else { "" }
    );
    let mut environment = Environment::new();
    environment.add_filter("units", |text: String| with_units(&text));
    environment.add_filter("code", |text: String| Value::from_safe_string(with_code(&text)));
    environment.add_template(NAME, TEMPLATE).expect("the template is part of the library");
    let template = environment.get_template(NAME).expect("it was just added");
    let scripts = scripts.into_iter().map(|(text, _)| text).collect();
    let frame = Frame { page, policy, style: STYLE, scripts };
    template.render(Serde(&frame)).expect("the template asks for what a page has")
}

/// A text for HTML in which names between backticks are code, as messages write them. A name may
/// have backticks of its own, within words: then they stay as they are.
fn with_code(text: &str) -> String {
    let opens = |before: &str| before.chars().next_back().is_none_or(|last| " (\n".contains(last));
    let closes = |after: &str| after.chars().next().is_none_or(|next| " ,.;:)'\n".contains(next));
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, inside)) = rest.split_once('`') {
        let Some((inside, after)) = inside.split_once('`') else { break };
        if inside.trim().is_empty() || !opens(before) || !closes(after) {
            return HtmlEscape(text).to_string();
        }
        out.push_str(&format!("{}<code>{}</code>", HtmlEscape(before), HtmlEscape(inside)));
        rest = after;
    }
    out + &HtmlEscape(rest).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_stands_between_backticks_and_stays_text() {
        assert_eq!(with_code("of `q_1` and <b>"), "of <code>q_1</code> and &lt;b&gt;");
        assert_eq!(with_code("`<i>` one ` left"), "<code>&lt;i&gt;</code> one ` left");
        for own in ["v\"`x`.csv: `q`", "tr`a`ain`.csv has `q`", "a`b`c", "` `"] {
            assert_eq!(with_code(own), HtmlEscape(own).to_string());
        }
    }
}
