//! Solids of a file: how much they hold, and where they touch the ground.

use crate::exact::{Vector, pi, root, rounded};
use denavit_codegen::number::{Rational, integer, ratio};
use num_traits::{Signed, Zero};

/// A solid about its own centre; what is round is round about z.
#[derive(Clone, Debug)]
pub(crate) enum Solid {
    /// Half of each edge.
    Box(Vector),
    /// Half of each axis.
    Ellipsoid(Vector),
    Sphere(Rational),
    Cylinder {
        radius: Rational,
        half: Rational,
    },
    /// A cylinder with half a sphere on both ends.
    Capsule {
        radius: Rational,
        half: Rational,
    },
}

impl Solid {
    /// Its volume, and the moments of inertia of a mass of 1.
    pub(crate) fn volume_and_moments(&self) -> (Rational, Vector) {
        match self {
            Self::Box(half) => of_axes(half, integer(8), &ratio(1, 3)),
            Self::Ellipsoid(half) => of_axes(half, pi() * ratio(4, 3), &ratio(1, 5)),
            Self::Sphere(radius) => {
                let square = radius * radius;
                let moment = &square * ratio(2, 5);
                (pi() * ratio(4, 3) * &square * radius, std::array::from_fn(|_| moment.clone()))
            }
            Self::Cylinder { radius, half } => {
                let (square, height) = (radius * radius, half * integer(2));
                let across = (&square * integer(3) + &height * &height) / integer(12);
                let along = &square / integer(2);
                (pi() * &square * height, [across.clone(), across, along])
            }
            Self::Capsule { radius, half } => {
                let (square, height) = (radius * radius, half * integer(2));
                let volume = pi() * &square * (&height + radius * ratio(4, 3));
                let ends = radius * integer(4) / (radius * integer(4) + &height * integer(3));
                let middle = integer(1) - &ends;
                let round = &ends * &square * ratio(2, 5);
                let away =
                    &ends * &height * (radius * integer(3) + &height * integer(2)) / integer(8);
                let across = &middle * (&square * integer(3) + &height * &height) / integer(12);
                let across = across + &round + away;
                let along = middle * &square / integer(2) + round;
                (volume, [across.clone(), across, along])
            }
        }
    }

    /// The points that touch the ground first, where it lies this way: the lowest one, or the
    /// corners of the face or of the edge that is lowest once it lies flat.
    pub(crate) fn lowest(&self, down: &Vector) -> Vec<Vector> {
        let Some(down) = unit(down) else { return Vec::new() };
        match self {
            Self::Box(half) => {
                let axis = steepest(&down);
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let corner = |(a, b): (i64, i64)| {
                    let mut point: Vector = std::array::from_fn(|_| Rational::zero());
                    point[axis] = &half[axis] * down[axis].signum();
                    point[u] = &half[u] * integer(a);
                    point[v] = &half[v] * integer(b);
                    point
                };
                [(1, 1), (1, -1), (-1, -1), (-1, 1)].map(corner).to_vec()
            }
            Self::Ellipsoid(half) => {
                let length = root(&(0..3).map(|k| &half[k] * &half[k] * &down[k] * &down[k]).sum());
                vec![std::array::from_fn(|k| rounded(&(&half[k] * &half[k] * &down[k] / &length)))]
            }
            Self::Sphere(radius) => vec![down.each_ref().map(|x| rounded(&(x * radius)))],
            Self::Cylinder { radius, half } => match steepest(&down) {
                2 => {
                    // from the lowest point of the rim on, if there is one
                    let z = half * down[2].signum();
                    let [x, y] = below_axis(&down, radius);
                    let rim = [[x.clone(), y.clone()], [-&y, x.clone()], [-&x, -&y], [y, -x]];
                    rim.map(|[x, y]| [x, y, z.clone()]).to_vec()
                }
                _ => {
                    let [x, y] = below_axis(&down, radius);
                    [half.clone(), -half].map(|z| [x.clone(), y.clone(), z]).to_vec()
                }
            },
            Self::Capsule { radius, half } => {
                let ball = down.each_ref().map(|x| x * radius);
                let end =
                    |z: Rational| [rounded(&ball[0]), rounded(&ball[1]), rounded(&(&ball[2] + z))];
                match steepest(&down) {
                    2 => vec![end(half * down[2].signum())],
                    _ => vec![end(half.clone()), end(-half)],
                }
            }
        }
    }
}

/// What fills three half axes: the volume is their product by a factor, and each moment the other
/// two squares by a share.
fn of_axes(half: &Vector, factor: Rational, share: &Rational) -> (Rational, Vector) {
    let square = |k: usize| &half[k] * &half[k];
    let sum = |a: usize, b: usize| (square(a) + square(b)) * share;
    (factor * &half[0] * &half[1] * &half[2], [sum(1, 2), sum(0, 2), sum(0, 1)])
}

/// A direction, of length 1; none if it has no length.
fn unit(direction: &Vector) -> Option<Vector> {
    let length = root(&direction.iter().map(|x| x * x).sum());
    (!length.is_zero()).then(|| direction.each_ref().map(|x| x / &length))
}

/// The axis that is nearest to a direction.
fn steepest(direction: &Vector) -> usize {
    (0..3).max_by_key(|&k| &direction[k] * &direction[k]).unwrap_or(2)
}

/// Where the side of a cylinder is lowest, x for one that stands.
fn below_axis(down: &Vector, radius: &Rational) -> [Rational; 2] {
    let length = root(&(&down[0] * &down[0] + &down[1] * &down[1]));
    if length.is_zero() {
        return [radius.clone(), Rational::zero()];
    }
    [0, 1].map(|k| rounded(&(&down[k] / &length * radius)))
}
