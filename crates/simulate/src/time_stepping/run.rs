//! Whole runs by time stepping: from a start to an end or a fall, with a log and audits.

use super::plant::ControlledPlant;
use super::record::{Made, StepRecorder};
use super::{Scheme, StepFailure, StepLaw, Stepping, TimeStepper};
use crate::breakdown::{Breakdown, Stop};
use crate::contact::{ContactFailure, Friction};
use crate::control::Control;
use crate::drive::Drives;
use crate::error::Error;
use crate::ground::Ground;
use crate::integrate::Statistics;
use crate::measure::Instrument;
use crate::run::{Run, Told};
use crate::settle::Scuffing;
use crate::simulation::Simulation;
use crate::start::{StartError, check, check_gaps, check_steps, quarter_turn_left};
use crate::state::State;
use denavit_plants::{Plant, PlantModel, point_positions};

/// Runs a plant under control from a state by steps; deterministic.
///
/// Of `simulation`, the method of integration, the rest speed, the fallback friction and the drift
/// rate belong to the event-driven scheme. Rows of the log, samples of the controller and jumps of
/// references are at ends of steps.
pub fn simulate_by_steps(
    plant: &mut dyn Plant,
    control: &Control,
    initial: &State,
    simulation: &Simulation,
    stepping: &Stepping,
) -> Result<Run, Error> {
    simulate_by_steps_told(plant, control, initial, simulation, stepping, &mut |_| true)
}

/// As [`simulate_by_steps`], heard by somebody.
///
/// # Errors
/// As of [`simulate_by_steps`].
pub fn simulate_by_steps_told(
    plant: &mut dyn Plant,
    control: &Control,
    initial: &State,
    simulation: &Simulation,
    stepping: &Stepping,
    told: &mut Told<'_>,
) -> Result<Run, Error> {
    let mut state = initial.clone();
    let drives = Drives::new(plant.model(), simulation.drives);
    check(plant, control, &mut state, simulation, &drives)?;
    if control.planning.is_some() {
        let what = "references that are planned during a run";
        return Err(StartError::EventSchemeOnly(what).into());
    }
    check_stepping(simulation, stepping)?;
    check_steps(&state, simulation, "time_stepping", stepping.step_s, 1.0)?;
    if plant.law_states() > 0 || plant.has_accelerated_laws() {
        let what = "effects with states, or that depend on the load";
        return Err(StartError::EventSchemeOnly(what).into());
    }
    check_gaps(plant, &state.q)?;
    let falls = FallWatch::new(plant.model());
    let friction = match simulation.friction {
        Friction::Coulomb(mu) => mu,
        Friction::NoSlip => stepping.no_slip_friction,
    };
    let law = StepLaw { friction, restitution: simulation.touching.restitution };
    let laws = vec![law; plant.model().contacts.len()];
    let ground = Ground::new(plant.model());
    let mut system = ControlledPlant::with_drives(plant, control, simulation.drives);
    system.set_stiction_rate(simulation.stiction_rate);
    let stepper = TimeStepper::new(*stepping, laws.clone(), &system);
    let q = [&state.q[..], &state.motor].concat();
    let qd = [&state.qd[..], &state.motor_rate].concat();
    let recorder = StepRecorder::new(&mut system, control, laws, state.t_s, &q, &qd);
    let mut runner = Runner {
        control,
        simulation,
        longest_s: stepping.step_s,
        instrument: Instrument::new(simulation.measurement, simulation.seed),
        statistics: Statistics::default(),
        iterations: 0,
        start_s: state.t_s,
        t_s: state.t_s,
        sample: 0,
        row: 0,
        before: qd.clone(),
        system,
        stepper,
        recorder,
        falls,
        ground,
        q,
        qd,
    };
    let stop = runner.go(told);
    Ok(runner.finish(stop))
}

