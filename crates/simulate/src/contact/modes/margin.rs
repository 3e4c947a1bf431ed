//! How far forces of given modes are from violating a law.

use super::super::lemke::LcpOutcome;
use super::super::sharing::{Limit, Loads};
use super::super::{ContactFailure, ContactProblem, Mode, interior};
use super::{ModeSolver, least_slack};

/// As much force to spare, relative to the largest, is far from any limit.
const ENOUGH: f64 = 1e-4;
/// Smaller pulls, relative to the largest force, are none.
const PULLS: f64 = 1e-8;

impl ModeSolver {
    /// The largest t such that forces exist that keep the modes, with f_n >= t for every closed
    /// contact and mu f_n - |f_t| >= t for every one that sticks \[N\].
    ///
    /// Continuous in time while the modes stay and the forces are determined; the first sign
    /// change from positive to negative is when a contact has to open or to slip. Where contacts
    /// slip, a pull of the forces that the motion has comes before it. Infinite if no
    /// contact is closed, or if contacts press against each other without bound. With it comes the
    /// largest component of the least forces that keep the modes.
    pub fn margin(
        &mut self,
        problem: &ContactProblem<'_>,
        modes: &[Mode],
    ) -> Result<(f64, f64), ContactFailure> {
        self.solve(problem, modes)?;
        let largest = self.values.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
        let slack = least_slack(&self.limits, &self.values);
        let rough = self.has_cones_in_space() && slack > 0.0;
        if rough || self.sharing.nullity() == 0 {
            return Ok((slack, largest));
        }
        let pull = self.least_shared_normal();
        if pull < -PULLS * largest {
            return Ok((pull, largest));
        }
        let enough = ENOUGH * largest;
        if self.has_cones_in_space() {
            if self.sharing.share(&self.limits, enough).is_some() {
                return Ok((enough, largest));
            }
            self.find_null_vectors();
            let (margin, _) =
                interior::largest_margin(&self.values, &self.system, &self.limits, enough);
            return Ok((margin, largest));
        }
        self.find_null_vectors();
        let mut margin = f64::INFINITY;
        self.with_planes(problem, modes, |solver| {
            margin = solver.largest_slack();
            margin.is_finite().then_some(margin)
        });
        Ok((margin, largest))
    }

    /// Whether forces that push keep the modes, but not those of equally compliant points.
    pub(crate) fn keeps_least_alone(
        &mut self,
        problem: &ContactProblem<'_>,
        modes: &[Mode],
    ) -> bool {
        let solved = self.solve(problem, modes).is_ok();
        if !solved || !self.slips() || self.sharing.nullity() == 0 {
            return false;
        }
        self.list_normals();
        self.sharing.share(&self.normals, 0.0) == Some(Loads::Least)
    }

    /// The least normal force, as the motion has them where contacts slip: then it is not free
    /// which of all forces push, and where equally compliant points would pull, steep friction
    /// leaves no others to them, though there may be some. Forces that push but are not the `loads`
    /// wanted count as what those would pull without limits.
    fn least_shared_normal(&mut self) -> f64 {
        let least = |forces: &[f64], limits: &[Limit]| {
            limits.iter().map(|limit| forces[limit.at]).fold(f64::INFINITY, f64::min)
        };
        let unlimited = least(&self.values, &self.limits);
        if !self.slips() || unlimited >= 0.0 {
            return 0.0;
        }
        self.list_normals();
        match self.sharing.share_or_pull(&self.normals) {
            Some(found) if found == self.sharing.wanted_loads() => {
                least(self.sharing.forces(), &self.normals)
            }
            _ => unlimited,
        }
    }

    fn slips(&self) -> bool {
        self.unknowns.iter().any(|unknown| unknown.tangents > 0)
    }

    fn list_normals(&mut self) {
        self.normals.clear();
        self.normals.extend(self.limits.iter().map(|limit| Limit { cone: None, ..*limit }));
    }

    /// max t subject to A z + c >= t, as a complementarity problem of the multipliers y and of
    /// (z, t) = x+ - x-; moves the values to z.
    fn largest_slack(&mut self) -> f64 {
        let (count, free) = (self.slack.len(), self.system.nullity());
        let smallest = self.slack.iter().copied().fold(f64::INFINITY, f64::min);
        self.values.copy_from_slice(&self.least);
        let largest = self.slack.iter().fold(0.0_f64, |sum, slack| sum.max(slack.abs()));
        if free == 0 || largest == 0.0 || !smallest.is_finite() {
            return smallest;
        }
        let (columns, size) = (free + 1, count + 2 * free + 2);
        self.lcp.clear();
        self.lcp.resize(size * size, 0.0);
        for row in 0..count {
            for column in 0..columns {
                let last = column == free;
                let entry = if last { -1.0 } else { self.slope[row * free + column] };
                let (plus, minus) = (count + column, count + columns + column);
                self.lcp[row * size + plus] = entry;
                self.lcp[row * size + minus] = -entry;
                self.lcp[plus * size + row] = -entry;
                self.lcp[minus * size + row] = entry;
            }
        }
        self.lcp_right.clear();
        self.lcp_right.extend(self.slack.iter().map(|slack| slack / largest));
        self.lcp_right.resize(size, 0.0);
        self.lcp_right[count + free] = -1.0;
        self.lcp_right[count + columns + free] = 1.0;
        let report = self.lemke.solve(&self.lcp, &self.lcp_right, 50 * size);
        match report.outcome {
            LcpOutcome::Solved => {}
            LcpOutcome::Ray => return f64::INFINITY,
            // A lower bound that is certain.
            LcpOutcome::Limit | LcpOutcome::Inaccurate => return smallest,
        }
        let x = |solution: &[f64], column: usize| {
            largest * (solution[count + column] - solution[count + columns + column])
        };
        for direction in 0..free {
            self.move_along(direction, x(self.lemke.solution(), direction));
        }
        x(self.lemke.solution(), free)
    }
}
