//! The loop of a run: smooth motion, an event, smooth motion; why it ended.

use super::breakdown::{Breakdown, Stop};
use super::contact::sharing::Loads;
use super::event::{Fired, Watch, Watched, look_ahead};
use super::ground::TOUCH_M;
use super::integrate::Stepper;
use super::measure::Instrument;
use super::motion::Motion;
use super::planner::{Looks, Sensed};
use super::push::Shove;
use super::record::Recorder;
use super::run::{Event, EventKind, Run, Told, stand};
use super::settle::{Onset, Scuffing, Settled, Settler};
use super::simulation::Simulation;
use super::start::StartError;
use super::variation::{Variation, VariationError};

/// This many events within `ZENO_S` are without end.
const ZENO_EVENTS: usize = 200;
const ZENO_S: f64 = 1e-9;
/// Times of the log, of samples and of references that are nearer are one: no step is shorter.
const SAME_TIME_S: f64 = 1e-12;
/// Steps are audited at this distance at least, besides rows of the log and the first step after
/// every event \[s\].
const AUDIT_S: f64 = 4e-3;

pub(super) struct Runner<'a> {
    simulation: &'a Simulation,
    motion: Motion<'a>,
    stepper: Stepper,
    watch: Watch,
    recorder: Recorder,
    settler: Settler,
    instrument: Instrument,
    /// What small changes of the initial state become.
    variation: Option<Variation>,
    events: Vec<Event>,
    /// Times of the last events.
    recent: Vec<f64>,
    /// What plans references, if anything does.
    looks: Option<Looks>,
    /// Number of the controller's next sample, and of the log's next row.
    sample: u64,
    /// Number of the next push.
    pushed: usize,
    row: u64,
    /// Time of the last row.
    written_s: f64,
    start_s: f64,
    /// Time of the last audit between rows.
    audited_s: f64,
    /// Time and state.
    t_s: f64,
    y: Vec<f64>,
    /// Who hears how far the run is.
    told: Option<&'a mut Told<'a>>,
}

impl<'a> Runner<'a> {
    /// At the start, with what stands on the ground closed.
    pub(super) fn begin(
        mut motion: Motion<'a>,
        simulation: &'a Simulation,
        start_s: f64,
        mut y: Vec<f64>,
        variation: Option<Variation>,
    ) -> Result<Self, StartError> {
        let standing = stand(&mut motion, &mut y)?;
        let model = motion.plant.model();
        let counts = [model.contacts.len(), model.links.len(), model.fall_points.len()];
        let mut runner = Self {
            watch: Watch::new(counts, y.len()),
            stepper: Stepper::new(simulation.method, start_s, &y),
            recorder: Recorder::new(&mut motion, simulation, &y),
            settler: Settler::default(),
            instrument: Instrument::new(simulation.measurement, simulation.seed),
            variation,
            events: Vec::new(),
            recent: Vec::new(),
            looks: Looks::of(&motion.control, start_s),
            sample: 0,
            pushed: 0,
            row: 0,
            written_s: f64::NEG_INFINITY,
            start_s,
            audited_s: start_s,
            t_s: start_s,
            simulation,
            motion,
            y,
            told: None,
        };
        runner.plan(start_s);
        runner.sample_control(start_s);
        if !standing.is_empty() {
            let happened = runner.happen(EventKind::Start, start_s, &standing);
            happened.map_err(StartError::Breakdown)?;
        }
        Ok(runner)
    }

    /// The same, heard by somebody.
    pub(super) fn told(self, told: &'a mut Told<'a>) -> Self {
        Self { told: Some(told), ..self }
    }

    /// To the end, whichever that is.
    pub(super) fn go(mut self) -> (Run, Option<Variation>) {
        let stop = match self.advance() {
            Ok(stop) => stop,
            Err(breakdown) => Stop::Breakdown(breakdown),
        };
        self.finish(stop)
    }