fn check_stepping(simulation: &Simulation, stepping: &Stepping) -> Result<(), StartError> {
    let positive = |value: f64| value > 0.0 && value.is_finite();
    if !positive(stepping.step_s) {
        return Err(StartError::Number("the step"));
    }
    if !(0.0..=1.0).contains(&stepping.implicitness) {
        return Err(StartError::Number("the implicit part of the damping"));
    }
    if simulation.touching.scuffing != Scuffing::Counts {
        return Err(StartError::EventSchemeOnly("contacts that do not count"));
    }
    if !simulation.pushes.is_empty() {
        return Err(StartError::EventSchemeOnly("pushes"));
    }
    let constrains_gaps = matches!(stepping.scheme, Scheme::Anitescu { .. });
    if constrains_gaps && simulation.touching.restitution > 0.0 {
        return Err(StartError::MoreauOnly("restitution"));
    }
    Ok(())
}

struct Runner<'a> {
    control: &'a Control,
    simulation: &'a Simulation,
    longest_s: f64,
    system: ControlledPlant<'a>,
    stepper: TimeStepper,
    recorder: StepRecorder,
    instrument: Instrument,
    statistics: Statistics,
    /// Sweeps and pivots of all contact problems so far.
    iterations: usize,
    falls: FallWatch,
    ground: Ground,
    start_s: f64,
    t_s: f64,
    /// Number of the controller's next sample, and of the log's next row.
    sample: u64,
    row: u64,
    q: Vec<f64>,
    qd: Vec<f64>,
    /// Rates before the last step.
    before: Vec<f64>,
}

impl Runner<'_> {
    fn go(&mut self, told: &mut Told<'_>) -> Stop {
        loop {
            self.sample_control();
            if self.due(self.row, self.simulation.log_period_s) {
                // a row shows the torque that is held from it on, or at the start the first one
                if self.row == 0 || self.control.period_s.is_some() {
                    self.system.drive(self.t_s, &self.q, &self.qd);
                }
                self.write_row();
                self.row += 1;
            }
            if self.t_s >= self.simulation.end_s {
                return Stop::End;
            }
            let stop_s = self.next_stop();
            let (start_s, length_s) = (self.t_s, stop_s - self.t_s);
            let steps = (length_s / self.longest_s - 1e-6).ceil().max(1.0);
            self.stepper.set_step_s(length_s / steps);
            let mut step = 0.0;
            while step < steps {
                step += 1.0;
                let end_s = if step < steps { start_s + length_s * (step / steps) } else { stop_s };
                if let Some(stop) = self.step(end_s) {
                    return stop;
                }
                let whole_s = self.simulation.end_s - self.start_s;
                if !told((self.t_s - self.start_s) / whole_s) {
                    return Stop::Watcher;
                }
            }
        }
    }

    /// Whether event number `number` of a period is due now.
    fn due(&self, number: u64, period_s: f64) -> bool {
        self.t_s >= self.start_s + number as f64 * period_s - 1e-12
    }

    /// Where a step must end: a sample, a row, a jump of a reference, the end.
    fn next_stop(&self) -> f64 {
        let sample = self.control.period_s.map(|p| self.start_s + self.sample as f64 * p);
        let row = self.start_s + self.row as f64 * self.simulation.log_period_s;
        // held torques do not see the references move
        let jump = match sample {
            None => self.control.next_break(self.t_s + 1e-12),
            Some(_) => None,
        };
        // what differs from the end by rounding would ask for a step as short as that
        let end_s = self.simulation.end_s;
        let before = |stop_s: &f64| *stop_s < end_s - 1e-12;
        [sample, jump, Some(row)].into_iter().flatten().filter(before).fold(end_s, f64::min)
    }

    fn sample_control(&mut self) {
        let Some(period_s) = self.control.period_s else { return };
        if self.due(self.sample, period_s) {
            self.sample += 1;
            self.system.sample(self.t_s, &self.q, &self.qd, &mut self.instrument);
        }
    }

    fn step(&mut self, end_s: f64) -> Option<Stop> {
        self.before.copy_from_slice(&self.qd);
        let base = self.system.plant().model().singular_base_joint();
        let start = self.q.clone();
        let made = self.stepper.step(&mut self.system, self.t_s, &mut self.q, &mut self.qd);
        let report = match made {
            Ok(report) => report,
            Err(failure) => return Some(Stop::Breakdown(breakdown(failure))),
        };
        if base.is_some_and(|joint| nears_quarter_turn(start[joint], self.q[joint])) {
            // the last state that steps of this length resolve is that before
            self.q = start;
            self.qd.copy_from_slice(&self.before);
            return Some(Stop::Breakdown(Breakdown::SingularPose));
        }
        self.t_s = end_s;
        self.statistics.steps += 1;
        self.statistics.evaluations += report.passes;
        self.iterations += report.iterations;
        self.statistics.rejected += report.passes - 1;
        let settings = *self.stepper.stepping();
        let (before, after) = (&self.before, &self.qd);
        let work = self.system.finish_step(before, after, settings.step_s, settings.implicitness);
        let made = Made { t_s: end_s, report, q: &self.q, before, after, work };
        self.recorder.note_step(&self.system, &self.stepper, &made);
        self.recorder.see_joints(self.control, end_s, &self.system.step.command, &self.q, after);
        if let Some(name) = self.falls.fallen(self.system.plant(), &self.ground, &self.q) {
            return Some(Stop::Fall(name));
        }
        if self.recorder.events.len() >= self.simulation.max_events {
            return Some(Stop::EventLimit);
        }
        let spent = self.statistics.evaluations + self.iterations;
        (spent > self.simulation.max_evaluations).then_some(Stop::EvaluationLimit)
    }

    fn write_row(&mut self) {
        let state = [&self.q[..], &self.qd];
        self.recorder.write_row(&mut self.system, &self.stepper, self.control, self.t_s, state);
    }

    fn finish(mut self, stop: Stop) -> Run {
        // a run that stops between two rows ends with one more
        if self.recorder.has_steps() {
            self.write_row();
        }
        let n = self.control.joints.len();
        let parts = |values: &[f64]| (values[..n].to_vec(), values[n..].to_vec());
        let ((q, motor), (qd, motor_rate)) = (parts(&self.q), parts(&self.qd));
        Run {
            stop,
            end: State { t_s: self.t_s, q, qd, motor, motor_rate, laws: Vec::new() },
            log: self.recorder.log,
            events: self.recorder.events,
            audit: self.recorder.audit,
            joints: self.recorder.joints.finish(),
            statistics: self.statistics,
            closed: self.recorder.pushing,
        }
    }
}

