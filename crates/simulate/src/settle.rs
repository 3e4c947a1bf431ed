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

/// Normal speeds above this, downwards, are impacts [m/s].
const IMPACT_SPEED: f64 = 1e-9;
/// Tangential speeds above this are slipping [m/s].
const SLIP_SPEED: f64 = 1e-8;

/// How often a decision is taken again for points that others of their foot hold.
const HELD_ROUNDS: usize = 3;

/// What contacts are asked to settle after.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Onset<'a> {
    /// These touch the ground beside those that are closed.
    Touch(&'a [usize]),
    /// An impulse has changed the velocities, which those that are closed may forbid.
    Push,
}

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
    /// The contacts of the last decision, with the laws that it took.
    contacts: Vec<Contact>,
}

impl Settler {
    /// Impact, if any, and the modes after it, of the closed contacts and those that touch. Changes
    /// the rates in `y`.
    pub(super) fn settle(
        &mut self,
        motion: &mut Motion<'_>,
        touching: &Touching,
        onset: Onset<'_>,
        t_s: f64,
        y: &mut [f64],
    ) -> Result<Settled, Breakdown> {
        let new = match onset {
            Onset::Touch(new) => new,
            Onset::Push => &[],
        };
        let mut candidates: Vec<usize> = motion.closed.iter().map(|c| c.contact).collect();
        candidates.extend(new);
        candidates.sort_unstable();
        candidates.dedup();
        let mut settled = Settled::default();
        if candidates.is_empty() {
            return Ok(settled);
        }
        motion.free_motion(t_s, y)?;
        motion.project(y, &candidates);
        let rows = motion.ground.rows();
        let hits = (0..candidates.len())
            .any(|index| motion.work.velocity[index * rows + rows - 1] < -IMPACT_SPEED);
        if hits || onset == Onset::Push {
            self.collide(motion, touching, &candidates, y, &mut settled)?;
        }
        self.rest(motion, touching, &candidates, t_s, y, &mut settled)?;
        Ok(settled)
    }

    /// The modes after the forces of the closed contacts have reached a limit.
    ///
    /// At that instant the modes before and those after it obey all laws alike, and what tells them
    /// apart is rounding. `ahead` is a time just after it, with the state that the modes before
    /// would lead to: there they break a law, and what the laws ask for instead is what happens.
    pub(super) fn switch(
        &mut self,
        motion: &mut Motion<'_>,
        touching: &Touching,
        ahead: (f64, &[f64]),
        y: &mut [f64],
    ) -> Result<Settled, Breakdown> {
        let mut settled = Settled::default();
        let candidates: Vec<usize> = motion.closed.iter().map(|c| c.contact).collect();
        let before = motion.closed.clone();
        motion.pose(ahead.0, ahead.1)?;
        self.contacts.clone_from(&motion.work.contacts);
        for _ in 0..HELD_ROUNDS {
            self.decide(motion, touching, &mut settled)?;
            motion.factor_mass(y)?;
            settled.impulses.extend(self.adopt(motion, &candidates, &before, &candidates, y));
            if !self.release_held(motion, &candidates, y) {
                break;
            }
            motion.closed.clone_from(&before);
            motion.pose(ahead.0, ahead.1)?;
        }
        let same = before.len() == motion.closed.len()
            && before.iter().zip(&motion.closed).all(|(a, b)| a.does_as(b));
        if same && self.let_go(motion, &before, ahead)? {
            self.decide(motion, touching, &mut settled)?;
            motion.factor_mass(y)?;
            settled.impulses.extend(self.adopt(motion, &candidates, &before, &candidates, y));
        }
        Ok(settled)
    }