    fn advance(&mut self) -> Result<Stop, Breakdown> {
        loop {
            let t = self.t_s;
            let planned = self.plan(t);
            self.sample_control(t);
            if planned && !self.motion.closed.is_empty() {
                self.happen(EventKind::Plan, t, &[])?;
            }
            self.push(t)?;
            self.write_rows(t)?;
            if t >= self.simulation.end_s {
                return Ok(Stop::End);
            }
            let stop = self.next_stop(t);
            self.motion.segment_end = stop;
            self.stepper.restart(t, &self.y);
            if let Some(stop) = self.smooth(stop)? {
                return Ok(stop);
            }
        }
    }

    /// Smooth motion up to `stop_s`, or to the next event, which is dealt with.
    fn smooth(&mut self, stop_s: f64) -> Result<Option<Stop>, Breakdown> {
        self.motion.begin_smooth();
        while self.stepper.time() < stop_s {
            // a row is a state that was stepped to: dense output would be audited for it
            let row_s = self.row_time();
            let end_s = if row_s < stop_s - 1e-12 { row_s } else { stop_s };
            if !self.stepper.advance(&mut self.motion, end_s)? {
                let jams = self.motion.jams(self.stepper.time(), &self.y);
                return Err(if jams { Breakdown::Painleve } else { Breakdown::StepTooSmall });
            }
            if self.stepper.statistics.evaluations > self.simulation.max_evaluations {
                return Ok(Some(Stop::EvaluationLimit));
            }
            if let Some(fired) = self.watch.find(&mut self.motion, &mut self.stepper)? {
                self.stepper.restep(&mut self.motion, fired.t_s, &mut self.y)?;
                self.t_s = fired.t_s;
                let stop = self.pass(fired)?;
                self.audited_s = f64::NEG_INFINITY;
                self.stepper.restart(fired.t_s, &self.y);
                return Ok(stop);
            }
            self.y.copy_from_slice(self.stepper.state());
            self.t_s = self.stepper.time();
            if let Some(told) = &mut self.told {
                let whole_s = self.simulation.end_s - self.start_s;
                if !told((self.t_s - self.start_s) / whole_s) {
                    return Ok(Some(Stop::Watcher));
                }
            }
            if let Some(variation) = &mut self.variation {
                variation.follow(&mut self.motion, &mut self.stepper, self.t_s)?;
            }
            self.motion.remember_slips(&self.y);
            self.motion.remember_loads(self.t_s, &self.y)?;
            if self.stepper.time() - self.audited_s > AUDIT_S {
                self.audited_s = self.stepper.time();
                self.recorder.note(&mut self.motion, self.audited_s, &self.y, false)?;
            }
            // the row of an instant shows what comes after it
            if self.stepper.time() < stop_s {
                self.write_rows(self.stepper.time())?;
            }
        }
        Ok(None)
    }

    /// Deals with an event, and with what it does to small changes of the state.
    fn pass(&mut self, fired: Fired) -> Result<Option<Stop>, Breakdown> {
        let Some(mut variation) = self.variation.take() else { return self.respond(fired) };
        variation.follow(&mut self.motion, &mut self.stepper, fired.t_s)?;
        let crossing = variation.cross(&mut self.motion, &mut self.watch, fired, &self.y)?;
        let hit = match fired.watched {
            Watched::Gap(contact) => Some(self.touching(contact)),
            Watched::Guard(_) => {
                variation.failure.get_or_insert(VariationError::Jumps);
                None
            }
            _ => None,
        };
        let passed = hit.as_ref().is_some_and(Vec::is_empty);
        let before = self.events.len();
        let stop = self.respond(fired)?;
        if self.events.len() > before && !passed {
            let law = &self.simulation.touching;
            variation.jump(&mut self.motion, &crossing, law, hit.as_deref(), &self.y)?;
        }
        self.variation = Some(variation);
        Ok(stop)
    }

