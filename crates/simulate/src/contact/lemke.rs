//! The linear complementarity problem: w = M z + q, w >= 0, z >= 0, w.z = 0.
//!
//! Lemke's method: an artificial variable covers the negative part of q, and complementary pivots
//! drive it out again. The ratio test is lexicographic (rows are compared together with the inverse
//! of the basis), so that no basis comes twice, however degenerate the problem; redundant contacts
//! are just that. The rows are equilibrated first by a positive diagonal D (D M D, D q), which
//! leaves the complementarity as it is.

use denavit_numerics::MinimumNorm;

/// How Lemke's method ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LcpOutcome {
    /// z solves the problem; the residual has been checked.
    Solved,
    /// The path ended in a secondary ray. For a copositive-plus M (every positive semidefinite
    /// one) this proves that the problem has no solution.
    Ray,
    /// The limit of pivots was reached.
    Limit,
    /// The path ended in a basis whose residual is too large: the problem is scaled too badly.
    Inaccurate,
}

/// What one solution cost and how good it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LcpReport {
    /// How the method ended.
    pub outcome: LcpOutcome,
    /// Number of pivots.
    pub pivots: usize,
    /// max |min(z_i, w_i)| of the equilibrated problem, relative to max |q|; infinite unless a
    /// basis was reached.
    pub residual: f64,
}

/// Entries below this, in a column whose entries are of order 1, are no pivots. What is rounding
/// of zero and what is a small pivot shows only in the residual: the next threshold is tried where
/// the one before ends inaccurately.
const PIVOTS: [f64; 3] = [1e-9, 1e-12, 1e-7];
/// Ratios closer than this, relatively, are equal: their rows are compared lexicographically.
const TIE: f64 = 1e-12;
/// Where rounding hides which ratios are equal, the path goes astray, and may end in a ray that is
/// none. Then right sides are moved apart by about these parts of the largest, so that there are no
/// ties; the solution of the last basis has them where they were.
const APART: [f64; 3] = [1e-9, 1e-7, 1e-11];
/// Multiples of the golden section are evenly spread, modulo 1.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Largest residual of a solution.
const RESIDUAL: f64 = 1e-8;

/// One way along the path.
#[derive(Clone, Copy, Debug)]
struct Attempt {
    /// The largest |q|.
    magnitude: f64,
    /// Pivots at most.
    limit: usize,
    /// Smaller entries of a column are none.
    pivot: f64,
    /// How far right sides are moved apart.
    apart: f64,
}

/// Lemke's method and its memory, which grows to the largest problem and stays.
#[derive(Clone, Debug, Default)]
pub struct Lemke {
    n: usize,
    /// Row-major, n rows of [w (n) | z (n) | cover | right side].
    tableau: Vec<f64>,
    /// Per row its basic variable: a column of the tableau.
    basis: Vec<usize>,
    scale: Vec<f64>,
    solution: Vec<f64>,
    pivot_row: Vec<f64>,
    exact: MinimumNorm,
    support: Vec<usize>,
    matrix: Vec<f64>,
    right: Vec<f64>,
}

impl Lemke {
    /// No memory yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// z of the last problem: its solution if that was solved, or the best that was found.
    pub fn solution(&self) -> &[f64] {
        &self.solution[..self.n]
    }

    /// Solves w = M z + q for M row-major, n x n; stops after `limit` pivots.
    pub fn solve(&mut self, m: &[f64], q: &[f64], limit: usize) -> LcpReport {
        let n = q.len();
        assert_eq!(m.len(), n * n, "the matrix fits the vector");
        self.n = n;
        self.solution.clear();
        self.solution.resize(n, 0.0);
        if q.iter().all(|entry| *entry >= 0.0) {
            return LcpReport { outcome: LcpOutcome::Solved, pivots: 0, residual: 0.0 };
        }
        self.equilibrate(m);
        let magnitude =
            q.iter().zip(&self.scale).fold(0.0_f64, |sum, (entry, d)| sum.max((entry * d).abs()));
        let exact = |pivot| Attempt { magnitude, limit, pivot, apart: 0.0 };
        let mut best = self.attempt(m, q, exact(PIVOTS[0]));
        let mut kept = self.solution.clone();
        let mut spent = best.pivots;
        let others = PIVOTS[1..].iter().map(|pivot| exact(*pivot));
        let moved = APART.iter().map(|apart| Attempt { apart: *apart, ..exact(PIVOTS[0]) });
        for attempt in others.chain(moved) {
            if best.outcome == LcpOutcome::Solved {
                break;
            }
            let report = self.attempt(m, q, attempt);
            spent += report.pivots;
            if report.residual < best.residual {
                best = report;
                kept.clone_from(&self.solution);
            }
        }
        self.solution = kept;
        LcpReport { pivots: spent, ..best }
    }

