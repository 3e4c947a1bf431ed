//! What happens at an event: impacts, then which of the touching contacts carry force.

use super::breakdown::Breakdown;
use super::contact::impact::{Impact, ImpactSolver};
use super::contact::solver::Search;
use super::contact::{
    Contact, ContactFailure, ContactProblem, ContactSolution, Friction, Mode, Tolerance,
};
use super::motion::{Closed, Motion};

/// Laws of impacts and of touching.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touching {
    /// Coefficient of restitution e of Newton's law.
    pub restitution: f64,
    /// Contacts that part more slowly than this are at rest if their forces hold them: the end of
    /// infinitely many bounces [m/s].
    pub rest_speed: f64,
    /// Where the no-slip law allows no impact, Coulomb's law with this coefficient is tried; none
    /// stops the run there.
    pub fallback_friction: Option<f64>,
    /// Whether every touching counts.
    pub scuffing: Scuffing,
}

/// Which touching of the ground counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scuffing {
    /// Every one.
    #[default]
    Counts,
    /// Only that ahead of every closed contact: legs without knees pass through the ground in the
    /// middle of a step.
    IgnoredBehind,
}

/// Heights below this are touching \[m\].
pub(super) const TOUCH_M: f64 = 1e-8;
/// Normal speeds above this, downwards, are impacts [m/s].
const IMPACT_SPEED: f64 = 1e-9;
/// Tangential speeds above this are slipping [m/s].
const SLIP_SPEED: f64 = 1e-8;

/// What an event did to the contacts.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Settled {
    /// Contact and impulse along the ground's directions, for each contact that was hit [N s].
    pub(super) impulses: Vec<(usize, Vec<f64>)>,
    /// Whether the fallback law was used.
    pub(super) fell_back: bool,
}

/// Solves events; memory that stays.
#[derive(Clone, Debug, Default)]
pub(super) struct Settler {
    impact: ImpactSolver,
    solution: ContactSolution,
}

impl Settler {
    /// Impact, if any, and the modes after it, of the closed contacts and those in `touching`.
    /// `released` is a contact that has to open. Changes the rates in `y`.
    pub(super) fn settle(
        &mut self,
        motion: &mut Motion<'_>,
        touching: &Touching,
        new: &[usize],
        released: bool,
        t_s: f64,
        y: &mut [f64],
    ) -> Result<Settled, Breakdown> {
        let mut candidates: Vec<usize> = motion.closed.iter().map(|c| c.contact).collect();
        candidates.extend(new);
        candidates.sort_unstable();
        candidates.dedup();
        let mut settled = Settled::default();
        if candidates.is_empty() {
            motion.closed.clear();
            return Ok(settled);
        }
        motion.free_motion(t_s, y)?;
        motion.project(y, &candidates);
        let rows = motion.ground.rows();
        let hits = (0..candidates.len())
            .any(|index| motion.work.velocity[index * rows + rows - 1] < -IMPACT_SPEED);
        if hits {
            self.collide(motion, touching, &candidates, y, &mut settled)?;
        }
        let stilled = self.hold(motion, touching, candidates, released, t_s, y)?;
        settled.impulses.extend(stilled);
        Ok(settled)
    }

    fn collide(
        &mut self,
        motion: &mut Motion<'_>,
        touching: &Touching,
        candidates: &[usize],
        y: &mut [f64],
        settled: &mut Settled,
    ) -> Result<(), Breakdown> {
        let restitution = vec![touching.restitution; candidates.len()];
        let laws: Vec<Friction> = candidates.iter().map(|c| motion.friction[*c]).collect();
        let mut outcome = self.strike(motion, &laws, &restitution);
        if let (Err(ContactFailure::NoSolution), Some(mu)) = (outcome, touching.fallback_friction) {
            let laws = vec![Friction::Coulomb(mu); candidates.len()];
            outcome = self.strike(motion, &laws, &restitution);
            settled.fell_back = true;
        }
        outcome.map_err(Breakdown::Contact)?;
        let rows = motion.ground.rows();
        motion.apply_impulses(&self.solution.force, y);
        let blocks = self.solution.force.chunks_exact(rows);
        settled.impulses = candidates.iter().copied().zip(blocks.map(<[f64]>::to_vec)).collect();
        Ok(())
    }

    fn strike(
        &mut self,
        motion: &Motion<'_>,
        laws: &[Friction],
        restitution: &[f64],
    ) -> Result<(), ContactFailure> {
        let contacts: Vec<Contact> = laws.iter().map(|law| Contact::resting(*law)).collect();
        let impact = Impact {
            space: motion.ground.space,
            contacts: &contacts,
            restitution,
            delassus: motion.delassus.matrix(),
            before: &motion.work.velocity,
            tolerance: Tolerance { force: 1e-12, response: 1e-12, relative: 1e-11 },
        };
        self.impact.solve(&impact, Search::First, &mut self.solution).map(|_| ())
    }