    fn respond(&mut self, fired: Fired) -> Result<Option<Stop>, Breakdown> {
        let t_s = fired.t_s;
        match fired.watched {
            Watched::FallPoint(point) => {
                let name = self.motion.plant.model().fall_points[point].name.clone();
                return Ok(Some(Stop::Fall(name)));
            }
            Watched::Gap(contact) => {
                let touching = self.touching(contact);
                self.happen(EventKind::Touch(contact), t_s, &touching)?;
            }
            Watched::Margin => self.happen(EventKind::Limit, t_s, &[])?,
            Watched::SlipSpeed(index) if self.motion.slips_on(index, &self.y) => {
                self.motion.remember_slips(&self.y);
                return Ok(None);
            }
            Watched::SlipSpeed(index) => {
                let contact = self.motion.closed[index].contact;
                self.happen(EventKind::SlipEnds(contact), t_s, &[])?;
            }
            Watched::Guard(guard) => self.jump(guard, t_s),
            Watched::QuarterTurn(_) => return Err(Breakdown::SingularPose),
        }
        self.recent.push(t_s);
        if self.events.len() >= self.simulation.max_events {
            return Ok(Some(Stop::EventLimit));
        }
        let before = self.recent.len().checked_sub(ZENO_EVENTS).map(|index| self.recent[index]);
        if before.is_some_and(|before| t_s - before < ZENO_S) {
            return Ok(Some(Stop::Zeno));
        }
        Ok(None)
    }

    /// The contact that touches, with all others that are on the ground, lest the impact makes
    /// them sink; none if it does not count.
    fn touching(&mut self, contact: usize) -> Vec<usize> {
        let closed: Vec<usize> = self.motion.closed.iter().map(|c| c.contact).collect();
        self.motion.place(&self.y);
        let near = |other: &usize| {
            let height = self.motion.gap(*other) - self.watch.level[*other];
            *other == contact || (!closed.contains(other) && height < TOUCH_M)
        };
        let mut touching: Vec<usize> = (0..self.watch.level.len()).filter(near).collect();
        if self.simulation.touching.scuffing == Scuffing::IgnoredBehind {
            let forward = self.motion.ground.tangents()[0];
            let place = |contact: usize| {
                let at = &self.motion.work.positions[3 * contact..3 * contact + 3];
                super::ground::dot(forward, at)
            };
            touching.retain(|other| closed.iter().all(|c| place(*other) > place(*c)));
        }
        touching
    }

    fn happen(&mut self, kind: EventKind, t_s: f64, touching: &[usize]) -> Result<(), Breakdown> {
        if let (EventKind::Touch(contact), []) = (&kind, touching) {
            // passes through, by rule: it counts again once it has risen
            self.watch.level[*contact] = f64::NEG_INFINITY;
            self.recorder.passing[*contact] = true;
            return Ok(());
        }
        let (n, rates) = (self.motion.layout.joints, self.motion.layout.joint_rates());
        let before = self.y[rates.clone()].to_vec();
        let energy = self.motion.energy(&self.y);
        let was: Vec<usize> = self.motion.closed.iter().map(|c| c.contact).collect();
        let start = (self.y.clone(), self.motion.closed.clone());
        let outcome = if kind == EventKind::Limit {
            self.reach_limit(t_s)
        } else {
            self.watch.slack = 0.0;
            self.motion.want(Loads::Compliant);
            let law = &self.simulation.touching;
            let onset = match kind {
                EventKind::Push => Onset::Push,
                _ => Onset::Touch(touching),
            };
            self.settler.settle(&mut self.motion, law, onset, t_s, &mut self.y)
        };
        let settled = match outcome {
            Ok(settled) => settled,
            Err(breakdown) => {
                // the end is what was before an event that has no answer
                (self.y, self.motion.closed) = start;
                return Err(breakdown);
            }
        };
        let closed: Vec<usize> = self.motion.closed.iter().map(|c| c.contact).collect();
        self.motion.place(&self.y);
        for &contact in was.iter().chain(touching) {
            if !closed.contains(&contact) {
                // what it is off by while closed is not a fall of its own
                self.watch.level[contact] = self.motion.gap(contact).min(0.0);
                self.watch.tried(contact);
            }
        }
        let energy_j = self.motion.energy(&self.y) - energy;
        self.recorder.add_impact(energy_j);
        let impulses: Vec<(usize, [f64; 3])> = settled
            .impulses
            .iter()
            .map(|(contact, p)| (*contact, self.motion.ground.in_world(p)))
            .collect();
        let after = self.y[rates].to_vec();
        self.audit_momentum(&before, &after, &impulses);
        let kind = if self.motion.takes_least() { EventKind::LeastLoads } else { kind };
        let fell_back = settled.fell_back;
        let q = self.y[..n].to_vec();
        let event = Event { t_s, kind, closed, impulses, energy_j, q, before, after, fell_back };
        self.events.push(event);
        Ok(())
    }

