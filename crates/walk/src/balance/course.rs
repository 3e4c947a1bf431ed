//! Balance along a run of a scenario, or along a log.

use super::instant::{Instant, Moving};
use crate::poincare::{PoincareOptions, WantedSection, analyse};
use denavit_plants::Plant;
use denavit_simulate::scenario::{RunScheme, Scenario};
use denavit_simulate::{Log, Run, Simulation, StartError, Stop, simulate};
use nalgebra::{Cholesky, DMatrix, DVector};
use std::fmt;

/// The time that a course covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    /// One cycle of a gait, from its fixed point.
    Cycle,
    /// A whole run, or a log.
    Run,
}

impl Over {
    /// What answers call it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Cycle => "cycle",
            Self::Run => "run",
        }
    }
}

/// Balance along a run.
#[derive(Clone, Debug)]
pub struct Course {
    /// What it covers.
    pub over: Over,
    /// Instant after instant.
    pub instants: Vec<Instant>,
    /// The run that was made for it.
    pub run: Option<Run>,
}

/// Why there is no course.
#[derive(Clone, Debug, PartialEq)]
pub enum BalanceError {
    /// A log has no such column.
    NoColumn(String),
    /// The robot has no contact points, or its base is fixed: no point of the ground tells of it.
    NotWalking,
    /// The run does not begin.
    Start(StartError),
    /// The mass matrix is singular at this time \[s\].
    Singular(f64),
}

impl fmt::Display for BalanceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoColumn(name) => write!(f, "the log has no column `{name}`"),
            Self::NotWalking => {
                write!(f, "only robots with a floating base and contact points can fall")
            }
            Self::Start(error) => write!(f, "{error}"),
            Self::Singular(t_s) => write!(f, "at {t_s} s the mass matrix is singular"),
        }
    }
}

impl std::error::Error for BalanceError {}

/// Balance along a scenario, at this distance of instants \[s\]: over one cycle where its gait has
/// one and `whole` is false, else from its start to its end.
///
/// # Errors
/// Robots that do not walk, runs that do not begin.
pub fn course_of_scenario(
    scenario: &mut Scenario,
    period_s: f64,
    whole: bool,
) -> Result<Course, BalanceError> {
    check_walker(scenario.plant.as_mut())?;
    let is_pushed = !scenario.simulation.pushes.is_empty();
    let cycle = if whole || is_pushed || scenario.scheme == RunScheme::TimeStepping {
        None
    } else {
        let options = PoincareOptions {
            checks: false,
            section: WantedSection::Best,
            ..PoincareOptions::default()
        };
        analyse(scenario, &options).ok()
    };
    let (over, start, end_s) = match cycle {
        Some(found) => {
            let start = found.cycle.chart.base.clone();
            let end_s = start.t_s + found.cycle.period_s;
            (Over::Cycle, start, end_s)
        }
        None => (Over::Run, scenario.initial.clone(), scenario.simulation.end_s),
    };
    let simulation = Simulation {
        end_s,
        log_period_s: period_s,
        logs_accelerations: true,
        ..scenario.simulation.clone()
    };
    let plant = scenario.plant.as_mut();
    let run = simulate(plant, &scenario.control, &start, &simulation);
    let run = run.map_err(BalanceError::Start)?;
    let mut instants = instants(plant, &run.log)?;
    if run.stop != Stop::End {
        // the last row of a run that breaks down has no forces
        instants.retain(|instant| instant.center_of_mass[2].iter().all(|a| a.is_finite()));
    }
    Ok(Course { over, instants, run: Some(run) })
}

/// Balance along a log with positions and velocities of all joints, the base included, and the
/// forces on the contact points. Accelerations are its columns `qdd_JOINT`, or else those that its
/// torques and forces make.
///
/// # Errors
/// Robots that do not walk, columns that are not there.
pub fn course_of_log(plant: &mut dyn Plant, log: &Log) -> Result<Course, BalanceError> {
    check_walker(plant)?;
    Ok(Course { over: Over::Run, instants: instants(plant, log)?, run: None })
}

/// Whether a robot can walk, and fall: it has a floating base and contact points.
///
/// # Errors
/// Robots that cannot.
pub fn check_walker(plant: &mut dyn Plant) -> Result<(), BalanceError> {
    let model = plant.model();
    let floats = model.joints.first().is_some_and(|joint| !joint.drivable);
    let walks = floats && !model.contacts.is_empty() && plant.walking().is_some();
    if walks { Ok(()) } else { Err(BalanceError::NotWalking) }
}

