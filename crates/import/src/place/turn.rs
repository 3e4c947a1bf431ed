//! Turns about coordinate axes, poses made of them, and the turns that bring z onto an axis.

use super::angle::{Angle, Made, Surd};
use super::quarter::Quarter;
use crate::exact::{self, Matrix, Vector, transformed};
use denavit_codegen::number::{Rational, integer};
use num_traits::Zero;

/// A turn about a coordinate axis: 0 is x, 1 is y, 2 is z.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Turn {
    pub(crate) axis: usize,
    pub(crate) angle: Angle,
}

/// A translation, then turns, each in the axes that those before it have left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pose {
    pub(crate) at: Vector,
    pub(crate) turns: Vec<Turn>,
}

impl Turn {
    /// A turn.
    pub(crate) fn new(axis: usize, angle: Angle) -> Self {
        Self { axis, angle }
    }

    fn negated(&self) -> Self {
        Self::new(self.axis, self.angle.negated())
    }
}

impl Pose {
    /// Here, unturned.
    pub(crate) fn identity() -> Self {
        Self::turned(Vec::new())
    }

    /// Elsewhere, unturned.
    pub(crate) fn moved(at: Vector) -> Self {
        Self { at, turns: Vec::new() }
    }

    /// Here, turned.
    pub(crate) fn turned(turns: Vec<Turn>) -> Self {
        Self { at: std::array::from_fn(|_| Rational::zero()), turns }
    }

    fn is_here(&self) -> bool {
        self.at.iter().all(Zero::is_zero)
    }

    /// This pose, and the other in it, if the position of both together is rational.
    pub(crate) fn then(&self, other: &Self) -> Option<Self> {
        let mut at = self.at.clone();
        if !other.is_here() {
            let (generic, quarter) = normal(&self.turns);
            if !generic.is_empty() {
                return None;
            }
            for (axis, length) in other.at.iter().enumerate() {
                let (to, minus) = quarter.of_axis(axis);
                if minus { at[to] -= length } else { at[to] += length }
            }
        }
        Some(Self { at, turns: [&self.turns[..], &other.turns].concat() })
    }

    /// This pose in another one, whose turns count to fifty digits where they are no quarters.
    pub(crate) fn within(&self, outer: &Self) -> Self {
        let moved = transformed(&matrix(&outer.turns), &self.at);
        Self {
            at: std::array::from_fn(|k| &outer.at[k] + &moved[k]),
            turns: [&outer.turns[..], &self.turns].concat(),
        }
    }

    /// The way back, as poses one after the other.
    pub(crate) fn inverse(&self) -> Vec<Self> {
        let back = Self::turned(inverse(&self.turns));
        let home = Self::moved(self.at.clone().map(|length| -length));
        match back.then(&home) {
            Some(pose) => vec![pose],
            None => vec![back, home],
        }
    }
}

/// The turns back.
fn inverse(turns: &[Turn]) -> Vec<Turn> {
    turns.iter().rev().map(Turn::negated).collect()
}

/// Turns as turns that are no quarter turns, about axes after which whole quarter turns come.
pub(crate) fn normal(turns: &[Turn]) -> (Vec<Turn>, Quarter) {
    let (mut generic, mut quarter) = (Vec::<Turn>::new(), Quarter::IDENTITY);
    for turn in turns {
        let (axis, minus) = quarter.of_axis(turn.axis);
        let rest = turn.angle.without_quarters();
        let rest = if minus { rest.negated() } else { rest };
        quarter = quarter.times(Quarter::about(turn.axis, i64::from(turn.angle.quarters())));
        if rest.is_quarter() {
            continue;
        }
        match generic.last_mut() {
            Some(last) if last.axis == axis && last.angle.may_join(&rest) => {
                let sum = last.angle.plus(&rest);
                let whole = i64::from(sum.quarters());
                // R(e, k) Q = Q' with the quarter turns in front of all that follows
                quarter = Quarter::about(axis, whole).times(quarter);
                last.angle = sum.without_quarters();
                if last.angle.is_quarter() {
                    generic.pop();
                }
            }
            _ => generic.push(Turn::new(axis, rest)),
        }
    }
    (generic, quarter)
}

/// Whether turns bring axes onto axes.
pub(crate) fn is_quarter(turns: &[Turn]) -> bool {
    normal(turns).0.is_empty()
}

/// The rotation matrix, to fifty digits; exact where turns are quarter turns.
pub(crate) fn matrix(turns: &[Turn]) -> Matrix {
    turns.iter().fold(exact::identity(), |before, turn| {
        let (sine, cosine) = turn.angle.sine_and_cosine();
        let (next, last) = ((turn.axis + 1) % 3, (turn.axis + 2) % 3);
        let mut about = exact::identity();
        about[next][next] = cosine.clone();
        about[last][last] = cosine;
        about[last][next] = sine.clone();
        about[next][last] = -sine;
        exact::product(&before, &about)
    })
}

/// The turns that bring z onto a direction, and whether a quarter turn among them was rounded. None
/// for no direction.
pub(crate) fn direction(v: &Vector) -> Option<(Vec<Turn>, bool)> {
    let [x, y, z] = v;
    let across = x * x + y * y;
    if across.is_zero() && z.is_zero() {
        return None;
    }
    let surd = |value: &Rational| Surd::rational(value.clone());
    let down = Angle::atan2(Surd::new(integer(1), across.clone()), surd(z));
    if down.angle == Angle::zero() {
        return Some((Vec::new(), down.is_snapped));
    }
    // along the turned x: a turn about y alone, about x alone, or about z and then y
    if y.is_zero() {
        let Made { angle, is_snapped } = Angle::atan2(surd(x), surd(z));
        return Some((vec![Turn::new(1, angle)], is_snapped));
    }
    if x.is_zero() {
        let Made { angle, is_snapped } = Angle::atan2(surd(&-y), surd(z));
        return Some((vec![Turn::new(0, angle)], is_snapped));
    }
    let around = Angle::atan2(surd(y), surd(x));
    let is_snapped = down.is_snapped || around.is_snapped;
    Some((vec![Turn::new(2, around.angle), Turn::new(1, down.angle)], is_snapped))
}

