//! What a run must begin with.

use super::breakdown::Breakdown;
use super::control::Control;
use super::drive::Drives;
use super::ground::Ground;
use super::push::{Push, Shove};
use super::simulation::Simulation;
use super::state::State;
use denavit_plants::Plant;
use std::fmt;

/// Why a run does not begin.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum StartError {
    /// A vector has not one entry for each joint (or motor): name, entries needed and found.
    Length(&'static str, usize, usize),
    /// A number of the initial state or of the options is not finite, or not positive.
    Number(&'static str),
    /// A contact point starts below the ground: its name and depth \[m\].
    Penetration(String, f64),
    /// What the event-driven scheme alone can do.
    EventSchemeOnly(&'static str),
    /// What Moreau's scheme alone can do.
    MoreauOnly(&'static str),
    /// Steps as short as they are to be take more evaluations to the end than are allowed: the
    /// part of a scenario that says so, needed at least, allowed.
    Steps(&'static str, f64, usize),
    /// The equations of motion have no answer at the start.
    Breakdown(Breakdown),
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length(what, needed, found) => {
                write!(f, "{what}: {needed} values expected, {found} given")
            }
            Self::Number(what) => write!(f, "{what} is not a usable number"),
            Self::Penetration(contact, depth) => {
                write!(f, "`{contact}` starts {depth:.3e} m below the ground")
            }
            Self::EventSchemeOnly(what) => {
                write!(f, "{what}: only the event-driven scheme has them")
            }
            Self::MoreauOnly(what) => {
                write!(f, "{what}: Anitescu's scheme constrains gaps and has none")
            }
            Self::Steps(_, needed, allowed) => write!(
                f,
                "steps this short take {needed:.1e} evaluations to the end: {allowed} are allowed"
            ),
            Self::Breakdown(breakdown) => write!(f, "at the start: {breakdown}"),
        }
    }
}

/// Checks the numbers of a run and completes its initial state: motors with relaxed springs.
pub(super) fn check(
    plant: &mut dyn Plant,
    control: &Control,
    state: &mut State,
    simulation: &Simulation,
    drives: &Drives,
) -> Result<(), StartError> {
    let n = plant.model().joints.len();
    let lengths = [("q", state.q.len()), ("qd", state.qd.len()), ("control", control.joints.len())];
    for (what, found) in lengths {
        if found != n {
            return Err(StartError::Length(what, n, found));
        }
    }
    if state.motor.is_empty() {
        state.motor =
            (0..drives.elastic.len()).map(|i| drives.relaxed(plant.model(), i, &state.q)).collect();
    }
    if state.motor_rate.is_empty() {
        state.motor_rate = vec![0.0; state.motor.len()];
    }
    for (what, found) in [("motor", state.motor.len()), ("motor_rate", state.motor_rate.len())] {
        if found != drives.elastic.len() {
            return Err(StartError::Length(what, drives.elastic.len(), found));
        }
    }
    let all = [&state.q, &state.qd, &state.motor, &state.motor_rate];
    if !all.into_iter().flatten().all(|entry| entry.is_finite()) {
        return Err(StartError::Number("a position or velocity of the initial state"));
    }
    let roll = plant.model().singular_base_joint().map(|joint| state.q[joint]);
    if roll.is_some_and(|roll| quarter_turn_left(roll) <= 0.0) {
        return Err(StartError::Breakdown(Breakdown::SingularPose));
    }
    if !are_in_order(&simulation.pushes) {
        return Err(StartError::Number("a push, or the order of pushes,"));
    }
    let positive = |value: f64| value > 0.0 && value.is_finite();
    if !positive(simulation.log_period_s) {
        return Err(StartError::Number("the period of the log"));
    }
    if control.period_s.is_some_and(|period| !positive(period)) {
        return Err(StartError::Number("the period of the controller"));
    }
    if control.planning.as_ref().is_some_and(|planning| !positive(planning.period_s())) {
        return Err(StartError::Number("the period of the planner"));
    }
    if !(simulation.end_s >= state.t_s && simulation.end_s.is_finite()) {
        return Err(StartError::Number("the end of the run"));
    }
    Ok(())
}

/// Whether pushes are sound, and in the order of their times.
fn are_in_order(pushes: &[Push]) -> bool {
    let is_sound = |push: &Push| {
        let (strength, length_s) = match push.shove {
            Shove::Impulse(impulse) => (impulse, 0.0),
            Shove::Force(force, duration_s) => (force, duration_s),
        };
        let numbers = strength.into_iter().chain(push.point.position).chain([push.at_s]);
        numbers.chain([length_s]).all(f64::is_finite) && length_s >= 0.0
    };
    pushes.iter().all(is_sound) && pushes.is_sorted_by(|a, b| a.at_s <= b.at_s)
}

/// How far the angle between the first and the last axis of a floating base is from where these are
/// one: rates of both are 100 times those of the base there, and its coordinates count as singular.
pub(super) fn quarter_turn_left(roll: f64) -> f64 {
    roll.cos().abs() - 1e-2
}

/// Checks that a run can come to its end within the evaluations that are allowed, with steps of
/// this length at most, of so many evaluations each.
pub(super) fn check_steps(
    state: &State,
    simulation: &Simulation,
    part: &'static str,
    step_s: f64,
    evaluations: f64,
) -> Result<(), StartError> {
    let needed = (simulation.end_s - state.t_s) / step_s * evaluations;
    let allowed = simulation.max_evaluations;
    let ends = needed <= allowed as f64;
    if ends { Ok(()) } else { Err(StartError::Steps(part, needed, allowed)) }
}

/// A contact point this far below the ground at the start is a fault; less is rounding, and taken
/// out \[m\].
pub(super) const DEPTH_M: f64 = 1e-8;

/// Checks that no contact point starts below the ground.
pub(super) fn check_gaps(plant: &mut dyn Plant, q: &[f64]) -> Result<(), StartError> {
    let ground = Ground::new(plant.model());
    let mut positions = vec![0.0; 3 * plant.model().contacts.len()];
    plant.contact_positions(q, &mut positions);
    for (contact, position) in plant.model().contacts.iter().zip(positions.chunks_exact(3)) {
        let depth = -ground.gap(position);
        if depth > DEPTH_M {
            return Err(StartError::Penetration(contact.name.clone(), depth));
        }
    }
    Ok(())
}