    fn attempt(&mut self, m: &[f64], q: &[f64], attempt: Attempt) -> LcpReport {
        let magnitude = attempt.magnitude;
        self.solution.fill(0.0);
        self.fill(m, q, attempt);
        let (outcome, pivots) = self.pivot_along_the_path(attempt.limit, attempt.pivot);
        if outcome != LcpOutcome::Solved {
            return LcpReport { outcome, pivots, residual: f64::INFINITY };
        }
        self.read_solution(magnitude);
        let mut residual = self.residual(m, q, magnitude);
        // The tableau has gathered the rounding of all pivots: solve for its last basis anew.
        if residual > 1e-14 {
            residual = self.polish(m, q, magnitude, residual);
        }
        let solved = residual <= RESIDUAL;
        let outcome = if solved { LcpOutcome::Solved } else { LcpOutcome::Inaccurate };
        LcpReport { outcome, pivots, residual }
    }

    /// Chooses D so that the largest entry of every row and column of D M D is about 1.
    fn equilibrate(&mut self, m: &[f64]) {
        let n = self.n;
        self.scale.clear();
        self.scale.resize(n, 1.0);
        for _ in 0..4 {
            for i in 0..n {
                let largest = (0..n).fold(0.0_f64, |largest, j| {
                    largest.max(m[i * n + j].abs().max(m[j * n + i].abs()) * self.scale[j])
                });
                if largest > 0.0 {
                    // Rounded to a power of two: scaling then loses nothing.
                    let exponent = (0.5 * (self.scale[i] * largest).log2()).round();
                    self.scale[i] *= (-exponent).exp2();
                }
            }
        }
    }

    fn fill(&mut self, m: &[f64], q: &[f64], attempt: Attempt) {
        let (n, width) = (self.n, 2 * self.n + 2);
        let spread = |i: usize| 0.5 + (i as f64 * GOLDEN).fract();
        self.tableau.clear();
        self.tableau.resize(n * width, 0.0);
        self.basis.clear();
        self.basis.extend(0..n);
        for i in 0..n {
            let row = &mut self.tableau[i * width..(i + 1) * width];
            row[i] = 1.0;
            for j in 0..n {
                row[n + j] = -m[i * n + j] * self.scale[i] * self.scale[j];
            }
            row[2 * n] = -1.0;
            row[2 * n + 1] = q[i] * self.scale[i] / attempt.magnitude + attempt.apart * spread(i);
        }
    }

    fn pivot_along_the_path(&mut self, limit: usize, smallest: f64) -> (LcpOutcome, usize) {
        let (n, width) = (self.n, 2 * self.n + 2);
        let right = |row: usize| self.tableau[row * width + 2 * n + 1];
        // Lexicographically smallest (q_i, e_i): of equal q_i the last.
        let mut row =
            (0..n).fold(0, |best, row| if right(row) <= right(best) { row } else { best });
        let mut entering = 2 * n;
        for pivots in 1..=limit {
            self.pivot(row, entering);
            let leaving = std::mem::replace(&mut self.basis[row], entering);
            if leaving == 2 * n {
                return (LcpOutcome::Solved, pivots);
            }
            entering = if leaving < n { leaving + n } else { leaving - n };
            match self.leaving_row(entering, smallest) {
                Some(next) => row = next,
                None => return (LcpOutcome::Ray, pivots),
            }
        }
        (LcpOutcome::Limit, limit)
    }

