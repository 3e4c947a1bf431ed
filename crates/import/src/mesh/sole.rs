//! The sole of a mesh: the corners on which it stands.

use crate::exact::{Vector, root, written};
use crate::fault::clip;
use denavit_codegen::number::{Rational, integer, ratio};
use num_traits::{One, Signed, Zero};

/// The corners on which a mesh stands.
pub(crate) struct Sole {
    /// At most four, in order around them.
    pub(crate) points: Vec<Vector>,
    /// How far above the lowest corner a corner of the sole may be.
    pub(crate) within: Rational,
    /// The share of the area over all corners of the sole that lies between the points.
    pub(crate) covered: Rational,
}

impl Sole {
    /// What is said of it: it is a choice.
    pub(crate) fn note(&self, link: &str, file: &str) -> String {
        let share = (&self.covered * integer(100)).round();
        let millimetres = (&self.within * integer(10_000)).round() / integer(10);
        format!(
            "contact points of `{}`: {} corners of {} with {} % of the area of its sole, which is \
             what lies within {} mm of the lowest corner",
            clip(link),
            self.points.len(),
            clip(file),
            written(&share),
            written(&millimetres),
        )
    }
}

/// The share of its height within which corners of a mesh are its sole: a choice, which the note
/// tells in millimetres.
fn flat() -> Rational {
    ratio(1, 100)
}

/// Corners of a sole that are kept: a rigid foot on a floor touches with no more than a face.
const KEPT: usize = 4;

/// The sole of a mesh where free fall has this direction.
pub(crate) fn sole(corners: &[Vector], down: &Vector) -> Sole {
    let depths: Vec<Rational> = corners.iter().map(|corner| dot(corner, down)).collect();
    let lowest = depths.iter().max().cloned().unwrap_or_default();
    let highest = depths.iter().min().cloned().unwrap_or_default();
    let within = (&lowest - highest) * flat();
    let is_low = |depth: &&Rational| &lowest - *depth <= within;
    let low: Vec<&Vector> =
        corners.iter().zip(&depths).filter(|(_, depth)| is_low(depth)).map(|(at, _)| at).collect();
    let mut outline = hull(&low, down);
    let whole = area(&outline);
    while outline.len() > KEPT {
        outline.remove(least_corner(&outline));
    }
    let covered =
        if whole.is_zero() { Rational::one() } else { area(&outline).abs() / whole.abs() };
    let points = outline.into_iter().map(|corner| corner.point.clone()).collect();
    let length = dot(down, down);
    // depths are lengths times that of `down`
    let within = within / root(&length);
    Sole { points, within, covered }
}

/// A corner, and where it is seen from above.
struct Seen<'c> {
    at: [Rational; 2],
    point: &'c Vector,
}

/// The corners around a set of points, seen along a direction.
fn hull<'c>(points: &[&'c Vector], along: &Vector) -> Vec<Seen<'c>> {
    // any two directions across it do: shares of areas stay what they are
    let shortest = (0..3).min_by(|&a, &b| along[a].abs().cmp(&along[b].abs())).unwrap_or(0);
    let axis: Vector = std::array::from_fn(|k| integer(i64::from(k == shortest)));
    let first = cross(along, &axis);
    let second = cross(along, &first);
    let seen = |point: &&'c Vector| Seen { at: [dot(point, &first), dot(point, &second)], point };
    let mut all: Vec<Seen<'c>> = points.iter().map(seen).collect();
    all.sort_by(|a, b| a.at.cmp(&b.at));
    all.dedup_by(|a, b| a.at == b.at);
    if all.len() < 3 {
        return all;
    }
    let forth = half_of_hull(0..all.len(), &all);
    let back = half_of_hull((0..all.len()).rev(), &all);
    let around: Vec<usize> = forth.into_iter().chain(back).collect();
    let mut all: Vec<Option<Seen<'c>>> = all.into_iter().map(Some).collect();
    around.into_iter().filter_map(|at| all[at].take()).collect()
}

/// One side of a hull, without its end.
fn half_of_hull(order: impl Iterator<Item = usize>, all: &[Seen<'_>]) -> Vec<usize> {
    let mut side: Vec<usize> = Vec::new();
    for next in order {
        while let [.., before, last] = side[..]
            && !turn(&all[before], &all[last], &all[next]).is_positive()
        {
            side.pop();
        }
        side.push(next);
    }
    side.pop();
    side
}

/// Twice the area of a triangle, positive where it turns to the left.
fn turn(a: &Seen<'_>, b: &Seen<'_>, c: &Seen<'_>) -> Rational {
    let [ab, ac] = [b, c].map(|to| [0, 1].map(|k| &to.at[k] - &a.at[k]));
    &ab[0] * &ac[1] - &ab[1] * &ac[0]
}

/// Twice the area of a polygon.
fn area(outline: &[Seen<'_>]) -> Rational {
    let Some(first) = outline.first() else { return Rational::zero() };
    outline.windows(2).map(|pair| turn(first, &pair[0], &pair[1])).sum()
}

/// The corner without which a polygon loses least.
fn least_corner(outline: &[Seen<'_>]) -> usize {
    let count = outline.len();
    let lost = |&at: &usize| {
        turn(&outline[(at + count - 1) % count], &outline[at], &outline[(at + 1) % count]).abs()
    };
    (0..count).min_by_key(lost).unwrap_or(0)
}

fn dot(a: &Vector, b: &Vector) -> Rational {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|k| {
        let (next, last) = ((k + 1) % 3, (k + 2) % 3);
        &a[next] * &b[last] - &a[last] * &b[next]
    })
}