    /// What comes after the forces of the closed contacts have reached a limit.
    fn reach_limit(&mut self, t_s: f64) -> Result<Settled, Breakdown> {
        let (motion, law) = (&mut self.motion, &self.simulation.touching);
        let mut ahead = self.y.clone();
        let (ahead_s, spare) = look_ahead(motion, &mut self.stepper, t_s, &mut ahead)?;
        if motion.loads_fail(ahead_s, &ahead)? {
            // the contacts stay as they are
            motion.want(Loads::Least);
            self.watch.slack = 0.0;
            return Ok(Settled::default());
        }
        motion.want(Loads::Compliant);
        let before = motion.closed.clone();
        let settled = self.settler.switch(motion, law, (ahead_s, &ahead), &mut self.y)?;
        let same = before.len() == motion.closed.len()
            && before.iter().zip(&motion.closed).all(|(a, b)| a.does_as(b));
        self.watch.slack = if same { self.watch.more_slack(spare) } else { 0.0 };
        Ok(settled)
    }

    fn audit_momentum(&mut self, before: &[f64], after: &[f64], impulses: &[(usize, [f64; 3])]) {
        let model = self.motion.plant.model();
        if impulses.is_empty() || model.joints.first().is_none_or(|joint| joint.drivable) {
            return;
        }
        let q = &self.y[..before.len()];
        let [old, new] = [before, after].map(|qd| self.motion.plant.momentum(q, qd));
        let error = |axis: usize| {
            let given: f64 = impulses.iter().map(|(_, impulse)| impulse[axis]).sum();
            (new[axis] - old[axis] - given).abs()
        };
        let worst = (0..3).map(error).fold(0.0, f64::max);
        self.recorder.audit.momentum_ns = self.recorder.audit.momentum_ns.max(worst);
    }

    fn jump(&mut self, guard: usize, t_s: f64) {
        let (n, rates) = (self.motion.layout.joints, self.motion.layout.joint_rates());
        let energy = self.motion.energy(&self.y);
        let before = self.y[rates.clone()].to_vec();
        let (positions, rest) = self.y.split_at_mut(rates.start);
        self.motion.plant.jump(guard, &mut positions[..n], &mut rest[..n]);
        self.motion.forget_position();
        let energy_j = self.motion.energy(&self.y) - energy;
        self.recorder.add_impact(energy_j);
        self.events.push(Event {
            t_s,
            kind: EventKind::Jump(guard),
            closed: self.motion.closed.iter().map(|c| c.contact).collect(),
            impulses: Vec::new(),
            energy_j,
            q: self.y[..n].to_vec(),
            before,
            after: self.y[rates].to_vec(),
            fell_back: false,
        });
    }

    /// Impulses from outside that are due.
    fn push(&mut self, t_s: f64) -> Result<(), Breakdown> {
        while let Some(push) = self.simulation.pushes.get(self.pushed) {
            if push.at_s > t_s + SAME_TIME_S {
                break;
            }
            self.pushed += 1;
            let Shove::Impulse(impulse) = push.shove else { continue };
            if push.at_s < t_s - SAME_TIME_S {
                continue;
            }
            if let Some(variation) = &mut self.variation {
                variation.failure.get_or_insert(VariationError::Pushed);
            }
            let rates = self.motion.layout.joint_rates();
            let before = self.y[rates.clone()].to_vec();
            let energy = self.motion.energy(&self.y);
            let q = self.motion.layout.parts(&self.y).q.to_vec();
            let mut change = push.torques(self.motion.plant, &q, impulse);
            self.motion.factor_mass(&self.y)?;
            self.motion.delassus.solve_mass(&mut change);
            self.y[rates].iter_mut().zip(change).for_each(|(rate, change)| *rate += change);
            let events = self.events.len();
            let pushed = self.motion.energy(&self.y) - energy;
            self.recorder.add_push(pushed);
            self.happen(EventKind::Push, t_s, &[])?;
            if let Some(event) = self.events.get_mut(events) {
                event.before = before;
                event.energy_j += pushed;
            }
        }
        Ok(())
    }

