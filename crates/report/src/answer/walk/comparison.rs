//! Criteria of stability compared on runs, as text, JSON and a page.

use crate::html::{Cell, Fact, Heading, HtmlTable, Page, Part, Row, Section};
use crate::{Align, Table};
use denavit_walk::comparison::{CASES, Compared, Verdict};
use serde_json::{Value, json as value};
use std::fmt::{self, Write};

/// What a comparison adds to scenarios.
const FRICTION: &str = "friction of 0.8 where no slip has no answer";

type Column = (&'static str, &'static str, fn(&Compared) -> Verdict);

const CRITERIA: [Column; 6] = [
    ("zmp", "exact ZMP", |run| run.zero_moment),
    ("cart_table", "cart-table", |run| run.cart_table),
    ("fri", "FRI", |run| run.foot_rotation),
    ("capture", "capture", |run| run.capture),
    ("momentum", "momentum", |run| run.momentum),
    ("poincare", "Poincare", |run| run.poincare),
];

fn verdict_text(verdict: Verdict, run: &Compared) -> String {
    let wrong = if run.is_wrong(verdict) { " (!)" } else { "" };
    match verdict {
        Verdict::Met => format!("met{wrong}"),
        Verdict::Missed(t_s) if t_s > 0.0 => format!("missed at {t_s:.2} s{wrong}"),
        Verdict::Missed(_) => format!("missed{wrong}"),
        Verdict::Silent => "-".to_owned(),
    }
}

fn outcome_text(run: &Compared) -> String {
    let (stop, t_s) = &run.outcome;
    match stop.word() {
        "end" if run.falls_are_seen => "no fall".to_owned(),
        "end" => "nothing counts as a fall".to_owned(),
        "fall" => format!("fell at {t_s:.2} s"),
        word => format!("{word} at {t_s:.2} s"),
    }
}

/// Runs compared by the criteria, as JSON.
pub fn comparison_json(all: &[Compared]) -> Value {
    value!({ "runs": all.iter().map(answer).collect::<Vec<_>>() })
}

fn answer(run: &Compared) -> Value {
    let mut criteria = serde_json::Map::new();
    for (key, _, verdict) in CRITERIA {
        let verdict = verdict(run);
        let (word, first) = match verdict {
            Verdict::Met => ("met", None),
            Verdict::Missed(t_s) => ("missed", Some(t_s)),
            Verdict::Silent => ("silent", None),
        };
        let wrong = run.is_wrong(verdict);
        criteria.insert(
            key.to_owned(),
            value!({ "verdict": word, "missed_at_s": first, "wrong": wrong }),
        );
    }
    let energy = run.energy.map(|energy| {
        value!({
            "speed_m_s": energy.speed_m_s,
            "cost_of_transport": energy.cost_of_transport,
            "torque_squared": energy.torque_squared,
        })
    });
    value!({
        "scenario": run.scenario,
        "outcome": run.outcome.0.word(),
        "end_s": run.outcome.1,
        "falls_are_seen": run.falls_are_seen,
        "criteria": criteria,
        "largest_angular_momentum": run.largest_momentum,
        "largest_multiplier": run.largest_multiplier,
        "energy": energy,
    })
}

/// How often each criterion was wrong: it was met, and the robot fell; it was missed, and it did
/// not.
fn counts(all: &[Compared]) -> Vec<(&'static str, [usize; 2])> {
    let wrong = |verdict: fn(&Compared) -> Verdict, fell: bool| {
        let runs = all.iter().filter(|run| run.fell() == fell);
        runs.filter(|run| run.is_wrong(verdict(run))).count()
    };
    let of = |(_, name, verdict): &Column| (*name, [wrong(*verdict, true), wrong(*verdict, false)]);
    CRITERIA.iter().map(of).collect()
}

fn cells(run: &Compared) -> Vec<String> {
    let mut cells = vec![run.scenario.clone(), outcome_text(run)];
    cells.extend(CRITERIA.iter().map(|(_, _, verdict)| verdict_text(verdict(run), run)));
    cells
}