    /// Poses the problem of the modes before once more, without the contact that pulls most in
    /// them: what the laws see nothing to change in has let go of it. False if none pulls.
    fn let_go(
        &mut self,
        motion: &mut Motion<'_>,
        before: &[Closed],
        ahead: (f64, &[f64]),
    ) -> Result<bool, Breakdown> {
        motion.closed.clear();
        motion.closed.extend_from_slice(before);
        motion.constrained_motion(ahead.0, ahead.1)?;
        let rows = motion.ground.rows();
        let normal = |index: usize| motion.work.force[index * rows + rows - 1];
        let worst = (0..before.len()).min_by(|a, b| normal(*a).total_cmp(&normal(*b)));
        let Some(worst) = worst.filter(|index| normal(*index) < 0.0) else { return Ok(false) };
        self.contacts.clone_from(&motion.work.contacts);
        self.contacts[worst].released = true;
        Ok(true)
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
            tolerance: Tolerance { force: 1e-11, response: 1e-11, relative: 1e-10 },
        };
        self.impact.solve(&impact, Search::First, &mut self.solution).map(|_| ())
    }

    /// Decides which of the contacts carry force from now on, and takes out the rest of the rates
    /// that these forbid.
    ///
    /// What is left of infinitely many bounces is decided with the forces, as one problem: with the
    /// rates v of what does not part, after the shortest flight tau that counts,
    ///
    /// > 0 <= f_n  _|_  v_n / tau + w_n >= 0,  w = G f + b.
    ///
    /// A contact rests if others' forces and its own weight bring it back within tau, in which a
    /// fall from the largest acceleration of all gains `rest_speed`. One near to the line about
    /// which its body turns away is slow, but does not come back, and stays open.
    fn rest(
        &mut self,
        motion: &mut Motion<'_>,
        touching: &Touching,
        candidates: &[usize],
        t_s: f64,
        y: &mut [f64],
        settled: &mut Settled,
    ) -> Result<(), Breakdown> {
        let rows = motion.ground.rows();
        motion.project(y, candidates);
        let normal = |index: usize| motion.work.velocity[index * rows + rows - 1];
        // without restitution what parts by rounding does not part
        let least = if touching.restitution > 0.0 { 0.0 } else { IMPACT_SPEED };
        let rest_speed = touching.rest_speed.max(least);
        let slow = (0..candidates.len()).filter(|index| normal(*index) <= rest_speed);
        let (slow, parting): (Vec<usize>, Vec<f64>) =
            slow.map(|index| (candidates[index], normal(index))).unzip();
        if slow.is_empty() {
            motion.closed.clear();
            return Ok(());
        }
        motion.project(y, &slow);
        self.describe(motion, touching, &slow, settled.fell_back);
        let before = y.to_vec();
        let mut carries = vec![true; slow.len()];
        let mut stilled = Vec::new();
        for _ in 0..HELD_ROUNDS {
            let at_rest = self.at_rest(motion, &slow, &carries, &before);
            motion.free_motion(t_s, &at_rest)?;
            motion.project(&at_rest, &slow);
            motion.free_response(&at_rest, &slow);
            let normals = || (0..slow.len()).map(|index| index * rows + rows - 1);
            let fall = normals().map(|row| -motion.work.free[row]).fold(0.0, f64::max);
            for (row, speed) in normals().zip(&parting) {
                motion.work.free[row] += speed * fall / touching.rest_speed.max(IMPACT_SPEED);
            }
            self.decide(motion, touching, settled)?;
            y.copy_from_slice(&before);
            stilled = self.adopt(motion, &slow, &[], candidates, y);
            let held = self.release_held(motion, &slow, y);
            let decided: Vec<bool> = self.solution.modes.iter().map(|m| m.is_closed()).collect();
            if !held && decided == carries {
                break;
            }
            carries = decided;
        }
        settled.impulses.extend(stilled);
        Ok(())
    }

    /// The state without the rates that those contacts still have that carry force: what is left
    /// of infinitely many bounces would ask for accelerations, towards the axis that they turn
    /// about, which points of one body at rest cannot have.
    fn at_rest(
        &self,
        motion: &mut Motion<'_>,
        contacts: &[usize],
        carries: &[bool],
        y: &[f64],
    ) -> Vec<f64> {
        motion.project(y, contacts);
        let rows = motion.ground.rows();
        let mut held = Vec::new();
        for (index, contact) in self.contacts.iter().enumerate().filter(|(i, _)| carries[*i]) {
            if contact.slipping.is_none() && contact.friction != Friction::Coulomb(0.0) {
                held.extend(index * rows..index * rows + rows - 1);
            }
            held.push(index * rows + rows - 1);
        }
        let mut at_rest = y.to_vec();
        let _ = motion.still(&held, &[], &mut at_rest);
        at_rest
    }

    /// What slid, until the rates of other points of its foot were taken out, is at rest with them:
    /// lets it be decided as such. Says if there was any.
    fn release_held(&mut self, motion: &mut Motion<'_>, candidates: &[usize], y: &[f64]) -> bool {
        let rows = motion.ground.rows();
        if rows < 3 {
            return false;
        }
        let rests_below = SLIP_SPEED.max(1.001 * motion.holding.slips.rests_below());
        motion.project(y, candidates);
        let mut any = false;
        for (index, contact) in self.contacts.iter_mut().enumerate() {
            let sliding = &motion.work.velocity[index * rows..index * rows + 2];
            let held = sliding[0].hypot(sliding[1]) <= rests_below;
            if held && self.solution.modes[index].is_closed() && contact.slipping.is_some() {
                contact.slipping = None;
                any = true;
            }
        }
        any
    }

    /// The contacts of a problem on accelerations: those that slide have their direction.
    fn describe(
        &mut self,
        motion: &Motion<'_>,
        touching: &Touching,
        candidates: &[usize],
        fell_back: bool,
    ) {
        let (rows, work, slips) = (motion.ground.rows(), &motion.work, motion.holding.slips);
        self.contacts.clear();
        for (index, contact) in candidates.iter().enumerate() {
            let before = motion.closed.iter().find(|closed| closed.contact == *contact);
            let sliding = &work.velocity[index * rows..index * rows + rows - 1];
            let speed = sliding.iter().map(|v| v * v).sum::<f64>().sqrt();
            let (slow, least) = match rows {
                2 => (speed < touching.rest_speed, SLIP_SPEED),
                _ => (!slips.is_left_by(sliding), SLIP_SPEED.max(1.001 * slips.rests_below())),
            };
            // what slid until now and is about to turn round has come to rest
            let turns = |before: &Closed| {
                matches!(before.mode, Mode::Slip(_))
                    && slips.slip_left(sliding, before) <= SLIP_SPEED
            };
            let slides = speed > least && !(slow && before.is_some_and(turns));
            let mut law = motion.friction[*contact];
            if let (true, Friction::NoSlip) = (slides, law) {
                // the law under which it began to slide holds until it rests
                let taken = before.map(|before| before.law).filter(|law| *law != Friction::NoSlip);
                let fallback = touching.fallback_friction.filter(|_| fell_back);
                law = taken.or(fallback.map(Friction::Coulomb)).unwrap_or(law);
            }
            let mut described = Contact::resting(law);
            if slides && matches!(law, Friction::Coulomb(mu) if mu > 0.0) {
                let direction = [sliding[0] / speed, sliding.get(1).map_or(0.0, |v| v / speed)];
                described.slipping = Some(match before.map(|before| before.mode) {
                    Some(Mode::Slip(last)) if rows == 3 => slips.direction(sliding, last),
                    _ => direction,
                });
            }
            self.contacts.push(described);
        }
    }

    /// Decides the modes of `contacts`; where no slip has no answer, by the fallback law.
    fn decide(
        &mut self,
        motion: &mut Motion<'_>,
        touching: &Touching,
        settled: &mut Settled,
    ) -> Result<(), Breakdown> {
        let mut outcome = self.attempt(motion);
        let fallback = touching.fallback_friction.map(Friction::Coulomb);
        let holds_fast = |contact: &Contact| contact.friction == Friction::NoSlip;
        if let (Err(ContactFailure::NoSolution), Some(law)) = (outcome, fallback)
            && self.contacts.iter().any(holds_fast)
        {
            for contact in self.contacts.iter_mut().filter(|contact| holds_fast(contact)) {
                contact.friction = law;
            }
            settled.fell_back = true;
            outcome = self.attempt(motion);
        }
        let slipping = self.contacts.iter().any(|contact| contact.slipping.is_some());
        outcome.map_err(|failure| match failure {
            ContactFailure::NoSolution if slipping => Breakdown::Painleve,
            ContactFailure::NotFinite => Breakdown::NotFinite,
            failure => Breakdown::Contact(failure),
        })
    }

    fn attempt(&mut self, motion: &mut Motion<'_>) -> Result<(), ContactFailure> {
        let problem = ContactProblem {
            space: motion.ground.space,
            contacts: &self.contacts,
            delassus: motion.delassus.matrix(),
            free: &motion.work.free,
            tolerance: motion.holding.tolerance,
        };
        motion.solver.decide(&problem, Search::First, &mut self.solution)
    }

    /// Takes the decided modes of contacts over, and takes out what is left of the rates that they
    /// forbid, so that none of those that touch sinks. What slips on, of those closed `before`,
    /// runs if it did then.
    ///
    /// Contacts that stick do so where they are now: places from different events would contradict
    /// each other by what they have drifted, for points of one rigid foot.
    fn adopt(
        &mut self,
        motion: &mut Motion<'_>,
        decided: &[usize],
        before: &[Closed],
        touching: &[usize],
        y: &mut [f64],
    ) -> Vec<(usize, Vec<f64>)> {
        motion.project(y, touching);
        let rows = motion.ground.rows();
        let (mut held, mut open) = (Vec::new(), Vec::new());
        motion.closed.clear();
        for (place, contact) in touching.iter().enumerate() {
            let normal = place * rows + rows - 1;
            let index = decided.iter().position(|other| other == contact);
            let closed = index.filter(|index| self.solution.modes[*index].is_closed());
            let Some(index) = closed else {
                open.push(normal);
                continue;
            };
            held.push(normal);
            let mode = self.solution.modes[index];
            // slipping that begins in space does so from rest
            let rests = rows == 3 && self.contacts[index].slipping.is_none();
            if mode == Mode::Stick || (rests && mode != Mode::Slip([0.0; 2])) {
                held.extend(normal + 1 - rows..normal);
            }
            let mut along = Vec::with_capacity(rows);
            motion.ground.append(&motion.work.positions[3 * contact..3 * contact + 3], &mut along);
            let anchor = [along[0], if rows == 3 { along[1] } else { 0.0 }];
            let law = self.contacts[index].friction;
            let ran = |closed: &Closed| closed.contact != *contact || closed.runs;
            let runs = self.contacts[index].slipping.is_some() && before.iter().all(ran);
            motion.closed.push(Closed { contact: *contact, mode, law, anchor, runs });
        }
        let impulses = motion.still(&held, &open, y).unwrap_or_default();
        let blocks = impulses.chunks_exact(rows).map(<[f64]>::to_vec);
        touching.iter().copied().zip(blocks).collect()
    }
}
