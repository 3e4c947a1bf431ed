//! Elementary rotations. A rotation is a list of these and is never multiplied out: two elementary
//! turns cost 8 multiplications where a 3x3 matrix costs 9 and hides its zeros.

use super::vector::{Matrix, Vector};
use crate::expr::{Dag, ExprId};

/// The axis of an elementary rotation. Denavit-Hartenberg rows turn about x and z alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The x axis.
    X,
    /// The z axis.
    Z,
}

impl Axis {
    /// (first turned coordinate, second turned coordinate, coordinate along the axis).
    pub(super) const fn indices(self) -> (usize, usize, usize) {
        match self {
            Self::X => (1, 2, 0),
            Self::Z => (0, 1, 2),
        }
    }
}

/// A rotation about one axis: it maps coordinates after the turn to coordinates before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turn {
    /// The axis.
    pub axis: Axis,
    /// The angle \[rad\].
    pub angle: ExprId,
    /// Its cosine.
    pub cos: ExprId,
    /// Its sine.
    pub sin: ExprId,
}

impl Turn {
    /// The turn by `angle` about `axis`.
    pub fn new(dag: &mut Dag, axis: Axis, angle: ExprId) -> Self {
        Self { axis, angle, cos: dag.cos(angle), sin: dag.sin(angle) }
    }

    /// Whether the angle is a multiple of 2 pi, as far as the expression shows.
    pub fn is_identity(&self, dag: &Dag) -> bool {
        self.cos == dag.one() && self.sin == dag.zero()
    }

    /// Coordinates after the turn to coordinates before it (child to parent).
    pub fn to_parent(&self, dag: &mut Dag, v: Vector) -> Vector {
        let (i, j, _) = self.axis.indices();
        let mut out = v;
        [out[i], out[j]] = self.pair_to_parent(dag, [v[i], v[j]]);
        out
    }

    /// Coordinates before the turn to coordinates after it (parent to child).
    pub fn to_child(&self, dag: &mut Dag, v: Vector) -> Vector {
        let (i, j, _) = self.axis.indices();
        let mut out = v;
        let (ci, sj) = (dag.mul(self.cos, v[i]), dag.mul(self.sin, v[j]));
        out[i] = dag.add(ci, sj);
        let (si, cj) = (dag.mul(self.sin, v[i]), dag.mul(self.cos, v[j]));
        out[j] = dag.sub(cj, si);
        out
    }

    /// `R A R^T` for a general matrix, child to parent.
    ///
    /// Of the turned 2x2 block only e = a - d and f = b + c matter, because the trace and b - c
    /// do not feel a turn: with x = cos e - sin f it becomes
    /// [d + cos x, b + sin x; c + sin x, a - cos x], 4 multiplications instead of 16.
    pub fn matrix_to_parent(&self, dag: &mut Dag, a: Matrix) -> Matrix {
        let (i, j, k) = self.axis.indices();
        let mut out = a;
        let e = dag.sub(a[i][i], a[j][j]);
        let f = dag.add(a[i][j], a[j][i]);
        let [cos_x, sin_x] = self.block_step(dag, e, f);
        out[i][i] = dag.add(a[j][j], cos_x);
        out[j][j] = dag.sub(a[i][i], cos_x);
        out[i][j] = dag.add(a[i][j], sin_x);
        out[j][i] = dag.add(a[j][i], sin_x);
        [out[k][i], out[k][j]] = self.pair_to_parent(dag, [a[k][i], a[k][j]]);
        [out[i][k], out[j][k]] = self.pair_to_parent(dag, [a[i][k], a[j][k]]);
        out
    }

    /// (cos x, sin x) times x = cos e - sin f.
    pub(super) fn block_step(&self, dag: &mut Dag, e: ExprId, f: ExprId) -> [ExprId; 2] {
        let (ce, sf) = (dag.mul(self.cos, e), dag.mul(self.sin, f));
        let x = dag.sub(ce, sf);
        [dag.mul(self.cos, x), dag.mul(self.sin, x)]
    }

    /// The two coordinates across the axis, child to parent.
    pub(super) fn pair_to_parent(&self, dag: &mut Dag, [x, y]: [ExprId; 2]) -> [ExprId; 2] {
        let (cx, sy) = (dag.mul(self.cos, x), dag.mul(self.sin, y));
        let (sx, cy) = (dag.mul(self.sin, x), dag.mul(self.cos, y));
        [dag.sub(cx, sy), dag.add(sx, cy)]
    }
}
