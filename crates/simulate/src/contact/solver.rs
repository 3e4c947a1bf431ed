//! Decides what every contact does: opens, sticks or slips.
//!
//! All combinations of modes are tried, those with the fewest open contacts first: exactly, so that
//! "no solution" (Painleve's inconsistency, or a no-slip law that nothing satisfies) and "several
//! solutions" are answers and not failures of an iteration.
//!
//! In space a contact that may begin to slip has a direction to be found. There Newton's method on
//! the cones ([`newton`]) gives forces, of which modes are read: those that all hold are tried
//! first, then the method starts from their forces, from those of a pyramid, and from sweeps over
//! the contacts. What still breaks a law in these modes is changed until nothing does: pushed out
//! of its cone, a contact slips against its force; pulled, it opens; sunk, it closes; and the
//! direction of what slips follows its motion.

use super::gauss_seidel::{self, SweepLimits};
use super::lemke::LcpOutcome;
use super::modes::ModeSolver;
use super::pyramid::Pyramid;
use super::sharing::Sharing;
use super::{
    Contact, ContactFailure, ContactProblem, ContactSolution, Friction, Mode, Space, closed_mode,
    length,
    newton::{self, Found},
};

/// How many combinations of modes are tried at most.
const COMBINATIONS: usize = 1 << 16;
/// Facets of the pyramid that gives the first directions of slipping.
const FACETS: usize = 16;

/// Squares of forces that differ by less than this part are the same.
const SAME: f64 = 1e-9;

/// How often modes are changed at most, from one guess.
const ROUNDS: usize = 120;

/// How far the modes are searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Search {
    /// The first solution is taken: of those with the fewest open contacts.
    First,
    /// All combinations are tried, and solutions with different motions are reported. Slipping
    /// that only begins in space is not enumerated.
    All,
}

/// Decides modes; memory that grows to the largest problem and stays.
#[derive(Clone, Debug, Default)]
pub struct ContactSolver {
    modes: ModeSolver,
    pyramid: Pyramid,
    options: Vec<Vec<Mode>>,
    choice: Vec<usize>,
    trial: ContactSolution,
    /// What nearly obeys the laws, if nothing does, and how nearly.
    nearest: Option<(f64, ContactSolution)>,
}

impl ContactSolver {
    /// No memory yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Forces of given modes; see [`ModeSolver::forces`].
    pub fn forces(
        &mut self,
        problem: &ContactProblem<'_>,
        modes: &[Mode],
        force: &mut [f64],
    ) -> Result<usize, ContactFailure> {
        self.modes.forces(problem, modes, force)
    }

    /// How far given modes are from violating a law; see [`ModeSolver::margin`].
    pub fn margin(
        &mut self,
        problem: &ContactProblem<'_>,
        modes: &[Mode],
    ) -> Result<(f64, f64), ContactFailure> {
        self.modes.margin(problem, modes)
    }

    /// Whether forces keep given modes, but not those of equally compliant points.
    pub(crate) fn keeps_least_alone(
        &mut self,
        problem: &ContactProblem<'_>,
        modes: &[Mode],
    ) -> bool {
        self.modes.keeps_least_alone(problem, modes)
    }

    /// Shares forces of redundant contacts in given modes.
    pub(crate) fn sharing(&mut self) -> &mut Sharing {
        self.modes.sharing()
    }

