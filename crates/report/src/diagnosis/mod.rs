//! What a model lacks, as a page.

mod law;
mod rivals;
mod robot;
mod unseen;
mod windows;
mod words;

use super::effects::formulas;
use super::html::{
    Cell, Chart, ChartCurve, Fact, Heading, HtmlTable, Look, Page, Panel, Part, Row, Section,
    mathml,
};
use super::jointed::JointedRobot;
use super::run::diagnosis_picture;
use super::{percent, short};
use denavit_codegen::effect::{Effect, Law};
use denavit_codegen::model::Robot;
use denavit_diagnose::{
    Candidate, Curve, Diagnosis, FoundEffect, Gap, Gaps, MotionGap, MotionGaps, Step, Where,
};
use law::law_chart;
use std::f64::consts::LN_10;
use windows::{windows, windows_table};
pub(crate) use words::closes;
pub use words::verdict_paragraph;
use words::{in_words, reasons, verdict};

/// Joints whose torques are drawn, at most.
const DRAWN: usize = 3;

/// The share of all that is left from which a joint is drawn.
const LEAST: f64 = 0.02;

/// What a page about a diagnosis says.
pub struct DiagnosisPage<'a> {
    model: &'a str,
    /// The robot in three dimensions; none where its numbers do not give it a shape.
    scene: Option<JointedRobot>,
    facts: &'a [Fact],
    remarks: &'a [String],
    joints: Vec<&'a str>,
    candidates: &'a [Candidate],
    effects: &'a [Effect],
    found: &'a Diagnosis,
}

/// What a page about a diagnosis is made of.
#[derive(Clone, Copy)]
pub struct DiagnosisSource<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// What it was made of: version, hash of the model, logs, seed.
    pub facts: &'a [Fact],
    /// What was noticed of the logs, and of the files that were written.
    pub remarks: &'a [String],
    /// Names of the joints.
    pub joints: &'a [&'a str],
    /// What may be missing.
    pub candidates: &'a [Candidate],
    /// The laws of these.
    pub effects: &'a [Effect],
    /// What was found.
    pub found: &'a Diagnosis,
}

/// Torques of one log, and what both models leave of them.
fn torque_chart(joint: &str, curve: &Curve) -> Chart {
    let computed = |left: &[f64]| -> Vec<f64> {
        curve.measured.iter().zip(left).map(|(torque, left)| torque - left).collect()
    };
    let torques = vec![
        ChartCurve::new("measured", Look::Measured, curve.measured.clone()),
        ChartCurve::new("nominal model", Look::Before, computed(&curve.before)),
        ChartCurve::new("with the effects", Look::Computed, computed(&curve.after)),
    ];
    let left = vec![
        ChartCurve::new("residual before", Look::Before, curve.before.clone()),
        ChartCurve::new("residual with the effects", Look::Residual, curve.after.clone()),
    ];
    Chart {
        name: format!("{}, {}", joint.replace('_', " "), curve.file),
        caption: String::new(),
        group: "torques",
        over: ["time [s]", "time [s]"],
        x: curve.t_s.clone(),
        panels: vec![
            Panel::new("torque [N m, N]", 190, torques),
            Panel::new("residual [N m, N]", 100, left),
        ],
        windows: windows(curve).iter().map(|one| [one.from_s, one.to_s]).collect(),
    }
    .thinned()
}

impl<'a> DiagnosisPage<'a> {
    /// The page of what was found.
    pub fn new(source: DiagnosisSource<'a>) -> Self {
        let DiagnosisSource { robot, facts, remarks, joints, candidates, effects, found } = source;
        let scene = JointedRobot::new(robot).ok();
        let joints = joints.to_vec();
        Self { model: &robot.name, scene, facts, remarks, joints, candidates, effects, found }
    }
}

