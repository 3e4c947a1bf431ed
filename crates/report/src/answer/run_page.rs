//! A run as a page.

use super::run::scheme_text;
use crate::html::{
    Cell, Fact, Grade, Heading, HtmlTable, Page, Part, Row, Section, VerdictLine, with_units,
};
use crate::run::{ShownWithRun, beside_parts, replay, run_charts};
use denavit_numerics::short;
use denavit_simulate::scenario::Scenario;
use denavit_simulate::{EventKind, Run, Stop};

/// A run on one page: played back, with its curves and its audit; `broken` are the tolerances that
/// it broke (law, found, allowed), `version` is that of the program.
pub fn run_page(
    scenario: &mut Scenario,
    run: &Run,
    broken: &[(&'static str, f64, f64)],
    with: ShownWithRun<'_>,
    version: &str,
) -> Page {
    let beside = with.log;
    let (motion, remarks) = replay(scenario.plant.as_mut(), run, with);
    let remarks = remarks.into_iter().map(|text| Part::Paragraph { text });
    let model = scenario.plant.model().clone();
    let charts: Vec<Part> =
        run_charts(&model, &run.log, beside).into_iter().map(Part::Chart).collect();
    let mut sections = Vec::new();
    let mut section = |heading: &str, parts: Vec<Part>| {
        if !parts.is_empty() {
            sections.push(Section { heading: heading.to_owned(), parts });
        }
    };
    section("Motion", motion.map(Part::Replay).into_iter().chain(remarks).collect());
    let compared = beside.map(|beside| beside_parts(&model, &run.log, beside));
    section("Measured beside simulated", compared.unwrap_or_default());
    section("Curves", charts);
    section("Audit", vec![Part::Table(audit(scenario, run, broken))]);
    let given = [
        ("denavit", version.to_owned()),
        ("model", model.name.clone()),
        ("scheme", scheme_text(scenario)),
    ];
    let given = given.map(|(name, value)| Fact { name: name.to_owned(), value });
    Page {
        watches: false,
        title: scenario.name.replace('_', " "),
        verdict: Some(verdict(run, broken)),
        lead: scenario.description.clone(),
        facts: given.to_vec(),
        sections,
    }
}

fn verdict(run: &Run, broken: &[(&'static str, f64, f64)]) -> VerdictLine {
    let end = format!("{} at {:.3} s", run.stop, run.end.t_s);
    // as many as are listed: a start is none
    let happened = run.events.iter().filter(|event| event.kind != EventKind::Start).count();
    let events = match happened {
        1 => "1 event".to_owned(),
        count => format!("{count} events"),
    };
    let (grade, text) = match (run.stop == Stop::End, broken) {
        (true, []) => {
            let text = format!("The run {end}, with {events}; every law that is audited holds.");
            (Grade::Good, text)
        }
        (false, []) => (Grade::Bad, format!("Not at its end: {end}, with {events}.")),
        (_, broken) => {
            let laws: Vec<&str> = broken.iter().map(|(law, ..)| *law).collect();
            (Grade::Bad, format!("Broken: {}. Ended: {end}, with {events}.", laws.join(", ")))
        }
    };
    VerdictLine { grade, text }
}

/// The laws that a run is held to, and how far it was from them at worst.
fn audit(scenario: &Scenario, run: &Run, broken: &[(&'static str, f64, f64)]) -> HtmlTable {
    let has_broken = !broken.is_empty();
    let heading = |(text, is_number): (&str, bool)| Heading { heading: text.to_owned(), is_number };
    let row = |law: String, worst: f64| {
        let allowed = broken.iter().find(|(_, found, _)| *found == worst);
        let allowed = allowed.map_or_else(String::new, |(.., most)| format!("{most:.0e}"));
        let is_marked = !allowed.is_empty();
        // more digits than these say nothing of it
        let shown = format!("{worst:.3e}").parse().map_or_else(|_| worst.to_string(), short);
        let mut cells = vec![Cell::text(with_units(&law)), Cell::number(worst, shown)];
        cells.extend(has_broken.then(|| Cell::text(allowed)));
        Row { cells, is_marked }
    };
    let listed = run.audit.listed(scenario.plant.model()).into_iter();
    let columns = [("law", false), ("worst", true), ("allowed", true)];
    let shown = if has_broken { 3 } else { 2 };
    let caption = match has_broken {
        true => "The laws that every run is held to; marked are those that it breaks.",
        false => "The laws that every run is held to. None is broken.",
    };
    HtmlTable {
        caption: caption.to_owned(),
        columns: columns.map(heading).into_iter().take(shown).collect(),
        rows: listed.map(|(_, law, worst)| row(law.to_string(), worst)).collect(),
    }
}
