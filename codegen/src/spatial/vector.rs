//! Vectors of three expressions, and 3x3 matrices as three rows.

use crate::expr::{Dag, ExprId};

/// Three coordinates in one frame.
pub type Vector = [ExprId; 3];

/// Three rows.
pub type Matrix = [Vector; 3];

/// The zero vector.
pub fn zero(dag: &Dag) -> Vector {
    [dag.zero(); 3]
}

/// The zero matrix.
pub fn zero_matrix(dag: &Dag) -> Matrix {
    [zero(dag); 3]
}

/// A vector made coordinate by coordinate.
pub fn entrywise(
    dag: &mut Dag,
    a: Vector,
    b: Vector,
    operation: fn(&mut Dag, ExprId, ExprId) -> ExprId,
) -> Vector {
    [0, 1, 2].map(|k| operation(dag, a[k], b[k]))
}

/// `a + b`.
pub fn add(dag: &mut Dag, a: Vector, b: Vector) -> Vector {
    entrywise(dag, a, b, Dag::add)
}

/// `a - b`.
pub fn subtract(dag: &mut Dag, a: Vector, b: Vector) -> Vector {
    entrywise(dag, a, b, Dag::sub)
}

/// `-a`.
pub fn negate(dag: &mut Dag, a: Vector) -> Vector {
    a.map(|x| dag.neg(x))
}

/// `factor a`.
pub fn scale(dag: &mut Dag, factor: ExprId, a: Vector) -> Vector {
    a.map(|x| dag.mul(factor, x))
}

/// `a . b`.
pub fn dot(dag: &mut Dag, a: Vector, b: Vector) -> ExprId {
    (0..3).fold(dag.zero(), |sum, k| {
        let product = dag.mul(a[k], b[k]);
        dag.add(sum, product)
    })
}

/// `a x b`.
pub fn cross(dag: &mut Dag, a: Vector, b: Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
        let (left, right) = (dag.mul(a[i], b[j]), dag.mul(a[j], b[i]));
        dag.sub(left, right)
    })
}

/// `A + B`.
pub fn add_matrix(dag: &mut Dag, a: Matrix, b: Matrix) -> Matrix {
    [0, 1, 2].map(|row| add(dag, a[row], b[row]))
}

/// Rows become columns.
pub fn transpose(a: Matrix) -> Matrix {
    [0, 1, 2].map(|column| [0, 1, 2].map(|row| a[row][column]))
}

/// The axial vector of `A - A^T`: (A32 - A23, A13 - A31, A21 - A12).
pub fn vee(dag: &mut Dag, a: Matrix) -> Vector {
    [(2, 1), (0, 2), (1, 0)].map(|(i, j)| dag.sub(a[i][j], a[j][i]))
}
