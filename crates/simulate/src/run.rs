//! A run: smooth motion from event to event (thesis 2.3.4, figure 2.4a).

use super::audit::Audit;
use super::breakdown::Stop;
use super::contact::Tolerance;
use super::control::Control;
use super::drive::Drives;
use super::error::Error;
use super::integrate::Statistics;
use super::joint_record::JointRecord;
use super::laws::LawForces;
use super::log::Log;
use super::motion::{Holding, Motion, SlipMemory};
use super::runner::Runner;
use super::simulation::Simulation;
use super::start::{DEPTH_M, StartError, check, check_steps};
use super::state::{Parts, State};
use super::variation::{Variation, VariationError};
use denavit_plants::Plant;

/// What happened at an instant.
#[derive(Clone, Debug, PartialEq)]
pub enum EventKind {
    /// The start, with contacts already closed.
    Start,
    /// A contact point reached the ground.
    Touch(usize),
    /// Forces reached a limit: a contact opens, or begins to slip.
    Limit,
    /// A sole that slides on has no loads of equally compliant points any more: from here to the
    /// next event they are the least that keep it flat.
    LeastLoads,
    /// A contact stopped slipping.
    SlipEnds(usize),
    /// A guard of the plant fired.
    Jump(usize),
    /// An impulse from outside.
    Push,
    /// References were planned anew: torques jump, and contacts with them.
    Plan,
}

/// An event of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// When \[s\].
    pub t_s: f64,
    /// What.
    pub kind: EventKind,
    /// The contacts that are closed after it.
    pub closed: Vec<usize>,
    /// Impulse on each contact that was hit, world frame [N s].
    pub impulses: Vec<(usize, [f64; 3])>,
    /// Change of energy \[J\].
    pub energy_j: f64,
    /// Joint positions at it.
    pub q: Vec<f64>,
    /// Rates just before it.
    pub before: Vec<f64>,
    /// Rates just after it.
    pub after: Vec<f64>,
    /// Whether the fallback law of friction had to be used.
    pub fell_back: bool,
}

/// What a run did.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Why it ended.
    pub stop: Stop,
    /// The state at its end.
    pub end: State,
    /// The log.
    pub log: Log,
    /// The events.
    pub events: Vec<Event>,
    /// The audits.
    pub audit: Audit,
    /// What became of each joint of the plant.
    pub joints: Vec<JointRecord>,
    /// What it cost.
    pub statistics: Statistics,
    /// The contacts that are closed at its end.
    pub closed: Vec<usize>,
}

/// Contacts this near the ground are closed at the start \[m\].
const START_TOUCH_M: f64 = 1e-6;

/// Hears the share of a run's time that is simulated, after each step, from 0 to 1. Says whether to
/// go on; if not, the run ends there ([`Stop::Watcher`]).
pub type Told<'a> = dyn FnMut(f64) -> bool + 'a;

/// Runs a plant under control from a state; deterministic.
pub fn simulate(
    plant: &mut dyn Plant,
    control: &Control,
    initial: &State,
    simulation: &Simulation,
) -> Result<Run, Error> {
    simulate_believing(plant, None, control, initial, simulation)
}

/// As [`simulate`], heard by somebody.
///
/// # Errors
/// As of [`simulate`].
pub fn simulate_told(
    plant: &mut dyn Plant,
    control: &Control,
    initial: &State,
    simulation: &Simulation,
    told: &mut Told<'_>,
) -> Result<Run, Error> {
    let (motion, t_s, y) = prepare(plant, control, initial, simulation)?;
    Ok(Runner::begin(motion, simulation, t_s, y, None)?.told(told).go().0)
}

/// As [`simulate`], with a controller that compensates by a model of its own, `believed`, which has
/// the joints of the plant.
pub fn simulate_believing(
    plant: &mut dyn Plant,
    believed: Option<&mut (dyn Plant + 'static)>,
    control: &Control,
    initial: &State,
    simulation: &Simulation,
) -> Result<Run, Error> {
    let (mut motion, t_s, y) = prepare(plant, control, initial, simulation)?;
    motion.believed = believed;
    Ok(Runner::begin(motion, simulation, t_s, y, None)?.go().0)
}

/// As [`simulate`], and what small changes of the initial state become: each a direction in the
/// space of states (its time counts for nothing), which must obey the constraints of the contacts
/// that are closed in the beginning. Returns the directions at the end of the run.
///
/// # Errors
/// A run that does not begin, that stops before its end, or an event of which first-order changes
/// say nothing.
pub fn simulate_varied(
    plant: &mut dyn Plant,
    control: &Control,
    initial: &State,
    simulation: &Simulation,
    changes: &[State],
) -> Result<(Run, Vec<State>), Error> {
    let (motion, t_s, y) = prepare(plant, control, initial, simulation)?;
    let layout = motion.layout;
    let variation = Some(Variation::new(layout, changes));
    let runner = Runner::begin(motion, simulation, t_s, y, variation);
    let (run, variation) = runner?.go();
    let changes = variation.map_or_else(|| Ok(Vec::new()), |variation| variation.finish(layout))?;
    match run.stop {
        Stop::End => Ok((run, changes)),
        stop => Err(VariationError::Stopped(stop, run.end.t_s).into()),
    }
}

/// The motion of a run, with the time and the state that it begins with.
fn prepare<'a>(
    plant: &'a mut dyn Plant,
    control: &'a Control,
    initial: &State,
    simulation: &'a Simulation,
) -> Result<(Motion<'a>, f64, Vec<f64>), StartError> {
    plant.begin();
    let mut state = initial.clone();
    let mut drives = Drives::new(plant.model(), simulation.drives);
    drives.stiction_rate = simulation.stiction_rate;
    check(plant, control, &mut state, simulation, &drives)?;
    let (step_s, evaluations) = simulation.method.longest_step();
    check_steps(&state, simulation, "integrator", step_s, evaluations)?;
    if state.laws.len() != plant.law_states() {
        let mut laws = LawForces::new(plant.model(), &drives);
        let started = laws.start(plant, state.t_s, Parts::of(&state));
        state.laws = started;
    }
    let friction = vec![simulation.friction; plant.model().contacts.len()];
    let holding = Holding {
        drift_rate: simulation.drift_rate,
        tolerance: Tolerance { force: 1e-9, response: 1e-9, relative: 1e-10 },
        slips: SlipMemory::of(simulation.method),
    };
    let mut motion = Motion::new(plant, control, drives, friction, holding);
    motion.pushes = &simulation.pushes;
    let y = motion.layout.pack(&state);
    Ok((motion, state.t_s, y))
}

/// Sets down what starts nearly on the ground; returns what stands there.
pub(super) fn stand(motion: &mut Motion<'_>, y: &mut [f64]) -> Result<Vec<usize>, StartError> {
    motion.place(y);
    let points = 0..motion.friction.len();
    let touching: Vec<usize> = points.filter(|c| motion.gap(*c) < START_TOUCH_M).collect();
    for &contact in &touching {
        let depth = -motion.gap(contact);
        if depth > DEPTH_M {
            let name = motion.plant.model().contacts[contact].name.clone();
            return Err(StartError::Penetration(name, depth));
        }
    }
    // from here on what touches is held where it is
    motion.set_down(&touching, y).map_err(StartError::Breakdown)
}
