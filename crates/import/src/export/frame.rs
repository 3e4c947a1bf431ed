//! Frames in doubles, as every reader of other formats has them.

/// A frame in another one: rows of a rotation, and a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) turn: [[f64; 3]; 3],
    pub(super) at: [f64; 3],
}

impl Frame {
    /// No change.
    pub(super) fn identity() -> Self {
        let turn = std::array::from_fn(|row| {
            std::array::from_fn(|column| f64::from(u8::from(row == column)))
        });
        Self { turn, at: [0.0; 3] }
    }

    /// Along a coordinate axis.
    pub(super) fn along(axis: usize, length: f64) -> Self {
        let mut frame = Self::identity();
        frame.at[axis] = length;
        frame
    }

    /// Turned about a coordinate axis.
    pub(super) fn about(axis: usize, angle: f64) -> Self {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut frame = Self::identity();
        let (sine, cosine) = sine_and_cosine(angle);
        frame.turn[next][next] = cosine;
        frame.turn[last][last] = cosine;
        frame.turn[last][next] = sine;
        frame.turn[next][last] = -sine;
        frame
    }

    /// A point of this frame in the other one.
    pub(super) fn place(&self, point: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|row| {
            self.at[row] + (0..3).map(|k| self.turn[row][k] * point[k]).sum::<f64>()
        })
    }

    /// This frame, and the other in it.
    pub(super) fn times(&self, other: &Self) -> Self {
        let turn = std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                (0..3).map(|k| self.turn[row][k] * other.turn[k][column]).sum()
            })
        });
        Self { turn, at: self.place(other.at) }
    }

    /// Angles about x, y, z, each about the fixed axes.
    pub(super) fn rpy(&self) -> [f64; 3] {
        let m = &self.turn;
        let across = m[0][0].hypot(m[1][0]);
        if across < 1e-12 {
            return [0.0, (-m[2][0]).atan2(across), (-m[0][1]).atan2(m[1][1])];
        }
        [m[2][1].atan2(m[2][2]), (-m[2][0]).atan2(across), m[1][0].atan2(m[0][0])]
            .map(|angle| if angle == 0.0 { 0.0 } else { angle })
    }
}

impl Frame {
    /// The turn as a quaternion w, x, y, z.
    pub(super) fn quaternion(&self) -> [f64; 4] {
        let halves = self.rpy().map(|angle| sine_and_cosine(angle / 2.0));
        let [(sr, cr), (sp, cp), (sy, cy)] = halves;
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ]
    }

    /// A tensor (xx, yy, zz, xy, xz, yz) of this frame in the axes of the other one.
    pub(super) fn tensor(&self, [xx, yy, zz, xy, xz, yz]: [f64; 6]) -> [f64; 6] {
        let own = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        let entry = |row: usize, column: usize| -> f64 {
            let terms = (0..9).map(|k| {
                let (a, b) = (k / 3, k % 3);
                self.turn[row][a] * own[a][b] * self.turn[column][b]
            });
            terms.sum()
        };
        [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|(row, column)| entry(row, column))
    }
}

/// Sine and cosine, exact at quarter turns.
fn sine_and_cosine(angle: f64) -> (f64, f64) {
    let quarters = angle / std::f64::consts::FRAC_PI_2;
    if quarters == quarters.round() && quarters.abs() < 1e6 {
        let place = (quarters.rem_euclid(4.0)) as usize % 4;
        return ([0.0, 1.0, 0.0, -1.0][place], [1.0, 0.0, -1.0, 0.0][place]);
    }
    angle.sin_cos()
}
