//! What was identified, as a page.

mod curves;
mod doubts;
mod parameters;
mod shown_by;
mod simulation;

pub(super) use curves::torques;
pub(crate) use doubts::{notes, warnings};
pub(super) use parameters::base_parameters;

use super::html::{
    Cell, Fact, FormulaError, Grade, Heading, HtmlTable, Page, Part, Row, Section, Tab, VerdictLine,
};
use super::short;
use curves::{condition, convergence};
use denavit_codegen::model::Robot;
use denavit_identify::Identification;
use denavit_identify::estimate::{Status, Validation};
use denavit_plants::UpdatedModel;
use denavit_plants::regression::RegressionModel;
use denavit_replay::Forward;
use parameters::{bodies, not_excited};

/// What a page about an identification says.
#[derive(Clone, Copy)]
pub struct IdentificationPage<'a> {
    /// The robot as its file has it.
    pub robot: &'a Robot,
    /// The columns of its base parameters.
    pub model: &'a RegressionModel,
    /// The same with what was found, where that has a place in the file.
    pub updated: Option<&'a UpdatedModel>,
    /// What it was made of: version, hash of the model, logs, method, seed.
    pub facts: &'a [Fact],
    /// What was noticed of the logs.
    pub remarks: &'a [String],
    /// The parameters and what they leave.
    pub found: &'a Identification,
    /// Whether what was found is to be believed.
    pub is_good: bool,
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
        let mut sections = Vec::from_iter(self.warnings());
        sections.push(self.parameters()?);
        sections.push(torques(&found.train, held_out));
        sections.push(residuals(&found.train, held_out));
        sections.extend(not_excited(self.model, &found.parameters));
        sections.push(self.convergence());
        sections.extend(self.simulation.map(|simulation| simulation.section(self.robot)));
        sections.extend(remarks(self.remarks));
        Ok(Page {
            watches: false,
            title: format!("Identification of {}", self.robot.name.replace('_', " ")),
            verdict: Some(self.verdict()),
            lead: self.lead(),
            facts: self.facts.to_vec(),
            sections,
        })
    }

    /// The answer in one sentence.
    fn verdict(&self) -> VerdictLine {
        let found = self.found;
        let hidden = found.not_excited().len();
        let (judged, whose) = match &found.validate {
            Some(held_out) => (held_out, "logs that they were not estimated from"),
            None => (&found.train, "the logs that they are from"),
        };
        let left = percent(judged.relative);
        let (grade, mut text) = match self.is_good {
            false => {
                let text = format!(
                    "Do not trust these parameters: their residual is {left} of the torques of \
                     {whose}, and what speaks against them is listed below"
                );
                (Grade::Bad, text)
            }
            true => {
                let is_said = warnings(found).is_empty() && found.lacking.is_empty();
                let is_clear = hidden == 0 && is_said;
                let grade = if is_clear { Grade::Good } else { Grade::Fair };
                (grade, format!("The parameters explain all but {left} of the torques of {whose}"))
            }
        };
        if hidden > 0 {
            let all = found.parameters.len();
            text += &format!("; the motion does not show {hidden} of {all}");
        }
        VerdictLine { grade, text: text + "." }
    }

    fn lead(&self) -> String {
        let found = self.found;
        let of = |status| found.parameters.iter().filter(|one| one.status == status).count();
        let are = |count: usize| format!("{count} {}", if count == 1 { "is" } else { "are" });
        let mut text = format!(
            "Of {} base parameters {} identified, {} may be 0, and {} not excited.",
            found.parameters.len(),
            are(of(Status::Identified)),
            of(Status::Uncertain),
            are(of(Status::NotExcited)),
        );
        if let Some(before) = found.before {
            text += &format!(" With the nominal parameters it was {}.", percent(before));
        }
        text
    }

    /// What is to be known before anybody believes the parameters.
    fn warnings(&self) -> Option<Section> {
        let found = self.found;
        let nearest = Some(nearest_bodies(found.consistent.distance)).filter(|one| !one.is_empty());
        let warnings = warnings(found).into_iter().chain(nearest.filter(|_| {
            // said by the warnings, unless noise makes most
            !found.is_of_no_bodies()
        }));
        let mut parts: Vec<Part> = warnings.map(|text| Part::Paragraph { text }).collect();
        let notes: Vec<Part> =
            notes(found).into_iter().map(|text| Part::Paragraph { text }).collect();
        if !notes.is_empty() {
            let summary = "Samples that were left out, and residuals without a name".to_owned();
            parts.push(Part::Folded { summary, parts: notes });
        }
        let heading = "Before you use them".to_owned();
        (!parts.is_empty()).then_some(Section { heading, parts })
    }

    /// The bodies that a model file has, then what the logs determine.
    fn parameters(&self) -> Result<Section, FormulaError> {
        let found = self.found;
        let base = Part::Table(base_parameters(&found.parameters)?);
        let bodies = self.updated.map(|updated| bodies(self.robot, updated, &found.parameters));
        let parts = match bodies {
            None => vec![base],
            Some(table) => {
                let tab = |name: &str, part| Tab { name: name.to_owned(), parts: vec![part] };
                let bodies = tab("Bodies and joints", Part::Table(table));
                vec![Part::Tabs { tabs: vec![bodies, tab("Base parameters", base)] }]
            }
        };
        Ok(Section { heading: "Parameters".to_owned(), parts })
    }

    fn convergence(&self) -> Section {
        let found = self.found;
        let parts = vec![
            Part::Chart(convergence(&found.parameters, &found.convergence)),
            Part::Chart(condition(&found.convergence)),
            Part::Paragraph { text: self.conditioned() },
        ];
        Section { heading: "Convergence".to_owned(), parts }
    }

    fn conditioned(&self) -> String {
        let solution = &self.found.estimate.solution;
        format!(
            "The regressor has condition {}, and {} with its columns scaled to length 1.",
            short(solution.condition),
            short(solution.scaled_condition)
        )
    }
}

