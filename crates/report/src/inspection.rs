//! A model as a page: the robot to turn around, its joints to move, its numbers and its equations.

use super::html::{Cell, Fact, Heading, HtmlTable, Page, Part, Row, Section, mathml};
use super::jointed::JointedRobot;
use super::symbolic::{model_row, model_rows, model_tables};
use super::table::{Align, Table};
use denavit_codegen::derive::{EquationOptions, EquationPart, MotionEquations};
use denavit_codegen::emit::latex::{Extent, Notation, write_expressions};
use denavit_codegen::model::{Base, Convention, Robot};
use denavit_codegen::program::LowerError;
use denavit_workflow::Shapes;

/// Robots of more joints have equations that nobody reads.
const MOST_JOINTS: usize = 4;

/// Equations of more summands are not set.
const MOST_TERMS: usize = 300;

/// A model as a page, with the shapes of its links if there are any; `version` is that of the
/// program.
///
/// # Errors
/// If a number of the model is one that no computer arithmetic holds.
pub fn inspection_page(
    robot: &Robot,
    version: &str,
    shapes: Option<&Shapes>,
) -> Result<Page, LowerError> {
    let mut scene = JointedRobot::new(robot)?.telling(|link| model_row(robot, link));
    let mut remarks = Vec::new();
    if let Some(shapes) = shapes {
        (scene, remarks) = scene.looking(shapes);
    }
    let name = format!("{} in three dimensions", robot.name);
    let caption = "Drag to turn, scroll to come closer. Point at a link to read its row. Axes of \
                   frames: x red, y green, z blue; joints turn about the z axes."
        .to_owned();
    let shown = Part::Replay(scene.with_sliders([name, caption]));
    let remarks = remarks.into_iter().map(|text| Part::Paragraph { text });
    let mut sections = vec![
        Section {
            heading: "Robot".to_owned(),
            parts: std::iter::once(shown).chain(remarks).collect(),
        },
        Section { heading: "Denavit-Hartenberg table".to_owned(), parts: rows(robot) },
    ];
    let numbers = model_tables(robot).into_iter();
    let parts: Vec<Part> = numbers.map(|(title, table)| part(title.to_owned(), &table)).collect();
    if !parts.is_empty() {
        sections.push(Section { heading: "Numbers".to_owned(), parts });
    }
    sections.push(Section { heading: "Equations of motion".to_owned(), parts: equations(robot) });
    if !robot.assumptions.is_empty() {
        let parts = robot.assumptions.iter().map(|text| Part::Paragraph { text: text.clone() });
        sections.push(Section { heading: "Assumptions".to_owned(), parts: parts.collect() });
    }
    let facts = [
        ("denavit", version.to_owned()),
        ("model", format!("{}, content {:016x}", robot.name, robot.hash)),
    ];
    let facts = facts.map(|(name, value)| Fact { name: name.to_owned(), value });
    Ok(Page {
        watches: false,
        title: robot.name.replace('_', " "),
        verdict: None,
        lead: robot.description.clone(),
        facts: facts.into_iter().chain(source(robot)).collect(),
        sections,
    })
}

fn source(robot: &Robot) -> Option<Fact> {
    let (name, value) = ("source".to_owned(), robot.source.clone());
    (!value.is_empty()).then_some(Fact { name, value })
}

fn rows(robot: &Robot) -> Vec<Part> {
    let base = match robot.base {
        Base::Fixed => "a fixed base",
        Base::Floating => "a floating base: six joints before the first row",
        Base::PlanarFloating => "a base that floats in a plane: three joints before the first row",
    };
    let convention = match robot.convention {
        Convention::Standard => {
            "Standard convention: the frame of a link stands at its far end, and its joint turns \
             about the z axis of the frame before"
        }
        Convention::Modified => {
            "Modified convention: the frame of a link stands on its own joint, which turns about \
             its z axis"
        }
    };
    vec![part(format!("{convention}. The robot has {base}."), &model_rows(robot))]
}

fn part(caption: String, table: &Table) -> Part {
    let heading = |(text, align): &(String, Align)| Heading {
        heading: text.clone(),
        is_number: *align == Align::Right,
    };
    let row = |cells: &Vec<String>| {
        let mut cells: Vec<Cell> = cells
            .iter()
            .zip(table.columns())
            .map(|(text, (heading, align))| match heading.as_str() {
                "unit" => Cell::unit(text),
                _ => cell(text, *align),
            })
            .collect();
        cells.resize(table.columns().len(), Cell::text(""));
        Row { cells, is_marked: false }
    };
    Part::Table(HtmlTable {
        caption,
        columns: table.columns().iter().map(heading).collect(),
        rows: table.rows().iter().map(row).collect(),
    })
}

fn cell(text: &str, align: Align) -> Cell {
    match text.parse::<f64>() {
        Ok(value) if align == Align::Right => Cell::number(value, text),
        _ => Cell::text(text),
    }
}

/// D, C and G where they can be read.
fn equations(robot: &Robot) -> Vec<Part> {
    let joints = robot.degrees_of_freedom();
    let paragraph = |text: String| vec![Part::Paragraph { text }];
    let too_many = format!(
        "The equations of {joints} joints fill more than a page: they can be derived as a LaTeX \
         document or as JSON."
    );
    if joints > MOST_JOINTS {
        return paragraph(too_many);
    }
    let mut equations = match MotionEquations::derive(robot, &EquationOptions::default()) {
        Ok(equations) => equations,
        Err(error) => return paragraph(format!("They cannot be derived: {error}.")),
    };
    let Some(entries) = equations.written_out(MOST_TERMS) else { return paragraph(too_many) };
    let notation = Notation::of_robot(&equations.dag, robot);
    let written = write_expressions(&equations.dag, &entries, &notation, Extent::FULL);
    let mut texts = written.outputs.into_iter().map(|lines| lines.join(" "));
    let numbered: Vec<String> = equations
        .joints
        .iter()
        .enumerate()
        .map(|(at, name)| format!("{} {name}", at + 1))
        .collect();
    let text = format!("{}. Joints: {}.", equations.law(), numbered.join(", "));
    let mut parts = paragraph(text);
    for one in equations.written() {
        let own: Vec<String> = texts.by_ref().take(one.entries.len()).collect();
        let summary = format!("{}: {}", one.label(), one.doc);
        let lines = own.iter().enumerate().filter(|(_, text)| *text != "0");
        let mut parts_of: Vec<Part> =
            lines.map(|(at, text)| formula(&format!("{} = {text}", entry(one, at)))).collect();
        if parts_of.is_empty() {
            parts_of = paragraph("All its entries are 0.".to_owned());
        }
        parts.push(Part::Folded { summary, parts: parts_of });
    }
    parts
}

fn formula(latex: &str) -> Part {
    match mathml(latex, true) {
        Ok(mathml) => Part::Formula { mathml },
        Err(_) => Part::Paragraph { text: latex.to_owned() },
    }
}

/// The name of an entry.
fn entry(part: &EquationPart, at: usize) -> String {
    let symbol = if part.label() == "tau_drive" {
        r"\tau_{\mathrm{drive}}".to_owned()
    } else {
        part.label().to_owned()
    };
    match part.shape[..] {
        [_, columns] => format!("{{{symbol}}}_{{{},{}}}", at / columns + 1, at % columns + 1),
        _ => format!("{{{symbol}}}_{{{}}}", at + 1),
    }
}
