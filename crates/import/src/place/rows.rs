//! The fewest rows `Rx(alpha) Tx(a) Rz(theta) Tz(d)` that make a pose.
//!
//! A pose is a translation, turns that are no quarter turns, and a quarter turn. What is left of it
//! after a row depends on which of the three numbers of the position are still to be made, how many
//! turns are, and which quarter turn the frame has: some hundred states. The shortest way through
//! them to nothing left is searched once for each shape of a pose, since numbers do not matter.

use super::angle::Angle;
use super::quarter::Quarter;
use super::turn::{Pose, Turn, normal};
use denavit_codegen::number::Rational;
use num_traits::Zero;
use rustc_hash::FxHashMap;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A row of constants.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Row {
    pub(crate) alpha: Angle,
    pub(crate) a: Rational,
    pub(crate) theta: Angle,
    pub(crate) d: Rational,
}

impl Row {
    /// The row that does nothing.
    pub(crate) fn nothing() -> Self {
        let zero = Angle::zero;
        Self { alpha: zero(), a: Rational::zero(), theta: zero(), d: Rational::zero() }
    }
}

/// What poses have in common that are made by the same rows but for their numbers.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Shape {
    /// Which numbers of the position are not 0.
    moves: [bool; 3],
    /// The axes of the turns that are no quarter turns.
    turns: Vec<usize>,
    quarter: Quarter,
}

/// What is left of a pose, in the axes of the frame that was reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Left {
    /// The number of the position along each axis, by its place in the pose, and its sign.
    moves: [Option<(u8, bool)>; 3],
    /// How many turns are made.
    turned: u8,
    /// The quarter turn from the pose's axes to those of the frame.
    frame: Quarter,
}

/// A turn of a row: some quarters, and one of the pose's turns perhaps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Spin {
    quarters: u8,
    turn: Option<(u8, bool)>,
}

/// A row without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Step {
    alpha: Spin,
    a: Option<(u8, bool)>,
    theta: Spin,
    d: Option<(u8, bool)>,
}

/// What a row costs beside the quarter turns in it.
const ROW_COST: u32 = 64;
/// A pose has up to this many turns; a file's frame has three, its axis two more.
const MAX_TURNS: usize = 12;

/// Searches rows, and remembers what it found for other poses of the same shape.
#[derive(Debug, Default)]
pub(crate) struct RowSearch {
    known: FxHashMap<Shape, Vec<Step>>,
}

impl RowSearch {
    /// The fewest rows that make a pose: none if it is none.
    pub(crate) fn rows(&mut self, pose: &Pose) -> Vec<Row> {
        let (turns, quarter) = normal(&pose.turns);
        if turns.len() > MAX_TURNS {
            // no frame of a file is made of so many: one half after the other
            let (first, second) = pose.turns.split_at(pose.turns.len() / 2);
            let first = Pose { at: pose.at.clone(), turns: first.to_vec() };
            let mut rows = self.rows(&first);
            rows.extend(self.rows(&Pose::turned(second.to_vec())));
            return rows;
        }
        let moves = pose.at.each_ref().map(|length| !length.is_zero());
        let shape = Shape { moves, turns: turns.iter().map(|turn| turn.axis).collect(), quarter };
        let steps = self.known.entry(shape).or_insert_with_key(search);
        steps.iter().map(|step| row(step, pose, &turns)).collect()
    }

    /// The fewest rows of poses one after the other.
    pub(crate) fn rows_along(&mut self, way: &[Pose]) -> Vec<Row> {
        let mut rows = Vec::new();
        let mut before: Option<Pose> = None;
        for pose in way {
            before = Some(match before {
                None => pose.clone(),
                Some(known) => match known.then(pose) {
                    Some(both) => both,
                    None => {
                        rows.extend(self.rows(&known));
                        pose.clone()
                    }
                },
            });
        }
        rows.extend(before.iter().flat_map(|pose| self.rows(pose)));
        rows
    }
}

fn row(step: &Step, pose: &Pose, turns: &[Turn]) -> Row {
    let length = |part: Option<(u8, bool)>| match part {
        None => Rational::zero(),
        Some((place, false)) => pose.at[usize::from(place)].clone(),
        Some((place, true)) => -pose.at[usize::from(place)].clone(),
    };
    let angle = |spin: Spin| {
        let whole = Angle::quarter(i64::from(spin.quarters));
        match spin.turn {
            None => whole,
            Some((place, minus)) => {
                let turn = &turns[usize::from(place)].angle;
                whole.plus(&if minus { turn.negated() } else { turn.clone() })
            }
        }
    };
    Row { alpha: angle(step.alpha), a: length(step.a), theta: angle(step.theta), d: length(step.d) }
}

/// The cheapest way to nothing left (Dijkstra).
fn search(shape: &Shape) -> Vec<Step> {
    let moves = [0, 1, 2].map(|axis| shape.moves[axis].then_some((axis as u8, false)));
    let start = Left { moves, turned: 0, frame: Quarter::IDENTITY };
    let mut places = vec![(start, None::<(usize, Step)>)];
    let mut cheapest = FxHashMap::from_iter([(start, 0_u32)]);
    let mut waiting = BinaryHeap::from([(Reverse(0_u32), Reverse(0_usize))]);
    while let Some((Reverse(cost), Reverse(at))) = waiting.pop() {
        let left = places[at].0;
        if cheapest.get(&left).is_some_and(|&known| known < cost) {
            continue;
        }
        if is_done(&left, shape) {
            return way_to(at, &places);
        }
        for (step, next) in steps(&left, shape) {
            let price = cost + ROW_COST + price(&step);
            let known = cheapest.entry(next).or_insert(u32::MAX);
            if price < *known {
                *known = price;
                waiting.push((Reverse(price), Reverse(places.len())));
                places.push((next, Some((at, step))));
            }
        }
    }
    // every pose is made by rows of one number each
    Vec::new()
}

