//! Whole runs by time stepping: from a start to an end or a fall, with a log and audits.

use super::plant::ControlledPlant;
use super::{StepFailure, Stepping, TimeStepper};
use crate::plants::{Plant, PlantModel, point_positions};
use crate::simulate::control::Control;
use crate::simulate::ground::Ground;
use crate::simulate::log::Log;
use crate::simulate::state::State;

/// Why a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum SteppedStop {
    /// The end time is reached.
    End,
    /// A point that must not touch the ground did; holds its name.
    Fall(String),
    /// A step could not be made.
    Failure(StepFailure),
}

/// The worst of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SteppedAudit {
    /// Depth of a contact point where contacts were looked for \[m\]; of order h.
    pub penetration_m: f64,
    /// Change of linear momentum over a step, less gravity and contacts per time \[N\]; of order h.
    pub force_n: f64,
    /// Tangential over normal force of all contacts together.
    pub friction_demand: f64,
    /// Steps whose sweeps did not converge, so that a pyramid stood in for the cones.
    pub fallbacks: usize,
    /// Steps.
    pub steps: usize,
}

/// A run.
#[derive(Clone, Debug, PartialEq)]
pub struct SteppedRun {
    /// Why it ended.
    pub stop: SteppedStop,
    /// The state at its end.
    pub end: State,
    /// Columns t, q, qd, ref of joints that follow one, and forces of contact points: means over
    /// the step that ends at t.
    pub log: Log,
    /// The worst of it.
    pub audit: SteppedAudit,
}

/// Makes steps from `initial` to `end_s`; a row of the log every `rows` steps, and one at the end.
///
/// The state has an entry for each joint, the settings have a law for each contact point. Drives
/// are ideal, control is continuous.
pub fn simulate_by_steps(
    plant: &mut dyn Plant,
    control: &Control,
    initial: &State,
    stepping: &Stepping,
    end_s: f64,
    rows: usize,
) -> SteppedRun {
    let model = plant.model().clone();
    let ground = Ground::new(&model);
    let mut falls = FallWatch::new(&model);
    let log = Log { columns: columns(&model, control), ..Log::default() };
    let mut run = SteppedRun {
        stop: SteppedStop::End,
        end: State { motor: Vec::new(), motor_rate: Vec::new(), ..initial.clone() },
        log,
        audit: SteppedAudit::default(),
    };
    let mut system = ControlledPlant::new(plant, control);
    let mut stepper = TimeStepper::new(stepping.clone(), &system);
    let steps = ((end_s - initial.t_s) / stepping.step_s).round().max(0.0) as usize;
    let mut momentum = system.plant().momentum(&run.end.q, &run.end.qd);
    write(&mut run, &model, control, &ground, &stepper);
    for step in 0..steps {
        let t_s = initial.t_s + step as f64 * stepping.step_s;
        match stepper.step(&mut system, t_s, &mut run.end.q, &mut run.end.qd) {
            Ok(report) => {
                let audit = &mut run.audit;
                audit.steps += 1;
                audit.fallbacks += usize::from(report.fell_back);
                audit.penetration_m = audit.penetration_m.max(report.penetration_m);
            }
            Err(failure) => {
                run.stop = SteppedStop::Failure(failure);
                break;
            }
        }
        run.end.t_s = initial.t_s + (step + 1) as f64 * stepping.step_s;
        let now = system.plant().momentum(&run.end.q, &run.end.qd);
        audit_forces(&mut run.audit, &model, &ground, &stepper, &momentum, &now);
        momentum = now;
        if let Some(name) = falls.fallen(system.plant(), &ground, &run.end.q) {
            run.stop = SteppedStop::Fall(name);
            break;
        }
        if (step + 1) % rows.max(1) == 0 || step + 1 == steps {
            write(&mut run, &model, control, &ground, &stepper);
        }
    }
    if run.stop != SteppedStop::End {
        write(&mut run, &model, control, &ground, &stepper);
    }
    run
}

/// World impulses of all contacts together [N s].
fn total(ground: &Ground, impulses: &[f64]) -> [f64; 3] {
    let mut sum = vec![0.0; ground.rows()];
    for impulse in impulses.chunks_exact(ground.rows()) {
        sum.iter_mut().zip(impulse).for_each(|(sum, p)| *sum += p);
    }
    ground.in_world(&sum)
}

fn audit_forces(
    audit: &mut SteppedAudit,
    model: &PlantModel,
    ground: &Ground,
    stepper: &TimeStepper,
    before: &[f64; 6],
    after: &[f64; 6],
) {
    let h = stepper.stepping().step_s;
    let impulse = total(ground, stepper.impulses());
    // A robot on a fixed base is held by more than its contacts.
    if model.joints.first().is_some_and(|joint| !joint.drivable) {
        for axis in (0..3).filter(|axis| !(model.planar && *axis == 1)) {
            let free = model.mass_kg * model.gravity[axis];
            let error = (after[axis] - before[axis] - impulse[axis]) / h - free;
            audit.force_n = audit.force_n.max(error.abs());
        }
    }
    let normal: f64 = ground.normal().iter().zip(impulse).map(|(n, p)| n * p).sum();
    let size: f64 = impulse.iter().map(|p| p * p).sum();
    if normal > 0.05 * h * model.mass_kg * 9.81 {
        let tangential = (size - normal * normal).max(0.0).sqrt();
        audit.friction_demand = audit.friction_demand.max(tangential / normal);
    }
}

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
        plant.link_transforms(q, &mut self.transforms);
        let points = &plant.model().fall_points;
        point_positions(points, &self.transforms, &mut self.positions);
        let below = self.positions.chunks_exact(3).position(|at| ground.gap(at) < 0.0)?;
        Some(points[below].name.clone())
    }
}

fn columns(model: &PlantModel, control: &Control) -> Vec<String> {
    let mut columns = vec!["t".to_owned()];
    for prefix in ["q", "qd"] {
        columns.extend(model.joints.iter().map(|joint| format!("{prefix}_{}", joint.name)));
    }
    let followed = model.joints.iter().zip(&control.joints);
    columns.extend(
        followed
            .filter(|(_, law)| law.reference.is_some())
            .map(|(joint, _)| format!("ref_{}", joint.name)),
    );
    for contact in &model.contacts {
        columns.extend(["x", "y", "z"].map(|axis| format!("f_{}_{axis}", contact.name)));
    }
    columns
}

fn write(
    run: &mut SteppedRun,
    model: &PlantModel,
    control: &Control,
    ground: &Ground,
    stepper: &TimeStepper,
) {
    let (values, end) = (&mut run.log.values, &run.end);
    values.push(end.t_s);
    values.extend(&end.q);
    values.extend(&end.qd);
    for joint in 0..model.joints.len() {
        values.extend(control.setpoint(joint, end.t_s).map(|setpoint| setpoint.position));
    }
    for impulse in stepper.impulses().chunks_exact(ground.rows()) {
        values.extend(ground.in_world(impulse).map(|p| p / stepper.stepping().step_s));
    }
}