    /// Finds modes, forces and responses that obey all laws.
    pub fn decide(
        &mut self,
        problem: &ContactProblem<'_>,
        search: Search,
        solution: &mut ContactSolution,
    ) -> Result<(), ContactFailure> {
        problem.checked()?;
        self.nearest = None;
        let begins_to_slip = |contact: &Contact| {
            !contact.has_slip_law() && !contact.released && contact.friction != Friction::NoSlip
        };
        let coulomb = problem.contacts.iter().all(|contact| contact.friction != Friction::NoSlip);
        let combinations = self.list_options(problem);
        let enumerable = combinations.is_some_and(|count| count <= COMBINATIONS);
        let open_question = problem.space == Space::Spatial || !enumerable;
        let iterates = open_question && coulomb && problem.contacts.iter().any(begins_to_slip);
        if iterates && search == Search::First && self.iterate(problem) {
            self.take_back(problem);
            solution.clone_from(&self.trial);
            return Ok(());
        }
        if enumerable && self.enumerate(problem, search, solution)? {
            return Ok(());
        }
        if iterates && search == Search::All && self.iterate(problem) {
            solution.clone_from(&self.trial);
            return Ok(());
        }
        if let Some((_, nearest)) = self.nearest.take() {
            *solution = nearest;
            return Ok(());
        }
        if enumerable || iterates {
            Err(ContactFailure::NoSolution)
        } else {
            Err(ContactFailure::TooManyModes { contacts: problem.contacts.len() })
        }
    }

    /// The modes that each contact may have, and the number of their combinations.
    fn list_options(&mut self, problem: &ContactProblem<'_>) -> Option<usize> {
        self.options.resize(problem.contacts.len(), Vec::new());
        let mut combinations = Some(1_usize);
        for (options, contact) in self.options.iter_mut().zip(problem.contacts) {
            options.clear();
            match (contact.friction, contact.slipping) {
                _ if contact.released => {}
                (Friction::NoSlip, _) => options.push(Mode::Stick),
                (Friction::Coulomb(0.0), _) => options.push(Mode::Slip([0.0; 2])),
                (Friction::Coulomb(_), Some(direction)) => options.push(Mode::Slip(direction)),
                (Friction::Coulomb(_), None) => {
                    options.push(Mode::Stick);
                    if problem.space == Space::Planar {
                        options.extend([Mode::Slip([1.0, 0.0]), Mode::Slip([-1.0, 0.0])]);
                    }
                }
            }
            options.push(Mode::Open);
            combinations = combinations.and_then(|count| count.checked_mul(options.len()));
        }
        combinations
    }

    /// Tries all combinations, by number of open contacts; says if a solution was found: of those
    /// with as few open ones the one with the least forces, whatever the contacts' order.
    fn enumerate(
        &mut self,
        problem: &ContactProblem<'_>,
        search: Search,
        solution: &mut ContactSolution,
    ) -> Result<bool, ContactFailure> {
        let count = problem.contacts.len();
        let mut least = f64::INFINITY;
        for open in 0..=count {
            self.choice.clear();
            self.choice.resize(count, 0);
            loop {
                let is_open = |(options, chosen): (&Vec<Mode>, &usize)| chosen + 1 == options.len();
                let opened = self.options.iter().zip(&self.choice).filter(|pair| is_open(*pair));
                if opened.count() == open && self.try_choice(problem) == Some(true) {
                    let found = least < f64::INFINITY;
                    if found && search == Search::All && self.moves_otherwise(problem, solution) {
                        return Err(ContactFailure::SeveralSolutions);
                    }
                    let size = self.trial.force.iter().map(|force| force * force).sum::<f64>();
                    if !found || (search == Search::First && size < (1.0 - SAME) * least) {
                        least = size;
                        solution.clone_from(&self.trial);
                    }
                }
                if !self.advance() {
                    break;
                }
            }
            if least < f64::INFINITY && search == Search::First {
                return Ok(true);
            }
        }
        Ok(least < f64::INFINITY)
    }

    /// The next combination; says if there is one.
    fn advance(&mut self) -> bool {
        for (chosen, options) in self.choice.iter_mut().zip(&self.options).rev() {
            *chosen += 1;
            if *chosen < options.len() {
                return true;
            }
            *chosen = 0;
        }
        false
    }

    fn try_choice(&mut self, problem: &ContactProblem<'_>) -> Option<bool> {
        let chosen = self.options.iter().zip(&self.choice).map(|(options, &index)| options[index]);
        self.trial.modes.clear();
        self.trial.modes.extend(chosen);
        self.try_modes(problem)
    }

