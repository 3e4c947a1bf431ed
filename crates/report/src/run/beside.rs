//! A log beside a run: how far the one is from the other.

use super::shown_joints;
use super::{RunPicture, Windowed};
use crate::html::{Cell, Heading, HtmlTable, Part, Row};
use crate::short;
use denavit_plants::PlantModel;
use denavit_simulate::Log;
use denavit_workflow::LogBeside;

/// Joints that are compared, at most.
const MOST: usize = 24;

/// A signal of a log at the times of a run; no number where the log has none.
pub(super) fn at_times(log: &LogBeside, signal: &[f64], times: &[f64]) -> Vec<f64> {
    times.iter().map(|&t| log.at(signal, t).unwrap_or(f64::NAN)).collect()
}

/// What was measured of a joint: its place among all.
pub(super) fn place_of(model: &PlantModel, name: &str) -> Option<usize> {
    model.joints.iter().position(|joint| joint.name == name)
}

/// Root of the mean square of a difference, its largest, and when; none where nothing is compared.
fn difference(times: &[f64], a: &[f64], b: &[f64]) -> Option<[f64; 3]> {
    let (mut squares, mut count) = (0.0, 0_usize);
    let (mut most, mut at) = (0.0, f64::NAN);
    for ((&t, a), b) in times.iter().zip(a).zip(b) {
        let off = a - b;
        if !off.is_finite() {
            continue;
        }
        squares += off * off;
        count += 1;
        if off.abs() > most || at.is_nan() {
            (most, at) = (off.abs(), t);
        }
    }
    (count > 0).then(|| [(squares / count as f64).sqrt(), most, at])
}

/// How far a run is from a log, joint by joint; says so where they have no time in common.
pub(crate) fn beside_parts(model: &PlantModel, log: &Log, beside: &LogBeside) -> Vec<Part> {
    let picture = RunPicture { title: "", subtitle: "", log, window_s: None };
    let shown = Windowed::new(&picture);
    let mut rows = Vec::new();
    for joint in shown_joints(model, &shown, MOST) {
        let Some(place) = place_of(model, &joint.name) else { continue };
        let unit = |turned: &str, slid: &str| if joint.slides { slid } else { turned }.to_owned();
        let torque = beside.torque[place].as_deref().zip(joint.torque.as_deref());
        let signals = [
            (
                format!("position [{}]", unit("rad", "m")),
                Some((&beside.q[place][..], &joint.position[..])),
            ),
            (format!("torque [{}]", unit("N m", "N")), torque),
        ];
        for (what, both) in signals {
            let Some((measured, simulated)) = both else { continue };
            let measured = at_times(beside, measured, &shown.times);
            let found = difference(&shown.times, simulated, &measured);
            let Some([rms, most, at]) = found else { continue };
            let number = |value: f64| {
                let text = format!("{value:.2e}").parse().map_or_else(|_| short(value), short);
                Cell::number(value, text)
            };
            let cells = vec![
                Cell::text(joint.name.replace('_', " ")),
                Cell::text(what),
                number(rms),
                number(most),
                Cell::number(at, format!("{at:.3}")),
            ];
            rows.push(Row { cells, is_marked: false });
        }
    }
    let span = format!("{} to {} s", short(beside.start_s), short(beside.end_s()));
    let mut parts = Vec::new();
    let is_beside = |t_s: &f64| (beside.start_s..=beside.end_s()).contains(t_s);
    if rows.is_empty() {
        let file = &beside.file;
        let text = match shown.times.iter().any(is_beside) {
            false => format!("{file} ({span}) has no time in common with the run."),
            true => format!("Nothing of {file} ({span}) is compared: no joint of the run moves."),
        };
        parts.push(Part::Paragraph { text });
    } else {
        let headings = [
            ("joint", false),
            ("signal", false),
            ("root of mean square", true),
            ("largest", true),
            ("at [s]", true),
        ];
        let heading =
            |(text, is_number): (&str, bool)| Heading { heading: text.to_owned(), is_number };
        let caption = format!(
            "Simulated less measured, while both are there: {} is from {span}. Nothing was \
             aligned in time.",
            beside.file
        );
        let columns = headings.map(heading).to_vec();
        parts.push(Part::Table(HtmlTable { caption, columns, rows }));
    }
    let remark = |text: &String| Part::Paragraph { text: format!("{}: {text}.", beside.file) };
    parts.extend(beside.remarks.iter().map(remark));
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_told_with_its_largest_and_when() {
        let times = [0.0, 1.0, 2.0, 3.0];
        let [rms, most, at] =
            difference(&times, &[0.0, 3.0, 0.0, 7.0], &[0.0, -1.0, 0.0, f64::NAN]).expect("some");
        assert!((rms - (16.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert_eq!((most, at), (4.0, 1.0));
        assert!(difference(&times, &[0.0; 4], &[f64::NAN; 4]).is_none());
    }
}