    /// Gauss-Jordan: the entering column becomes the unit vector of `row`.
    fn pivot(&mut self, row: usize, entering: usize) {
        let (n, width) = (self.n, 2 * self.n + 2);
        let inverse = 1.0 / self.tableau[row * width + entering];
        for entry in &mut self.tableau[row * width..(row + 1) * width] {
            *entry *= inverse;
        }
        self.tableau[row * width + entering] = 1.0;
        self.pivot_row.clear();
        self.pivot_row.extend_from_slice(&self.tableau[row * width..(row + 1) * width]);
        for other in (0..n).filter(|&other| other != row) {
            let line = &mut self.tableau[other * width..(other + 1) * width];
            let factor = line[entering];
            if factor == 0.0 {
                continue;
            }
            for (entry, pivot) in line.iter_mut().zip(&self.pivot_row) {
                *entry -= factor * pivot;
            }
            line[entering] = 0.0;
        }
    }

    /// The row of the smallest ratio; the cover's, if that is among the smallest.
    fn leaving_row(&self, entering: usize, smallest: f64) -> Option<usize> {
        let (n, width) = (self.n, 2 * self.n + 2);
        let at = |row: usize, column: usize| self.tableau[row * width + column];
        let largest = (0..n).fold(1.0_f64, |sum, row| sum.max(at(row, entering).abs()));
        let candidates = || (0..n).filter(|&row| at(row, entering) > smallest * largest);
        let ratio = |row: usize| at(row, 2 * n + 1).max(0.0) / at(row, entering);
        let least = candidates().map(ratio).fold(f64::INFINITY, f64::min);
        if least == f64::INFINITY {
            return None;
        }
        let margin = TIE * (1.0 + least);
        let tied = || candidates().filter(|&row| ratio(row) <= least + margin);
        if let Some(cover) = tied().find(|&row| self.basis[row] == 2 * n) {
            return Some(cover);
        }
        tied().reduce(|best, row| {
            let difference = (0..n)
                .map(|column| {
                    at(row, column) / at(row, entering) - at(best, column) / at(best, entering)
                })
                .find(|difference| difference.abs() > TIE);
            if difference.is_some_and(|difference| difference < 0.0) { row } else { best }
        })
    }

    fn read_solution(&mut self, magnitude: f64) {
        let (n, width) = (self.n, 2 * self.n + 2);
        for row in 0..n {
            let variable = self.basis[row];
            if (n..2 * n).contains(&variable) {
                let value = self.tableau[row * width + 2 * n + 1].max(0.0);
                self.solution[variable - n] = value * magnitude * self.scale[variable - n];
            }
        }
    }

    /// max |min(z_i, w_i)| of the equilibrated problem, relative to its max |q|.
    fn residual(&self, m: &[f64], q: &[f64], magnitude: f64) -> f64 {
        let n = self.n;
        (0..n).fold(0.0_f64, |worst, i| {
            let row = &m[i * n..(i + 1) * n];
            let w = q[i] + row.iter().zip(&self.solution).map(|(a, z)| a * z).sum::<f64>();
            let smaller = (w * self.scale[i]).min(self.solution[i] / self.scale[i]);
            worst.max(smaller.abs() / magnitude)
        })
    }

    /// Solves M_aa z_a = -q_a for the basic z; keeps the better of the two solutions.
    fn polish(&mut self, m: &[f64], q: &[f64], magnitude: f64, before: f64) -> f64 {
        let n = self.n;
        self.support.clear();
        self.support.extend((0..n).filter(|i| self.basis.contains(&(n + i))));
        let size = self.support.len();
        self.matrix.clear();
        self.right.clear();
        for &i in &self.support {
            let scaled = |j: &usize| m[i * n + j] * self.scale[i] * self.scale[*j];
            self.matrix.extend(self.support.iter().map(scaled));
            self.right.push(-q[i] * self.scale[i]);
        }
        self.exact.factor(&self.matrix, size, 1e-13);
        let old = std::mem::take(&mut self.right);
        let mut z = std::mem::take(&mut self.matrix);
        z.clear();
        z.resize(size, 0.0);
        self.exact.solve(&old, &mut z);
        // The solution of the tableau goes where the right side stood.
        let mut kept = old;
        for (position, &i) in self.support.iter().enumerate() {
            kept[position] = self.solution[i];
            self.solution[i] = z[position].max(0.0) * self.scale[i];
        }
        let mut after = self.residual(m, q, magnitude);
        if after >= before {
            for (position, &i) in self.support.iter().enumerate() {
                self.solution[i] = kept[position];
            }
            after = before;
        }
        (self.right, self.matrix) = (kept, z);
        after
    }
}
