//! The phases of a step as data: which contacts are closed in each, and what lies between two.

use super::legs::Role;
use crate::error::NoStep;

/// A part of a step in which the closed contacts stay.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    /// What reports call it.
    pub name: String,
    /// The closed contacts, each once, in the order of [`Role`].
    pub closed: Vec<Role>,
    /// Share of the step's duration in the guess, and of the intervals.
    pub share: f64,
}

/// One of the two directions that a contact is held in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Along the ground.
    Along,
    /// Up.
    Up,
}

impl Axis {
    /// Number of the world's coordinate.
    pub fn index(self) -> usize {
        match self {
            Self::Along => 0,
            Self::Up => 2,
        }
    }
}

impl Phase {
    /// A phase of this name with these closed contacts and this share of the step.
    pub fn new(name: &str, closed: &[Role], share: f64) -> Self {
        let mut closed = closed.to_vec();
        closed.sort_unstable();
        closed.dedup();
        Self { name: name.to_owned(), closed, share }
    }

    /// Independent conditions on the closed contacts: all that hold a foot, each once. A flat foot
    /// is held along the ground at one point alone.
    pub fn held(&self) -> Vec<(Role, Axis)> {
        let mut rows = Vec::new();
        for role in &self.closed {
            let other = self.closed.iter().find(|other| other.is_stance() == role.is_stance());
            if other == Some(role) {
                rows.push((*role, Axis::Along));
            }
            rows.push((*role, Axis::Up));
        }
        rows
    }

    /// Whether a contact is closed.
    pub fn holds(&self, role: Role) -> bool {
        self.closed.contains(&role)
    }

    /// Whether a foot is in the air.
    pub fn is_in_flight(&self, stance: bool) -> bool {
        self.closed.iter().all(|role| role.is_stance() != stance)
    }
}

/// What lies between two phases that follow each other; at the end of the step the legs swap.
#[derive(Clone, Debug, PartialEq)]
pub struct Transition {
    /// Phase before.
    pub from: usize,
    /// Phase after; roles below are those in it.
    pub to: usize,
    /// Whether the legs swap.
    pub swaps: bool,
    /// Contacts that close: with an impact.
    pub closing: Vec<Role>,
    /// Contacts that open.
    pub opening: Vec<Role>,
}

impl Transition {
    /// Whether velocities jump.
    pub fn is_impact(&self) -> bool {
        !self.closing.is_empty()
    }
}

/// What lies between phases, in the order of the phases after; the first is the end of the step.
pub fn transitions(phases: &[Phase]) -> Vec<Transition> {
    let between = |to: usize| {
        let swaps = to == 0;
        let from = if swaps { phases.len() - 1 } else { to - 1 };
        let before = phases[from].closed.iter();
        let before: Vec<Role> =
            before.map(|role| if swaps { role.swapped() } else { *role }).collect();
        let after = &phases[to].closed;
        Transition {
            from,
            to,
            swaps,
            closing: after.iter().filter(|role| !before.contains(role)).copied().collect(),
            opening: before.iter().filter(|role| !after.contains(role)).copied().collect(),
        }
    };
    (0..phases.len()).map(between).collect()
}

/// Checks that phases make a step.
pub(crate) fn check(phases: &[Phase]) -> Result<(), NoStep> {
    if phases.is_empty() {
        return Err(NoStep::Empty);
    }
    if let Some(phase) = phases.iter().position(|phase| phase.closed.is_empty()) {
        return Err(NoStep::Flight(phase));
    }
    let [end, rest @ ..] = &transitions(phases)[..] else { return Err(NoStep::Empty) };
    let lands = end.closing.iter().any(|role| role.is_stance())
        || rest.iter().any(|t| t.closing.iter().any(|role| !role.is_stance()));
    if !lands {
        return Err(NoStep::NoTouchdown);
    }
    match flat_phase(phases) {
        Some(_) => Ok(()),
        None => Err(NoStep::NeverFlat),
    }
}

/// The phase in which the stance foot alone stands flat.
pub(super) fn flat_phase(phases: &[Phase]) -> Option<usize> {
    phases.iter().position(|phase| phase.closed == [Role::StanceHeel, Role::StanceToe])
}

/// Aspects of a human gait (thesis 4.4.3), each of which may be left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Aspects {
    /// The swing leg may move back before it strikes the ground.
    pub retraction: bool,
    /// The heel strikes first, with the toe up; else the foot lands flat.
    pub heel_strike: bool,
    /// The stance foot turns about its toe before the other foot strikes, and pushes while both
    /// are on the ground.
    pub push_off: bool,
    /// The torso may lean; else it stays upright.
    pub lean: bool,
    /// The stance knee may bend; else it stays as straight as in the guess.
    pub knee_flexion: bool,
}

impl Default for Aspects {
    fn default() -> Self {
        Self { retraction: true, heel_strike: true, push_off: true, lean: true, knee_flexion: true }
    }
}

/// The phases of a step with these aspects.
pub fn phases_of(aspects: Aspects) -> Vec<Phase> {
    use Role::{StanceHeel, StanceToe, SwingToe};
    let mut phases = Vec::new();
    match (aspects.heel_strike, aspects.push_off) {
        (true, true) => {
            phases.push(Phase::new("heel and rear toe", &[StanceHeel, SwingToe], 0.1));
            phases.push(Phase::new("flat and rear toe", &[StanceHeel, StanceToe, SwingToe], 0.1));
        }
        (true, false) => phases.push(Phase::new("heel", &[StanceHeel], 0.1)),
        (false, true) => {
            phases.push(Phase::new("flat and rear toe", &[StanceHeel, StanceToe, SwingToe], 0.15));
        }
        (false, false) => {}
    }
    phases.push(Phase::new("flat", &[StanceHeel, StanceToe], 0.55));
    if aspects.push_off {
        phases.push(Phase::new("toe", &[StanceToe], 0.25));
    }
    phases
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_foot_is_held_by_three_conditions() {
        let [heel, toe] = [Role::StanceHeel, Role::StanceToe];
        let flat = Phase::new("flat", &[toe, heel], 1.0);
        assert_eq!(flat.held(), [(heel, Axis::Along), (heel, Axis::Up), (toe, Axis::Up)]);
    }

    #[test]
    fn every_choice_of_aspects_makes_a_step() {
        for choice in 0..4 {
            let aspects = Aspects {
                heel_strike: choice & 1 == 1,
                push_off: choice & 2 == 2,
                ..Aspects::default()
            };
            let phases = phases_of(aspects);
            assert_eq!(check(&phases), Ok(()));
            let end = &transitions(&phases)[0];
            assert!(end.swaps && end.closing.contains(&Role::StanceHeel));
            assert_eq!(end.closing.contains(&Role::StanceToe), !aspects.heel_strike);
            assert_eq!(end.opening.contains(&Role::SwingToe), !aspects.push_off);
        }
    }

    #[test]
    fn lists_that_are_no_step_are_refused() {
        assert_eq!(check(&[]), Err(NoStep::Empty));
        let flat = Phase::new("flat", &[Role::StanceHeel, Role::StanceToe], 1.0);
        assert_eq!(check(std::slice::from_ref(&flat)), Ok(()));
        assert_eq!(check(&[flat, Phase::new("none", &[], 1.0)]), Err(NoStep::Flight(1)));
        let toe = Phase::new("toe", &[Role::StanceToe], 1.0);
        assert_eq!(check(&[toe]), Err(NoStep::NeverFlat));
    }
}
