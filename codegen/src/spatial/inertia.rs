//! The pseudo-inertia of a body: all ten inertial parameters, in which everything is linear.

use super::turn::Turn;
use super::vector::{Matrix, Vector, add, scale};
use crate::expr::{Dag, ExprId, Node};
use crate::number::ratio;

/// The 4x4 pseudo-inertia `[[K, s], [s^T, m]]` about the origin of a frame: m the mass \[kg\],
/// s = m c the first moment [kg m], K = integral of r r^T dm = tr(J)/2 1 - J [kg m^2], with J the
/// inertia tensor about the origin (math: Wensing's pseudo-inertia matrix).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PseudoInertia {
    /// K, symmetric: entries (i, j) and (j, i) are the same expression.
    pub second: Matrix,
    /// s.
    pub first: Vector,
    /// m.
    pub mass: ExprId,
}

impl PseudoInertia {
    /// No matter at all.
    pub fn zero(dag: &Dag) -> Self {
        let zero = dag.zero();
        Self { second: [[zero; 3]; 3], first: [zero; 3], mass: zero }
    }

    /// From mass, centre of mass and tensor entries [xx yy zz xy xz yz] (Ixy = -integral xy dm),
    /// the tensor about the centre of mass (`central`) or about the frame's origin.
    pub fn from_body(
        dag: &mut Dag,
        mass: ExprId,
        com: Vector,
        tensor: [ExprId; 6],
        central: bool,
    ) -> Self {
        // a centre of mass that is written as s/m says its first moment s: exact also where m = 0
        let first = com.map(|coordinate| match dag.node(coordinate) {
            Node::Div(moment, by) if by == mass => moment,
            _ => dag.mul(mass, coordinate),
        });
        let [xx, yy, zz, xy, xz, yz] = tensor;
        let half = dag.constant(ratio(1, 2));
        let mut diagonal = |a, b, c| {
            let sum = dag.add(a, b);
            let difference = dag.sub(sum, c);
            dag.mul(half, difference)
        };
        let (k11, k22, k33) = (diagonal(yy, zz, xx), diagonal(xx, zz, yy), diagonal(xx, yy, zz));
        let [k12, k13, k23] = [xy, xz, yz].map(|product| dag.neg(product));
        let mut second = [[k11, k12, k13], [k12, k22, k23], [k13, k23, k33]];
        if central {
            // K about the origin = K about the centre of mass + m c c^T
            for (i, j) in UPPER {
                let shift = dag.mul(first[i], com[j]);
                second[i][j] = dag.add(second[i][j], shift);
                second[j][i] = second[i][j];
            }
        }
        Self { second, first, mass }
    }

    /// The sum of two bodies in one frame.
    pub fn add(&self, dag: &mut Dag, other: &Self) -> Self {
        let mut second = self.second;
        for (i, j) in UPPER {
            second[i][j] = dag.add(self.second[i][j], other.second[i][j]);
            second[j][i] = second[i][j];
        }
        let first = add(dag, self.first, other.first);
        Self { second, first, mass: dag.add(self.mass, other.mass) }
    }

    /// The same body in the coordinates before a turn.
    pub fn turned(&self, dag: &mut Dag, turn: &Turn) -> Self {
        let (i, j, k) = turn.axis.indices();
        let a = &self.second;
        let mut second = *a;
        let two = dag.integer(2);
        let e = dag.sub(a[i][i], a[j][j]);
        let f = dag.mul(two, a[i][j]);
        let [cos_x, sin_x] = turn.block_step(dag, e, f);
        second[i][i] = dag.add(a[j][j], cos_x);
        second[j][j] = dag.sub(a[i][i], cos_x);
        second[i][j] = dag.add(a[i][j], sin_x);
        second[j][i] = second[i][j];
        [second[i][k], second[j][k]] = turn.pair_to_parent(dag, [a[i][k], a[j][k]]);
        (second[k][i], second[k][j]) = (second[i][k], second[j][k]);
        Self { second, first: turn.to_parent(dag, self.first), mass: self.mass }
    }

    /// The same body about another origin: the old origin lies at `offset` from the new one.
    pub fn shifted(&self, dag: &mut Dag, offset: Vector) -> Self {
        let moved = scale(dag, self.mass, offset);
        let first = add(dag, self.first, moved);
        let mut second = self.second;
        for (i, j) in UPPER {
            // K + r (s + m r)^T + s r^T
            let (left, right) = (dag.mul(offset[i], first[j]), dag.mul(self.first[i], offset[j]));
            let shift = dag.add(left, right);
            second[i][j] = dag.add(self.second[i][j], shift);
            second[j][i] = second[i][j];
        }
        Self { second, first, mass: self.mass }
    }

    /// All matter `factor` times.
    pub fn scaled(&self, dag: &mut Dag, factor: ExprId) -> Self {
        Self {
            second: self.second.map(|row| scale(dag, factor, row)),
            first: scale(dag, factor, self.first),
            mass: dag.mul(factor, self.mass),
        }
    }

    /// The inertia tensor J = tr(K) 1 - K about the origin.
    pub fn tensor(&self, dag: &mut Dag) -> Matrix {
        let k = &self.second;
        let mut tensor = [[dag.zero(); 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                tensor[i][j] = if i == j {
                    dag.add(k[(i + 1) % 3][(i + 1) % 3], k[(i + 2) % 3][(i + 2) % 3])
                } else {
                    dag.neg(k[i][j])
                };
            }
        }
        tensor
    }
}

/// The entries on and above the diagonal.
const UPPER: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