    /// Decides, on accelerations, which contacts carry force; returns the impulses that take out
    /// the rest of the rates that these contacts forbid.
    fn hold(
        &mut self,
        motion: &mut Motion<'_>,
        touching: &Touching,
        mut candidates: Vec<usize>,
        released: bool,
        t_s: f64,
        y: &mut [f64],
    ) -> Result<Vec<(usize, Vec<f64>)>, Breakdown> {
        let rows = motion.ground.rows();
        motion.project(y, &candidates);
        let parting: Vec<bool> = (0..candidates.len())
            .map(|i| motion.work.velocity[i * rows + rows - 1] > touching.rest_speed)
            .collect();
        let mut index = 0;
        candidates.retain(|_| {
            index += 1;
            !parting[index - 1]
        });
        let before = std::mem::take(&mut motion.closed);
        if candidates.is_empty() {
            return Ok(Vec::new());
        }
        motion.free_motion(t_s, y)?;
        motion.project(y, &candidates);
        motion.free_response(y, &candidates);
        let mut contacts = describe(motion, &candidates);
        self.decide(motion, &contacts)?;
        let unchanged = before.len()
            == self.solution.modes.iter().filter(|m| m.is_closed()).count()
            && before.iter().all(|closed| {
                let index = candidates.iter().position(|contact| *contact == closed.contact);
                index.is_some_and(|index| same(self.solution.modes[index], closed.mode))
            });
        if released && unchanged {
            // the limit is reached, and rounding hides it: the least loaded contact opens
            let load = |index: &usize| self.solution.force[index * rows + rows - 1];
            let least = (0..candidates.len()).min_by(|a, b| load(a).total_cmp(&load(b)));
            if let Some(least) = least {
                contacts[least].released = true;
                self.decide(motion, &contacts)?;
            }
        }
        Ok(self.adopt(motion, &candidates, &before, y))
    }

    fn decide(&mut self, motion: &mut Motion<'_>, contacts: &[Contact]) -> Result<(), Breakdown> {
        let problem = ContactProblem {
            space: motion.ground.space,
            contacts,
            delassus: motion.delassus.matrix(),
            free: &motion.work.free,
            tolerance: motion.holding.tolerance,
        };
        let decided = motion.solver.decide(&problem, Search::First, &mut self.solution);
        let slipping = contacts.iter().any(|contact| contact.slipping.is_some());
        decided.map_err(|failure| match failure {
            ContactFailure::NoSolution if slipping => Breakdown::Painleve,
            ContactFailure::NotFinite => Breakdown::NotFinite,
            failure => Breakdown::Contact(failure),
        })
    }

    /// Takes the decided modes over, with the anchors of those that go on sticking, and takes out
    /// what is left of the rates that they forbid.
    fn adopt(
        &mut self,
        motion: &mut Motion<'_>,
        candidates: &[usize],
        before: &[Closed],
        y: &mut [f64],
    ) -> Vec<(usize, Vec<f64>)> {
        let rows = motion.ground.rows();
        let mut held = Vec::new();
        for (index, (&contact, &mode)) in candidates.iter().zip(&self.solution.modes).enumerate() {
            if !mode.is_closed() {
                continue;
            }
            held.push(index * rows + rows - 1);
            let mut along = Vec::with_capacity(rows);
            motion.ground.append(&motion.work.positions[3 * contact..3 * contact + 3], &mut along);
            let mut anchor = [along[0], if rows == 3 { along[1] } else { 0.0 }];
            let old = before.iter().find(|closed| closed.contact == contact);
            if mode == Mode::Stick {
                held.extend(index * rows..index * rows + rows - 1);
                if let Some(old) = old.filter(|old| old.mode == Mode::Stick) {
                    anchor = old.anchor;
                }
            }
            motion.closed.push(Closed { contact, mode, anchor });
        }
        let impulses = motion.still(&held, y).unwrap_or_default();
        let blocks = impulses.chunks_exact(rows).map(<[f64]>::to_vec);
        candidates.iter().copied().zip(blocks).collect()
    }
}

fn same(a: Mode, b: Mode) -> bool {
    match (a, b) {
        (Mode::Slip(a), Mode::Slip(b)) => a[0] * b[0] + a[1] * b[1] > 0.0 || a == b,
        (a, b) => a == b,
    }
}

/// The contacts of a problem on accelerations: those that slide have their direction.
fn describe(motion: &Motion<'_>, candidates: &[usize]) -> Vec<Contact> {
    let (rows, work) = (motion.ground.rows(), &motion.work);
    let one = |(index, contact): (usize, &usize)| {
        let mut described = Contact::resting(motion.friction[*contact]);
        let sliding = &work.velocity[index * rows..index * rows + rows - 1];
        let speed = sliding.iter().map(|v| v * v).sum::<f64>().sqrt();
        let rubs = matches!(described.friction, Friction::Coulomb(mu) if mu > 0.0);
        if rubs && speed > SLIP_SPEED {
            described.slipping =
                Some([sliding[0] / speed, sliding.get(1).map_or(0.0, |v| v / speed)]);
        }
        described
    };
    candidates.iter().enumerate().map(one).collect()
}
