//! The least push that fells a walking robot, over the time in the step and the direction.

use super::outcome::Outcome;
use super::parallel::{Observer, Opener, each};
use denavit_plants::PointModel;
use denavit_simulate::scenario::Scenario;
use denavit_simulate::{Push, Shove, Simulation, State, simulate};

/// Which pushes are tried.
#[derive(Clone, Debug, PartialEq)]
pub struct PushOptions {
    /// Where it is pushed.
    pub point: PointModel,
    /// When, after the start \[s\].
    pub times_s: Vec<f64>,
    /// Unit vectors in the world.
    pub directions: Vec<[f64; 3]>,
    /// No stronger push is tried [N s].
    pub most_ns: f64,
    /// Strengths that are tried between none and the strongest before the least that fells is
    /// searched for between two of them: stronger pushes may be easier to bear.
    pub coarse: usize,
    /// The least is found to this [N s].
    pub resolution_ns: f64,
    /// How long it must walk on after the push \[s\].
    pub after_s: f64,
}

/// The least push that fells at one time in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct LeastPush {
    /// When, after the start \[s\].
    pub at_s: f64,
    /// Unit vector in the world.
    pub direction: [f64; 3],
    /// The least impulse that fells it: 0 if it falls anyway, none if the strongest does not [N s].
    pub impulse_ns: Option<f64>,
    /// What became of it then.
    pub outcome: Outcome,
}

/// The least push for each time and each direction, direction after direction.
pub fn least_pushes(
    open: &Opener<'_>,
    start: &State,
    options: &PushOptions,
    observer: &Observer<'_>,
) -> Vec<LeastPush> {
    let (times, directions) = (&options.times_s, &options.directions);
    each(times.len() * directions.len(), observer, &|| open(), &|scenario, index| {
        let at_s = times[index % times.len()];
        let direction = directions[index / times.len()];
        let Some(scenario) = scenario else {
            return LeastPush { at_s, direction, impulse_ns: None, outcome: Outcome::NoStart };
        };
        let mut outcome_of =
            |impulse_ns: f64| outcome(scenario, start, at_s, direction, impulse_ns, options);
        let (impulse_ns, outcome) = least(&mut outcome_of, options);
        LeastPush { at_s, direction, impulse_ns, outcome }
    })
}

/// The least strength that fells, from weak to strong, then by halving.
fn least(
    outcome_of: &mut dyn FnMut(f64) -> Outcome,
    options: &PushOptions,
) -> (Option<f64>, Outcome) {
    let unpushed = outcome_of(0.0);
    if !unpushed.walks() {
        return (Some(0.0), unpushed);
    }
    let mut borne = 0.0;
    for step in 1..=options.coarse.max(1) {
        let strength = options.most_ns * step as f64 / options.coarse.max(1) as f64;
        let mut felled = outcome_of(strength);
        if felled.walks() {
            borne = strength;
            continue;
        }
        let mut fells = strength;
        while fells - borne > options.resolution_ns {
            let middle = 0.5 * (borne + fells);
            match outcome_of(middle) {
                Outcome::Walks => borne = middle,
                outcome => (fells, felled) = (middle, outcome),
            }
        }
        return (Some(fells), felled);
    }
    (None, Outcome::Walks)
}

fn outcome(
    scenario: &mut Scenario,
    start: &State,
    at_s: f64,
    direction: [f64; 3],
    impulse_ns: f64,
    options: &PushOptions,
) -> Outcome {
    let at_s = start.t_s + at_s;
    let shove = Shove::Impulse(direction.map(|entry| impulse_ns * entry));
    let mut pushes = scenario.simulation.pushes.clone();
    pushes.push(Push { point: options.point.clone(), at_s, shove });
    pushes.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    let end_s = at_s + options.after_s;
    let simulation = Simulation {
        end_s,
        log_period_s: (end_s - start.t_s).max(1e-9),
        pushes,
        ..scenario.simulation.clone()
    };
    match simulate(scenario.plant.as_mut(), &scenario.control, start, &simulation) {
        Ok(run) => Outcome::of(run.stop, run.end.t_s),
        Err(_) => Outcome::NoStart,
    }
}
