//! The time in which effects show: the windows that have half of what they explain.

use super::super::html::{Cell, HtmlTable, Part, Row};
use super::super::short;
use super::{headings, share};
use denavit_diagnose::Curve;

/// Windows of a log.
const WINDOWS: usize = 60;

/// The share of what is explained that windows have together.
const HALF: f64 = 0.5;

/// Windows of a joint that are listed, at most.
const LISTED: usize = 5;

/// A stretch of time with its share of what the effects explain of a joint.
pub(super) struct Window {
    pub(super) from_s: f64,
    pub(super) to_s: f64,
    pub(super) share: f64,
}

/// The windows of a log that have half of what effects explain of its torque, in their order; none
/// where they explain nothing.
pub(super) fn windows(curve: &Curve) -> Vec<Window> {
    let rows = curve.t_s.len();
    let length = rows.div_ceil(WINDOWS).max(1);
    let explained = |from: usize| -> f64 {
        let rows = from..(from + length).min(rows);
        rows.map(|row| curve.before[row].powi(2) - curve.after[row].powi(2)).sum()
    };
    let all: Vec<(usize, f64)> =
        (0..rows).step_by(length).map(|from| (from, explained(from))).collect();
    let whole: f64 = all.iter().map(|(_, squares)| squares.max(0.0)).sum();
    let mut most: Vec<(usize, f64)> = all.into_iter().filter(|(_, part)| *part > 0.0).collect();
    most.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut sum = 0.0;
    let mut chosen: Vec<(usize, f64)> = Vec::new();
    for (from, part) in most {
        if sum >= HALF * whole {
            break;
        }
        sum += part;
        chosen.push((from, part));
    }
    chosen.sort_by_key(|(from, _)| *from);
    let mut joined: Vec<(usize, usize, f64)> = Vec::new();
    for (from, part) in chosen {
        let to = (from + length).min(rows - 1);
        match joined.last_mut().filter(|last| last.1 == from) {
            Some(last) => (last.1, last.2) = (to, last.2 + part),
            None => joined.push((from, to, part)),
        }
    }
    let window = |(from, to, part): (usize, usize, f64)| Window {
        from_s: curve.t_s[from],
        to_s: curve.t_s[to],
        share: part / whole.max(f64::MIN_POSITIVE),
    };
    joined.into_iter().map(window).collect()
}

/// The windows that have most, of each joint.
pub(super) fn windows_table(curves: &[(&str, &Curve)]) -> Option<Part> {
    let mut rows = Vec::new();
    for (joint, curve) in curves {
        let mut own = windows(curve);
        own.sort_by(|a, b| b.share.total_cmp(&a.share));
        own.truncate(LISTED);
        rows.extend(own.iter().map(|one| {
            let time = format!("{} to {}", short(one.from_s), short(one.to_s));
            let cells = vec![
                Cell::text(*joint),
                Cell::text(&curve.file),
                Cell::number(one.from_s, time),
                share(one.share),
            ];
            Row { cells, is_marked: false }
        }));
    }
    let columns = headings(&[
        ("joint", false),
        ("log", false),
        ("time [s]", true),
        ("share of what is explained", true),
    ]);
    let caption = "Where it shows: the windows with most of what the effects explain. Those with \
                   half of it are shaded in the curves."
        .to_owned();
    (!rows.is_empty()).then_some(Part::Table(HtmlTable { caption, columns, rows }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_effect_of_one_second_shows_there() {
        let t_s: Vec<f64> = (0..600).map(|at| 0.01 * f64::from(at)).collect();
        let bump = |t: &f64| if (2.0..3.0).contains(t) { 1.0 } else { 0.0 };
        let curve = Curve {
            file: "log".to_owned(),
            at: "joint".to_owned(),
            before: t_s.iter().map(bump).collect(),
            after: vec![0.0; 600],
            as_given: t_s.iter().map(bump).collect(),
            measured: vec![0.0; 600],
            t_s,
        };
        let found = windows(&curve);
        assert!(!found.is_empty());
        assert!(found.iter().all(|one| one.from_s > 1.9 && one.to_s < 3.11));
        let sum: f64 = found.iter().map(|one| one.share).sum();
        assert!((0.5..0.7).contains(&sum), "{sum}");
    }
}