fn way_to(mut at: usize, places: &[(Left, Option<(usize, Step)>)]) -> Vec<Step> {
    let mut way = Vec::new();
    while let Some((before, step)) = places[at].1 {
        way.push(step);
        at = before;
    }
    way.reverse();
    way
}

fn is_done(left: &Left, shape: &Shape) -> bool {
    left.moves.iter().all(Option::is_none)
        && usize::from(left.turned) == shape.turns.len()
        && left.frame.times(shape.quarter) == Quarter::IDENTITY
}

/// Rows without quarter turns are plainer, and half a turn says more than a quarter.
fn price(step: &Step) -> u32 {
    [step.alpha, step.theta].map(|spin| [0, 2, 3, 2][usize::from(spin.quarters)]).iter().sum()
}

/// Every row that may stand next, with what it leaves.
fn steps(left: &Left, shape: &Shape) -> Vec<(Step, Left)> {
    let mut found = Vec::new();
    for (alpha, turned) in spins(left, shape, 0) {
        for (a, moved) in slides(&turned, 0) {
            for (theta, again) in spins(&moved, shape, 2) {
                for (d, next) in slides(&again, 2) {
                    found.push((Step { alpha, a, theta, d }, next));
                }
            }
        }
    }
    found
}

/// Turns about x or z, and what they leave.
fn spins(left: &Left, shape: &Shape, axis: usize) -> Vec<(Spin, Left)> {
    let mut found = Vec::with_capacity(8);
    let mut bases = vec![(None, *left)];
    let here = (0..3).all(|other| other == axis || left.moves[other].is_none());
    if let Some(&next) = shape.turns.get(usize::from(left.turned)).filter(|_| here) {
        let (about, minus) = left.frame.of_axis(next);
        if about == axis {
            let rest = Left { turned: left.turned + 1, ..*left };
            bases.push((Some((left.turned, minus)), rest));
        }
    }
    for (turn, base) in bases {
        for quarters in 0..4 {
            let back = Quarter::about(axis, -i64::from(quarters));
            let mut moves = [None; 3];
            for (from, part) in base.moves.into_iter().enumerate() {
                let (to, flips) = back.of_axis(from);
                moves[to] = part.map(|(place, minus)| (place, minus != flips));
            }
            let next = Left { moves, turned: base.turned, frame: back.times(base.frame) };
            found.push((Spin { quarters, turn }, next));
        }
    }
    found
}

/// What is left along an axis is made, or stays.
fn slides(left: &Left, axis: usize) -> Vec<(Option<(u8, bool)>, Left)> {
    let mut made = *left;
    made.moves[axis] = None;
    match left.moves[axis] {
        None => vec![(None, made)],
        part => vec![(part, made), (None, *left)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{self, Matrix, Vector};
    use crate::place::matrix;
    use denavit_codegen::number::{integer, ratio};
    use num_traits::Signed;

    fn times((r, p): &(Matrix, Vector), (s, q): &(Matrix, Vector)) -> (Matrix, Vector) {
        let moved = exact::transformed(r, q);
        (exact::product(r, s), std::array::from_fn(|k| &p[k] + &moved[k]))
    }

    fn composed(rows: &[Row]) -> (Matrix, Vector) {
        let zero = || integer(0);
        let start = (exact::identity(), [zero(), zero(), zero()]);
        rows.iter().fold(start, |before, row| {
            let alpha = (matrix(&[Turn::new(0, row.alpha.clone())]), [zero(), zero(), zero()]);
            let theta = matrix(&[Turn::new(2, row.theta.clone())]);
            let a = (exact::identity(), [row.a.clone(), zero(), zero()]);
            let d = (exact::identity(), [zero(), zero(), row.d.clone()]);
            let turned = times(&times(&before, &alpha), &a);
            times(&times(&turned, &(theta, [zero(), zero(), zero()])), &d)
        })
    }

    fn check(at: [i64; 3], turns: &[(usize, &str)], most: usize) {
        let turns = turns
            .iter()
            .map(|&(axis, text)| Turn::new(axis, Angle::radians(text).expect("a decimal").angle));
        let pose = Pose { at: at.map(|length| ratio(length, 10)), turns: turns.collect() };
        let rows = RowSearch::default().rows(&pose);
        assert!(rows.len() <= most, "{} rows for {pose:?}", rows.len());
        let (found, at) = composed(&rows);
        let wanted = matrix(&pose.turns);
        for (a, b) in
            found.iter().flatten().zip(wanted.iter().flatten()).chain(at.iter().zip(&pose.at))
        {
            assert!((a - b).abs() < ratio(1, 1_000_000_000_000), "{pose:?} as {rows:?}");
        }
    }

    #[test]
    fn rows_make_poses_and_are_few() {
        let quarter = "1.5707963267948966";
        check([0, 0, 0], &[], 0);
        check([3, 0, 2], &[(2, "0.4")], 1);
        check([0, -3, 0], &[(0, quarter)], 1);
        check([1, 2, 3], &[], 2);
        check([0, 0, 0], &[(1, quarter)], 2);
        check([1, 2, 3], &[(2, "0.1"), (1, "0.2"), (0, "0.3")], 4);
        check([0, 0, 3], &[(0, "0.3")], 2);
        check([1, 0, 0], &[(0, "0.3")], 1);
        for first in 0..3 {
            for second in 0..3 {
                for third in 0..3 {
                    let turns = [(first, "0.3"), (second, "-1.5708"), (third, "3.1")];
                    check([-1, 2, 5], &turns, 5);
                }
            }
        }
    }
}
