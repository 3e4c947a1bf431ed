//! A gait on one page, with the figures of thesis chapter 4.

use super::balance::{BalanceCriterion, balance_picture, margin_cells};
use super::cycle::{gait_verdict, multipliers_picture, returns_picture, size};
use crate::answer::run::drawn_run;
use crate::html::{Cell, Fact, Heading, HtmlTable, Page, Part, Row, Section};
use crate::run::{GaitCurve, GaitPicture, ShownWithRun, replay};
use denavit_simulate::scenario::Scenario;
use denavit_walk::balance::Course;
use denavit_walk::poincare::PoincareAnalysis;
use denavit_workflow::Judged;

fn figure(svg: String, caption: &str) -> Part {
    Part::Figure { svg, caption: caption.to_owned() }
}

/// A gait on one page: its course, and its cycle or why it has none.
pub fn gait_page(
    scenario: &mut Scenario,
    course: Course,
    cycle: Result<PoincareAnalysis, String>,
) -> Page {
    let mut moves = vec![figure(joints(scenario, &course), "Joint angles (figures 4.2 and 4.4).")];
    if let Some(run) = &course.run {
        let motion = replay(scenario.plant.as_mut(), run, ShownWithRun::default()).0;
        moves.splice(0..0, motion.map(Part::Replay));
        let caption = "Snapshots, joints, forces of the ground (figures 4.3 and 4.5).";
        moves.push(figure(drawn_run(scenario, run, None), caption));
    }
    let verdict = Some(gait_verdict(&course, &cycle));
    let energy = course.energy(scenario.plant.as_ref());
    let over = format!("{}, {:.4} s", course.over.word(), course.duration_s());
    let model = scenario.plant.model().clone();
    let judged = Judged { name: scenario.name.clone(), model, course, notes: Vec::new() };
    let balance = vec![
        Part::Table(margins(&judged)),
        figure(balance_picture(BalanceCriterion::Zmp, &judged), "Zero moment point (figure 4.7)."),
        figure(
            balance_picture(BalanceCriterion::Capture, &judged),
            "Capture point (thesis 4.2.4).",
        ),
        figure(
            balance_picture(BalanceCriterion::Momentum, &judged),
            "Angular momentum (thesis 4.2.3).",
        ),
    ];
    let mut facts = vec![
        Fact { name: "model".into(), value: judged.model.name.clone() },
        Fact { name: "over one".into(), value: over },
    ];
    if let Some(energy) = energy {
        facts.push(Fact { name: "speed".into(), value: format!("{:.3} m/s", energy.speed_m_s) });
        let cost = format!("{:.3}", energy.cost_of_transport);
        facts.push(Fact { name: "cost of transport".into(), value: cost });
        let square = format!("{:.0} N\u{b2} m s", energy.torque_squared);
        facts.push(Fact { name: "torque squared per metre".into(), value: square });
    }
    let section = |heading: &str, parts| Section { heading: heading.into(), parts };
    Page {
        watches: false,
        title: scenario.name.replace('_', " "),
        verdict,
        lead: scenario.description.clone(),
        facts,
        sections: vec![
            section("Motion", moves),
            section("Balance", balance),
            section("Cycle", cycle_parts(scenario, cycle)),
        ],
    }
}

/// Joint angles over the course.
fn joints(scenario: &Scenario, course: &Course) -> String {
    let (log, model) = (course.run.as_ref().map(|run| &run.log), scenario.plant.model());
    let column = |name: &str| log.and_then(|log| log.column(name)).unwrap_or_default();
    let driven = model.joints.iter().filter(|joint| joint.drivable);
    let curves: Vec<GaitCurve> = driven
        .map(|joint| GaitCurve {
            name: joint.name.clone(),
            values: column(&format!("q_{}", joint.name)),
        })
        .collect();
    let subtitle = format!("{}, over one {}", model.name, course.over.word());
    GaitPicture {
        title: "joint angles",
        subtitle: &subtitle,
        times_s: &column("t"),
        curves: &curves,
        postures: &[],
    }
    .draw()
}

fn table(caption: &str, columns: &[&str], rows: Vec<Vec<String>>) -> HtmlTable {
    let heading =
        |name: &&str| Heading { heading: (*name).to_owned(), is_number: *name != columns[0] };
    // what begins with a number is one, behind the name of its row
    let cell = |(at, text): (usize, String)| {
        let value = text.split(' ').next().and_then(|number| number.parse::<f64>().ok());
        match value.filter(|_| at > 0) {
            Some(value) => Cell::number(value, text),
            None => Cell::text(text),
        }
    };
    let row = |cells: Vec<String>| Row {
        is_marked: false,
        cells: cells.into_iter().enumerate().map(cell).collect(),
    };
    HtmlTable {
        caption: caption.to_owned(),
        columns: columns.iter().map(heading).collect(),
        rows: rows.into_iter().map(row).collect(),
    }
}

/// Points of balance by the names that commands have for them.
const POINTS: [(&str, &str); 4] = [
    ("exact", "zero moment point"),
    ("cart-table", "zero moment point of a cart-table"),
    ("fri", "foot rotation indicator"),
    ("capture", "capture point"),
];

fn margins(judged: &Judged) -> HtmlTable {
    let columns = ["point", "least margin [mm]", "at [s]", "largest [mm]", "outside"];
    let all = [BalanceCriterion::Zmp, BalanceCriterion::Fri, BalanceCriterion::Capture];
    let mut rows: Vec<Vec<String>> =
        all.into_iter().flat_map(|what| margin_cells(what, &judged.course)).collect();
    for name in rows.iter_mut().filter_map(|row| row.first_mut()) {
        let words = POINTS.iter().find(|(known, _)| known == name).map(|(_, words)| *words);
        *name = words.map_or_else(|| name.clone(), str::to_owned);
    }
    table("Distance from the edge of the support polygon, negative outside.", &columns, rows)
}

fn cycle_parts(scenario: &Scenario, cycle: Result<PoincareAnalysis, String>) -> Vec<Part> {
    let found = match cycle {
        Ok(found) => found,
        Err(reason) => {
            return vec![Part::Paragraph { text: format!("No cycle was found: {reason}.") }];
        }
    };
    let row = |(index, one): (usize, &denavit_walk::poincare::Multiplier)| {
        let [re, im] = one.value.map(size);
        vec![(index + 1).to_string(), re, im, size(one.modulus())]
    };
    let rows = found.multipliers.iter().enumerate().map(row).collect();
    let columns = ["", "real", "imaginary", "modulus"];
    let caption = "Floquet multipliers (tables 4.1a and b); deviations die where all are below 1.";
    let mut parts = vec![Part::Table(table(caption, &columns, rows))];
    if let Some(returns) = &found.convergence {
        let map = returns_picture(scenario, &found, returns);
        parts.push(figure(map, "States on the section after each cycle (figure 4.8)."));
    }
    parts.push(figure(
        multipliers_picture(scenario, &found),
        "Multipliers in the unit circle (figure 4.9).",
    ));
    parts
}
