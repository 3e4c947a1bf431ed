//! Solving with D: its factorisation along the branches of the tree, and what follows from it.

use crate::expr::{Dag, ExprId};
use crate::kinematics::Frames;

/// D = L^T diag(d) L, with L unit lower triangular and nonzero only between a joint and those
/// below it on its chain (Featherstone's LTDL). The zeros of the tree stay zeros.
pub(super) struct Factors {
    /// L[k][i] for i on the chain of k; 0 elsewhere.
    lower: Vec<Vec<ExprId>>,
    /// 1/d: a division costs many multiplications, so there is one for each pivot.
    shares: Vec<ExprId>,
    /// The parent of each joint.
    parents: Vec<Option<usize>>,
}

impl Factors {
    /// Factorises D.
    pub(super) fn new(dag: &mut Dag, frames: &Frames, mass_matrix: &[Vec<ExprId>]) -> Self {
        let n = frames.len();
        let parents: Vec<_> = frames.frames.iter().map(|frame| frame.parent).collect();
        let mut h: Vec<Vec<ExprId>> = mass_matrix.to_vec();
        let mut shares = vec![dag.zero(); n];
        for k in (0..n).rev() {
            let one = dag.one();
            shares[k] = dag.div(one, h[k][k]);
            let above: Vec<usize> = chain_above(&parents, k).collect();
            for &i in &above {
                let a = dag.mul(h[k][i], shares[k]);
                for j in std::iter::once(i).chain(chain_above(&parents, i)) {
                    let product = dag.mul(a, h[k][j]);
                    h[i][j] = dag.sub(h[i][j], product);
                }
                h[k][i] = a;
            }
        }
        Self { lower: h, shares, parents }
    }

    /// D^-1 b.
    pub(super) fn solve(&self, dag: &mut Dag, right: &[ExprId]) -> Vec<ExprId> {
        let n = self.shares.len();
        let mut x = right.to_vec();
        for k in (0..n).rev() {
            for i in chain_above(&self.parents, k) {
                let product = dag.mul(self.lower[k][i], x[k]);
                x[i] = dag.sub(x[i], product);
            }
        }
        for k in 0..n {
            x[k] = dag.mul(x[k], self.shares[k]);
        }
        for k in 0..n {
            for i in chain_above(&self.parents, k) {
                let product = dag.mul(self.lower[k][i], x[i]);
                x[k] = dag.sub(x[k], product);
            }
        }
        x
    }
}

/// The joints between `k` and the root, `k` excluded, nearest first.
fn chain_above(parents: &[Option<usize>], k: usize) -> impl Iterator<Item = usize> + '_ {
    std::iter::successors(parents[k], |&i| parents[i])
}
