//! From space to the plane of a picture: an axonometric (parallel) projection.

use super::space::{Vec3, add, cross, direction, dot, norm, perpendicular, scale, sub};
use denavit_runtime::Scalar;

/// A point of the picture [px]: right, down.
pub(super) type Vec2 = [f64; 2];

/// How far the camera looks down \[rad\].
const ELEVATION: f64 = 0.36;

/// Directions from which the camera may look, about the vertical \[rad\], the preferred one first.
const AZIMUTHS: [f64; 10] = [0.75, -0.75, 1.2, -1.2, 0.35, -0.35, 1.9, -1.9, 2.8, -2.8];

/// A later direction must show this much more than the preferred one to be taken.
const GAIN: f64 = 1.15;

/// Points whose pairs are looked at: the mean over 256 is known to a sixteenth of its spread, and
/// directions need tell apart by [`GAIN`] only. Robots of some tens of links have fewer.
const LOOKED_AT: usize = 256;

/// A projection.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    right: Vec3,
    up: Vec3,
    /// From the robot to the eye.
    pub(super) eye: Vec3,
    /// Pixels per metre.
    pub(super) scale: f64,
    /// Where the origin of frame 0 is seen [px].
    shift: Vec2,
}

impl Camera {
    /// The camera that shows `points` well, with `up` upwards, at the largest scale at which they
    /// fit into a rectangle of this size [px]; its upper left corner is at 0. Where all joints are
    /// parallel, their `axis` points to the eye as far as may be.
    pub(super) fn new(points: &[Vec3], up: Vec3, axis: Option<Vec3>, size: Vec2) -> Self {
        let mut best: Option<(f64, Self)> = None;
        for azimuth in AZIMUTHS {
            let camera = Self::from_azimuth(azimuth, up);
            let seen = match axis {
                Some(axis) => 1.0 + dot(axis, camera.eye),
                None => camera.spread(points),
            };
            if best.as_ref().is_none_or(|(most, _)| seen > most * GAIN) {
                best = Some((seen, camera));
            }
        }
        let mut camera = best.map_or_else(|| Self::from_azimuth(AZIMUTHS[0], up), |(_, it)| it);
        camera.fit(points, size);
        camera
    }

    fn from_azimuth(azimuth: f64, up: Vec3) -> Self {
        let x = [1.0, 0.0, 0.0];
        let level = direction(sub(x, scale(up, dot(x, up))));
        let forward = level.unwrap_or_else(|| perpendicular(up));
        let side = cross(up, forward);
        let (sin_azimuth, cos_azimuth) = azimuth.sincos();
        let (sin_elevation, cos_elevation) = ELEVATION.sincos();
        let level = add(scale(forward, cos_azimuth), scale(side, sin_azimuth));
        let eye = add(scale(level, cos_elevation), scale(up, sin_elevation));
        let right = cross(up, level);
        Self { right, up: cross(eye, right), eye, scale: 1.0, shift: [0.0; 2] }
    }

    /// The camera that looks against the unit vector `eye`, at right angles to `up`; scale 1.
    pub(super) fn from_eye(eye: Vec3, up: Vec3) -> Self {
        Self { right: cross(up, eye), up, eye, scale: 1.0, shift: [0.0; 2] }
    }

    /// How far apart the points are seen, each pair by the logarithm of its distance: what
    /// coincides counts most.
    fn spread(&self, points: &[Vec3]) -> f64 {
        let mut sum = 1.0;
        let stride = points.len().div_ceil(LOOKED_AT).max(1);
        let points: Vec<Vec3> = points.iter().copied().step_by(stride).collect();
        for (index, &a) in points.iter().enumerate() {
            for &b in &points[..index] {
                let apart = norm(sub(a, b));
                if apart > 1e-9 {
                    let (p, q) = (self.place(a), self.place(b));
                    let seen = (p[0] - q[0]).hypot(p[1] - q[1]);
                    sum += (seen / apart).min(0.8);
                }
            }
        }
        sum
    }

    fn fit(&mut self, points: &[Vec3], size: Vec2) {
        let [low, high] = self.bounds(points);
        let [wide, tall] = [0, 1].map(|side| high[side] - low[side]);
        if wide.is_finite() && tall.is_finite() {
            let scale = (size[0] / wide.max(1e-6)).min(size[1] / tall.max(1e-6));
            self.scale = scale.min(1e5);
            self.shift = low.map(|part| -part * self.scale);
        }
    }

    /// The rectangle in which the points are seen: upper left and lower right corner [px].
    pub(super) fn bounds(&self, points: &[Vec3]) -> [Vec2; 2] {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for place in points.iter().map(|&point| self.place(point)) {
            for side in 0..2 {
                low[side] = low[side].min(place[side]);
                high[side] = high[side].max(place[side]);
            }
        }
        [low, high]
    }

    /// Moves the picture [px].
    pub(super) fn shift(&mut self, by: Vec2) {
        self.shift = [0, 1].map(|side| self.shift[side] + by[side]);
    }

    /// Where a point is seen [px].
    pub(super) fn place(&self, point: Vec3) -> Vec2 {
        let [x, y] = self.turn(point);
        [self.shift[0] + x, self.shift[1] + y]
    }

    /// How a direction is seen [px/m].
    pub(super) fn turn(&self, vector: Vec3) -> Vec2 {
        [dot(vector, self.right) * self.scale, -dot(vector, self.up) * self.scale]
    }

    /// How near the eye a point is \[m\]; larger is nearer.
    pub(super) fn nearness(&self, point: Vec3) -> f64 {
        dot(point, self.eye)
    }
}
