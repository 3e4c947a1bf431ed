//! Springs, motors and the load, identified in two stages, as a page.

use super::html::{Cell, Fact, FormulaError, HtmlTable, Page, Part, Row, Section};
use super::identification::{
    base_parameters, headings, nearest_bodies, percent, remarks, residuals, torques,
};
use super::short;
use denavit_elastic::{Estimate, Spring};
use denavit_identify::estimate::{IdentifiedParameter, Validation};

/// What a page about an identification in two stages says.
#[derive(Clone, Copy, Debug)]
pub struct TwoStagePage<'a> {
    /// The model's name.
    pub model: &'a str,
    /// What it was made of: version, hash of the model, logs.
    pub facts: &'a [Fact],
    /// What was noticed of the logs.
    pub remarks: &'a [String],
    /// The first stage.
    pub springs: &'a [Spring],
    /// The base parameters of the load.
    pub parameters: &'a [IdentifiedParameter],
    /// What they leave of the torques on the loads, in the log of the estimate.
    pub train: &'a Validation,
    /// What they leave of other logs, if there are any.
    pub validate: Option<&'a Validation>,
    /// Standard errors to the nearest bodies that exist.
    pub distance: f64,
}

impl TwoStagePage<'_> {
    /// The page.
    pub fn page(&self) -> Result<Page, FormulaError> {
        let mut sections = vec![
            self.springs(),
            self.load()?,
            torques(self.train, self.validate),
            residuals(self.train, self.validate),
        ];
        sections.extend(remarks(self.remarks));
        Ok(Page {
            watches: false,
            title: format!("Identification of {} in two stages", self.model.replace('_', " ")),
            verdict: None,
            lead: self.lead(),
            facts: self.facts.to_vec(),
            sections,
        })
    }

    fn lead(&self) -> String {
        let mut text = format!(
            "{} springs and their motors are identified first, then {} base parameters of the \
             load, from the torques that the springs pass on. The residual is {} of these torques",
            self.springs.len(),
            self.parameters.len(),
            percent(self.train.relative),
        );
        if let Some(held_out) = self.validate {
            text += &format!(", and {} of those of other logs", percent(held_out.relative));
        }
        format!("{text}. {}", nearest_bodies(self.distance)).trim_end().to_owned()
    }

    fn load(&self) -> Result<Section, FormulaError> {
        let parts = vec![Part::Table(base_parameters(self.parameters)?)];
        Ok(Section { heading: "Parameters of the load".to_owned(), parts })
    }

    fn springs(&self) -> Section {
        let columns = headings(&[
            ("joint", false),
            ("stiffness [N/m]", true),
            ("viscous friction [N m s/rad]", true),
            ("Coulomb friction [N m]", true),
            ("zero of the motor [rad]", true),
            ("torque rms [N m]", true),
            ("residual rms [N m]", true),
            ("left", true),
        ]);
        let estimate = |Estimate { value, std }: Estimate| {
            Cell::number(value, format!("{} ± {std:.1e}", short(value)))
        };
        let number = |value: f64| Cell::number(value, short(value));
        let rows = self.springs.iter().map(|spring| {
            // a motor at rest has no torque, of which nothing can be left
            let left = spring.residual / spring.torque.max(f64::MIN_POSITIVE);
            let cells = vec![
                Cell::text(&spring.joint),
                estimate(spring.stiffness),
                estimate(spring.viscous),
                estimate(spring.coulomb),
                estimate(spring.motor_zero),
                number(spring.torque),
                number(spring.residual),
                Cell::number(left, percent(left)),
            ];
            Row { cells, is_marked: false }
        });
        let caption = "Springs and motors, each with its standard error; the residual of each \
                       motor's torque, less that of its inertia.";
        let table = HtmlTable { caption: caption.to_owned(), columns, rows: rows.collect() };
        Section { heading: "Springs and motors".to_owned(), parts: vec![Part::Table(table)] }
    }
}
