//! How redundant contacts share the impulses of a step of which some slip.
//!
//! Where contacts slip, the way of sharing decides the motion, and what sweeps and pivots end at
//! depends on the order of the contacts. Shared alike is as equally compliant points do in the
//! limit of no compliance: the law of the event-driven scheme.

use crate::contact::cholesky::{dot, factorise};
use crate::contact::gauss_seidel::{self, SweepLimits};
use crate::contact::{Contact, ContactProblem, newton};

/// Normals that are independent by less than this part of the largest entry are redundant.
const DEPENDENT: f64 = 1e-9;
/// A contact slips whose friction is this near to its limit, relative to that.
const AT_LIMIT: f64 = 1e-9;

/// What leaves the ground more slowly touches it [m/s].
const TOUCHES: f64 = 1e-7;

/// Where the search for impulses starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Start {
    /// At those that are given.
    Given,
    /// Where all contacts have the same: what leaves most of them without any, as pivots do, is far
    /// from alike.
    Spread,
}

/// Shares impulses; memory that stays.
#[derive(Clone, Debug, Default)]
pub(super) struct AlikeSharing {
    /// The contacts that touch after the step, their laws, and their part of the problem.
    touching: Vec<usize>,
    contacts: Vec<Contact>,
    matrix: Vec<f64>,
    free: Vec<f64>,
    force: Vec<f64>,
    was: Vec<f64>,
    normals: Vec<f64>,
    /// The impulses of the last step were shared alike.
    shared: bool,
}

/// The normal speed of a contact after the step.
fn normal_speed(problem: &ContactProblem<'_>, contact: usize, force: &[f64]) -> f64 {
    let normal = problem.normal(contact);
    problem.free[normal] + dot(&problem.delassus[normal * force.len()..][..force.len()], force)
}

impl AlikeSharing {
    /// Where the last step was shared alike: improves `force`, that of the last step, to that of
    /// this one, which spares sweeps. False, with the force as it was, if that fails.
    pub(super) fn follow(&mut self, problem: &ContactProblem<'_>, force: &mut [f64]) -> bool {
        if !self.shared {
            return false;
        }
        self.touching.clear();
        let pushes = |contact: &usize| force[problem.normal(*contact)] > 0.0;
        self.touching.extend((0..problem.contacts.len()).filter(pushes));
        let found = self.solve_part(problem, force, Start::Given);
        self.shared = found && self.slips(problem, force);
        found
    }

    /// Shares `force`, which solves the problem, alike if that matters; leaves it where no better
    /// one is found.
    pub(super) fn share(&mut self, problem: &ContactProblem<'_>, force: &mut [f64]) {
        self.touching.clear();
        let touches = |contact: &usize| {
            let pushes = force[problem.normal(*contact)] > 0.0;
            let released = problem.contacts[*contact].released;
            !released && (pushes || normal_speed(problem, *contact, force) < TOUCHES)
        };
        self.touching.extend((0..problem.contacts.len()).filter(touches));
        let matters = self.slips(problem, force) && self.is_redundant(problem);
        self.shared = matters
            && [Start::Spread, Start::Given]
                .into_iter()
                .any(|start| self.solve_part(problem, force, start));
    }

    /// Whether a contact that touches has as much friction as it can.
    fn slips(&self, problem: &ContactProblem<'_>, force: &[f64]) -> bool {
        let tangents = problem.space.tangents();
        self.touching.iter().any(|&contact| {
            let f = &force[problem.block(contact)];
            let square: f64 = f[..tangents].iter().map(|entry| entry * entry).sum();
            let limit = problem.contacts[contact].coefficient().unwrap_or(0.0) * f[tangents];
            limit > 0.0 && square >= (1.0 - AT_LIMIT) * limit * limit
        })
    }

    /// Solves for the contacts that touch, alike; false, with `force` as it was, if that does not
    /// solve the whole problem.
    fn solve_part(
        &mut self,
        problem: &ContactProblem<'_>,
        force: &mut [f64],
        start: Start,
    ) -> bool {
        self.list(problem, force);
        if start == Start::Spread {
            self.spread(problem.space.rows());
        }
        let part = ContactProblem {
            contacts: &self.contacts,
            delassus: &self.matrix,
            free: &self.free,
            ..*problem
        };
        if self.touching.is_empty() {
            return false;
        }
        let Some(is_exact) = newton::improve(&part, &mut self.force) else {
            return false;
        };
        if start == Start::Spread && !is_exact {
            return false;
        }
        self.was.clear();
        self.was.extend_from_slice(force);
        force.fill(0.0);
        let rows = problem.space.rows();
        for (&contact, own) in self.touching.iter().zip(self.force.chunks_exact(rows)) {
            force[problem.block(contact)].copy_from_slice(own);
        }
        // what does not touch must not sink; what is nearly right is near to where sweeps end
        let others = (0..problem.contacts.len()).filter(|c| !self.touching.contains(c));
        let sinks = |contact: usize| normal_speed(problem, contact, force) < 0.0;
        let sound = !others.filter(|c| !problem.contacts[*c].released).any(sinks)
            && (is_exact || gauss_seidel::solve(problem, SweepLimits::default(), force).converged);
        if !sound {
            force.copy_from_slice(&self.was);
        }
        sound
    }

    /// Gives every contact the mean of all forces.
    fn spread(&mut self, rows: usize) {
        let count = self.force.len() / rows;
        for row in 0..rows {
            let own = || (0..count).map(|contact| contact * rows + row);
            let mean = own().map(|at| self.force[at]).sum::<f64>() / count as f64;
            own().for_each(|at| self.force[at] = mean);
        }
    }

    /// The part of the problem, and of the forces, of the contacts that touch.
    fn list(&mut self, problem: &ContactProblem<'_>, force: &[f64]) {
        let size = problem.rows();
        for list in [&mut self.matrix, &mut self.free, &mut self.force] {
            list.clear();
        }
        self.contacts.clear();
        for &contact in &self.touching {
            self.contacts.push(problem.contacts[contact]);
            self.free.extend_from_slice(&problem.free[problem.block(contact)]);
            self.force.extend_from_slice(&force[problem.block(contact)]);
            for row in problem.block(contact) {
                let line = &problem.delassus[row * size..(row + 1) * size];
                for &other in &self.touching {
                    self.matrix.extend_from_slice(&line[problem.block(other)]);
                }
            }
        }
    }

    /// Whether the normals of the contacts that touch depend on each other.
    fn is_redundant(&mut self, problem: &ContactProblem<'_>) -> bool {
        let (count, size) = (self.touching.len(), problem.rows());
        self.normals.clear();
        for &contact in &self.touching {
            let line = &problem.delassus[problem.normal(contact) * size..][..size];
            self.normals.extend(self.touching.iter().map(|other| line[problem.normal(*other)]));
        }
        let diagonal = (0..count).map(|i| self.normals[i * (count + 1)]);
        let largest = diagonal.fold(0.0_f64, f64::max);
        for i in 0..count {
            self.normals[i * (count + 1)] -= DEPENDENT * largest;
        }
        factorise(&mut self.normals, count).is_err()
    }
}