    /// Has references planned, if a look at the state is due; says if there are new ones.
    fn plan(&mut self, t_s: f64) -> bool {
        let Some(looks) = &mut self.looks else { return false };
        let parts = self.motion.layout.parts(&self.y);
        let closed: Vec<usize> = self.motion.closed.iter().map(|c| c.contact).collect();
        let sensed = Sensed { t_s, q: parts.q, qd: parts.qd, closed: &closed };
        let plans = looks.look(self.motion.plant, &sensed);
        let is_new = plans.is_some();
        plans.into_iter().for_each(|plans| self.motion.follow(plans));
        is_new
    }

    /// Takes the samples of the controller that are due.
    fn sample_control(&mut self, t_s: f64) {
        let Some(period_s) = self.motion.control.period_s else { return };
        if t_s < self.start_s + self.sample as f64 * period_s - 1e-12 {
            return;
        }
        self.sample += 1;
        let parts = self.motion.layout.parts(&self.y);
        let [mut q, mut qd] = [Vec::new(), Vec::new()];
        let (model, feedback) = (self.motion.plant.model(), self.motion.control.feedback);
        self.motion.drives.measured(model, feedback, parts, &mut q, &mut qd);
        let (q, qd) = self.instrument.sample(&q, &qd, period_s);
        let mut command = vec![0.0; q.len()];
        self.motion.segment_end = f64::INFINITY;
        self.motion.command(t_s, q, qd, &mut command);
        self.motion.held = Some(command);
    }

    /// Where smooth motion ends at the latest.
    fn next_stop(&self, t_s: f64) -> f64 {
        let sample = self.motion.control.period_s.map(|p| self.start_s + self.sample as f64 * p);
        // held torques do not see the references move
        let jump = match sample {
            None => self.motion.control.next_break(t_s + SAME_TIME_S),
            Some(_) => None,
        };
        let end_s = self.simulation.end_s;
        let pushes = self.simulation.pushes.iter().flat_map(|push| [push.at_s, push.end_s()]);
        let push = pushes.filter(|at_s| *at_s > t_s + SAME_TIME_S).reduce(f64::min);
        let look = self.looks.as_ref().map(Looks::next_s);
        let before = |stop_s: &f64| *stop_s < end_s - SAME_TIME_S;
        [sample, jump, push, look].into_iter().flatten().filter(before).fold(end_s, f64::min)
    }

    /// The time of the log's next row.
    fn row_time(&self) -> f64 {
        self.start_s + self.row as f64 * self.simulation.log_period_s
    }

    /// Rows of the log that are due.
    fn write_rows(&mut self, t_s: f64) -> Result<(), Breakdown> {
        while self.row_time() <= t_s.min(self.simulation.end_s) + 1e-12 {
            let row_s = self.row_time().min(t_s);
            self.recorder.note(&mut self.motion, row_s, &self.y, true)?;
            self.row += 1;
            self.written_s = row_s;
        }
        Ok(())
    }

    fn finish(mut self, stop: Stop) -> (Run, Option<Variation>) {
        if self.t_s > self.written_s + SAME_TIME_S {
            // a run that ends between two rows ends with one more
            self.recorder.note_end(&mut self.motion, self.t_s, &self.y);
        }
        let end = self.motion.layout.unpack(self.t_s, &self.y);
        let run = Run {
            stop,
            end,
            log: self.recorder.log,
            events: self.events,
            audit: self.recorder.audit,
            joints: self.recorder.joints.finish(),
            statistics: self.stepper.statistics,
            closed: self.motion.closed.iter().map(|closed| closed.contact).collect(),
        };
        (run, self.variation)
    }
}