/// Columns of a log by what they are.
struct Columns {
    time: usize,
    positions: Vec<usize>,
    velocities: Vec<usize>,
    accelerations: Option<Vec<usize>>,
    torques: Vec<Option<usize>>,
    forces: Vec<[usize; 3]>,
    modes: Option<usize>,
}

impl Columns {
    fn of(plant: &dyn Plant, log: &Log) -> Result<Self, BalanceError> {
        let find = |name: String| {
            let place = log.columns.iter().position(|column| *column == name);
            place.ok_or(BalanceError::NoColumn(name))
        };
        let model = plant.model();
        let all = |prefix: &str| -> Result<Vec<usize>, BalanceError> {
            let names = model.joints.iter().map(|joint| format!("{prefix}_{}", joint.name));
            names.map(find).collect()
        };
        let force = |contact: &denavit_plants::PointModel| {
            let [x, y, z] = ["x", "y", "z"].map(|axis| format!("f_{}_{axis}", contact.name));
            Ok([find(x)?, find(y)?, find(z)?])
        };
        Ok(Self {
            time: find("t".to_owned())?,
            positions: all("q")?,
            velocities: all("qd")?,
            accelerations: all("qdd").ok(),
            torques: {
                let joints = model.joints.iter();
                joints.map(|joint| find(format!("tau_{}", joint.name)).ok()).collect()
            },
            forces: model.contacts.iter().map(force).collect::<Result<_, _>>()?,
            modes: find("contact_modes".to_owned()).ok(),
        })
    }
}

fn instants(plant: &mut dyn Plant, log: &Log) -> Result<Vec<Instant>, BalanceError> {
    let columns = Columns::of(plant, log)?;
    let mut instants = Vec::with_capacity(log.len());
    for row in log.rows() {
        let take = |columns: &[usize]| -> Vec<f64> { columns.iter().map(|c| row[*c]).collect() };
        let t_s = row[columns.time];
        let (q, qd) = (take(&columns.positions), take(&columns.velocities));
        let forces: Vec<[f64; 3]> =
            columns.forces.iter().map(|force| force.map(|column| row[column])).collect();
        let qdd = match &columns.accelerations {
            Some(columns) => take(columns),
            None => {
                let torque = |column: &Option<usize>| column.map_or(0.0, |column| row[column]);
                let torques: Vec<f64> = columns.torques.iter().map(torque).collect();
                let found = accelerations(plant, (&q, &qd), &torques, &forces);
                found.ok_or(BalanceError::Singular(t_s))?
            }
        };
        let closed = closed(plant, &forces, columns.modes.map(|column| row[column]));
        let at = Moving { t_s, q: &q, qd: &qd, qdd: &qdd, forces: &forces, closed: &closed };
        instants.push(Instant::of(plant, &at).ok_or(BalanceError::NotWalking)?);
    }
    Ok(instants)
}

/// Which contact points are closed: by their decimal digits, else where the ground presses.
fn closed(plant: &dyn Plant, forces: &[[f64; 3]], modes: Option<f64>) -> Vec<bool> {
    let normal = plant.model().ground.normal;
    let weight = plant.model().mass_kg * 9.81;
    let presses = |force: &[f64; 3]| {
        let along: f64 = force.iter().zip(normal).map(|(f, n)| f * n).sum();
        along > 1e-6 * weight
    };
    let digit = |modes: f64, contact: usize| {
        let digit = (modes / 10.0_f64.powi(contact as i32)) % 10.0;
        digit.floor() > 0.0
    };
    match modes.filter(|modes| modes.is_finite()) {
        Some(modes) => (0..forces.len()).map(|contact| digit(modes, contact)).collect(),
        None => forces.iter().map(presses).collect(),
    }
}

/// D^-1 (tau - bias + W f).
fn accelerations(
    plant: &mut dyn Plant,
    (q, qd): (&[f64], &[f64]),
    torques: &[f64],
    forces: &[[f64; 3]],
) -> Option<Vec<f64>> {
    let (n, points) = (q.len(), forces.len());
    let mut mass = vec![0.0; n * n];
    let mut bias = vec![0.0; n];
    let mut jacobian = vec![0.0; 3 * points * n];
    plant.mass_matrix(q, &mut mass);
    plant.bias(q, qd, &mut bias);
    plant.contact_jacobian(q, &mut jacobian);
    let mut driving = DVector::from_fn(n, |joint, _| torques[joint] - bias[joint]);
    for (entry, force) in forces.iter().flatten().enumerate() {
        for joint in 0..n {
            driving[joint] += jacobian[entry * n + joint] * force;
        }
    }
    let factored = Cholesky::new(DMatrix::from_row_slice(n, n, &mass))?;
    Some(factored.solve(&driving).as_slice().to_vec())
}
