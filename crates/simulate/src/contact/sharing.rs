//! How redundant contacts share their forces: equally compliant points in the limit of no
//! compliance.
//!
//! Forces x keep the modes if A x = b, and each point's lie in a cone K. With a compliance eps the
//! points give way by eps x: A x + eps x - b is a pull into the cones, and
//! x = P(u) with u = (b - A x) / eps and P the projection onto K. In the limit u is in the range of
//! A, and A x = b still holds. With A = L R (of full rank) and u = L c that is
//!
//! > R P(L c) = d,  where L d = b,
//!
//! as many equations as A has rank, solved by Newton's method. For a symmetric A it is the dual of
//! min |x|^2 in K with A x = b. What b has outside of the range of A (a drift in which redundant
//! contacts contradict each other) reaches neither c nor x.

mod choice;

pub(crate) use self::choice::Loads;
use super::lemke::Lemke;
use super::length;
use denavit_numerics::MinimumNorm;

/// What the force of one contact must keep: 0 <= x_n, and |x_t| <= mu x_n if it has a cone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limit {
    /// Place of the normal force among the unknowns; tangential ones stand just before it.
    pub(crate) at: usize,
    /// Number of those, and the coefficient of friction.
    pub(crate) cone: Option<(usize, f64)>,
}

/// How limits are kept.
#[derive(Clone, Copy, Debug, Default)]
struct Keep {
    /// By so much force.
    spare: f64,
    /// This part of a pull is let through.
    leak: f64,
}

/// Newton steps at most; a set of active limits that comes again ends it sooner.
const STEPS: usize = 30;
/// Part of a pull that is let through where none should be.
const LEAK: f64 = 1e-9;
const HALVINGS: usize = 8;
/// How exactly the equations must hold, relative to d; and what is good enough where rounding
/// stops the method.
const RESIDUAL: [f64; 2] = [1e-14, 1e-11];
/// Slope that is left to forces at the tip of their cone, so that Newton's matrix is regular.
const TIP: f64 = LEAK;
/// Pivots of A below this part of the largest are redundancies of contacts.
const RANK: f64 = 1e-10;
/// Pivots of Newton's matrix below this part of the largest are none.
const PIVOT: f64 = 1e-14;

/// Shares forces; memory that grows to the largest problem and stays.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sharing {
    wanted_loads: Loads,
    /// Which limits have carried load last; none if all do, or nothing is known.
    loaded: Vec<bool>,
    /// Number of forces.
    size: usize,
    /// L, `size` x rank, row-major.
    left: Vec<f64>,
    /// R, rank x `size`, row-major.
    right: Vec<f64>,
    /// d.
    wanted: Vec<f64>,
    /// c.
    place: Vec<f64>,
    trial: Vec<f64>,
    /// P(L c).
    forces: Vec<f64>,
    /// Those without limits, and c of them.
    start: Vec<f64>,
    origin: Vec<f64>,
    missed: Vec<f64>,
    step: Vec<f64>,
    /// The derivative of P times L.
    slope: Vec<f64>,
    matrix: Vec<f64>,
    newton: MinimumNorm,
    system: MinimumNorm,
    lemke: Lemke,
}

impl Sharing {
    /// Takes A x = b (A row-major) and finds the forces without limits: R L c = d. Returns by how
    /// much b is outside of A's range.
    pub(crate) fn pose(&mut self, a: &[f64], b: &[f64]) -> f64 {
        self.size = b.len();
        self.system.factor_range(a, self.size, RANK);
        self.forces.clear();
        if self.nullity() == 0 {
            self.forces.resize(self.size, 0.0);
            return self.system.solve(b, &mut self.forces);
        }
        self.system.full_rank_factors(&mut self.left, &mut self.right);
        let missed = self.system.reduce(b, &mut self.wanted);
        self.share_freely();
        missed
    }

    /// Directions in which the forces are not determined by A x = b.
    pub(crate) fn nullity(&self) -> usize {
        self.system.nullity()
    }

    /// The factored A, without null vectors.
    pub(crate) fn system(&self) -> &MinimumNorm {
        &self.system
    }

    /// The forces that were found last.
    pub(crate) fn forces(&self) -> &[f64] {
        &self.forces
    }

    fn share_freely(&mut self) {
        self.missed.clear();
        self.missed.extend(self.wanted.iter().map(|wanted| -wanted));
        self.newton_step(&[], Keep::default());
        let mut place = std::mem::take(&mut self.place);
        place.clear();
        place.extend(self.step.iter().map(|step| -step));
        self.spread(&place, &[], Keep::default());
        self.place = place;
        self.origin.clone_from(&self.place);
        self.start.clone_from(&self.forces);
    }

