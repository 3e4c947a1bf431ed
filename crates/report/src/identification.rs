//! What was identified, as a page.

use super::html::{Cell, Fact, FormulaError, Heading, HtmlTable, Page, Part, Row, Section};
use super::run::convergence_picture;
use super::{TorquePicture, motion_picture, short, torque_picture};
use denavit_identify::Identification;
use denavit_identify::estimate::{IdentifiedParameter, JointResidual, Status, Validation};
use denavit_identify::forward::{Compared, Forward, ForwardJoint};

/// What a page about an identification says.
#[derive(Clone, Copy, Debug)]
pub struct IdentificationPage<'a> {
    /// The model's name.
    pub model: &'a str,
    /// What it was made of: version, hash of the model, logs, method, seed.
    pub facts: &'a [Fact],
    /// What was noticed of the logs.
    pub remarks: &'a [String],
    /// The parameters and what they leave.
    pub found: &'a Identification,
    /// Logs that were simulated again, if any were.
    pub simulation: Option<SimulationPart<'a>>,
}

/// What a page says of logs that were simulated again.
#[derive(Clone, Copy, Debug)]
pub struct SimulationPart<'a> {
    /// How, as part of a sentence.
    pub method: &'a str,
    /// With the values that the model had.
    pub before: Option<&'a Forward>,
    /// With those that were found.
    pub after: Option<&'a Forward>,
    /// What kept a model from being simulated.
    pub reasons: &'a [String],
}

impl IdentificationPage<'_> {
    /// The page.
    pub fn page(&self) -> Result<Page, FormulaError> {
        let (found, held_out) = (self.found, self.found.validate.as_ref());
        let mut sections = vec![
            parameters(&found.parameters)?,
            residuals(&found.train, held_out),
            torques(self.model, &found.train, held_out),
        ];
        sections.extend(self.simulation.map(|simulation| simulation.section(self.model)));
        sections.push(self.convergence());
        sections.extend(remarks(self.remarks));
        Ok(Page {
            title: format!("Identification of {}", self.model.replace('_', " ")),
            lead: self.lead(),
            facts: self.facts.to_vec(),
            sections,
        })
    }

    fn lead(&self) -> String {
        let found = self.found;
        let of = |status| found.parameters.iter().filter(|one| one.status == status).count();
        let mut text = format!(
            "Of {} base parameters {} are identified, {} may be 0, and {} are not excited. They \
             leave {} of the torques that they were estimated from",
            found.parameters.len(),
            of(Status::Identified),
            of(Status::Uncertain),
            of(Status::NotExcited),
            percent(found.train.relative),
        );
        if let Some(held_out) = &found.validate {
            text += &format!(", and {} of those of other logs", percent(held_out.relative));
        }
        if let Some(before) = found.before {
            text += &format!("; the model left {} before", percent(before));
        }
        text.push('.');
        for warning in found.notes().into_iter().chain(found.warnings()) {
            text = format!("{text} {warning}");
        }
        text + &nearest_bodies(found.consistent.distance)
    }

    fn convergence(&self) -> Section {
        let found = self.found;
        let svg = convergence_picture("As data come in", &found.parameters, &found.convergence);
        let caption = "Estimates of the data up to a time, with the weights of the end, and the \
                       condition of the regressor.";
        let caption = caption.to_owned();
        Section { heading: "Convergence".to_owned(), parts: vec![Part::Figure { svg, caption }] }
    }
}

impl SimulationPart<'_> {
    fn section(&self, model: &str) -> Section {
        let columns = headings(&[
            ("joint", false),
            ("position before", true),
            ("position", true),
            ("rate before", true),
            ("rate", true),
            ("torque before", true),
            ("torque", true),
        ]);
        let joints = self.after.or(self.before).map_or(&[][..], |made| &made.joints);
        let rows = joints.iter().map(|joint| {
            let of = |forward: Option<&Forward>| {
                let joints = forward.map_or(&[][..], |made| &made.joints);
                joints.iter().find(|other| other.name == joint.name).cloned()
            };
            let both = [of(self.before), of(self.after)];
            let mut cells = vec![Cell::text(&joint.name)];
            let signals: [fn(&ForwardJoint) -> Option<&Compared>; 3] =
                [|one| Some(&one.position), |one| Some(&one.rate), |one| one.torque.as_ref()];
            for signal in signals {
                for made in &both {
                    let compared = made.as_ref().and_then(signal);
                    cells.push(compared.map_or_else(|| Cell::text(""), |one| share(one.relative)));
                }
            }
            Row { cells, is_marked: false }
        });
        let caption = format!(
            "Logs {}: rms of simulated less measured, over the size of what there is to predict.",
            self.method
        );
        let table = HtmlTable { caption, columns, rows: rows.collect() };
        let mut parts = vec![Part::Table(table)];
        let paragraph = |text: &String| Part::Paragraph { text: text.clone() };
        parts.extend(self.reasons.iter().map(paragraph));
        if let Some(after) = self.after {
            let svg = motion_picture(&model.replace('_', " "), self.method, after);
            let caption = "Measured and simulated, with the values that were found.".to_owned();
            parts.push(Part::Figure { svg, caption });
        }
        Section { heading: "Simulation".to_owned(), parts }
    }
}

