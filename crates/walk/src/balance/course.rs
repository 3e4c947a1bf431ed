//! Balance along a run of a scenario, or along a log.

use super::columns::Columns;
use super::instant::{Instant, Moving};
use crate::error::{BalanceError, Error};
use crate::poincare::{PoincareOptions, WantedSection, analyse};
use denavit_plants::Plant;
use denavit_simulate::scenario::{RunScheme, Scenario};
use denavit_simulate::{Log, LogFile, Run, Simulation, Stop, simulate};
use nalgebra::{Cholesky, DMatrix, DVector};

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
    /// The scheme of the run, as files and logs call it; none where a log does not say.
    pub scheme: Option<String>,
    /// The distance of instants, where it was asked for or chosen \[s\].
    pub period_s: Option<f64>,
    /// Instant after instant.
    pub instants: Vec<Instant>,
    /// The run that was made for it.
    pub run: Option<Run>,
}

/// Balance along a scenario, at this distance of instants \[s\]: over one cycle where its gait has
/// one and `whole` is false, else from its start to its end.
///
/// # Errors
/// Robots that do not walk, runs that do not begin.
pub fn course_of_scenario(
    scenario: &mut Scenario,
    period_s: f64,
    whole: bool,
) -> Result<Course, Error> {
    course_on_grid(scenario, Grid::Every(period_s), whole)
}

/// Which instants are looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grid {
    /// At this distance \[s\].
    Every(f64),
    /// At this distance \[s\], of long runs at a larger one: at most 200 000.
    From(f64),
}

/// More instants are refused: each takes about 1.3 kB.
pub const MOST_INSTANTS: u32 = 1_000_000;
/// So many are made where nobody asked for more.
const ENOUGH_INSTANTS: f64 = 200_000.0;

impl Grid {
    /// The distance of instants over a time, both \[s\].
    fn period_s(self, over_s: f64) -> Result<f64, Error> {
        match self {
            Self::Every(period_s) if over_s / period_s > f64::from(MOST_INSTANTS) => {
                Err(BalanceError::TooMany((over_s / period_s).ceil(), MOST_INSTANTS).into())
            }
            Self::Every(period_s) => Ok(period_s),
            Self::From(mut period_s) => {
                while over_s / period_s > ENOUGH_INSTANTS {
                    period_s *= 2.0;
                }
                Ok(period_s)
            }
        }
    }
}

/// Balance along a scenario, as [`course_of_scenario`] has it, on a grid of instants. The run is
/// made from event to event, whatever the scenario's scheme: that has forces at instants.
///
/// # Errors
/// Robots that do not walk, runs that do not begin, more instants than are kept.
pub fn course_on_grid(scenario: &mut Scenario, grid: Grid, whole: bool) -> Result<Course, Error> {
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
    let period_s = grid.period_s(end_s - start.t_s)?;
    let simulation = Simulation {
        end_s,
        log_period_s: period_s,
        logs_accelerations: true,
        ..scenario.simulation.clone()
    };
    let plant = scenario.plant.as_mut();
    let run = simulate(plant, &scenario.control, &start, &simulation);
    let run = run.map_err(BalanceError::Start)?;
    let columns = Columns::of(plant.model(), &run.log).map_err(|_| BalanceError::NotWalking)?;
    let mut instants = instants(plant, &run.log, &columns)?;
    if run.stop != Stop::End {
        // the last row of a run that breaks down has no forces
        instants.retain(|instant| instant.center_of_mass[2].iter().all(|a| a.is_finite()));
    }
    let scheme = Some(RunScheme::Event.word().to_owned());
    Ok(Course { over, scheme, period_s: Some(period_s), instants, run: Some(run) })
}

/// Balance along a log with positions and velocities of all joints, the base included, and the
/// forces on the contact points. Accelerations are its columns `qdd_JOINT`, or else those that its
/// torques, its forces and what pushes (`w_LINK_fx|fy|fz|mx|my|mz`) make. Rows without forces are
/// left out.
///
/// # Errors
/// Robots that do not walk, columns that are not there, cells that are empty or no digits.
pub fn course_of_log(plant: &mut dyn Plant, file: &LogFile) -> Result<Course, Error> {
    check_walker(plant)?;
    let columns = Columns::of_file(plant.model(), file).map_err(BalanceError::Log)?;
    let instants = instants(plant, &file.log, &columns)?;
    let scheme = file.log.scheme().map(str::to_owned);
    Ok(Course { over: Over::Run, scheme, period_s: None, instants, run: None })
}

