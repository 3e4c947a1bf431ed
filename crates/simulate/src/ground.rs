//! The ground under a plant: gaps, and the rows of contact points in the ground's own directions.

use super::contact::Space;
use denavit_plants::{GroundModel, PlantModel};

/// Points lower than this touch, and land at once with one that lands \[m\].
pub(super) const TOUCH_M: f64 = 1e-8;

/// The plane with its directions: tangents, then the normal; a planar plant has one tangent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ground {
    pub(super) space: Space,
    point: [f64; 3],
    directions: [[f64; 3]; 3],
}

impl Ground {
    pub(super) fn new(model: &PlantModel) -> Self {
        let GroundModel { point, normal } = model.ground;
        let space = if model.planar { Space::Planar } else { Space::Spatial };
        let [forward, left] = model.ground.tangents();
        Self { space, point, directions: [forward, left, normal] }
    }

    /// Rows per contact.
    pub(super) fn rows(&self) -> usize {
        self.space.rows()
    }

    fn used(&self) -> &'static [usize] {
        match self.space {
            Space::Planar => &[0, 2],
            Space::Spatial => &[0, 1, 2],
        }
    }

    /// Height of a point above the ground \[m\].
    pub(super) fn gap(&self, position: &[f64]) -> f64 {
        let above: [f64; 3] = std::array::from_fn(|axis| position[axis] - self.point[axis]);
        dot(self.directions[2], &above)
    }

    /// A world vector along the used directions, appended to `rows`.
    pub(super) fn append(&self, vector: &[f64], rows: &mut Vec<f64>) {
        rows.extend(self.used().iter().map(|&axis| dot(self.directions[axis], vector)));
    }

    /// Three rows of a world Jacobian with `n` columns, along the used directions.
    pub(super) fn append_rows(&self, world: &[f64], n: usize, rows: &mut Vec<f64>) {
        for &axis in self.used() {
            let [x, y, z] = self.directions[axis];
            rows.extend((0..n).map(|j| x * world[j] + y * world[n + j] + z * world[2 * n + j]));
        }
    }

    /// The world vector of components along the used directions.
    pub(super) fn in_world(&self, components: &[f64]) -> [f64; 3] {
        let mut vector = [0.0; 3];
        for (&axis, component) in self.used().iter().zip(components) {
            for (entry, direction) in vector.iter_mut().zip(self.directions[axis]) {
                *entry += component * direction;
            }
        }
        vector
    }

    /// The normal.
    pub(super) fn normal(&self) -> [f64; 3] {
        self.directions[2]
    }

    /// The tangents.
    pub(super) fn tangents(&self) -> [[f64; 3]; 2] {
        [self.directions[0], self.directions[1]]
    }
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn dot(a: [f64; 3], b: &[f64]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
