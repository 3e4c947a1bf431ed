//! How redundant contacts share the impulses of a step of which some slip.
//!
//! Where contacts slip, the way of sharing decides the motion, and what sweeps and pivots end at
//! depends on the order of the contacts. Shared alike is as equally compliant points do in the
//! limit of no compliance: the law of the event-driven scheme.

use crate::simulate::contact::cholesky::{dot, factorise};
use crate::simulate::contact::{Contact, ContactProblem, newton};

/// Normals that are independent by less than this part of the largest entry are redundant.
const DEPENDENT: f64 = 1e-9;
/// A contact slips whose friction is this near to its limit, relative to that.
const AT_LIMIT: f64 = 1e-9;

/// What leaves the ground more slowly touches it [m/s].
const TOUCHES: f64 = 1e-7;

/// Shares impulses; memory that stays.
#[derive(Clone, Debug, Default)]
pub(super) struct AlikeSharing {
    /// The contacts that touch after the step, their laws, and their part of the problem.
    touching: Vec<usize>,
    contacts: Vec<Contact>,
    matrix: Vec<f64>,
    free: Vec<f64>,
    force: Vec<f64>,
    normals: Vec<f64>,
}

impl AlikeSharing {
    /// Shares `force`, which solves the problem, alike if that matters; leaves it where no better
    /// one is found.
    pub(super) fn share(&mut self, problem: &ContactProblem<'_>, force: &mut [f64]) {
        let (rows, tangents) = (problem.space.rows(), problem.space.tangents());
        self.touching.clear();
        let speed = |contact: usize, force: &[f64]| {
            let line = &problem.delassus[problem.normal(contact) * force.len()..][..force.len()];
            dot(line, force) + problem.free[problem.normal(contact)]
        };
        let touches = |contact: &usize| {
            let pushes = force[problem.normal(*contact)] > 0.0;
            let law = &problem.contacts[*contact];
            !law.released && (pushes || speed(*contact, force) < TOUCHES)
        };
        self.touching.extend((0..problem.contacts.len()).filter(touches));
        let slips = |contact: &usize| {
            let f = &force[contact * rows..(contact + 1) * rows];
            let size = f[..tangents].iter().map(|entry| entry * entry).sum::<f64>().sqrt();
            let limit = problem.contacts[*contact].coefficient().unwrap_or(0.0) * f[tangents];
            limit > 0.0 && size >= (1.0 - AT_LIMIT) * limit
        };
        if !self.touching.iter().any(slips) || !self.is_redundant(problem) {
            return;
        }
        self.list(problem, force);
        let part = ContactProblem {
            contacts: &self.contacts,
            delassus: &self.matrix,
            free: &self.free,
            ..*problem
        };
        if !newton::improve(&part, &mut self.force) {
            return;
        }
        let was = force.to_vec();
        for (place, contact) in self.touching.iter().enumerate() {
            let own = &self.force[place * rows..(place + 1) * rows];
            force[contact * rows..(contact + 1) * rows].copy_from_slice(own);
        }
        // what did not touch must not sink for it
        let others = (0..problem.contacts.len()).filter(|c| !self.touching.contains(c));
        let sinks = |contact: usize| speed(contact, force) < 0.0;
        if others.filter(|c| !problem.contacts[*c].released).any(sinks) {
            force.copy_from_slice(&was);
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
