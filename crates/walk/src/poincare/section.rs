//! Where a cycle is looked at, and the map from there to the next time.

use crate::error::{CycleError, Error};
use crate::leg_exchange::LegExchange;
use denavit_plants::Plant;
use denavit_simulate::{Control, EventKind, Run, Simulation, State, Stop, simulate};

/// A section through a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Section {
    /// The same phase of the clock of the controller: its time, and the time of one cycle \[s\].
    Clock {
        /// A time of the first cycle \[s\].
        at_s: f64,
        /// \[s\].
        period_s: f64,
    },
    /// Just after this contact point has touched the ground; the time of a cycle is what it takes.
    Touch(usize),
    /// Just after this guard of the plant has fired.
    Jump(usize),
}

/// A cycle of a walking robot that is looked at again and again.
pub struct ReturnMap<'a> {
    /// The robot.
    pub plant: &'a mut dyn Plant,
    /// What drives it.
    pub control: &'a Control,
    /// How runs are made; when they end is not taken from it.
    pub simulation: Simulation,
    /// The exchange of the legs after a cycle; none if a cycle has all steps of a period.
    pub exchange: Option<LegExchange>,
    /// Where it is looked at.
    pub section: Section,
    /// After how many cycles it is looked at again: 2 for orbits of twice the period.
    pub cycles: usize,
    /// A cycle that is not over after this time is none: only of sections of events \[s\].
    pub patience_s: f64,
    /// The time of the controller's clock that passes in one cycle; none if the control does not
    /// depend on time \[s\].
    pub clock_s: Option<f64>,
}

/// A state on a section, after a cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct Returned {
    /// The state, with the legs exchanged and the clock set back by a cycle.
    pub state: State,
    /// The contacts that are closed in it.
    pub closed: Vec<usize>,
    /// The time of the cycle \[s\].
    pub took_s: f64,
}

/// Events this soon after the start are those of the start \[s\].
const SAME_EVENT_S: f64 = 1e-7;

impl ReturnMap<'_> {
    /// The cycles from a state on the section.
    ///
    /// # Errors
    /// A run that stops, or that does not come back.
    pub fn apply(&mut self, start: &State) -> Result<Returned, Error> {
        let mut returned = self.one_cycle(start)?;
        for _ in 1..self.cycles {
            let next = self.one_cycle(&returned.state)?;
            returned = Returned { took_s: returned.took_s + next.took_s, ..next };
        }
        Ok(returned)
    }

    fn one_cycle(&mut self, start: &State) -> Result<Returned, Error> {
        match self.section {
            Section::Clock { period_s, .. } => {
                let run = self.run(start, period_s)?;
                if run.stop != Stop::End {
                    return Err(CycleError::Stopped(run.stop, run.end.t_s).into());
                }
                Ok(self.returned(run.end, &run.closed, period_s))
            }
            Section::Touch(contact) => {
                let becomes = |e: &LegExchange| e.contacts.iter().position(|to| *to == contact);
                let contact = self.exchange.as_ref().and_then(becomes).unwrap_or(contact);
                self.until_event(start, &EventKind::Touch(contact))
            }
            Section::Jump(guard) => self.until_event(start, &EventKind::Jump(guard)),
        }
    }

    /// What a state becomes by the exchange of the legs and of the clock after a cycle.
    pub fn exchanged(&self, state: State) -> State {
        let mut exchanged = self.exchanged_change(state);
        if let Some(exchange) = &self.exchange {
            exchanged.q.iter_mut().zip(&exchange.offsets).for_each(|(q, offset)| *q += offset);
        }
        exchanged.t_s -= self.clock_s.unwrap_or(0.0);
        exchanged
    }

    /// What a change of the state becomes by the exchange of the legs.
    pub fn exchanged_change(&self, mut state: State) -> State {
        if let Some(exchange) = &self.exchange {
            state.q = exchange.velocities(&state.q);
            state.qd = exchange.velocities(&state.qd);
            [state.motor, state.motor_rate] =
                [&state.motor, &state.motor_rate].map(|values| self.exchanged_motors(values));
        }
        state
    }

    fn until_event(&mut self, start: &State, kind: &EventKind) -> Result<Returned, Error> {
        if !start.motor.is_empty() || self.plant.law_states() > 0 {
            return Err(CycleError::HiddenStates.into());
        }
        let run = self.run(start, self.patience_s)?;
        let after_s = start.t_s + SAME_EVENT_S;
        let mut events = run.events.iter();
        let Some(event) = events.find(|event| event.t_s > after_s && event.kind == *kind) else {
            return Err(match run.stop {
                Stop::End => CycleError::NoEvent(self.patience_s).into(),
                stop => CycleError::Stopped(stop, run.end.t_s).into(),
            });
        };
        let (q, qd) = (event.q.clone(), event.after.clone());
        let state = State { t_s: event.t_s, q, qd, ..State::default() };
        let closed = event.closed.clone();
        Ok(self.returned(state, &closed, event.t_s - start.t_s))
    }

    fn run(&mut self, start: &State, length_s: f64) -> Result<Run, Error> {
        let end_s = start.t_s + length_s;
        let simulation =
            Simulation { end_s, log_period_s: 2.0 * length_s, ..self.simulation.clone() };
        Ok(simulate(self.plant, self.control, start, &simulation).map_err(CycleError::Start)?)
    }

    fn returned(&self, state: State, closed: &[usize], took_s: f64) -> Returned {
        let mut closed = closed.to_vec();
        if let Some(exchange) = &self.exchange {
            closed = closed.into_iter().map(|contact| exchange.contacts[contact]).collect();
            closed.sort_unstable();
        }
        Returned { state: self.exchanged(state), closed, took_s }
    }

    /// Motors stand in the order of their joints.
    fn exchanged_motors(&self, values: &[f64]) -> Vec<f64> {
        let Some(exchange) = &self.exchange else { return values.to_vec() };
        let elastic: Vec<usize> = self.plant.model().sprung_joints().collect();
        if elastic.len() != values.len() {
            return values.to_vec();
        }
        let of = |joint: &usize| {
            let from = exchange.coordinates[*joint];
            let place = elastic.iter().position(|other| *other == from);
            place.map_or(0.0, |place| exchange.signs[*joint] * values[place])
        };
        elastic.iter().map(of).collect()
    }
}