impl DiagnosisPage<'_> {
    /// The page.
    pub fn page(&self) -> Page {
        let mut sections = vec![self.gaps()];
        sections.extend(self.robot());
        sections.extend(self.terms());
        sections.push(self.torques());
        sections.extend(self.unnamed());
        sections.push(self.regimes());
        sections.extend(self.unseen());
        sections.extend(self.evidence());
        if !self.remarks.is_empty() {
            let parts =
                self.remarks.iter().map(|text| Part::Paragraph { text: text.clone() }).collect();
            sections.push(Section { heading: "Remarks".to_owned(), parts });
        }
        Page {
            watches: false,
            title: format!("Diagnosis of {}", self.model.replace('_', " ")),
            verdict: Some(verdict(self.found, self.candidates)),
            lead: reasons(self.found),
            facts: self.facts.to_vec(),
            sections,
        }
    }

    fn gaps(&self) -> Section {
        let columns = headings(&[
            ("joint", false),
            ("before, after, noise", false),
            ("train before", true),
            ("after", true),
            ("noise", true),
            ("held out before", true),
            ("after", true),
            ("noise", true),
        ]);
        let sets = [&self.found.train, &self.found.held_out];
        let of = |value: &dyn Fn(&Gap) -> Option<f64>| -> Vec<Cell> {
            let gaps = sets.iter().flat_map(|set| [&set.before, &set.after, &set.floor]);
            gaps.map(|gap| value(gap).map_or_else(|| Cell::text(""), share)).collect()
        };
        let mut rows: Vec<Row> = Vec::new();
        for (place, name) in self.found.places.iter().enumerate() {
            let numbers = of(&|gap| gap.per_joint.get(place).copied().flatten());
            let bars = self.bars(&|gap| gap.per_joint.get(place).copied().flatten());
            let cells = [vec![Cell::text(name), bars], numbers].concat();
            rows.push(Row { cells, is_marked: false });
        }
        let all = |gap: &Gap| Some(gap.all);
        let cells = [vec![Cell::text("all"), self.bars(&all)], of(&all)].concat();
        rows.push(Row { cells, is_marked: true });
        let caption =
            "Torque mismatch: size of the residual over that of the torque (root of mean square), \
                       before and after the effects, and of noise alone. All: root of mean square \
                       over the joints and springs. Bars are of the held-out logs."
                .to_owned();
        let mut parts = vec![Part::Table(HtmlTable { caption, columns, rows })];
        parts.extend(self.in_motion());
        Section { heading: "Torque mismatch".to_owned(), parts }
    }

    /// What is left of held-out logs before, after and of noise, beside that of other joints.
    fn bars(&self, value: &dyn Fn(&Gap) -> Option<f64>) -> Cell {
        let Gaps { before, after, floor, .. } = &self.found.held_out;
        let sizes = [before, after, floor].map(|gap| value(gap).unwrap_or(0.0));
        let of_joints = before.per_joint.iter().chain(&after.per_joint).flatten().copied();
        Cell::bars(&sizes, of_joints.fold(before.all, f64::max), "")
    }

    /// The gap of the models in motion.
    fn in_motion(&self) -> Option<Part> {
        let MotionGaps { train, held_out } = match self.found.motion.as_ref()? {
            Ok(gaps) => gaps,
            Err(reason) => {
                return Some(Part::Paragraph { text: format!("Not simulated: {reason}.") });
            }
        };
        let columns = headings(&[
            ("joint", false),
            ("train before", true),
            ("after", true),
            ("held out before", true),
            ("after", true),
        ]);
        let row = |name: &str, value: &dyn Fn(&MotionGap) -> Option<f64>| -> Vec<Cell> {
            let gaps = train.iter().chain(held_out);
            let cells = gaps.map(|gap| value(gap).map_or_else(|| Cell::text(""), share));
            std::iter::once(Cell::text(name)).chain(cells).collect()
        };
        let of_joint = |(joint, name): (usize, &&str)| Row {
            cells: row(name, &|gap| gap.per_joint.get(joint).copied().flatten()),
            is_marked: false,
        };
        let mut rows: Vec<Row> = self.joints.iter().enumerate().map(of_joint).collect();
        rows.push(Row { cells: row("all", &|gap| Some(gap.all)), is_marked: true });
        let caption = "Simulation mismatch: errors of positions in short windows from measured \
                       states under measured torques, over how far joints went (root of mean \
                       square)."
            .to_owned();
        Some(Part::Table(HtmlTable { caption, columns, rows }))
    }

    /// The joints that leave most, at least one.
    fn worst(&self) -> impl Iterator<Item = &Where> {
        let count = self.found.before.iter().filter(|one| one.share > LEAST).count();
        self.found.before.iter().take(count.clamp(1, DRAWN))
    }

    /// Torques of these joints, each in the held-out log where it leaves most.
    fn torque_curves(&self) -> Vec<(&str, &Curve)> {
        let squares = |curve: &Curve| curve.before.iter().map(|left| left * left).sum::<f64>();
        let of_joint = |one: &Where| -> Option<(&str, &Curve)> {
            let own = self.found.curves.iter().filter(|curve| curve.at == one.joint);
            let most = own.max_by(|a, b| squares(a).total_cmp(&squares(b)))?;
            Some((most.at.as_str(), most))
        };
        self.worst().filter_map(of_joint).collect()
    }

    fn torques(&self) -> Section {
        let shown = self.torque_curves();
        let text = "Held-out logs, the joints with the largest residuals: torques that were \
                    measured, and those of the model, its parameters estimated again, without and \
                    with the effects; below, the residuals of both. All through one filter."
            .to_owned();
        let mut parts = vec![Part::Paragraph { text }];
        parts.extend(shown.iter().map(|(joint, curve)| Part::Chart(torque_chart(joint, curve))));
        parts.extend(windows_table(&shown));
        let svg = diagnosis_picture(&self.model.replace('_', " "), &shown);
        let caption = "Where the residual of the nominal model is largest.".to_owned();
        let summary = "As a picture for papers".to_owned();
        parts.push(Part::Folded { summary, parts: vec![Part::Figure { svg, caption }] });
        Section { heading: "Torques".to_owned(), parts }
    }

    /// What was found: law, parameters, what would do as well.
    fn terms(&self) -> Option<Section> {
        if self.found.effects.is_empty() {
            return None;
        }
        let parts = self.found.effects.iter().flat_map(|one| self.term(one)).collect();
        Some(Section { heading: "What was found".to_owned(), parts })
    }

    fn term(&self, one: &FoundEffect) -> Vec<Part> {
        let own = &self.candidates[one.candidate];
        let doubt = if one.is_named { "New" } else { "Nearest to something without a name" };
        let closes = match closes(one) {
            Some(share) => format!("It closes {share} of the torque mismatch."),
            None => "Without it the other terms, estimated again, explain the held-out logs as \
                     well: what speaks for it are its odds."
                .to_owned(),
        };
        let (title, at, odds) = (&own.title, own.at_in_words(), odds(one.log_odds));
        let text = format!("{doubt}: {title} at {at}. Its odds are {odds}. {closes}");
        let mut parts = vec![Part::Paragraph { text }];
        if let Some(effect) = self.effects.iter().find(|effect| effect.name == own.effect) {
            let new = formulas(effect).into_iter().map(|formula| marked(effect, &own.at, formula));
            parts.extend(new.map(|latex| match mathml(&latex, true) {
                Ok(mathml) => Part::Formula { mathml },
                Err(_) => Part::Paragraph { text: latex },
            }));
        }
        parts.extend(one.curve.as_ref().map(|curve| {
            let title = own.title.clone();
            Part::Chart(law_chart(&title, "", curve))
        }));
        parts.push(Part::Table(self.values(one)));
        parts.push(self.rivals(one));
        parts.extend(self.separating(one));
        parts
    }

    /// The parameters of an effect.
    fn values(&self, one: &FoundEffect) -> HtmlTable {
        let columns = headings(&[
            ("parameter", false),
            ("value", true),
            ("standard error", true),
            ("unit", false),
        ]);
        let rows = one.parameters.iter().map(|value| {
            let std = match value.std.is_finite() {
                true => Cell::number(value.std, two_digits(value.std)),
                false => Cell::text("not determined"),
            };
            let cells = vec![
                Cell::text(&value.name),
                Cell::number(value.value, short(value.value)),
                std,
                Cell::unit(&value.unit),
            ];
            Row { cells, is_marked: false }
        });
        let caption = format!("Parameters of {}.", in_words(&self.candidates[one.candidate]));
        HtmlTable { caption, columns, rows: rows.collect() }
    }

    /// What joints still lack, as formulas without a name.
    fn unnamed(&self) -> Option<Section> {
        let of = |one: &denavit_diagnose::Structure| {
            let joint = &one.at;
            let (share, formula) = (percent(one.share), one.formula());
            let text = format!(
                "{joint} still lacks something without a name; {formula} explains {share} of \
                 its squares."
            );
            Part::Paragraph { text }
        };
        let parts: Vec<Part> = self.found.structures.iter().map(of).collect();
        (!parts.is_empty()).then(|| Section { heading: "Without a name".to_owned(), parts })
    }

    fn regimes(&self) -> Section {
        let columns = headings(&[
            ("joint", false),
            ("state of motion", false),
            ("share of time", true),
            ("share of squares before", true),
            ("of it remains", true),
        ]);
        let mut rows = Vec::new();
        for one in self.worst() {
            let after = self.found.after.iter().find(|other| other.joint == one.joint);
            // both are over the same noise
            let kept = after.map(|after| (after.over_noise / one.over_noise).powi(2));
            for part in &one.parts {
                let same = after
                    .and_then(|after| after.parts.iter().find(|other| other.regime == part.regime));
                let left = same.zip(kept).map(|(same, kept)| kept * same.share / part.share);
                let cells = vec![
                    Cell::text(&one.joint),
                    Cell::text(part.regime.to_string()),
                    share(part.time),
                    share(part.share),
                    left.map_or_else(|| Cell::text(""), share),
                ];
                rows.push(Row { cells, is_marked: part.excess() > 0.15 });
            }
        }
        let sentences = self.found.before.iter().filter(|one| one.share > 0.05);
        let mut parts: Vec<Part> =
            sentences.map(|one| Part::Paragraph { text: one.sentence() + "." }).collect();
        let caption =
            "Squared residual of a joint's torque in the logs for training, by states of \
                       its motion, which overlap. Marked: more than their time has."
                .to_owned();
        parts.push(Part::Table(HtmlTable { caption, columns, rows }));
        Section { heading: "Where".to_owned(), parts }
    }

    fn evidence(&self) -> Option<Section> {
        if self.found.steps.is_empty() {
            return None;
        }
        let mut parts = Vec::new();
        for (round, step) in self.found.steps.iter().enumerate() {
            parts.push(Part::Paragraph { text: self.round(round, step) });
            let columns = headings(&[("candidate", false), ("log10 of odds", true)]);
            let winner = (step.added, step.log_odds, true);
            let others = step.runners_up.iter().map(|&(other, odds)| (other, odds, false));
            let rows = std::iter::once(winner).chain(others).map(|(candidate, log, is_marked)| {
                let name = Cell::text(in_words(&self.candidates[candidate]));
                let tens = log / LN_10;
                let odds = Cell::number(tens, format!("{tens:.1}"));
                Row { cells: vec![name, odds], is_marked }
            });
            let caption = "The best of the round, marked, and those that came next.".to_owned();
            parts.push(Part::Table(HtmlTable { caption, columns, rows: rows.collect() }));
        }
        parts.extend(self.exchanged().map(|text| Part::Paragraph { text }));
        Some(Section { heading: "Evidence".to_owned(), parts })
    }

    /// What rounds took and is not there in the end, and what is there in its place.
    fn exchanged(&self) -> Option<String> {
        let taken: Vec<usize> =
            self.found.steps.iter().filter(|step| step.is_taken).map(|step| step.added).collect();
        let found: Vec<usize> = self.found.effects.iter().map(|one| one.candidate).collect();
        let without = |all: &[usize], others: &[usize]| -> String {
            let rest = all.iter().filter(|one| !others.contains(one));
            rest.map(|&one| in_words(&self.candidates[one])).collect::<Vec<_>>().join(", ")
        };
        let [gone, new] = [without(&taken, &found), without(&found, &taken)];
        let text = "After each round effects are exchanged for others that make the logs more \
                    likely";
        match (gone.is_empty(), new.is_empty()) {
            (false, false) => Some(format!("{text}: {new} stands in the place of {gone}.")),
            (false, true) => Some(format!("{text}, or left out: {gone} is not there in the end.")),
            _ => None,
        }
    }

    fn round(&self, round: usize, step: &Step) -> String {
        format!(
            "Round {}: {} {}. Its odds are {}, and it does {} of the torque of its joint.",
            round + 1,
            in_words(&self.candidates[step.added]),
            if step.is_taken { "was taken" } else { "was not taken" },
            odds(step.log_odds),
            percent(step.size),
        )
    }
}