    /// Solves for the modes of the trial; says if the result obeys the laws. None: no forces
    /// whatever keep these modes.
    fn try_modes(&mut self, problem: &ContactProblem<'_>) -> Option<bool> {
        let trial = &mut self.trial;
        for vector in [&mut trial.force, &mut trial.response] {
            vector.clear();
            vector.resize(problem.rows(), 0.0);
        }
        trial.redundancy = self.modes.forces(problem, &trial.modes, &mut trial.force).ok()?;
        problem.respond(&trial.force, &mut trial.response);
        Some(problem.is_admissible(&trial.modes, &trial.force, &trial.response))
    }

    fn moves_otherwise(&self, problem: &ContactProblem<'_>, solution: &ContactSolution) -> bool {
        let different = |(a, b): (&f64, &f64)| (a - b).abs() > 1e3 * problem.response_zero();
        solution.response.iter().zip(&self.trial.response).any(different)
    }

    /// Solves for forces and reads their modes, from one start after the other, and changes the
    /// modes until they obey all laws; the trial has what was found.
    fn iterate(&mut self, problem: &ContactProblem<'_>) -> bool {
        self.trial.modes.clear();
        self.trial.modes.extend(problem.contacts.iter().map(closed_mode));
        if self.try_modes(problem) == Some(true) {
            return true;
        }
        if self.refine(problem) {
            return true;
        }
        self.trial.force.fill(0.0);
        let report = self.pyramid.solve(problem, FACETS, &mut self.trial.force);
        if report.outcome == LcpOutcome::Solved && self.refine(problem) {
            return true;
        }
        if problem.contacts.iter().any(|contact| contact.slipping.is_some()) {
            return false;
        }
        self.trial.force.fill(0.0);
        let limits = SweepLimits { sweeps: 20_000, response: 1e-3 * problem.response_zero() };
        gauss_seidel::solve(problem, limits, &mut self.trial.force);
        self.refine(problem)
    }

    /// Closes what the trial left open though it does not leave the ground, if lawful modes follow:
    /// points of a flat foot that pulled on the way may well carry load.
    fn take_back(&mut self, problem: &ContactProblem<'_>) {
        let found = self.trial.clone();
        let zero = problem.response_zero();
        let mut any = false;
        for (index, contact) in problem.contacts.iter().enumerate() {
            let touches = found.response[problem.normal(index)] <= zero && !contact.released;
            if found.modes[index] == Mode::Open && touches {
                let along = &found.response[problem.block(index)][..problem.space.tangents()];
                let (speed, sticks) = (length(along), closed_mode(contact));
                let slips = sticks == Mode::Stick && speed > zero;
                self.trial.modes[index] =
                    if slips { Mode::Slip(unit(along, speed)) } else { sticks };
                any = true;
            }
        }
        if any && !self.change_until_lawful(problem) {
            self.trial = found;
        }
    }

    /// From the forces of the trial to lawful modes; keeps what only nearly obeys the laws.
    fn refine(&mut self, problem: &ContactProblem<'_>) -> bool {
        let solved = newton::solve(problem, &mut self.trial.force);
        self.trial.redundancy = 0;
        problem.respond(&self.trial.force, &mut self.trial.response);
        newton::modes(problem, &self.trial.force, &self.trial.response, &mut self.trial.modes);
        let found = self.trial.clone();
        match solved {
            Found::Forces => {
                // at the edge of a case rounding reads a mode, of which the forces tell whether it
                // is right
                let lawful = self.try_modes(problem) == Some(true);
                self.trial.modes.clone_from(&found.modes);
                if lawful || !self.change_until_lawful(problem) {
                    self.trial = found;
                }
                return true;
            }
            Found::Nearly(way) => {
                if self.nearest.as_ref().is_none_or(|(least, _)| way < *least) {
                    self.nearest = Some((way, found));
                }
            }
            Found::Nothing => {}
        }
        self.change_until_lawful(problem)
    }