/// The turns about z, y, x onto axes x and y at right angles, of any lengths, and whether a quarter
/// turn among them was rounded.
pub(crate) fn onto_axes(x: &Vector, y: &Vector) -> (Vec<Turn>, bool) {
    let surd = |value: &Rational| Surd::rational(value.clone());
    let across = &x[0] * &x[0] + &x[1] * &x[1];
    let square = &across + &x[2] * &x[2];
    let pitch = Angle::atan2(surd(&-&x[2]), Surd::new(integer(1), across));
    if pitch.angle.is_quarter() && pitch.angle.quarters() % 2 == 1 {
        // x points up or down: roll and yaw are one turn
        let yaw = Angle::atan2(surd(&-&y[0]), surd(&y[1]));
        let turns = vec![Turn::new(2, yaw.angle), Turn::new(1, pitch.angle)];
        return (turns, yaw.is_snapped || pitch.is_snapped);
    }
    let yaw = Angle::atan2(surd(&x[1]), surd(&x[0]));
    // z of x cross y is |x| |y| as long
    let up = &x[0] * &y[1] - &x[1] * &y[0];
    let roll = Angle::atan2(Surd::new(y[2].clone(), square), surd(&up));
    let is_snapped = yaw.is_snapped || pitch.is_snapped || roll.is_snapped;
    let all = [(2, yaw), (1, pitch), (0, roll)];
    let turns = all.into_iter().map(|(axis, made)| Turn::new(axis, made.angle));
    (turns.filter(|turn| turn.angle != Angle::zero()).collect(), is_snapped)
}

/// The shortest turn that brings z onto a direction, and whether a quarter turn in it was rounded.
/// None for no direction.
pub(crate) fn shortest(v: &Vector) -> Option<(Vec<Turn>, bool)> {
    let (turns, is_snapped) = direction(v)?;
    let whole = match &turns[..] {
        [around, down] => vec![around.clone(), down.clone(), around.negated()],
        _ => turns,
    };
    Some((whole, is_snapped))
}

/// A turn by an angle about a direction, and whether a quarter turn of it was rounded. None for no
/// direction.
pub(crate) fn about(v: &Vector, angle: Angle) -> Option<(Vec<Turn>, bool)> {
    let (there, is_snapped) = direction(v)?;
    let back = inverse(&there);
    Some(([there, vec![Turn::new(2, angle)], back].concat(), is_snapped))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::root;
    use denavit_codegen::number::{ratio, to_f64};
    use num_traits::Signed;

    #[test]
    fn z_comes_onto_every_direction() {
        for v in [[0, 0, 1], [0, 0, -2], [1, 0, 0], [0, -3, 0], [1, 2, 0], [3, 0, 4], [-1, 2, -2]] {
            let v = v.map(integer);
            let (turns, is_snapped) = direction(&v).expect("a direction");
            let column = exact::transformed(&matrix(&turns), &[0, 0, 1].map(integer));
            let length = root(&v.iter().map(|x| x * x).sum());
            for (found, wanted) in column.iter().zip(&v) {
                assert!((to_f64(found) - to_f64(&(wanted / &length))).abs() < 1e-15);
            }
            assert!(!is_snapped);
        }
        assert!(direction(&[0, 0, 0].map(integer)).is_none());
    }

    #[test]
    fn axes_of_any_length_are_reached() {
        for (x, y) in [([1, 2, 2], [-2, 2, -1]), ([0, 0, 3], [5, 12, 0]), ([-4, 0, 3], [0, 7, 0])] {
            let (x, y) = (x.map(integer), y.map(integer));
            let found = matrix(&onto_axes(&x, &y).0);
            for (column, axis) in [x, y].iter().enumerate() {
                let length = root(&axis.iter().map(|k| k * k).sum());
                for row in 0..3 {
                    let wanted = to_f64(&(&axis[row] / &length));
                    assert!((to_f64(&found[row][column]) - wanted).abs() < 1e-15);
                }
            }
        }
    }

    #[test]
    fn normal_form_is_the_same_turn() {
        let angle = |text: &str| Angle::radians(text).expect("a decimal").angle;
        let turns = [
            Turn::new(2, angle("0.3").plus(&Angle::quarter(1))),
            Turn::new(0, Angle::quarter(3)),
            Turn::new(1, angle("-0.2").plus(&Angle::quarter(2))),
            Turn::new(0, angle("1.1")),
        ];
        let (generic, quarter) = normal(&turns);
        let mut whole = matrix(&generic);
        let axes: [Vector; 3] = std::array::from_fn(|axis| {
            let (to, minus) = quarter.of_axis(axis);
            std::array::from_fn(|k| {
                integer(if k != to {
                    0
                } else if minus {
                    -1
                } else {
                    1
                })
            })
        });
        whole = exact::product(&whole, &exact::transposed(&axes));
        let wanted = matrix(&turns);
        for (a, b) in whole.iter().flatten().zip(wanted.iter().flatten()) {
            assert!((a - b).abs() < ratio(1, 1_000_000_000_000));
        }
    }
}
