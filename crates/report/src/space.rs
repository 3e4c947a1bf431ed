//! Points and directions in three dimensions, as pictures need them.

/// A point or a direction.
pub(super) type Vec3 = [f64; 3];

pub(super) fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(super) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    add(a, scale(b, -1.0))
}

pub(super) fn scale(a: Vec3, factor: f64) -> Vec3 {
    a.map(|component| component * factor)
}

pub(super) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn norm(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

/// The direction of `a`; none where it is shorter than any length of a robot.
pub(super) fn direction(a: Vec3) -> Option<Vec3> {
    let length = norm(a);
    (length.is_finite() && length > 1e-12).then(|| scale(a, 1.0 / length))
}

/// A direction at right angles to the unit vector `a`.
pub(super) fn perpendicular(a: Vec3) -> Vec3 {
    let axis = if a[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    direction(sub(axis, scale(a, dot(axis, a)))).unwrap_or(axis)
}

/// A frame seen from frame 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Transform {
    /// The directions of its axes x, y, z.
    pub(super) axes: [Vec3; 3],
    /// Its origin \[m\].
    pub(super) origin: Vec3,
}

impl Transform {
    /// Frame 0 itself.
    pub(super) const IDENTITY: Self =
        Self { axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], origin: [0.0; 3] };

    /// The frame of the upper three rows [R | o], row-major.
    pub(super) fn from_rows(rows: &[f64]) -> Self {
        let entry = |row: usize, column: usize| rows[4 * row + column];
        let column = |column| [entry(0, column), entry(1, column), entry(2, column)];
        Self { axes: [column(0), column(1), column(2)], origin: column(3) }
    }

    /// Where a point of the frame lies in frame 0.
    pub(super) fn point(&self, p: Vec3) -> Vec3 {
        let turned = (0..3).fold([0.0; 3], |sum, axis| add(sum, scale(self.axes[axis], p[axis])));
        add(self.origin, turned)
    }
}

/// The least size of a robot \[m\].
pub(super) const LEAST_SIZE_M: f64 = 0.05;

/// The size of what some points are the ends of, and its middle.
pub(super) fn extent(points: &[Vec3]) -> (f64, Vec3) {
    let bound = |of: fn(f64, f64) -> f64, start: f64| {
        [0, 1, 2].map(|axis| {
            let along = points.iter().map(|point| point[axis]).filter(|entry| entry.is_finite());
            along.fold(start, of)
        })
    };
    let (low, high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
    let size = norm(sub(high, low));
    (if size.is_finite() { size.max(LEAST_SIZE_M) } else { 1.0 }, scale(add(low, high), 0.5))
}