/// Whether a step brought the roll of a base within a few of its length of a quarter turn, or past
/// it.
fn nears_quarter_turn(before: f64, now: f64) -> bool {
    let left = quarter_turn_left(now).min(now.cos().abs() - STEPS_LEFT * (now - before).abs());
    left <= 0.0 || (before.cos() < 0.0) != (now.cos() < 0.0)
}

fn breakdown(failure: StepFailure) -> Breakdown {
    match failure {
        StepFailure::Singular(error) => Breakdown::Singular { coordinate: error.coordinate },
        StepFailure::NotFinite => Breakdown::NotFinite,
        StepFailure::NoImpulses => Breakdown::Contact(ContactFailure::NoSolution),
    }
}

/// So many steps away from where its coordinates are singular a base counts as there.
const STEPS_LEFT: f64 = 5.0;

/// Watches for points that must not touch the ground.
struct FallWatch {
    transforms: Vec<f64>,
    positions: Vec<f64>,
}

impl FallWatch {
    fn new(model: &PlantModel) -> Self {
        let (links, points) = (model.links.len(), model.fall_points.len());
        Self { transforms: vec![0.0; 12 * links], positions: vec![0.0; 3 * points] }
    }

    fn fallen(&mut self, plant: &mut dyn Plant, ground: &Ground, q: &[f64]) -> Option<String> {
        if self.positions.is_empty() {
            return None;
        }
        let n = plant.model().joints.len();
        plant.link_transforms(&q[..n], &mut self.transforms);
        let model = plant.model();
        point_positions(&model.fall_points, &self.transforms, &mut self.positions);
        let mut places = self.positions.chunks_exact(3).zip(&model.fall_radii_m);
        let below = places.position(|(at, radius_m)| ground.gap(at) < *radius_m)?;
        Some(model.fall_points[below].name.clone())
    }
}
