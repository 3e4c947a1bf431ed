//! The support polygon: the convex hull of the contact points that carry a robot.

use denavit_plants::{GroundModel, PlantModel};

/// What carries a robot, seen along the normal of the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct SupportPolygon {
    corners: Vec<[f64; 2]>,
    ground: GroundModel,
    is_planar: bool,
}

/// The form of what carries a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SupportForm {
    /// The robot flies.
    Nothing,
    /// One point, or several in one place.
    Point,
    /// Points on a line: in the plane all that a foot can have.
    Line,
    /// A polygon with an area.
    Area,
}

/// Points that are nearer are one \[m\].
const ONE_M: f64 = 1e-9;

impl SupportPolygon {
    /// Of some points in the world, 3 entries each \[m\].
    pub fn of<'a>(model: &PlantModel, points: impl Iterator<Item = &'a [f64]>) -> Self {
        let (ground, is_planar) = (model.ground, model.planar);
        let corners = points.map(|point| ground.along(point)).collect();
        Self { corners, ground, is_planar }
    }

    /// The corners along the tangents of the ground \[m\], in no order.
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.corners
    }

    /// Its form.
    pub fn form(&self) -> SupportForm {
        let Some(first) = self.corners.first() else { return SupportForm::Nothing };
        let from_first = |corner: &[f64; 2]| [corner[0] - first[0], corner[1] - first[1]];
        let arms = self.corners.iter().map(from_first);
        let longest =
            arms.clone().reduce(|a, b| if b[0].hypot(b[1]) > a[0].hypot(a[1]) { b } else { a });
        let longest = longest.unwrap_or_default();
        let length = longest[0].hypot(longest[1]);
        if length < ONE_M {
            return SupportForm::Point;
        }
        let beside = |arm: [f64; 2]| (longest[0] * arm[1] - longest[1] * arm[0]).abs() / length;
        if self.is_planar || arms.map(beside).fold(0.0, f64::max) < ONE_M {
            return SupportForm::Line;
        }
        SupportForm::Area
    }

    /// Lowest and highest coordinate along the first tangent \[m\].
    pub fn range(&self) -> Option<[f64; 2]> {
        let along = self.corners.iter().map(|corner| corner[0]);
        Some([along.clone().reduce(f64::min)?, along.reduce(f64::max)?])
    }

    /// Distance of a point in the world from the edge; negative outside, and minus the distance
    /// for polygons without area. In the plane the edge is the ends of a line \[m\].
    pub fn margin(&self, point: [f64; 3]) -> f64 {
        let at = self.ground.along(&point);
        if !self.is_planar {
            return hull_margin(&self.corners, at);
        }
        let ends = |pick: fn(f64, f64) -> f64, start: f64| {
            self.corners.iter().fold(start, |sum, corner| pick(sum, corner[0]))
        };
        let (low, high) = (ends(f64::min, f64::INFINITY), ends(f64::max, f64::NEG_INFINITY));
        (at[0] - low).min(high - at[0])
    }
}

fn hull_margin(corners: &[[f64; 2]], at: [f64; 2]) -> f64 {
    let mut margin = f64::INFINITY;
    let mut edges = 0;
    for (i, a) in corners.iter().enumerate() {
        for b in corners.iter().skip(i + 1).chain(&corners[..i]) {
            let along = [b[0] - a[0], b[1] - a[1]];
            let size = along[0].hypot(along[1]);
            if size < 1e-9 {
                continue;
            }
            let left = |p: &[f64; 2]| (along[0] * (p[1] - a[1]) - along[1] * (p[0] - a[0])) / size;
            // an edge has every corner on its left
            if corners.iter().all(|corner| left(corner) >= -1e-9) {
                edges += 1;
                margin = margin.min(left(&at));
            }
        }
    }
    if edges >= 3 { margin } else { -nearest(corners, at) }
}

/// Distance from the nearest of the lines between corners.
fn nearest(corners: &[[f64; 2]], at: [f64; 2]) -> f64 {
    let mut least = f64::INFINITY;
    for (i, a) in corners.iter().enumerate() {
        for b in &corners[i..] {
            let along = [b[0] - a[0], b[1] - a[1]];
            let (square, arm) = (along[0].powi(2) + along[1].powi(2), [at[0] - a[0], at[1] - a[1]]);
            let share = (arm[0] * along[0] + arm[1] * along[1]) / square.max(1e-18);
            let share = share.clamp(0.0, 1.0);
            let apart = [arm[0] - share * along[0], arm[1] - share * along[1]];
            least = least.min(apart[0].hypot(apart[1]));
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_margin_of_a_square_is_the_distance_from_its_nearest_edge() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0]];
        assert!((hull_margin(&square, [0.5, 1.0]) - 0.5).abs() < 1e-15);
        assert!((hull_margin(&square, [1.0, 2.25]) + 0.25).abs() < 1e-15);
        // on an edge that two points alone support
        assert_eq!(hull_margin(&square[..2], [0.7, 0.0]), 0.0);
        assert_eq!(hull_margin(&square[..2], [3.0, 0.0]), -1.0);
    }
}
