//! Which of the forces that keep all limits redundant contacts have.
//!
//! Without friction those of equally compliant points are the least of all, and unique. Steep
//! friction under a sole that slides and turns makes the problem unsymmetric: it may have a second
//! solution, and none. Then the one goes on that was there before, until it ends; at the start, and
//! after contacts have changed, it is the one that Newton's method or pivots reach from where all
//! points are loaded. Where there is none, the least forces stand in until contacts change.

use super::{Keep, LEAK, Limit, Sharing};
use crate::contact::lemke::LcpOutcome;

/// Which of the forces that keep all limits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Loads {
    /// Those of equally compliant points.
    #[default]
    Compliant,
    /// The least of all, min |x|^2, where equally compliant points find no rest: steep friction
    /// under a sole that turns lets it tilt further and further.
    Least,
}

impl Sharing {
    /// Which forces are wanted from now on where there are several; nothing is known of what
    /// carried load. `Least` is wanted until contacts change, lest it be taken in turns with the
    /// other.
    pub(crate) fn want(&mut self, loads: Loads) {
        self.wanted_loads = loads;
        self.loaded.clear();
    }

    /// Which forces are wanted where there are several.
    pub(crate) fn wanted_loads(&self) -> Loads {
        self.wanted_loads
    }

    /// Remembers which limits carry load.
    pub(crate) fn remember(&mut self, loaded: &[bool]) {
        self.loaded.clear();
        if loaded.iter().any(|loaded| !loaded) {
            self.loaded.extend_from_slice(loaded);
        }
    }

    /// Whether the forces without limits are wanted if they keep these.
    pub(crate) fn is_free(&self) -> bool {
        self.wanted_loads == Loads::Compliant && self.loaded.is_empty()
    }

    /// The forces that keep every limit by `spare` at least; none, with the forces without limits,
    /// if none were found. Only where forces are not determined by A x = b.
    pub(crate) fn share(&mut self, limits: &[Limit], spare: f64) -> Option<Loads> {
        let keep = Keep { spare, leak: 0.0 };
        let plain = are_plain(limits, keep);
        if !(plain && self.wanted_loads == Loads::Least) && self.find(limits, keep) {
            return Some(Loads::Compliant);
        }
        (plain && self.find_least(limits, keep)).then_some(Loads::Least)
    }

    /// As `share`, for normal forces alone, which may pull where that must be: as points would that
    /// are 1 / `LEAK` times as stiff against it. Continuous across the end of what is possible.
    pub(crate) fn share_or_pull(&mut self, limits: &[Limit]) -> Option<Loads> {
        let keep = Keep { spare: 0.0, leak: LEAK };
        let pulled = |sharing: &mut Self, loads| match loads {
            Loads::Compliant => sharing.find(limits, keep).then_some(loads),
            Loads::Least => sharing.find_least(limits, keep).then_some(loads),
        };
        let (first, second) = match self.wanted_loads {
            Loads::Compliant => (Loads::Compliant, Loads::Least),
            Loads::Least => (Loads::Least, Loads::Compliant),
        };
        let found = self.share(limits, 0.0).or_else(|| pulled(self, first));
        found.or_else(|| pulled(self, second))
    }

    /// The least forces that keep the limits: x = P(R^T c), which there always are if any forces
    /// keep them.
    fn find_least(&mut self, limits: &[Limit], keep: Keep) -> bool {
        let (size, rank) = (self.size, self.wanted.len());
        let compliant = (self.left.clone(), self.origin.clone(), self.start.clone());
        self.left.clear();
        for row in 0..size {
            self.left.extend((0..rank).map(|column| self.right[column * size + row]));
        }
        self.share_freely();
        let found = self.find(limits, keep);
        (self.left, self.origin, self.start) = compliant;
        if !found {
            self.forces.clone_from(&self.start);
        }
        found
    }

    /// Newton's method from the forces of what has carried load last, then from those without
    /// limits; where it fails, from those that pivots find.
    fn find(&mut self, limits: &[Limit], keep: Keep) -> bool {
        let mut found = self.recall(limits, keep) && self.approach(limits, keep);
        if !found {
            self.place.clone_from(&self.origin);
            found = self.approach(limits, keep)
                || (self.pivot(limits, keep) && self.approach(limits, keep));
        }
        if !found {
            self.forces.clone_from(&self.start);
        }
        found
    }

    /// The place at which what carried load last has all, whether it pushes or pulls; false if
    /// nothing is known.
    fn recall(&mut self, limits: &[Limit], keep: Keep) -> bool {
        if self.loaded.len() != limits.len() || !are_plain(limits, keep) {
            return false;
        }
        let rank = self.wanted.len();
        self.slope.clone_from(&self.left);
        for (limit, _) in limits.iter().zip(&self.loaded).filter(|(_, loaded)| !**loaded) {
            self.slope[limit.at * rank..(limit.at + 1) * rank].fill(0.0);
        }
        self.missed.clone_from(&self.wanted);
        self.solve_slope();
        self.place.clone_from(&self.step);
        true
    }

    /// The place at which normal forces alone keep their limits, from the one without limits, by
    /// pivots, which end also where Newton's steps go to and fro between sets of loaded points:
    /// with the pushes v of the limits, n = n0 + M v, M = 1 - L (R L)^-1 R, and
    ///
    /// > 0 <= v  _|_  (1 - leak) n0 + ((1 - leak) M + leak) v >= 0.
    ///
    /// Steep friction makes M so unsymmetric that there are several solutions; the path is that of
    /// a load on all points alike that is taken away again, so that the state alone decides.
    fn pivot(&mut self, limits: &[Limit], keep: Keep) -> bool {
        if !are_plain(limits, keep) {
            return false;
        }
        let (rank, count, kept) = (self.origin.len(), limits.len(), 1.0 - keep.leak);
        self.place.clone_from(&self.origin);
        self.missed.clear();
        self.missed.resize(rank, 0.0);
        // columns of (R L)^-1 R
        let mut moves = Vec::with_capacity(count * rank);
        for limit in limits {
            for (row, entry) in self.missed.iter_mut().enumerate() {
                *entry = self.right[row * self.size + limit.at];
            }
            self.newton_step(&[], Keep::default());
            moves.extend_from_slice(&self.step);
        }
        self.matrix.clear();
        for (i, limit) in limits.iter().enumerate() {
            let line = &self.left[limit.at * rank..(limit.at + 1) * rank];
            for (j, column) in moves.chunks_exact(rank).enumerate() {
                let along: f64 = line.iter().zip(column).map(|(l, m)| l * m).sum();
                self.matrix.push(f64::from(u8::from(i == j)) - kept * along);
            }
        }
        let normals: Vec<f64> = limits.iter().map(|limit| kept * self.start[limit.at]).collect();
        let report = self.lemke.solve(&self.matrix, &normals, 50 * (count + 1));
        for (push, column) in self.lemke.solution().iter().zip(moves.chunks_exact(rank)) {
            self.place.iter_mut().zip(column).for_each(|(place, step)| *place -= push * step);
        }
        report.outcome == LcpOutcome::Solved
    }
}

/// Whether the limits are those of normal forces alone.
fn are_plain(limits: &[Limit], keep: Keep) -> bool {
    keep.spare == 0.0 && limits.iter().all(|limit| limit.cone.is_none())
}