fn energy_cells(run: &Compared) -> Option<Vec<String>> {
    let energy = run.energy?;
    Some(vec![
        run.scenario.clone(),
        format!("{:.3}", energy.speed_m_s),
        format!("{:.3}", energy.cost_of_transport),
        format!("{:.0}", energy.torque_squared),
        run.largest_multiplier.map_or_else(|| "-".to_owned(), |largest| format!("{largest:.4}")),
    ])
}

const ENERGY: [&str; 5] = [
    "gait",
    "speed [m/s]",
    "cost of transport",
    "torque\u{b2} [N\u{b2} m s]",
    "largest multiplier",
];

/// The same as text.
pub fn comparison_text(all: &[Compared]) -> String {
    let mut out = String::new();
    write(&mut out, all).expect("text has room");
    out
}

fn write(out: &mut String, all: &[Compared]) -> fmt::Result {
    let mut columns = vec![("run", Align::Left), ("outcome", Align::Left)];
    columns.extend(CRITERIA.iter().map(|(_, name, _)| (*name, Align::Left)));
    let mut table = Table::new(&columns);
    all.iter().for_each(|run| table.push(cells(run)));
    writeln!(out, "{table}\n(!) met, and it fell; or missed, and it did not; {FRICTION}\n")?;
    let columns = [
        ("criterion", Align::Left),
        ("met, and fell", Align::Right),
        ("missed, and did not", Align::Right),
    ];
    let mut table = Table::new(&columns);
    for (name, [met, missed]) in counts(all) {
        table.push(vec![name.to_owned(), met.to_string(), missed.to_string()]);
    }
    writeln!(out, "{table}")?;
    let mut table = Table::new(&ENERGY.map(|name| (name, Align::Right)));
    all.iter().filter_map(energy_cells).for_each(|cells| table.push(cells));
    if !table.is_empty() {
        write!(out, "{table}")?;
    }
    Ok(())
}

/// The same as a page.
pub fn comparison_page(all: &[Compared]) -> Page {
    let headings = |names: &[&str]| -> Vec<Heading> {
        names.iter().map(|name| Heading { heading: (*name).to_owned(), is_number: false }).collect()
    };
    let row = |cells: Vec<String>| Row {
        is_marked: cells.iter().any(|cell| cell.ends_with("(!)")),
        cells: cells.into_iter().map(Cell::text).collect(),
    };
    let mut names = vec!["run", "outcome"];
    names.extend(CRITERIA.iter().map(|(_, name, _)| *name));
    let verdicts = HtmlTable {
        caption: "What each criterion says; (!) met, and it fell, or missed, and it did not."
            .into(),
        columns: headings(&names),
        rows: all.iter().map(|run| row(cells(run))).collect(),
    };
    let count = |(name, [met, missed]): (&str, [usize; 2])| {
        row(vec![name.to_owned(), met.to_string(), missed.to_string()])
    };
    let wrong = HtmlTable {
        caption: "How often each was wrong: not sufficient, not necessary.".into(),
        columns: headings(&["criterion", "met, and it fell", "missed, and it did not"]),
        rows: counts(all).into_iter().map(count).collect(),
    };
    let energies = HtmlTable {
        caption: "Speed and energy of the gaits (thesis 4.4.1).".into(),
        columns: headings(&ENERGY),
        rows: all.iter().filter_map(energy_cells).map(row).collect(),
    };
    let shown = CASES.iter().map(|case| format!("{}: {}.", case.scenario, case.shows));
    let paragraph = Part::Paragraph { text: shown.collect::<Vec<_>>().join(" ") };
    Page {
        watches: false,
        title: "Criteria of stability, compared by runs".to_owned(),
        verdict: None,
        lead: "No criterion is right on all runs: each is met in a fall, missed without one, or \
               says nothing."
            .to_owned(),
        facts: vec![Fact { name: "denavit".into(), value: env!("CARGO_PKG_VERSION").into() }],
        sections: vec![
            Section {
                heading: "Verdicts".into(),
                parts: vec![Part::Table(verdicts), Part::Table(wrong)],
            },
            Section { heading: "Energy".into(), parts: vec![Part::Table(energies)] },
            Section { heading: "The shipped runs".into(), parts: vec![paragraph] },
        ],
    }
}