    /// Newton's method from `place`; says if the forces keep all limits then.
    fn approach(&mut self, limits: &[Limit], keep: Keep) -> bool {
        let size = self.wanted.iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
        let mut place = std::mem::take(&mut self.place);
        let mut trial = std::mem::take(&mut self.trial);
        let mut now = self.spread(&place, limits, keep);
        for _ in 0..STEPS {
            if now <= RESIDUAL[0] * size {
                break;
            }
            self.place.clone_from(&place);
            self.newton_step(limits, keep);
            let mut share = 1.0;
            let mut then = f64::INFINITY;
            for _ in 0..HALVINGS {
                trial.clear();
                trial.extend(place.iter().zip(&self.step).map(|(c, step)| c - share * step));
                then = self.spread(&trial, limits, keep);
                if then <= (1.0 - 0.1 * share) * now {
                    break;
                }
                share *= 0.5;
            }
            if then.is_nan() || then >= now {
                // rounding, or nothing keeps the limits
                break;
            }
            std::mem::swap(&mut place, &mut trial);
            now = then;
        }
        let found = self.spread(&place, limits, keep) <= RESIDUAL[1] * size;
        (self.place, self.trial) = (place, trial);
        found
    }

    /// P(L c) into `forces`, R P(L c) - d into `missed`; returns the largest of it.
    fn spread(&mut self, place: &[f64], limits: &[Limit], keep: Keep) -> f64 {
        let rank = place.len();
        self.forces.clear();
        self.forces.extend((0..self.size).map(|row| {
            let line = &self.left[row * rank..(row + 1) * rank];
            line.iter().zip(place).map(|(l, c)| l * c).sum::<f64>()
        }));
        for limit in limits {
            project(&mut self.forces, limit, keep);
        }
        self.missed.clear();
        for (row, wanted) in self.wanted.iter().enumerate() {
            let line = &self.right[row * self.size..(row + 1) * self.size];
            let made: f64 = line.iter().zip(&self.forces).map(|(r, x)| r * x).sum();
            self.missed.push(made - wanted);
        }
        self.missed.iter().fold(0.0_f64, |most, entry| most.max(entry.abs()))
    }

    /// (R P' L)^-1 times what is missed at `place`, into `step`.
    fn newton_step(&mut self, limits: &[Limit], keep: Keep) {
        self.slope.clone_from(&self.left);
        for limit in limits {
            self.bend(limit, keep);
        }
        self.solve_slope();
    }

    /// (R S)^-1 times what is missed, into `step`, with S as `slope` has it.
    fn solve_slope(&mut self) {
        let rank = self.wanted.len();
        self.matrix.clear();
        self.matrix.resize(rank * rank, 0.0);
        for (row, target) in self.matrix.chunks_exact_mut(rank.max(1)).enumerate() {
            let line = &self.right[row * self.size..(row + 1) * self.size];
            for (factor, slope) in line.iter().zip(self.slope.chunks_exact(rank)) {
                if *factor != 0.0 {
                    for (entry, slope) in target.iter_mut().zip(slope) {
                        *entry += factor * slope;
                    }
                }
            }
        }
        self.newton.factor(&self.matrix, rank, PIVOT);
        self.step.clear();
        self.step.resize(rank, 0.0);
        self.newton.solve(&self.missed, &mut self.step);
    }

    /// Multiplies the rows of one contact in `slope` by the derivative of its projection.
    fn bend(&mut self, limit: &Limit, keep: Keep) {
        let rank = self.wanted.len();
        let tangents = limit.cone.map_or(0, |(tangents, _)| tangents);
        let first = limit.at - tangents;
        let mut u = [0.0; 3];
        for (entry, row) in u.iter_mut().zip(first..=limit.at) {
            let line = &self.left[row * rank..(row + 1) * rank];
            *entry = line.iter().zip(&self.place).map(|(l, c)| l * c).sum();
        }
        u[tangents] -= tip(limit, keep);
        let Some(derivative) = derivative(&u[..=tangents], limit) else { return };
        for column in 0..rank {
            let mut old = [0.0; 3];
            for (entry, row) in old.iter_mut().zip(first..=limit.at) {
                *entry = self.slope[row * rank + column];
            }
            for (line, row) in derivative.iter().zip(first..=limit.at) {
                let sum: f64 = line.iter().zip(&old[..=tangents]).map(|(d, o)| d * o).sum();
                self.slope[row * rank + column] = sum;
            }
        }
    }
}

/// The normal force at the tip of what keeps a limit by `spare`.
fn tip(limit: &Limit, keep: Keep) -> f64 {
    match limit.cone {
        Some((_, mu)) if keep.spare > 0.0 => keep.spare.max(keep.spare / mu),
        _ => keep.spare,
    }
}

