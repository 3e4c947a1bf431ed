//! What the logs of a diagnosis could not have shown.

use super::super::html::{Cell, HtmlTable, Part, Row, Section, unit};
use super::super::percent;
use super::{DiagnosisPage, headings, rough};
use denavit_diagnose::Visible;

/// Effects of a joint that are listed at once; the others are folded.
const WORST: usize = 3;

impl DiagnosisPage<'_> {
    /// How large effects must be to be seen, those that are seen worst first.
    pub(super) fn unseen(&self) -> Option<Section> {
        let mut all: Vec<&Visible> = self.found.visible.iter().collect();
        all.sort_by(|a, b| b.share.total_cmp(&a.share));
        let (mut worst, mut rest) = (Vec::new(), Vec::new());
        let mut counts = vec![0; self.joints.len()];
        for one in all {
            let Some(count) = counts.get_mut(one.joint.0) else { continue };
            *count += 1;
            let list = if *count <= WORST { &mut worst } else { &mut rest };
            list.push(self.unseen_row(one));
        }
        if worst.is_empty() {
            return None;
        }
        let never = self.found.visible.iter().filter(|one| !one.least.is_finite()).count();
        let count = self.found.visible.len();
        let text = format!(
            "That an effect was not found says no more than that it is smaller than what these \
             logs would have shown. Of {count} effects of one parameter, {never} would never have \
             shown, however large."
        );
        let mut parts = vec![Part::Paragraph { text }, Part::Table(table(worst))];
        if !rest.is_empty() {
            let summary = "All other effects".to_owned();
            parts.push(Part::Folded { summary, parts: vec![Part::Table(table(rest))] });
        }
        let heading = "What these logs could not have shown".to_owned();
        Some(Section { heading, parts })
    }

    fn unseen_row(&self, one: &Visible) -> Row {
        let own = &self.candidates[one.candidate];
        let parameter = &own.law.parameters()[0];
        let is_seen = one.least.is_finite();
        let cells = match is_seen {
            true => [
                Cell::number(one.least, in_digits(one.least, &parameter.unit)),
                Cell::number(one.share, percent(one.share)),
            ],
            false => [f64::MAX; 2].map(|most| Cell::number(most, "never")),
        };
        let joint = self.joints[one.joint.0];
        let [least, share] = cells;
        let cells = vec![Cell::text(joint), Cell::prose(&own.title), least, share];
        Row { cells, is_marked: !is_seen }
    }
}

/// In three digits, with its unit.
fn in_digits(value: f64, of: &str) -> String {
    format!("{} {}", rough(value), unit(of)).trim_end().to_owned()
}

fn table(rows: Vec<Row>) -> HtmlTable {
    let columns = headings(&[
        ("joint", false),
        ("effect", false),
        ("seen from", true),
        ("of the torque of the joint", true),
    ]);
    let caption = "The least size at which an effect would have been named, and what it then is \
                   of the torque of its joint. Marked: the motion has nothing of it."
        .to_owned();
    HtmlTable { caption, columns, rows }
}
