//! Decides what every contact does: opens, sticks or slips.
//!
//! All combinations of modes are tried, those with the fewest open contacts first: exactly, so that
//! "no solution" (Painleve's inconsistency, or a no-slip law that nothing satisfies) and "several
//! solutions" are answers and not failures of an iteration. In space a contact that may begin to
//! slip has a direction to be found: a pyramid of friction gives a first guess, the linear solution
//! for given directions the next, until the directions stand still.

use super::gauss_seidel::{self, SweepLimits};
use super::lemke::LcpOutcome;
use super::modes::ModeSolver;
use super::pyramid::Pyramid;
use super::{
    Contact, ContactFailure, ContactProblem, ContactSolution, Friction, Mode, Space, length,
};

/// How many combinations of modes are tried at most.
const COMBINATIONS: usize = 1 << 16;
/// Facets of the pyramid that gives the first directions of slipping.
const FACETS: usize = 16;

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
    ) -> Result<f64, ContactFailure> {
        self.modes.margin(problem, modes)
    }

    /// Finds modes, forces and responses that obey all laws.
    pub fn decide(
        &mut self,
        problem: &ContactProblem<'_>,
        search: Search,
        solution: &mut ContactSolution,
    ) -> Result<(), ContactFailure> {
        problem.checked()?;
        let combinations = self.list_options(problem);
        let enumerable = combinations.is_some_and(|count| count <= COMBINATIONS);
        let found = enumerable && self.enumerate(problem, search, solution)?;
        if found {
            return Ok(());
        }
        let begins_to_slip = |contact: &Contact| {
            !contact.has_slip_law() && !contact.released && contact.friction != Friction::NoSlip
        };
        let coulomb = problem.contacts.iter().all(|contact| contact.friction != Friction::NoSlip);
        let open_question = problem.space == Space::Spatial || !enumerable;
        if open_question && coulomb && problem.contacts.iter().any(begins_to_slip) {
            return self.find_directions(problem, solution);
        }
        if enumerable {
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

    /// Tries all combinations, by number of open contacts; says if a solution was found.
    fn enumerate(
        &mut self,
        problem: &ContactProblem<'_>,
        search: Search,
        solution: &mut ContactSolution,
    ) -> Result<bool, ContactFailure> {
        let count = problem.contacts.len();
        let mut found = false;
        for open in 0..=count {
            self.choice.clear();
            self.choice.resize(count, 0);
            loop {
                let is_open = |(options, chosen): (&Vec<Mode>, &usize)| chosen + 1 == options.len();
                let opened = self.options.iter().zip(&self.choice).filter(|pair| is_open(*pair));
                if opened.count() == open && self.try_choice(problem) {
                    if !found {
                        found = true;
                        solution.clone_from(&self.trial);
                    } else if self.moves_otherwise(problem, solution) {
                        return Err(ContactFailure::SeveralSolutions);
                    }
                    if search == Search::First {
                        return Ok(true);
                    }
                }
                if !self.advance() {
                    break;
                }
            }
        }
        Ok(found)
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

    fn try_choice(&mut self, problem: &ContactProblem<'_>) -> bool {
        let chosen = self.options.iter().zip(&self.choice).map(|(options, &index)| options[index]);
        self.trial.modes.clear();
        self.trial.modes.extend(chosen);
        self.try_modes(problem)
    }

    /// Solves for the modes of the trial; says if the result obeys the laws.
    fn try_modes(&mut self, problem: &ContactProblem<'_>) -> bool {
        let trial = &mut self.trial;
        for vector in [&mut trial.force, &mut trial.response] {
            vector.clear();
            vector.resize(problem.rows(), 0.0);
        }
        match self.modes.forces(problem, &trial.modes, &mut trial.force) {
            Ok(redundancy) => {
                trial.redundancy = redundancy;
                problem.respond(&trial.force, &mut trial.response);
                problem.is_admissible(&trial.modes, &trial.force, &trial.response)
            }
            Err(_) => false,
        }
    }

    fn moves_otherwise(&self, problem: &ContactProblem<'_>, solution: &ContactSolution) -> bool {
        let different = |(a, b): (&f64, &f64)| (a - b).abs() > 1e3 * problem.response_zero();
        solution.response.iter().zip(&self.trial.response).any(different)
    }

    /// Slipping in space: directions by iteration, from a pyramid, or from sweeps over the cones.
    fn find_directions(
        &mut self,
        problem: &ContactProblem<'_>,
        solution: &mut ContactSolution,
    ) -> Result<(), ContactFailure> {
        self.trial.force.clear();
        self.trial.force.resize(problem.rows(), 0.0);
        let report = self.pyramid.solve(problem, FACETS, &mut self.trial.force);
        let guessed = report.outcome == LcpOutcome::Solved && self.follow_directions(problem);
        if !guessed {
            let slipping = problem.contacts.iter().any(|contact| contact.slipping.is_some());
            if slipping {
                return Err(ContactFailure::NoSolution);
            }
            self.trial.force.clear();
            self.trial.force.resize(problem.rows(), 0.0);
            let limits = SweepLimits { sweeps: 20_000, response: 1e-3 * problem.response_zero() };
            let report = gauss_seidel::solve(problem, limits, &mut self.trial.force);
            self.read_modes(problem);
            let trial = &self.trial;
            if !report.converged
                || !problem.is_admissible(&trial.modes, &trial.force, &trial.response)
            {
                return Err(ContactFailure::NoSolution);
            }
        }
        solution.clone_from(&self.trial);
        Ok(())
    }

    /// Reads modes off the forces of the trial and their responses.
    fn read_modes(&mut self, problem: &ContactProblem<'_>) {
        self.trial.response.resize(problem.rows(), 0.0);
        problem.respond(&self.trial.force, &mut self.trial.response);
        self.trial.modes.clear();
        let largest = self.trial.force.iter().fold(0.0_f64, |sum, f| sum.max(f.abs()));
        for (index, contact) in problem.contacts.iter().enumerate() {
            let tangential = &self.trial.response[problem.block(index)][..problem.space.tangents()];
            let speed = length(tangential);
            let normal = self.trial.force[problem.normal(index)];
            self.trial.modes.push(if normal <= problem.force_zero(largest) {
                Mode::Open
            } else if contact.has_slip_law() {
                Mode::Slip(contact.slipping.unwrap_or([0.0; 2]))
            } else if speed <= 1e-6 * (problem.response_scale() + problem.tolerance.response) {
                Mode::Stick
            } else {
                Mode::Slip(unit(tangential, speed))
            });
        }
    }

    /// Lets the directions follow the responses until they stand still; says if they do.
    fn follow_directions(&mut self, problem: &ContactProblem<'_>) -> bool {
        self.read_modes(problem);
        for _ in 0..100 {
            let admissible = self.try_modes(problem);
            let mut turned = 0.0_f64;
            for (index, contact) in problem.contacts.iter().enumerate() {
                let tangential =
                    &self.trial.response[problem.block(index)][..problem.space.tangents()];
                let speed = length(tangential);
                if let Mode::Slip(direction) = &mut self.trial.modes[index]
                    && !contact.has_slip_law()
                    && speed > 0.0
                {
                    let new = unit(tangential, speed);
                    turned = turned.max((new[0] - direction[0]).hypot(new[1] - direction[1]));
                    // Friction overshoots: what slips to one side is braked to the other. The mean
                    // of both directions damps that.
                    let mean = [0, 1].map(|axis| 0.5 * (new[axis] + direction[axis]));
                    let size = length(&mean);
                    *direction = if size > 0.5 { unit(&mean, size) } else { new };
                }
            }
            if turned <= 1e-14 {
                return admissible;
            }
            if admissible && turned <= 1e-12 {
                return true;
            }
        }
        false
    }
}

fn unit(vector: &[f64], length: f64) -> [f64; 2] {
    [vector[0] / length, vector.get(1).map_or(0.0, |entry| entry / length)]
}