/// Moves the forces of one contact to the nearest that keep its limit.
fn project(forces: &mut [f64], limit: &Limit, keep: Keep) {
    let tip = tip(limit, keep);
    let normal = forces[limit.at] - tip;
    let Some((tangents, mu)) = limit.cone else {
        forces[limit.at] = tip + normal.max(keep.leak * normal);
        return;
    };
    let along = &mut forces[limit.at - tangents..limit.at];
    let size = length(along);
    if size <= mu * normal {
        return;
    }
    if mu * size <= -normal {
        along.fill(0.0);
        forces[limit.at] = tip;
        return;
    }
    let kept = (mu * size + normal) / (1.0 + mu * mu);
    along.iter_mut().for_each(|entry| *entry *= mu * kept / size);
    forces[limit.at] = tip + kept;
}

/// The derivative of the projection at u (tangents, then the normal from the tip); none if it is 1.
fn derivative(u: &[f64], limit: &Limit) -> Option<[[f64; 3]; 3]> {
    let tangents = u.len() - 1;
    let normal = u[tangents];
    let mut d = [[0.0; 3]; 3];
    let mut at_tip = || {
        (0..=tangents).for_each(|i| d[i][i] = TIP);
        Some(d)
    };
    let Some((_, mu)) = limit.cone else {
        return if normal >= 0.0 { None } else { at_tip() };
    };
    let size = length(&u[..tangents]);
    if size <= mu * normal {
        return None;
    }
    if mu * size <= -normal {
        return at_tip();
    }
    let scale = 1.0 / (1.0 + mu * mu);
    let turned = mu * (mu * size + normal) / size;
    for i in 0..tangents {
        let along = u[i] / size;
        for j in 0..tangents {
            let both = along * u[j] / size;
            let across = f64::from(u8::from(i == j)) - both;
            d[i][j] = scale * (mu * mu * both + turned * across);
        }
        d[i][tangents] = scale * mu * along;
        d[tangents][i] = scale * mu * along;
    }
    d[tangents][tangents] = scale;
    (0..=tangents).for_each(|i| d[i][i] += TIP);
    Some(d)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A = u v^T and b = u d: x = P(c u) with v . x = d.
    fn posed(u: &[f64], v: &[f64], d: f64) -> Sharing {
        let a: Vec<f64> = u.iter().flat_map(|u| v.iter().map(move |v| u * v)).collect();
        let b: Vec<f64> = u.iter().map(|u| u * d).collect();
        let mut sharing = Sharing::default();
        assert!(sharing.pose(&a, &b) < 1e-14);
        assert_eq!(sharing.nullity(), u.len() - 1);
        sharing
    }

    fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < tolerance, "{found} for {expected}");
        }
    }

    #[test]
    fn what_would_pull_gives_its_share_to_the_others() {
        let limits = [0, 1, 2].map(|at| Limit { at, cone: None });
        let mut sharing = posed(&[1.0, -1.0, 2.0], &[1.0, 1.0, 1.0], 6.0);
        assert_close(sharing.forces(), &[3.0, -3.0, 6.0], 1e-13);
        assert_eq!(sharing.share(&limits, 0.0), Some(Loads::Compliant));
        assert_close(sharing.forces(), &[2.0, 0.0, 4.0], 1e-13);
        assert_eq!(sharing.share(&limits, 0.5), Some(Loads::Compliant));
        // c (1, -1, 2), at least a half each: c + 1/2 + 2 c = 6
        assert_close(sharing.forces(), &[5.5 / 3.0, 0.5, 11.0 / 3.0], 1e-13);
        assert_eq!(sharing.share_or_pull(&limits), Some(Loads::Compliant));
        assert_close(sharing.forces(), &[2.0, 0.0, 4.0], 1e-8);
    }

    #[test]
    fn a_force_beyond_its_cone_goes_to_the_edge() {
        let cone = Some((2, 0.5));
        let limits = [2, 5].map(|at| Limit { at, cone });
        let w = [1.0, 0.0, 1.0, 0.0, 0.0, 1.0];
        let mut sharing = posed(&w, &w, 28.0);
        assert_eq!(sharing.share(&limits, 0.0), Some(Loads::Compliant));
        // the projection of (1, 0, 1) is (0.6, 0, 1.2): 0.6 c + 1.2 c + c = 28
        assert_close(sharing.forces(), &[6.0, 0.0, 12.0, 0.0, 0.0, 10.0], 1e-11);
    }

    #[test]
    fn forces_that_must_pull_do_so_together() {
        let limits = [0, 1].map(|at| Limit { at, cone: None });
        let mut sharing = posed(&[1.0, 1.0], &[1.0, 1.0], -2.0);
        assert_eq!(sharing.share(&limits, 0.0), None);
        assert_close(sharing.forces(), &[-1.0, -1.0], 1e-14);
        assert_eq!(sharing.share_or_pull(&limits), Some(Loads::Compliant));
        assert_close(sharing.forces(), &[-1.0, -1.0], 1e-6);
    }
}
