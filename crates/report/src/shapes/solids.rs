//! Solids as triangles, about their own centres; what is round is round about z.

use super::Triangle;
use crate::space::Vec3;
use std::f64::consts::{PI, TAU};

/// Parts of a turn, and of half a turn from pole to pole.
const AROUND: usize = 32;
const DOWN: usize = 16;

pub(super) fn block(half: Vec3) -> Vec<Triangle> {
    let corner = |at: usize| -> Vec3 {
        std::array::from_fn(|axis| if at >> axis & 1 == 0 { -half[axis] } else { half[axis] })
    };
    let faces =
        [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    let halves = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    halves.map(|corners| corners.map(corner)).collect()
}

pub(super) fn sphere(radius: f64) -> Vec<Triangle> {
    capsule(radius, 0.0)
}

pub(super) fn ellipsoid(half: Vec3) -> Vec<Triangle> {
    let scaled = |corner: Vec3| [0, 1, 2].map(|axis| half[axis] * corner[axis]);
    sphere(1.0).into_iter().map(|corners| corners.map(scaled)).collect()
}

/// Two half spheres, each so far from the centre, and what is between them.
pub(super) fn capsule(radius: f64, half: f64) -> Vec<Triangle> {
    let ring = |at: usize, away: f64| {
        let angle = PI * at as f64 / DOWN as f64;
        (radius * angle.sin(), radius * angle.cos() + away)
    };
    let upper = (0..=DOWN / 2).map(|at| ring(at, half));
    let lower = (DOWN / 2..=DOWN).map(|at| ring(at, -half));
    let rings: Vec<(f64, f64)> = upper.chain(lower).collect();
    rings.windows(2).flat_map(|pair| band([pair[0], pair[1]])).collect()
}

pub(super) fn cylinder(radius: f64, half: f64) -> Vec<Triangle> {
    let rings = [(0.0, half), (radius, half), (radius, -half), (0.0, -half)];
    rings.windows(2).flat_map(|pair| band([pair[0], pair[1]])).collect()
}

/// What is between two rings, each with its radius and its height.
fn band(rings: [(f64, f64); 2]) -> Vec<Triangle> {
    let at = |(radius, height): (f64, f64), step: usize| {
        let (sin, cos) = (TAU * (step % AROUND) as f64 / AROUND as f64).sin_cos();
        [radius * cos, radius * sin, height]
    };
    let [up, down] = rings;
    let four = |step| [at(up, step), at(down, step), at(down, step + 1), at(up, step + 1)];
    (0..AROUND)
        .map(four)
        .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{cross, dot, norm};

    /// The volume between the triangles and the origin, whichever way round they are.
    fn volume(soup: &[Triangle]) -> f64 {
        soup.iter().map(|[a, b, c]| dot(*a, cross(*b, *c)).abs() / 6.0).sum()
    }

    #[test]
    fn solids_have_their_volumes() {
        assert!((volume(&block([0.5, 1.0, 1.5])) - 6.0).abs() < 1e-12);
        let whole = 4.0 / 3.0 * PI;
        assert!((volume(&sphere(1.0)) / whole - 1.0).abs() < 0.02);
        assert!((volume(&cylinder(1.0, 0.5)) / PI - 1.0).abs() < 0.01);
        assert!((volume(&capsule(1.0, 0.5)) / (whole + PI) - 1.0).abs() < 0.02);
        assert!((volume(&ellipsoid([0.5, 1.0, 1.5])) / (0.75 * whole) - 1.0).abs() < 0.02);
        assert!(sphere(2.0).iter().flatten().all(|corner| (norm(*corner) - 2.0).abs() < 1e-12));
    }
}