/// Odds in words: as powers of ten where they are large.
fn odds(log_odds: f64) -> String {
    let tens = log_odds / LN_10;
    if tens.abs() < 3.0 { rough(log_odds.exp()) } else { format!("10{}", raised(tens)) }
}

/// In three digits.
fn rough(value: f64) -> String {
    format!("{value:.2e}").parse().map_or_else(|_| value.to_string(), short)
}

/// A whole number as an exponent.
fn raised(tens: f64) -> String {
    const DIGITS: [char; 10] = [
        '\u{2070}', '\u{b9}', '\u{b2}', '\u{b3}', '\u{2074}', '\u{2075}', '\u{2076}', '\u{2077}',
        '\u{2078}', '\u{2079}',
    ];
    let letter = |letter: char| match letter.to_digit(10) {
        Some(digit) => DIGITS[digit as usize],
        None => '\u{207b}',
    };
    format!("{tens:.0}").chars().map(letter).collect()
}

/// A line of a law as a new term of the equation that it is part of.
fn marked(effect: &Effect, at: &str, formula: String) -> String {
    let (first, second) = at.split_once(" with ").unwrap_or((at, at));
    let of_joint = [(r"\tau = ", first), (r"\tau_2 = ", second)];
    let mut torques = of_joint.iter().filter_map(|(is, at)| Some((formula.strip_prefix(is)?, *at)));
    match (&effect.law, torques.next()) {
        (Law::Torque(_) | Law::Term(_), Some((law, at))) => {
            // nothing of a name is a command
            let is_plain = |letter: &char| letter.is_alphanumeric() || " _".contains(*letter);
            let at: String = at.chars().filter(is_plain).collect();
            let at = at.replace(['_', ' '], r"\ ");
            let nominal = r"\tau_{\mathrm{nominal}}";
            let new = format!(r"\underbrace{{{law}}}_{{\mathrm{{new}}}}");
            format!(r"\tau_{{\mathrm{{{at}}}}} = {nominal} + {new}")
        }
        _ => formula,
    }
}

fn headings(list: &[(&str, bool)]) -> Vec<Heading> {
    let heading =
        |&(text, is_number): &(&str, bool)| Heading { heading: text.to_owned(), is_number };
    list.iter().map(heading).collect()
}

fn share(value: f64) -> Cell {
    Cell::number(value, percent(value))
}

/// An error as a person writes it: two digits say all of it.
fn two_digits(value: f64) -> String {
    format!("{value:.1e}").parse().map_or_else(|_| short(value), short)
}
