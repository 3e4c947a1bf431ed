//! `denavit walk page`: a gait on one page, with the figures of thesis chapter 4.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::outputs::{check_outputs, on_stdout, say_written, write_whole};
use super::super::progress::Progress;
use super::super::simulate::draw as draw_run;
use super::balance::{Judged, What, draw as draw_balance, margin_cells, period};
use super::design::open_or_design;
use super::poincare::{picture, return_map, size};
use clap::Args;
use denavit::report::html::{Cell, Fact, Heading, HtmlTable, Page, Part, Row, Section};
use denavit::report::{GaitCurve, GaitPicture};
use denavit::simulate::scenario::Scenario;
use denavit::walk::balance::{Course, course_of_scenario};
use denavit::walk::poincare::{PoincareAnalysis, PoincareOptions, analyse};
use std::io::Write;
use std::path::PathBuf;

/// Show a gait on one page: joints, snapshots, zero moment point, returns, multipliers
///
/// The pictures are those of thesis figures 4.2 to 4.5 and 4.7 to 4.9, over one cycle of the gait,
/// or over the whole run where it has none; tables say what each criterion finds, speed and energy.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  denavit walk page planar_biped_limit_cycle_gait -o gait.html")]
pub(crate) struct Arguments {
    /// A scenario or a gait, which is designed first: the path of its file, or a shipped name
    #[arg(value_name = "SCENARIO|GAIT")]
    scenario: PathBuf,
    /// Distance of the instants that are looked at
    #[arg(long, value_name = "SECONDS", default_value = "0.001", value_parser = period)]
    period: f64,
    /// Where the page goes; - is standard output
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [Some(&arguments.output)];
    let is_answered = on_stdout(&outputs, false)?;
    let mut scenario = open_or_design(&arguments.scenario)?;
    check_outputs(&outputs)?;
    let name = arguments.scenario.display().to_string();
    let progress = Progress::new();
    progress.show("simulating");
    let course = course_of_scenario(&mut scenario, arguments.period, false)
        .map_err(|error| Failure::Walk(name, error.to_string()))?;
    let options =
        PoincareOptions { checks: false, returns: (0.1, 12), ..PoincareOptions::default() };
    // a gait without a cycle has a page, too: it says why there is none
    progress.show("following the cycle");
    let cycle = analyse(&mut scenario, &options);
    progress.clear();
    let page = page(&mut scenario, course, cycle.map_err(|error| error.to_string()));
    write_whole(&arguments.output, page.render().as_bytes())?;
    if !is_answered {
        say_written(out, &outputs)?;
    }
    Ok(Answer::Done)
}

fn figure(svg: String, caption: &str) -> Part {
    Part::Figure { svg, caption: caption.to_owned() }
}

fn page(scenario: &mut Scenario, course: Course, cycle: Result<PoincareAnalysis, String>) -> Page {
    let mut moves = vec![figure(joints(scenario, &course), "Joint angles (figures 4.2 and 4.4).")];
    if let Some(run) = &course.run {
        let caption = "Snapshots, joints, forces of the ground (figures 4.3 and 4.5).";
        moves.push(figure(draw_run(scenario, run, None), caption));
    }
    let energy = course.energy(scenario.plant.as_ref());
    let over = format!("{}, {:.4} s", course.over.word(), course.duration_s());
    let model = scenario.plant.model().clone();
    let judged = Judged { name: scenario.name.clone(), model, course, notes: Vec::new() };
    let balance = vec![
        Part::Table(margins(&judged)),
        figure(draw_balance(What::Zmp, &judged), "Zero moment point (figure 4.7)."),
        figure(draw_balance(What::Capture, &judged), "Capture point (thesis 4.2.4)."),
        figure(draw_balance(What::Momentum, &judged), "Angular momentum (thesis 4.2.3)."),
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
        title: scenario.name.replace('_', " "),
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
    let row = |cells: Vec<String>| Row {
        is_marked: false,
        cells: cells.into_iter().map(Cell::text).collect(),
    };
    HtmlTable {
        caption: caption.to_owned(),
        columns: columns.iter().map(heading).collect(),
        rows: rows.into_iter().map(row).collect(),
    }
}

fn margins(judged: &Judged) -> HtmlTable {
    let columns = ["point", "least margin [mm]", "at [s]", "largest [mm]", "outside"];
    let all = [What::Zmp, What::Fri, What::Capture];
    let rows = all.into_iter().flat_map(|what| margin_cells(what, &judged.course)).collect();
    table("Distance from the edge of the support polygon, negative outside.", &columns, rows)
}

fn cycle_parts(scenario: &Scenario, cycle: Result<PoincareAnalysis, String>) -> Vec<Part> {
    let found = match cycle {
        Ok(found) => found,
        Err(reason) => {
            return vec![Part::Paragraph { text: format!("No cycle was found: {reason}.") }];
        }
    };
    let row = |(index, one): (usize, &denavit::walk::poincare::Multiplier)| {
        let [re, im] = one.value.map(size);
        vec![(index + 1).to_string(), re, im, size(one.modulus())]
    };
    let rows = found.multipliers.iter().enumerate().map(row).collect();
    let columns = ["", "real", "imaginary", "modulus"];
    let caption = "Floquet multipliers (tables 4.1a and b); deviations die where all are below 1.";
    let mut parts = vec![Part::Table(table(caption, &columns, rows))];
    if let Some(returns) = &found.convergence {
        let map = return_map(scenario, &found, returns);
        parts.push(figure(map, "States on the section after each cycle (figure 4.8)."));
    }
    parts.push(figure(picture(scenario, &found), "Multipliers in the unit circle (figure 4.9)."));
    parts
}