/// The base parameters.
pub(super) fn parameters(found: &[IdentifiedParameter]) -> Result<Section, FormulaError> {
    let columns = headings(&[
        ("parameter", false),
        ("formula", false),
        ("value", true),
        ("standard error", true),
        ("95 % interval", true),
        ("bias by noise of positions, in errors", true),
        ("model", true),
        ("unit", false),
        ("", false),
    ]);
    let rows = found.iter().map(parameter_row).collect::<Result<_, _>>()?;
    let caption = "Base parameters; marked are those that the motion does not show, which keep the \
                   model's values. A click on a heading sorts.";
    let table = HtmlTable { caption: caption.to_owned(), columns, rows };
    Ok(Section { heading: "Parameters".to_owned(), parts: vec![Part::Table(table)] })
}

/// What is left of the torques of the logs of an estimate, and of others.
pub(super) fn residuals(train: &Validation, held_out: Option<&Validation>) -> Section {
    let columns = headings(&[
        ("joint", false),
        ("torque rms", true),
        ("residual rms", true),
        ("left", true),
        ("left of other logs", true),
        ("largest residual", true),
        ("correlation with the next sample", true),
    ]);
    let rows = train.joints.iter().map(|joint| {
        let other = held_out.and_then(|all| find(all, &joint.name));
        let number = |value: f64| Cell::number(value, short(value));
        let next = joint.autocorrelation.first().copied().unwrap_or(0.0);
        let cells = vec![
            Cell::text(&joint.name),
            number(joint.torque_rms),
            number(joint.residual_rms),
            share(joint.relative),
            other.map_or_else(|| Cell::text(""), |other| share(other.relative)),
            number(joint.largest),
            Cell::number(next, format!("{next:.2}")),
        ];
        Row { cells, is_marked: false }
    });
    let caption = "What is left of the torques [N m, N], after the filter. Residuals that are \
                   noise alone are not correlated.";
    let table = HtmlTable { caption: caption.to_owned(), columns, rows: rows.collect() };
    Section { heading: "Residuals".to_owned(), parts: vec![Part::Table(table)] }
}

/// Measured and computed torques, of logs that the estimate has not seen if there are any.
pub(super) fn torques(model: &str, train: &Validation, held_out: Option<&Validation>) -> Section {
    let (validation, caption) = match held_out {
        Some(validation) => (validation, "Logs that the estimate has not seen."),
        None => (train, "The logs that the estimate is from: there are no others."),
    };
    let title = model.replace('_', " ");
    let picture = TorquePicture { title: &title, subtitle: caption, validation };
    let svg = torque_picture(&picture);
    let caption = "Measured and computed torques.".to_owned();
    Section { heading: "Torques".to_owned(), parts: vec![Part::Figure { svg, caption }] }
}

/// What was noticed of the logs; none if nothing was.
pub(super) fn remarks(remarks: &[String]) -> Option<Section> {
    let paragraph = |text: &String| Part::Paragraph { text: text.clone() };
    let parts: Vec<Part> = remarks.iter().map(paragraph).collect();
    let heading = "Remarks on the logs".to_owned();
    (!parts.is_empty()).then_some(Section { heading, parts })
}

/// How far the nearest bodies that exist are, where the estimate belongs to none.
pub(super) fn nearest_bodies(distance: f64) -> String {
    match distance > 1.0 {
        true => format!(
            " The estimate belongs to no bodies that exist; the nearest ones are {} standard \
             errors away, over all parameters.",
            short(distance)
        ),
        false => String::new(),
    }
}

fn parameter_row(one: &IdentifiedParameter) -> Result<Row, FormulaError> {
    let status = match one.status {
        Status::Identified => "",
        Status::Uncertain => "may be 0",
        Status::NotExcited => "not excited",
    };
    let or_none = |value: Option<f64>, shown: fn(f64) -> String| match value {
        Some(value) => Cell::number(value, shown(value)),
        None => Cell::text(""),
    };
    let cells = vec![
        Cell::text(&one.name),
        Cell::formula(&one.latex)?,
        Cell::number(one.value, short(one.value)),
        or_none(one.std, |std| format!("{std:.1e}")),
        or_none(one.interval, |half| format!("± {half:.1e}")),
        or_none(one.noise_bias, |bias| format!("{bias:.2}")),
        or_none(one.model_value, short),
        Cell::text(&one.unit),
        Cell::text(status),
    ];
    Ok(Row { cells, is_marked: one.status == Status::NotExcited })
}

pub(super) fn headings(list: &[(&str, bool)]) -> Vec<Heading> {
    let heading =
        |&(text, is_number): &(&str, bool)| Heading { heading: text.to_owned(), is_number };
    list.iter().map(heading).collect()
}

fn find<'a>(validation: &'a Validation, joint: &str) -> Option<&'a JointResidual> {
    validation.joints.iter().find(|other| other.name == joint)
}

pub(super) fn percent(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}

fn share(value: f64) -> Cell {
    Cell::number(value, percent(value))
}