/// What is left of the torques of the logs of an estimate, and of others.
pub(super) fn residuals(train: &Validation, held_out: Option<&Validation>) -> Section {
    let columns = headings(&[
        ("joint", false),
        ("torque rms", true),
        ("residual rms", true),
        ("residual", true),
        ("residual, held out", true),
        ("largest residual", true),
        ("correlation with the next sample", true),
    ]);
    let rows = train.joints.iter().map(|joint| {
        let other = held_out.and_then(|all| all.joint(&joint.name));
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
    let caption = "Residuals [N m, N], after the filter. The filter makes the noise of \
                   neighbouring samples alike: also of a good fit this correlation is near 1 where \
                   samples are much faster than the filter.";
    let table = HtmlTable { caption: caption.to_owned(), columns, rows: rows.collect() };
    Section { heading: "Residuals".to_owned(), parts: vec![Part::Table(table)] }
}

/// What was noticed of the logs; none if nothing was.
pub(super) fn remarks(remarks: &[String]) -> Option<Section> {
    let paragraph = |text: &String| Part::Paragraph { text: text.clone() };
    let parts: Vec<Part> = remarks.iter().map(paragraph).collect();
    let heading = "Remarks on the logs".to_owned();
    (!parts.is_empty()).then_some(Section { heading, parts })
}

/// How far the nearest physically consistent parameters are, where the estimate is not so.
pub(super) fn nearest_bodies(distance: f64) -> String {
    match distance > 1.0 {
        true => format!(
            "The estimate is not physically consistent; the nearest one that is lies {} standard \
             errors away, over all parameters.",
            short(distance)
        ),
        false => String::new(),
    }
}

pub(super) fn headings(list: &[(&str, bool)]) -> Vec<Heading> {
    let heading =
        |&(text, is_number): &(&str, bool)| Heading { heading: text.to_owned(), is_number };
    list.iter().map(heading).collect()
}

pub(super) fn percent(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}

pub(super) fn share(value: f64) -> Cell {
    Cell::number(value, percent(value))
}