    /// Solves for the modes of the trial and changes those that break a law, all at once, until
    /// none does and directions of slipping come no nearer; says if that was reached.
    fn change_until_lawful(&mut self, problem: &ContactProblem<'_>) -> bool {
        let mut best: Option<(f64, ContactSolution)> = None;
        for round in 0..ROUNDS {
            let Some(admissible) = self.try_modes(problem) else { return false };
            let lawful = admissible.then(|| self.trial.clone());
            let turns = admissible || round >= ROUNDS / 2;
            let (changed, turned) = self.change(problem, turns);
            match (lawful, best.take()) {
                // steep friction may turn directions away from each other again
                (_, Some((before, kept))) if changed || !admissible || turned >= before => {
                    self.trial = kept;
                    return true;
                }
                (Some(kept), _) if !changed && turned <= 1e-13 => {
                    self.trial = kept;
                    return true;
                }
                (Some(kept), _) if !changed => best = Some((turned, kept)),
                _ if !changed && turned == 0.0 => return false,
                _ => {}
            }
        }
        false
    }

    /// Changes the modes that break a law, and turns directions of slipping; says if a mode was
    /// changed, and how far a direction was turned.
    ///
    /// `turns` if slipping only turns: what slips against its direction else holds. First contacts
    /// open and close; only among those that stay, friction is looked at: what pulls
    /// shifts the friction of all others.
    fn change(&mut self, problem: &ContactProblem<'_>, turns: bool) -> (bool, f64) {
        let tangents = problem.space.tangents();
        let largest = self.trial.force.iter().fold(0.0_f64, |sum, f| sum.max(f.abs()));
        let (no_force, no_response) = (problem.force_zero(largest), problem.response_zero());
        let mut changed = false;
        for (index, contact) in problem.contacts.iter().enumerate() {
            let (normal, mode) = (problem.normal(index), &mut self.trial.modes[index]);
            let new = match *mode {
                Mode::Open if !contact.released && self.trial.response[normal] < -no_response => {
                    closed_mode(contact)
                }
                Mode::Stick | Mode::Slip(_) if self.trial.force[normal] < -no_force => Mode::Open,
                _ => continue,
            };
            (*mode, changed) = (new, true);
        }
        if changed {
            return (true, 0.0);
        }
        let mut turned = 0.0_f64;
        for (index, contact) in problem.contacts.iter().enumerate() {
            let block = problem.block(index);
            let (f, w) = (&self.trial.force[block.clone()], &self.trial.response[block]);
            let (pushed, speed) = (length(&f[..tangents]), length(&w[..tangents]));
            let mode = &mut self.trial.modes[index];
            match (*mode, contact.friction) {
                (Mode::Stick, Friction::Coulomb(mu)) if pushed > mu * f[tangents] + no_force => {
                    let against = unit(&f[..tangents], pushed);
                    (*mode, changed) = (Mode::Slip(against.map(|entry| -entry)), true);
                }
                (Mode::Slip(direction), _) if !contact.has_slip_law() => {
                    let along: f64 = w[..tangents].iter().zip(direction).map(|(w, d)| w * d).sum();
                    // Friction that stops the motion or turns it round was too much: it holds.
                    if along < no_response && !turns {
                        (*mode, changed) = (Mode::Stick, true);
                    } else if speed > 0.0 {
                        let towards = unit(&w[..tangents], speed);
                        let [x, y] = [0, 1].map(|axis| towards[axis] - direction[axis]);
                        turned = turned.max(x.hypot(y));
                        // Friction overshoots: what slips to one side is braked to the other. The
                        // mean of both directions damps that.
                        let mean = [0, 1].map(|axis| 0.5 * (towards[axis] + direction[axis]));
                        let size = length(&mean);
                        *mode = Mode::Slip(if size > 0.5 { unit(&mean, size) } else { towards });
                    }
                }
                _ => {}
            }
        }
        (changed, turned)
    }
}

fn unit(vector: &[f64], length: f64) -> [f64; 2] {
    [vector[0] / length, vector.get(1).map_or(0.0, |entry| entry / length)]
}
