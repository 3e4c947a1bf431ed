//! What would do as well as an effect that was found, and the motion that would tell.

use super::super::html::{Cell, HtmlTable, Part, Row, SceneMark};
use super::super::jointed::{JointMotion, JointedRobot, RATE};
use super::super::percent;
use super::{DiagnosisPage, headings, odds, rough};
use denavit_diagnose::{Alternative, Experiment, FoundEffect};

impl DiagnosisPage<'_> {
    /// The effects that would do in the place of one that was found, with their odds.
    pub(super) fn rivals(&self, one: &FoundEffect) -> Part {
        let separated = match &one.experiment {
            Some(Ok(found)) => found.rivals.as_slice(),
            _ => &[],
        };
        let told = |other: &Alternative| match other.is_exact {
            true => "no motion: the equations are the same",
            false if separated.contains(&other.candidate) => "the motion below",
            false => "other logs: no motion was found",
        };
        let row = |other: &Alternative, told: &str| {
            let own = &self.candidates[other.candidate];
            let odds = Cell::number(other.log_odds, odds(other.log_odds));
            let at = Cell::text(own.at_in_words());
            let cells = vec![Cell::prose(&own.title), at, odds, Cell::prose(told)];
            Row { cells, is_marked: other.is_exact }
        };
        let finer = "a finer form of it: these logs do not ask for it";
        let finer = one.finer.iter().map(|other| row(other, finer));
        let others = one.alternatives.iter().map(|other| row(other, told(other)));
        let rows: Vec<Row> = others.chain(finer).collect();
        if rows.is_empty() {
            let text = "No other effect of the catalogue comes near: with any in its place these \
                        logs are less than a hundredth as likely."
                .to_owned();
            return Part::Paragraph { text };
        }
        let columns = headings(&[
            ("rival", false),
            ("at", false),
            ("odds against it", true),
            ("what would tell them apart", false),
        ]);
        let caption = "Rivals, effects that would do in its place, and finer forms of its law. \
                       Odds near 1 mean that these logs do not tell."
            .to_owned();
        Part::Table(HtmlTable { caption, columns, rows })
    }

    /// The motion that would tell an effect from its rivals, to be played.
    pub(super) fn separating(&self, one: &FoundEffect) -> Vec<Part> {
        let found = match &one.experiment {
            None => return Vec::new(),
            Some(Err(reason)) => {
                let text = format!("No motion was found that would tell it apart: {reason}.");
                return vec![Part::Paragraph { text }];
            }
            Some(Ok(found)) => found,
        };
        let text = format!(
            "A motion of {} s within the limits of the robot tells it from its rivals in {} of {} \
             simulated logs with the same noise. Its separation is {}, that of these logs {}.",
            found.duration_s,
            percent(found.power),
            found.draws,
            rough(found.separation),
            rough(found.separation_before)
        );
        let motion = self.scene.as_ref().and_then(|scene| self.played(scene, one, found));
        [Some(Part::Paragraph { text }), motion].into_iter().flatten().collect()
    }

    fn played(&self, scene: &JointedRobot, one: &FoundEffect, found: &Experiment) -> Option<Part> {
        let frames = (found.duration_s * RATE).ceil() as usize;
        let t_s: Vec<f64> =
            (0..=frames).map(|at| found.duration_s * at as f64 / frames as f64).collect();
        let of_joint = |reference: &denavit_plants::trajectory::Reference| -> Vec<f64> {
            t_s.iter().map(|t| reference.at(*t).position).collect()
        };
        let positions: Vec<Vec<f64>> = found.references.iter().map(of_joint).collect();
        let joints = self.joints.iter().copied().zip(positions.iter().map(Vec::as_slice));
        let motion = JointMotion { t_s: &t_s, q: joints.collect(), ..JointMotion::default() };
        let name = format!("The motion that tells {} apart", self.candidates[one.candidate].name());
        let caption =
            "The separating experiment, one lap. Its file is beside this page.".to_owned();
        let (scene, mark) = self.marked(scene, one);
        scene.moving([name, caption], mark, &motion).map(Part::Replay)
    }

    /// The robot with the joint or the body of an effect marked, and the words for that.
    pub(super) fn marked(
        &self,
        scene: &JointedRobot,
        one: &FoundEffect,
    ) -> (JointedRobot, Vec<SceneMark>) {
        let own = &self.candidates[one.candidate];
        let names: Vec<&str> = own.at.split(" with ").collect();
        let word = format!("{} at {}", own.title, own.at_in_words());
        (scene.clone().marking(&names, own.is_body), vec![SceneMark::marked(word)])
    }
}
