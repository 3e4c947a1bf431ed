//! Names that the data cannot tell apart.

use super::driven::stands_for;
use super::evidence::paired;
use super::gap::Gap;
use super::problem::Problem;
use super::search::{ALIKE, Screen, SearchOptions, alike, is_worse, refine, score};
use super::state::{Setting, State, Taken, Trial};

/// An effect that would do as well in the place of one that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// The candidate.
    pub candidate: usize,
    /// The values of its parameters.
    pub values: Vec<f64>,
    /// The gap that it leaves on held-out logs.
    pub held_out_gap: f64,
    /// Whether it has fewer parameters.
    pub is_simpler: bool,
    /// Standard errors by which it is worse, over all logs.
    pub worse_by: f64,
    /// The cosine of the angle between what the two do to the torques that the model's own
    /// parameters cannot.
    pub cosine: f64,
    /// Whether no motion could tell the two apart: by the symbolic regressor.
    pub is_exact: bool,
}

/// The effects that would do as well as the one in a place of `state.taken`, with the others as
/// they are, best first. Laws with more parameters that are no better are no alternatives.
pub fn family(
    (setting, screen): (&Setting<'_>, &Screen),
    options: &SearchOptions,
    state: &State,
    place: usize,
) -> Vec<Alternative> {
    let mut others = state.taken.clone();
    let own = others.remove(place);
    let rest = State { taken: others.clone(), ..state.clone() };
    let problem = Problem::new(setting.train, &state.deviation[0], &[]);
    let scored = score(setting, screen, (&rest, &rest.taken), None);
    let chosen = {
        let mut taken = others;
        taken.push(own.clone());
        setting.trial(&problem, &rest, &taken)
    };
    let idle = setting.trial(&problem, &rest, &rest.taken);
    let [_, trust] = state.trust();
    let gap = |residual: &[f64]| Gap::new(setting.held_out, residual, &trust).all;
    let most = alike([&idle, &chosen]);
    let stands = |trial: &Trial| stands_for(setting, [&idle, trial]);
    let is_alike = |trial: &Trial| {
        trial.held_out_cost() <= most
            && !is_worse(setting, &rest, trial, &chosen)
            && (!stands(&chosen) || stands(trial))
    };
    // Where the model's own uncertainty would do, so would any effect that is off.
    let is_off = |trial: &Trial| is_alike(&idle) && !is_worse(setting, &rest, &idle, trial);
    let mut found = Vec::new();
    for trial in refine(setting, 2 * options.refined, &rest, (&problem, &scored)) {
        let Some(other) = trial.taken.last().cloned() else { continue };
        let Taken { candidate, values } = other.clone();
        if candidate == own.candidate || trial.parameters() > chosen.parameters() {
            continue;
        }
        let worse_by = paired(&trial.blocks.concat(), &chosen.blocks.concat());
        if is_alike(&trial) && !is_off(&trial) {
            let held_out_gap = gap(&trial.held_out_residual);
            let cosine = cosine(setting, &problem, &rest, [&own, &other]);
            let is_exact = false;
            found.push(Alternative {
                candidate,
                values,
                is_simpler: trial.parameters() < chosen.parameters(),
                held_out_gap,
                worse_by,
                cosine,
                is_exact,
            });
        }
    }
    found.sort_by(|a, b| a.held_out_gap.total_cmp(&b.held_out_gap));
    found
}

/// A state, and for each effect that was found the names that would do as well.
pub(super) type Families = (State, Vec<Vec<Alternative>>);

/// The effects of a state with the names that would do as well: of these the simplest is the
/// effect's, since with what was found it is known better what is left.
pub(super) fn named(
    (setting, screen): (&Setting<'_>, &Screen),
    options: &SearchOptions,
    mut state: State,
) -> Families {
    let mut families = Vec::new();
    for place in setting.given.len()..state.taken.len() {
        let of = |state: &State| family((setting, screen), options, state, place);
        let mut own = of(&state);
        let mut simpler = own.iter().filter(|other| other.is_simpler);
        if let Some(simpler) = simpler.find_map(|other| in_place(setting, &state, place, other)) {
            state = simpler;
            own = of(&state);
        }
        families.push(own);
    }
    (state, families)
}

/// The state with another name in a place, if that leaves what it was tried with: numbers of the
/// model that were free for the trial have to stay within their bounds.
fn in_place(
    setting: &Setting<'_>,
    state: &State,
    place: usize,
    other: &Alternative,
) -> Option<State> {
    let mut taken = state.taken.clone();
    taken[place] = Taken { candidate: other.candidate, values: other.values.clone() };
    let found = setting.state(&taken);
    let [_, trust] = state.trust();
    let left = Gap::new(setting.held_out, &found.held_out_residual, &trust).all;
    (left <= (1.0 + ALIKE) * other.held_out_gap).then_some(found)
}

/// The cosine of what two effects do, in the rows, outside of what z can do.
fn cosine(setting: &Setting<'_>, problem: &Problem<'_>, state: &State, pair: [&Taken; 2]) -> f64 {
    let rows = pair.map(|one| {
        let fitted = setting.fitted(std::slice::from_ref(one));
        let mut rows = vec![0.0; setting.train.rows()];
        for response in problem.responses(&fitted, &state.torques[0]) {
            response.subtract_from(&mut rows);
        }
        problem.outside(&rows)
    });
    let [a, b] = &rows;
    a.dot(b) / (a.norm() * b.norm()).max(f64::MIN_POSITIVE)
}
