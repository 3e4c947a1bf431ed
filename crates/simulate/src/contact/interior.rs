//! How far forces can be kept inside all friction cones: an interior point method.
//!
//! Redundant contacts leave f = f0 + N z. Sought is the largest t with f_n >= t and
//! mu f_n - |f_t| >= t for every contact: a barrier keeps (z, t) inside, and lets it come the
//! nearer to the edge the steeper t is weighted (Boyd and Vandenberghe 2004, chapter 11). Tangent
//! planes instead of the cones would be an endless number of nearly parallel ones.

use super::sharing::Limit;
use denavit_numerics::MinimumNorm;
use nalgebra::{Cholesky, DMatrix, DVector};

/// A linear function of (z, t): its value at 0 and its slope.
struct Line {
    base: f64,
    slope: DVector<f64>,
}

impl Line {
    fn at(&self, x: &DVector<f64>) -> f64 {
        self.base + self.slope.dot(x)
    }
}

/// s > 0, or s > 0 and s^2 > |a|^2.
struct Barrier {
    side: Line,
    across: Option<[Line; 2]>,
}

impl Barrier {
    /// How much is left of it, negative outside.
    fn left(&self, x: &DVector<f64>) -> f64 {
        let side = self.side.at(x);
        match &self.across {
            Some([a, b]) if side > 0.0 => side * side - a.at(x).powi(2) - b.at(x).powi(2),
            _ => side,
        }
    }

    /// Number of logarithms that it counts as.
    fn weight(&self) -> f64 {
        if self.across.is_some() { 2.0 } else { 1.0 }
    }
}

/// The weight of t grows by this factor a round.
const GROWTH: f64 = 30.0;
const ROUNDS: usize = 12;
const STEPS: usize = 30;
/// The largest t is approached this near, relative to the largest force.
const GAP: f64 = 1e-10;

/// The largest t, and the forces' place z on the null vectors at which it is (nearly) kept; stops
/// early once t exceeds `enough`.
pub(super) fn largest_margin(
    least: &[f64],
    system: &MinimumNorm,
    limits: &[Limit],
    enough: f64,
) -> (f64, Vec<f64>) {
    let free = system.nullity();
    let scale = least.iter().fold(f64::MIN_POSITIVE, |most, f| most.max(f.abs()));
    let barriers = list(least, system, limits, scale);
    let mut x = DVector::zeros(free + 1);
    let worst = barriers.iter().map(margin).fold(f64::INFINITY, f64::min);
    x[free] = worst - 0.1 * (1.0 + worst.abs());
    let count: f64 = barriers.iter().map(Barrier::weight).sum();
    let mut steepness = count;
    for _ in 0..ROUNDS {
        center(&barriers, steepness, &mut x);
        if x[free] * scale > enough || count / steepness <= GAP {
            break;
        }
        steepness *= GROWTH;
    }
    let margin = if x[free] * scale > enough { x[free] } else { x[free] + count / steepness };
    (margin * scale, x.iter().take(free).map(|z| z * scale).collect())
}

/// What the barrier leaves to t at z = 0.
fn margin(barrier: &Barrier) -> f64 {
    let across = barrier.across.as_ref().map_or(0.0, |[a, b]| a.base.hypot(b.base));
    barrier.side.base - across
}

fn list(least: &[f64], system: &MinimumNorm, limits: &[Limit], scale: f64) -> Vec<Barrier> {
    let free = system.nullity();
    let line = |at: usize, factor: f64, of_t: f64| {
        let mut slope = DVector::zeros(free + 1);
        for direction in 0..free {
            slope[direction] = factor * system.null_vector(direction)[at];
        }
        slope[free] = of_t;
        Line { base: factor * least[at] / scale, slope }
    };
    let mut barriers = Vec::new();
    for limit in limits {
        barriers.push(Barrier { side: line(limit.at, 1.0, -1.0), across: None });
        if let Some((tangents, mu)) = limit.cone {
            let across = [line(limit.at - tangents, 1.0, 0.0), line(limit.at - 1, 1.0, 0.0)];
            barriers.push(Barrier { side: line(limit.at, mu, -1.0), across: Some(across) });
        }
    }
    barriers
}

/// Newton's method for the least of -steepness t - sum log(left).
fn center(barriers: &[Barrier], steepness: f64, x: &mut DVector<f64>) {
    let size = x.len();
    let value = |x: &DVector<f64>| {
        let mut sum = -steepness * x[size - 1];
        for barrier in barriers {
            let left = barrier.left(x);
            if left <= 0.0 || barrier.side.at(x) <= 0.0 {
                return f64::INFINITY;
            }
            sum -= left.ln();
        }
        sum
    };
    let mut now = value(x);
    for _ in 0..STEPS {
        let mut gradient = DVector::zeros(size);
        gradient[size - 1] = -steepness;
        let mut curvature = DMatrix::zeros(size, size);
        for barrier in barriers {
            let left = barrier.left(x);
            let side = barrier.side.at(x);
            let mut slope = barrier.side.slope.clone();
            if let Some([a, b]) = &barrier.across {
                slope *= 2.0 * side;
                slope.axpy(-2.0 * a.at(x), &a.slope, 1.0);
                slope.axpy(-2.0 * b.at(x), &b.slope, 1.0);
                for (line, sign) in [(&barrier.side, -2.0), (a, 2.0), (b, 2.0)] {
                    curvature.ger(sign / left, &line.slope, &line.slope, 1.0);
                }
            }
            gradient.axpy(-1.0 / left, &slope, 1.0);
            curvature.ger(1.0 / (left * left), &slope, &slope, 1.0);
        }
        // what no limit feels stays where it is
        let floor = 1e-14 * curvature.trace();
        for i in 0..size {
            curvature[(i, i)] += floor;
        }
        let Some(factors) = Cholesky::new(curvature) else { return };
        let step = factors.solve(&gradient);
        let decrease = gradient.dot(&step);
        if decrease.is_nan() || decrease <= 1e-8 {
            return;
        }
        let mut share = 1.0;
        loop {
            let trial = &*x - share * &step;
            let then = value(&trial);
            if then <= now - 0.1 * share * decrease {
                (*x, now) = (trial, then);
                break;
            }
            share *= 0.5;
            if share < 1e-10 {
                return;
            }
        }
    }
}