/// Balance along a run that was made, as its log has it.
///
/// # Errors
/// Robots that do not walk, logs without velocities or forces.
pub fn course_of_run(plant: &mut dyn Plant, log: &Log) -> Result<Course, Error> {
    check_walker(plant)?;
    let columns = Columns::of(plant.model(), log).map_err(|_| BalanceError::NotWalking)?;
    let instants = instants(plant, log, &columns)?;
    let scheme = log.scheme().map(str::to_owned);
    Ok(Course { over: Over::Run, scheme, period_s: None, instants, run: None })
}

/// Whether a robot can walk, and fall: it has a floating base and contact points.
///
/// # Errors
/// Robots that cannot.
pub fn check_walker(plant: &mut dyn Plant) -> Result<(), Error> {
    let model = plant.model();
    let floats = model.joints.first().is_some_and(|joint| !joint.drivable);
    let walks = floats && !model.contacts.is_empty() && plant.walking().is_some();
    if walks { Ok(()) } else { Err(BalanceError::NotWalking.into()) }
}

/// The instants of the rows that have forces, or accelerations.
fn instants(plant: &mut dyn Plant, log: &Log, columns: &Columns) -> Result<Vec<Instant>, Error> {
    let mut instants = Vec::with_capacity(log.len());
    for row in log.rows().filter(|row| columns.has_forces(row)) {
        let take = |columns: &[usize]| -> Vec<f64> { columns.iter().map(|c| row[*c]).collect() };
        let t_s = row[columns.time];
        let (q, qd) = (take(&columns.positions), take(&columns.velocities));
        let forces: Vec<[f64; 3]> =
            columns.forces.iter().map(|force| force.map(|column| row[column])).collect();
        let wrenches = columns.wrenches(row);
        let qdd = match &columns.accelerations {
            Some(columns) => take(columns),
            None => {
                let torque = |column: &Option<usize>| column.map_or(0.0, |column| row[column]);
                let mut torques: Vec<f64> = columns.torques.iter().map(torque).collect();
                for wrench in &wrenches {
                    let pushed = wrench.torques(plant, &q);
                    torques.iter_mut().zip(pushed).for_each(|(torque, push)| *torque += push);
                }
                let found = accelerations(plant, &q, &qd, &torques, &forces);
                found.ok_or(BalanceError::Singular(t_s))?
            }
        };
        let closed = closed(plant, &forces, columns.closed(row));
        let at = Moving {
            t_s,
            q: &q,
            qd: &qd,
            qdd: &qdd,
            forces: &forces,
            wrenches: &wrenches,
            closed: &closed,
        };
        instants.push(Instant::of(plant, &at).ok_or(BalanceError::NotWalking)?);
    }
    Ok(instants)
}

/// Which contact points carry: those that are closed by their digits, and those on which the ground
/// presses. By time stepping digits are of the end of a row, and forces means over it: what they
/// act on carried.
fn closed(plant: &dyn Plant, forces: &[[f64; 3]], digits: Option<Vec<bool>>) -> Vec<bool> {
    let normal = plant.model().ground.normal;
    let weight = plant.model().mass_kg * 9.81;
    // beside digits, rounding alone is no force
    let least = if digits.is_some() { 1e-12 } else { 1e-6 } * weight;
    let presses = |force: &[f64; 3]| {
        let along: f64 = force.iter().zip(normal).map(|(f, n)| f * n).sum();
        along > least
    };
    let closed = |contact: usize| digits.as_ref().is_some_and(|closed| closed[contact]);
    forces.iter().enumerate().map(|(contact, force)| closed(contact) || presses(force)).collect()
}

/// D^-1 (tau - bias + W f).
fn accelerations(
    plant: &mut dyn Plant,
    q: &[f64],
    qd: &[f64],
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_runs_have_at_most_200_000_instants() {
        let period = |over_s: f64| Grid::From(5e-4).period_s(over_s).unwrap();
        assert_eq!(period(100.0), 5e-4);
        // 1000 s / 200 000 = 5 ms, and the next doubling of 0.5 ms is 8 ms
        assert_eq!(period(1000.0), 8e-3);
        assert_eq!(Grid::Every(1e-3).period_s(1000.0), Ok(1e-3));
        assert!(Grid::Every(0.9e-3).period_s(1000.0).is_err());
    }
}
